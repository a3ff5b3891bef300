// A plot with its legend. The legend shows the values at the mouse, and takes curves away.
import { useEffect, useLayoutEffect, useRef } from "react";
import { quantity } from "../numbers";
import { useStudio } from "../state/store";
import { ScopePlot, type Band, type Curve, type PlotOptions } from "./drawing";

export interface PlotProps extends PlotOptions {
  title: string;
  curves: Curve[];
  range?: { from: number; to: number } | null;
  cursors?: { a: number; b: number } | null;
  band?: Band | null;
  on_zoom?: (from: number, to: number) => void;
  on_reset?: () => void;
  on_cursor?: (which: "a" | "b", x: number) => void;
  on_remove?: (name: string) => void;
  on_drop?: (name: string) => void;
}

const DRAGGED = "text/x-loopwright-signal";
const nothing = () => undefined;

export function Plot(props: PlotProps) {
  const { curves, height, range = null, cursors = null, band = null } = props;
  const place = useRef<HTMLDivElement>(null), plot = useRef<ScopePlot | null>(null), legend = useRef<HTMLUListElement>(null);
  const latest = useRef(props);
  latest.current = props;
  const dark = useStudio((state) => state.dark);
  // A new drawing only where it is needed; numbers alone are exchanged.
  const structure = JSON.stringify([curves.map((curve) => [curve.name, curve.style, curve.colour, curve.unit]), props.x_unit, props.x_label, props.y_unit, props.y_label, props.show_x, props.logarithmic, props.group]);

  useLayoutEffect(() => {
    const drawn = new ScopePlot(place.current!, latest.current.curves, latest.current, {
      zoom: (from, to) => (latest.current.on_zoom ?? nothing)(from, to),
      reset: () => (latest.current.on_reset ?? nothing)(),
      cursor: (which, x) => (latest.current.on_cursor ?? nothing)(which, x),
      read: (values) => {
        legend.current?.querySelectorAll("output").forEach((output, k) => {
          const curve = latest.current.curves[k];
          output.textContent = values && curve ? quantity(values[k], curve.unit) : "";
        });
      },
    });
    drawn.show(latest.current.range ?? null, latest.current.cursors ?? null, latest.current.band ?? null);
    plot.current = drawn;
    const observer = new ResizeObserver(([entry]) => drawn.resize(Math.floor(entry!.contentRect.width), latest.current.height));
    observer.observe(place.current!);
    return () => { observer.disconnect(); drawn.destroy(); plot.current = null; };
  }, [structure]);

  const first = useRef(true);
  useLayoutEffect(() => { if (!first.current) plot.current?.update(curves); first.current = false; }, [curves]);
  useLayoutEffect(() => plot.current?.show(range, cursors, band), [range, cursors, band]);
  useLayoutEffect(() => plot.current?.resize(place.current!.clientWidth, height), [height]);
  useEffect(() => plot.current?.repaint(), [dark]);

  return (
    <section className="plot" aria-label={props.title}
      onDragOver={(event) => { if (props.on_drop && event.dataTransfer.types.includes(DRAGGED)) event.preventDefault(); }}
      onDrop={(event) => { const name = event.dataTransfer.getData(DRAGGED); if (name && props.on_drop) { event.preventDefault(); props.on_drop(name); } }}>
      <ul className="legend" ref={legend}>
        {curves.map((curve, k) => (
          <li key={k} hidden={!curve.label} draggable={Boolean(props.on_drop)} onDragStart={(event) => event.dataTransfer.setData(DRAGGED, curve.name)} className={curve.style}>
            <i className={curve.style === "measured" ? "measured" : `series-${curve.colour % 8} ${curve.style}`} aria-hidden="true" />
            <span>{curve.label}</span><output />
            {props.on_remove && curve.style !== "ghost" && curve.style !== "pinned" && (
              <button type="button" className="quiet small" title={`Take ${curve.name} out of the scope`} aria-label={`Take ${curve.name} out of the scope`} onClick={() => props.on_remove!(curve.name)}>×</button>
            )}
          </li>
        ))}
      </ul>
      <div className="canvas" ref={place} tabIndex={0} role="group" aria-label={`${props.title}: plus and minus zoom, arrows move, 0 shows everything`} />
    </section>
  );
}
