// The picture of a sweep over two sliders: a click on a place runs the diagram there.
import { quantity } from "../numbers";
import { run_live } from "../state/run";
import { get, patch, useStudio } from "../state/store";

export function SweepScopes() {
  const sweep = useStudio((state) => state.sweep);
  if (!sweep) return null;
  const all = sweep.values.flat().filter((value): value is number => value !== null);
  const low = Math.min(...all), high = Math.max(...all);
  const choose = (i: number, j: number) => {
    const text = (value: number, unit: string) => (unit && unit !== "1" ? `${value} ${unit}` : String(value));
    patch({ overrides: { ...get().overrides, [sweep.x_set]: text(sweep.x[i]!, sweep.x_unit), [sweep.y_set]: text(sweep.y[j]!, sweep.y_unit) }, scope_tab: "run" });
    void run_live();
  };
  return (
    <div className="sweep">
      <p>{sweep.metric} over {sweep.x_set} (→) and {sweep.y_set} (↑), from <b>{quantity(low, sweep.unit, 3)}</b> (light) to <b>{quantity(high, sweep.unit, 3)}</b> (dark). A click runs the diagram there.</p>
      <table>
        <tbody>
          {sweep.y.map((_, row) => {
            const j = sweep.y.length - 1 - row;
            return (
              <tr key={j}>
                <th scope="row">{j === 0 || row === 0 ? quantity(sweep.y[j]!, sweep.y_unit, 3) : ""}</th>
                {sweep.x.map((x, i) => {
                  const value = sweep.values[j]?.[i] ?? null;
                  const share = value === null ? 0 : high > low ? (value - low) / (high - low) : 0.5;
                  const title = `${sweep.x_set} ${quantity(x, sweep.x_unit)}, ${sweep.y_set} ${quantity(sweep.y[j]!, sweep.y_unit)}: ${value === null ? "failed" : quantity(value, sweep.unit)}`;
                  return <td key={i}><button type="button" className={value === null ? "failed" : ""} title={title} aria-label={title} style={value === null ? {} : { backgroundColor: `color-mix(in oklab, var(--heat-high) ${Math.round(100 * share)}%, var(--heat-low))` }} onClick={() => choose(i, j)} /></td>;
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
