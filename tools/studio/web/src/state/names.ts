// Names of the diagram in the page: they follow when the program renames a block or a parameter, and when that is undone.
import type { Renamed } from "../protocol/types";
import { get, patch } from "./store";

/** A port, or a setting inside a block. */
function inside_block(path: string, renamed: Renamed[]): string {
  for (const { kind, from, to } of renamed) if (kind === "block" && path.startsWith(from + ".")) path = to + path.slice(from.length);
  return path;
}
/** What a slider, a fit or `--set` names: a parameter, or a setting inside a block. */
function setting(path: string, renamed: Renamed[]): string {
  for (const { kind, from, to } of renamed) if (kind === "parameter" && path === from) path = to;
  return inside_block(path, renamed);
}

export function follow_names(renamed: Renamed[]): void {
  if (!renamed.length) return;
  const { overrides, plots, fit_chosen, diagnosed_set, linear } = get();
  const settings = (set: Record<string, string>) => Object.fromEntries(Object.entries(set).map(([path, text]) => [setting(path, renamed), text]));
  patch({
    overrides: settings(overrides), diagnosed_set: settings(diagnosed_set),
    fit_chosen: fit_chosen.map((path) => setting(path, renamed)),
    plots: plots.map((names) => names.map((name) => inside_block(name, renamed))),
    linear: linear && { ...linear, from: inside_block(linear.from, renamed), to: inside_block(linear.to, renamed), to_name: inside_block(linear.to_name, renamed) },
  });
}
