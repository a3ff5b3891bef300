// Scopes of the present run, with the run before as a ghost and kept runs beside it.
import { useMemo } from "react";
import { move_signal, toggle_signal, zoom } from "../state/run";
import { signal_colours } from "../state/signals";
import { get, patch, useStudio } from "../state/store";
import type { RunAnswer } from "../protocol/types";
import { Plot } from "./Plot";
import type { Curve, Style } from "./drawing";
import { usePlotHeight, VERDICT_HEIGHT } from "./size";

function curve_of(run: RunAnswer | null, name: string, colour: number, style: Style, label: string): Curve[] {
  const signal = run?.signals.find((entry) => entry.name === name);
  if (!signal) return [];
  return [{ name, label, unit: signal.unit, x: signal.x, y: signal.y, colour, style: style === "line" && signal.steps ? "steps" : style }];
}

/** Several curves of one earlier run are named once in the legend of a plot. */
function once(curves: Curve[]): Curve[] {
  const seen = new Set<string>();
  return curves.map((curve) => {
    if (curve.style !== "ghost" && curve.style !== "pinned") return curve;
    if (seen.has(curve.label)) return { ...curve, label: "" };
    seen.add(curve.label);
    return curve;
  });
}

export const set_cursor = (which: "a" | "b", x: number): void => { const { cursors } = get(); if (cursors) patch({ cursors: { ...cursors, [which]: x } }); };

export function RunScopes() {
  const run = useStudio((state) => state.run), ghost = useStudio((state) => state.ghost), pinned = useStudio((state) => state.pinned);
  const plots = useStudio((state) => state.plots), range = useStudio((state) => state.range), cursors = useStudio((state) => state.cursors);
  const loads = useStudio((state) => state.document?.loads), alone = useStudio((state) => state.document?.runs_alone);
  const { ref, height } = usePlotHeight(plots.length, run?.verdict.length ? VERDICT_HEIGHT : 0);
  const curves = useMemo(() => {
    const colours = signal_colours(plots);
    return plots.map((names) => once(names.flatMap((name) => {
      const colour = colours.get(name) ?? 0;
      return [
        ...curve_of(ghost && ghost.run !== run?.run ? ghost : null, name, colour, "ghost", "before"),
        ...pinned.filter((other) => other.run !== run?.run).flatMap((other) => curve_of(other, name, colour, "pinned", other.name || `run ${other.run}`)),
        ...curve_of(run, name, colour, "line", name),
      ];
    })));
  }, [run, ghost, pinned, plots]);
  if (!run) return <p className="empty">{loads === false ? "The diagram has problems: it cannot run. The list of problems says where." : alone === false ? "This diagram has inputs: it runs inside another one, or along an experiment that drives them." : "Press Run, or Ctrl+Enter."}</p>;
  if (!plots.length) return <p className="empty">Click a wire of the diagram to see its signal here.</p>;
  return (
    <div ref={ref}>
      {run.verdict.slice(0, 1).map((notice) => <p key={notice.text} className={`outcome is-${notice.severity}`} title={run.verdict.map((other) => other.text).join("\n")}>{notice.text}</p>)}
      {plots.map((names, k) => {
        const last = k === plots.length - 1, unit = run.signals.find((signal) => signal.name === names[0])?.unit ?? "";
        return (
          <Plot key={names.join()} title={`Plot of ${names.join(", ")}`} curves={curves[k]!} group="time" x_label="time" x_unit="s" y_unit={unit} height={height(last)} show_x={last}
            range={range} cursors={cursors} on_zoom={(from, to) => void zoom({ from, to })} on_reset={() => void zoom(null)} on_cursor={set_cursor}
            on_remove={(name) => void toggle_signal(name)} on_drop={(name) => move_signal(name, k)} />
        );
      })}
    </div>
  );
}
