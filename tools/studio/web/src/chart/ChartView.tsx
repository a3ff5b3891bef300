// The chart of a state machine over the canvas: states and transitions are selected by mouse and by keys, and edited in the panel.
import { useEffect, useState, type KeyboardEvent } from "react";
import { arrange_chart } from "../layout/client";
import type { ChartLayout, Point } from "../layout/messages";
import type { Block } from "../protocol/types";
import { add_state, choose_part, close_chart, written_transition, type ChartPart } from "../state/chart";
import { useStudio } from "../state/store";

const LINE = 15, TIP = 7, HALF_TIP = 3.2;  // px

const path_of = (points: Point[]): string => points.map(({ x, y }, i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");
/** An arrow head at the end of a line that runs along an axis. */
function tip(points: Point[]): string {
  const end = points.at(-1)!, before = points.at(-2) ?? end, u = Math.sign(Math.round(end.x - before.x)), v = Math.sign(Math.round(end.y - before.y));
  const x = end.x - u * TIP, y = end.y - v * TIP;
  return `M${end.x} ${end.y}L${x - v * HALF_TIP} ${y - u * HALF_TIP}L${x + v * HALF_TIP} ${y + u * HALF_TIP}z`;
}
const on_key = (action: () => void) => (event: KeyboardEvent) => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); event.stopPropagation(); action(); } };
const is_part = (a: ChartPart | null, b: ChartPart | null): boolean => a !== null && b !== null && JSON.stringify(a) === JSON.stringify(b);

export function ChartView() {
  const name = useStudio((state) => state.chart), editable = useStudio((state) => state.document?.view?.editable ?? false);
  const block = useStudio((state) => (state.chart ? state.document?.view?.blocks.find((entry) => entry.name === state.chart) : undefined));
  const chart = block?.chart ?? null, [layout, setLayout] = useState<ChartLayout | null>(null);
  useEffect(() => {
    let current = true;
    if (chart) void arrange_chart(chart).then((result) => { if (current) setLayout(result); });
    return () => { current = false; };
  }, [chart]);
  useEffect(() => { if (name && !chart) close_chart(); }, [name, chart]);
  if (!block || !chart) return null;
  return (
    <section className="machine" aria-label={`Chart of ${name}`} onKeyDown={(event) => { if (event.key === "Escape") { event.stopPropagation(); close_chart(); } }}>
      <header className="bar"><h2>{name}</h2><span className="gap" />
        {editable && <button type="button" onClick={() => void add_state(block)}>+ State</button>}
        <button type="button" onClick={close_chart}>Back to the diagram</button></header>
      <div className="sheet">{layout && <Drawing layout={layout} block={block} />}</div>
    </section>
  );
}

function Drawing({ layout, block }: { layout: ChartLayout; block: Block }) {
  const chosen = useStudio((state) => state.chart_part), chart = block.chart!;
  return (
    <svg width={layout.width} height={layout.height} viewBox={`0 0 ${layout.width} ${layout.height}`} role="group" aria-label={`${chart.states.length} states, ${chart.transitions.length} transitions`} onClick={() => choose_part(null)}>
      {layout.states.map(({ index, x, y, width, height, title, lines, isOuter }) => {
        const part: ChartPart = { kind: "state", state: index }, choose = () => choose_part(part);
        return (
          <g key={index} className={`state${isOuter ? " outer" : ""}${is_part(chosen, part) ? " selected" : ""}`} data-state={chart.states[index]?.name} tabIndex={0} role="button" aria-label={`state ${chart.states[index]?.name}`} aria-pressed={is_part(chosen, part)}
            onClick={(event) => { event.stopPropagation(); choose(); }} onKeyDown={on_key(choose)}>
            <rect x={x} y={y} width={width} height={height} rx="8" />
            {title.map((line, i) => <text key={i} className="name" x={x + width / 2} y={y + 16 + LINE * i}>{line}</text>)}
            {lines.map((line, i) => <text key={`l${i}`} x={x + width / 2} y={y + 20 + LINE * (title.length + i)}>{line}</text>)}
          </g>
        );
      })}
      {layout.defaults.map((points, i) => <g key={i} className="transition"><path className="line" d={path_of(points)} /><path className="tip" d={tip(points)} /></g>)}
      {layout.dots.map(({ x, y }, i) => <circle key={i} className="initial" cx={x} cy={y} r="5" />)}
      {layout.transitions.map(({ index, points, label }) => {
        const part = written_transition(block, index), choose = () => choose_part(part), drawn = chart.transitions[index];
        const title = drawn ? `transition from ${chart.states[drawn.from]?.name} to ${chart.states[drawn.to]?.name}, ${drawn.guard ? `when ${drawn.guard}` : "always"}` : "";
        return (
          <g key={index} className={`transition${is_part(chosen, part) ? " selected" : ""}`} data-transition={index} tabIndex={0} role="button" aria-label={title} aria-pressed={is_part(chosen, part)}
            onClick={(event) => { event.stopPropagation(); choose(); }} onKeyDown={on_key(choose)}>
            {points.map((line, i) => <path key={i} className="line" d={path_of(line)} />)}
            {points.map((line, i) => <path key={`a${i}`} className="area" d={path_of(line)} />)}
            {points.length > 0 && <path className="tip" d={tip(points.at(-1)!)} />}
            <rect className="ground" x={label.x} y={label.y} width={label.width} height={label.height} />
            {label.lines.map((line, i) => <text key={`t${i}`} className="when" x={label.x + label.width / 2} y={label.y + 12 + LINE * i}>{line}</text>)}
            <title>{title}</title>
          </g>
        );
      })}
    </svg>
  );
}
