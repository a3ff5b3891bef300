// What lies between the cursors A and B: differences, slopes, and root mean squares of the full data.
import { useEffect, useState } from "react";
import { quantity } from "../numbers";
import type { Signal } from "../protocol/types";
import { between } from "../state/run";
import { attempt } from "../state/session";
import { useStudio, type ScopeTab } from "../state/store";

const PAUSE = 120;  // ms after the last movement

const at = (signal: Signal | undefined, last: boolean): number | null => (signal ? (last ? signal.y.at(-1) : signal.y[0]) ?? null : null);

export function CursorTable({ source, tab }: { source: string; tab: ScopeTab }) {
  const cursors = useStudio((state) => state.cursors)!;
  const plots = useStudio((state) => state.plots);
  const comparison = useStudio((state) => state.comparison);
  const names = tab === "compare" ? (comparison?.signals ?? []).flatMap((signal) => [`measured ${signal.name}`, `simulated ${signal.name}`, `error ${signal.name}`]) : plots.flat();
  const [signals, setSignals] = useState<Signal[]>([]);
  const { a, b } = cursors, key = `${source} ${a} ${b} ${names.join()}`;
  useEffect(() => {
    const timer = setTimeout(() => void attempt(between(source, names, a, b)).then((answer) => { if (answer) setSignals(answer.signals); }), PAUSE);
    return () => clearTimeout(timer);
  // eslint-disable-next-line
  }, [key]);
  const seconds = b - a;
  return (
    <div className="cursor-table">
      <table>
        <caption>A {quantity(a, "s", 5)}, B {quantity(b, "s", 5)}, B − A {quantity(seconds, "s", 5)}, 1/(B − A) {seconds ? quantity(1 / Math.abs(seconds), "Hz", 4) : "–"}</caption>
        <thead><tr><th scope="col">signal</th><th scope="col">at A</th><th scope="col">at B</th><th scope="col">B − A</th><th scope="col">slope</th><th scope="col">rms</th><th scope="col">least</th><th scope="col">greatest</th></tr></thead>
        <tbody>
          {signals.map((signal) => {
            const [first, last] = a <= b ? [at(signal, false), at(signal, true)] : [at(signal, true), at(signal, false)];
            const change = first !== null && last !== null ? last - first : null;
            return (
              <tr key={signal.name}><th scope="row">{signal.name}</th>
                <td>{quantity(first, signal.unit)}</td><td>{quantity(last, signal.unit)}</td><td>{quantity(change, signal.unit)}</td>
                <td>{change === null || !seconds ? "–" : quantity(change / seconds, signal.unit && signal.unit !== "1" ? `${signal.unit}/s` : "1/s")}</td>
                <td>{quantity(signal.rms, signal.unit)}</td><td>{quantity(signal.min, signal.unit)}</td><td>{quantity(signal.max, signal.unit)}</td></tr>
            );
          })}
        </tbody>
      </table>
    </div>
  );
}
