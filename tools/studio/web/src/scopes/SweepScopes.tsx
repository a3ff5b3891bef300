// The picture of a sweep over two numbers: a click on a place runs the diagram there.
import { prettyUnit, quantity } from "../numbers";
import { settings_text, with_unit } from "../state/request";
import { follow_overrides, write_sweep } from "../state/run";
import { get, patch, useStudio, type State } from "../state/store";

/** Values further apart than this factor are told apart by their logarithms: one that nearly diverges leaves colours for the others. */
const WIDE = 30;

function colours_of(values: number[]): { share: (value: number) => number; low: number; high: number; is_logarithmic: boolean } {
  const low = values.reduce((least, value) => Math.min(least, value), Infinity), high = values.reduce((most, value) => Math.max(most, value), -Infinity);
  const is_logarithmic = low > 0 && high / low > WIDE;
  const scale = is_logarithmic ? Math.log : (value: number) => value;
  return { low, high, is_logarithmic, share: (value) => (high > low ? (scale(value) - scale(low)) / (scale(high) - scale(low)) : 0.5) };
}
/** Both ends with as many digits as tell them apart. */
function ends(low: number, high: number, unit: string): [string, string] {
  const both = (digits: number): [string, string] => [quantity(low, unit, digits), quantity(high, unit, digits)];
  for (let digits = 3; digits < 10; ++digits) {
    const texts = both(digits);
    if (texts[0] !== texts[1]) return texts;
  }
  return both(3);
}
const heat = (share: number): string => `color-mix(in oklab, var(--heat-high) ${Math.round(100 * share)}%, var(--heat-low))`;

function choose(sweep: NonNullable<State["sweep"]>, i: number, j: number): void {
  const here = { [sweep.x_set]: with_unit(sweep.x[i]!, sweep.x_unit), [sweep.y_set]: with_unit(sweep.y[j]!, sweep.y_unit) };
  patch({ overrides: { ...get().overrides, ...sweep.set, ...here }, scope_tab: "run" });
  follow_overrides();
}

export function SweepScopes() {
  const sweep = useStudio((state) => state.sweep);
  if (!sweep) return <p className="empty">Choose two numbers under Inspect, with nothing selected.</p>;
  const cells = sweep.values.flat(), found = cells.filter((value): value is number => value !== null);
  const gaps = cells.length - found.length, { share, low, high, is_logarithmic } = colours_of(found), changes = settings_text(sweep.set);
  const [least, most] = ends(low, high, sweep.unit);
  return (
    <div className="sweep">
      <p>{sweep.metric} over {sweep.x_set} (→) and {sweep.y_set} (↑){changes && `, with ${prettyUnit(changes)}`}. A click runs the diagram there.</p>
      <p className="scale">
        {found.length > 0 && <><b>{least}</b><span className="heat" aria-hidden="true" style={{ backgroundImage: `linear-gradient(to right in oklab, ${heat(0)}, ${heat(1)})` }} /><b>{most}</b></>}
        {is_logarithmic && <span className="soft">logarithmic</span>}
        {gaps > 0 && <span className="soft"><span className="gap-sample" aria-hidden="true" /> {gaps} of {cells.length}: refused, or the run failed</span>}
      </p>
      {sweep.file ? <p className="command"><code>{sweep.file.command}</code></p>
        : <p className="buttons"><button type="button" title="Writes a sweep file beside the diagram, for loopwright sweep" onClick={() => void write_sweep()}>Repeat it in the terminal</button></p>}
      <table>
        <tbody>
          {sweep.y.map((_, row) => {
            const j = sweep.y.length - 1 - row;
            return (
              <tr key={j}>
                <th scope="row">{j === 0 || row === 0 ? quantity(sweep.y[j]!, sweep.y_unit, 3) : ""}</th>
                {sweep.x.map((x, i) => {
                  const value = sweep.values[j]?.[i] ?? null;
                  const title = `${sweep.x_set} ${quantity(x, sweep.x_unit)}, ${sweep.y_set} ${quantity(sweep.y[j]!, sweep.y_unit)}: ${value === null ? "refused, or the run failed" : quantity(value, sweep.unit)}`;
                  return <td key={i}><button type="button" className={value === null ? "failed" : ""} title={title} aria-label={title} style={value === null ? {} : { backgroundColor: heat(share(value)) }} onClick={() => choose(sweep, i, j)} /></td>;
                })}
              </tr>
            );
          })}
        </tbody>
        <tfoot><tr><th />{sweep.x.map((x, i) => <th key={i} scope="col">{i === 0 || i === sweep.x.length - 1 ? quantity(x, sweep.x_unit, 3) : ""}</th>)}</tr></tfoot>
      </table>
    </div>
  );
}
