// Names and colours of signals.

export const COLOURS = 8;

/** The name in the log of a wire of one level. Inputs of a subdiagram have no signal of their own: "". */
export const signal_name = (inside: string, source: string): string =>
  source.includes(".") ? (inside ? `${inside}.${source}` : source) : "";

/** The number of the colour of each signal: in the order in which the scopes show them. */
export function signal_colours(plots: string[][]): Map<string, number> {
  const colours = new Map<string, number>();
  for (const name of plots.flat()) if (!colours.has(name)) colours.set(name, colours.size % COLOURS);
  return colours;
}
