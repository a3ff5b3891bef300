// Measured beside simulated, the error before and after, and what remains against time, position and velocity.
import { useLayoutEffect, useMemo, useRef, useState } from "react";
import { prettyUnit, quantity } from "../numbers";
import { ask, attempt } from "../state/session";
import { SCOPE_POINTS } from "../state/run";
import { patch, useStudio, type Range } from "../state/store";
import type { Compared, Comparison, Signal } from "../protocol/types";
import { Plot } from "./Plot";
import type { Curve } from "./drawing";
import { set_cursor } from "./RunScopes";
import { LEGEND_HEIGHT, NUMBERS_HEIGHT, useRoom } from "./size";

const VERDICT_HEIGHT = 36, RESIDUAL_HEIGHT = 160;  // px
const bounded = (size: number, least: number, most: number): number => Math.round(Math.max(least, Math.min(most, size)));
const show_range = (range: Range | null): void => patch({ range });

/** In a range of time, the program sends what lies in it in full detail. */
function useDetail(comparison: Comparison | null, range: Range | null): Map<string, Signal> {
  const [detail, setDetail] = useState(new Map<string, Signal>()), seen = useRef<{ comparison: Comparison | null; range: Range | null }>({ comparison: null, range: null });
  // Before what is there is painted for the new range: the program works meanwhile.
  useLayoutEffect(() => {
    // Until it comes, what was there is shown: the detail of the range around it, if there is one.
    const { comparison: old, range: around } = seen.current;
    const is_within = comparison === old && range && around && around.from <= range.from && range.to <= around.to;
    if (!is_within) setDetail((before) => (before.size ? new Map() : before));
    seen.current = { comparison, range };
    if (!comparison || !range) return;
    let current = true;
    const names = comparison.signals.flatMap((signal) => ["measured", "simulated", "error"].map((what) => `${what} ${signal.name}`));
    void attempt(ask<{ signals: Signal[] }>("signals", { source: `comparison:${comparison.comparison}`, names, ...range, points: SCOPE_POINTS }))
      .then((answer) => { if (current && answer) setDetail(new Map(answer.signals.map((signal) => [signal.name, signal]))); });
    return () => { current = false; };
  }, [comparison, range]);
  return detail;
}

function Verdict({ signal, before }: { signal: Compared; before: Compared | undefined }) {
  const falls = before && before.rmse !== null && signal.rmse !== null && signal.rmse !== before.rmse;
  return (
    <div className="verdict" data-signal={signal.name}>
      <span>Error of {signal.name}</span>
      {falls && <><b className="was">{quantity(before.rmse, before.unit, 3)}</b><span aria-hidden="true">→</span><span className="hidden">now</span></>}
      <b className={falls ? (signal.rmse! < before.rmse! ? "good" : "bad") : ""} data-rmse={signal.rmse}>{quantity(signal.rmse, signal.unit, 3)}</b>
      <span className="soft">rms</span>
      {signal.max !== null && <span className="soft">largest {quantity(signal.max, signal.unit, 3)}</span>}
      {signal.resolution ? <span className="soft">resolution {quantity(signal.resolution, signal.unit, 3)}</span> : null}
    </div>
  );
}

export function CompareScopes() {
  const comparison = useStudio((state) => state.comparison), before = useStudio((state) => state.comparison_before);
  const preview = useStudio((state) => state.preview), range = useStudio((state) => state.range), cursors = useStudio((state) => state.cursors);
  const detail = useDetail(comparison, range), { ref, room } = useRoom();
  const plots = useMemo(() => (comparison?.signals ?? []).map((signal) => {
    const now = (what: "measured" | "simulated" | "error") => {
      const zoomed = detail.get(`${what} ${signal.name}`);
      return zoomed ? { x: zoomed.x, y: zoomed.y } : { x: signal.x, y: signal[what] };
    };
    const old = before?.signals.find((entry) => entry.name === signal.name);
    const both: Curve[] = [
      { name: "measured", label: `${signal.name} measured`, unit: signal.unit, ...now("measured"), colour: 7, style: "measured" },
      { name: "simulated", label: "simulated", unit: signal.unit, ...now("simulated"), colour: 0, style: "line" },
    ];
    const error: Curve[] = [
      ...(old ? [{ name: "before", label: "error before", unit: signal.unit, x: old.x, y: old.error, colour: 1, style: "ghost" as const }] : []),
      { name: "error", label: "error, simulated − measured", unit: signal.unit, ...now("error"), colour: 1, style: "line" as const },
      ...(preview && preview.signal === signal.name ? [{ name: "preview", label: `error with ${preview.effects.join(", ")}`, unit: preview.unit, x: preview.x, y: preview.y, colour: 2, style: "preview" as const }] : []),
    ];
    return { signal, old, both, error };
  }), [comparison, before, preview, detail]);
  const residuals = useMemo(() => (comparison?.residual ?? []).map((entry) => {
    const old = before?.residual.find((other) => other.against === entry.against && other.of === entry.of);
    const curves: Curve[] = [
      ...(old ? [{ name: "before", label: "before", unit: old.residual_unit, x: old.x, y: old.y, colour: 7, style: old.points ? "points" as const : "ghost" as const }] : []),
      { name: entry.against, label: `${entry.of} over ${entry.against}`, unit: entry.residual_unit, x: entry.x, y: entry.y, colour: 3, style: entry.points ? "points" : "line" },
    ];
    return { entry, curves };
  }), [comparison, before]);
  const elsewhere = useMemo((): Curve[] => (preview && !comparison?.signals.some((signal) => signal.name === preview.signal)
    ? [{ name: "preview", label: `error of ${preview.signal} in the diagnosed record, with ${preview.effects.join(", ")}: ${quantity(preview.rmse, preview.unit, 3)} rms`, unit: preview.unit, x: preview.x, y: preview.y, colour: 2, style: "preview" }] : []), [preview, comparison]);
  if (!comparison) return <p className="empty">Drop a recording (CSV, MAT) on the page, or choose an experiment under Measurements.</p>;
  const floor = comparison.force?.noise_floor;
  // Both plots of a signal fit into the room; the error, which is what matters, gets the larger part.
  const space = room - VERDICT_HEIGHT - 2 * LEGEND_HEIGHT - NUMBERS_HEIGHT;
  const measured_height = bounded(0.38 * space, 80, 170), error_height = bounded(0.62 * space, 110, 260) + NUMBERS_HEIGHT;
  return (
    <div className="comparison" ref={ref}>
      {elsewhere.length > 0 && <Plot title="Preview" curves={elsewhere} group="" x_label="time" x_unit="s" y_unit={preview!.unit} height={RESIDUAL_HEIGHT} show_x />}
      {plots.map(({ signal, old, both, error }) => (
        <div key={signal.name} className="pair">
          <Verdict signal={signal} before={old} />
          <Plot title={`${signal.name}, measured and simulated`} curves={both} group="record" x_label="time" x_unit="s" y_unit={signal.unit} height={measured_height} show_x={false}
            range={range} cursors={cursors} on_zoom={(from, to) => show_range({ from, to })} on_reset={() => show_range(null)} on_cursor={set_cursor} />
          <Plot title={`Error of ${signal.name}`} curves={error} group="record" x_label="time" x_unit="s" y_unit={signal.unit} height={error_height} show_x
            range={range} cursors={cursors} on_zoom={(from, to) => show_range({ from, to })} on_reset={() => show_range(null)} on_cursor={set_cursor}
            band={signal.resolution ? { low: -signal.resolution / 2, high: signal.resolution / 2, label: "" } : null} />
        </div>
      ))}
      {comparison.why_no_force && <p className="hint">{comparison.why_no_force}</p>}
      {residuals.length > 0 && <h3>What the model lacks{comparison.force ? `: ${quantity(comparison.force.rmse, comparison.force.unit, 3)} rms, noise floor ${quantity(floor, comparison.force.unit, 3)}` : ""}</h3>}
      <div className="residuals">
        {residuals.map(({ entry, curves }) => (
          <Plot key={entry.of + entry.against} title={`${entry.of} over ${entry.against}`} curves={curves} group="" x_label={entry.against} x_unit={entry.unit} y_unit={entry.residual_unit} height={RESIDUAL_HEIGHT} show_x
            band={floor && entry.residual_unit === comparison.force?.unit ? { low: -floor, high: floor, label: `noise ±${prettyUnit(quantity(floor, entry.residual_unit, 2))}` } : null} />
        ))}
      </div>
    </div>
  );
}
