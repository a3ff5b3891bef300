// One plot, drawn by uPlot: curves with their own abscissae, zoom by dragging and wheel, cursors A and B, a band.
import uPlot from "uplot";
import { decimalsFor, exponentFor, quantity, scaledUnit, superscript, withMinus } from "../numbers";
import { CurvePainter } from "./painter";

export type Style = "line" | "steps" | "points" | "ghost" | "pinned" | "measured" | "preview";
type Values = readonly (number | null)[];

export interface Curve { name: string; label: string; unit: string; x: Values; y: Values; colour: number; style: Style }
export interface Band { low: number; high: number; label: string }
export interface PlotOptions {
  x_label: string; x_unit: string; y_unit: string; y_label?: string;
  logarithmic?: boolean;        // the abscissa
  group: string;                // plots of one group share the abscissa and the cursor
  height: number;
  show_x: boolean;              // numbers below the plot
  equal?: boolean;              // the same scale on both axes
}
export interface PlotEvents {
  zoom: (from: number, to: number) => void;
  reset: () => void;
  cursor: (which: "a" | "b", x: number) => void;
  read: (values: (number | null | undefined)[] | null, x: number | null) => void;
}

const AXIS_WIDTH = 66, WHEEL_STEP = 0.8, LEAST_RANGE = 1e-9;
const variable = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const font = (size: number): string => `${size}px ${getComputedStyle(document.body).fontFamily}`;

function stroke(curve: Curve): string {
  if (curve.style === "measured") return variable("--measured");
  return variable(`--series-${curve.colour % 8}`);
}
function translucent(colour: string, alpha: number): string {
  return colour.startsWith("#") ? colour + Math.round(alpha * 255).toString(16).padStart(2, "0") : colour;
}
const ALPHA: Partial<Record<Style, number>> = { ghost: 0.42, pinned: 0.8, points: 0.6 };

const colour_of = (curve: Curve): string => translucent(stroke(curve), ALPHA[curve.style] ?? 1);
function thickness_of({ style }: Curve): number { return style === "measured" ? 2.4 : style === "ghost" ? 1.3 : style === "preview" ? 2 : 1.6; }

function series(curve: Curve, painter: CurvePainter): uPlot.Series {
  const base: uPlot.Series = {
    label: curve.label, scale: "y", pxAlign: 0, stroke: () => colour_of(curve), points: { show: false }, width: thickness_of(curve), paths: painter.paths,
  };
  if (curve.style === "ghost") base.dash = [5, 4];
  if (curve.style === "pinned") base.dash = [9, 3, 2, 3];
  if (curve.style === "preview") base.dash = [2, 3];
  if (curve.style === "points") {
    base.paths = () => null;
    base.points = { show: true, size: 3, width: 0, fill: () => translucent(stroke(curve), ALPHA.points!) };
  }
  return base;
}

function axis(key: "x" | "y", label: string, unit: string, options: PlotOptions): uPlot.Axis {
  const exponent = (u: uPlot): number => exponentFor(Math.max(Math.abs(u.scales[key]!.min ?? 0), Math.abs(u.scales[key]!.max ?? 0)), unit);
  const linear = (u: uPlot, splits: number[], _axis: number, _space: number, step: number): string[] => {
    const power = 10 ** exponent(u), decimals = decimalsFor(step / power);
    return splits.map((value) => withMinus((Math.abs(value) < step * 1e-6 ? 0 : value / power).toFixed(decimals)));
  };
  const logarithmic = (_u: uPlot, splits: number[]): string[] => splits.map((value) => {
    if (value === null) return "";
    const power = Math.round(Math.log10(value));
    return power >= -2 && power <= 3 ? String(+value.toPrecision(3)) : "10" + superscript(power);
  });
  const is_x = key === "x", is_log = is_x && options.logarithmic;
  const title = (u: uPlot): string => {
    const shown = is_log ? unit : scaledUnit(exponent(u), unit);
    return label && shown ? `${label} (${shown})` : label || shown;
  };
  return {
    scale: key, stroke: () => variable("--soft"), font: font(11), labelFont: font(11), labelSize: is_x ? 16 : 18, labelGap: is_x ? -2 : 0,
    grid: { stroke: () => variable("--grid"), width: 1 }, ticks: { stroke: () => variable("--grid"), width: 1, size: 4 },
    values: (is_log ? logarithmic : linear) as uPlot.Axis.Values, size: is_x ? (options.show_x ? 30 : 8) : AXIS_WIDTH - 18, gap: 4,
    label: is_x && !options.show_x ? undefined : (title as unknown as string),
    space: is_x ? 70 : 24,
    ...(is_x && !options.show_x ? { values: (_u: uPlot, splits: number[]) => splits.map(() => "") } : {}),
  };
}

/** uPlot needs one rising abscissa: curves are joined, and clouds of points sorted. */
function table(curves: Curve[]): uPlot.AlignedData {
  if (!curves.length) return [[], []] as unknown as uPlot.AlignedData;
  const tables = curves.map((curve): uPlot.AlignedData => {
    const order = curve.x.map((_, i) => i).filter((i) => curve.x[i] !== null);
    const rises = order.every((i, k) => k === 0 || curve.x[i]! > curve.x[order[k - 1]!]!);
    if (rises && order.length === curve.x.length) return [curve.x as number[], curve.y as number[]] as uPlot.AlignedData;
    if (!rises) order.sort((a, b) => curve.x[a]! - curve.x[b]!);
    // A join keeps one row for each x: equal ones are set apart by the least step.
    let last = -Infinity;
    const xs = order.map((i) => { const x = curve.x[i]!; last = x > last ? x : last + Math.max(Math.abs(last) * 1e-12, 1e-300); return last; });
    return [xs, order.map((i) => curve.y[i]!)] as uPlot.AlignedData;
  });
  return tables.length === 1 ? tables[0]! : joined(tables);
}
/** On the abscissae of all. A row that a curve does not have is undefined there: its line passes over it. */
function joined(tables: uPlot.AlignedData[]): uPlot.AlignedData {
  const sorted = Float64Array.from(tables.flatMap(([x]) => x as number[])).sort();
  const xs = [...sorted].filter((x, i) => i === 0 || x !== sorted[i - 1]);
  const columns = tables.map(([x, y]) => { let row = 0; return xs.map((at) => (x[row] === at ? (y as (number | null)[])[row++] : undefined)); });
  return [xs, ...columns] as uPlot.AlignedData;
}

export class ScopePlot {
  private readonly plot: uPlot;
  private readonly flags: Record<"a" | "b", HTMLDivElement>;
  private cursors: { a: number; b: number } | null = null;
  private band: Band | null = null;
  private range: { from: number; to: number } | null = null;

  constructor(private readonly target: HTMLElement, private curves: Curve[], private readonly options: PlotOptions, private readonly events: PlotEvents) {
    const painters = curves.map(({ style }) => new CurvePainter(style === "steps"));
    this.plot = new uPlot({
      width: Math.max(120, target.clientWidth), height: options.height,
      padding: [6, 10, 0, 0],
      scales: {
        x: { time: false, distr: options.logarithmic ? 3 : 1, range: (u, min, max) => (options.equal ? this.equal_ranges(u).x : this.x_range(u, min, max)) },
        y: { range: (u, min, max) => (options.equal ? this.equal_ranges(u).y : this.y_range(min, max)) },
      },
      legend: { show: false },
      cursor: {
        ...(options.group ? { sync: { key: options.group, setSeries: false } } : {}),
        drag: { x: true, y: false, setScale: false }, points: { show: true, size: 6 }, focus: { prox: -1 },
      },
      axes: [axis("x", options.x_label, options.x_unit, options), axis("y", options.y_label ?? "", options.y_unit, options)],
      series: [{}, ...curves.map((curve, k) => series(curve, painters[k]!))],
      hooks: {
        drawSeries: [(u, k) => { const curve = curves[k - 1]; if (curve) painters[k - 1]!.draw(u, colour_of(curve), thickness_of(curve) * devicePixelRatio); }],
        setSelect: [(u) => this.selected(u)], setCursor: [(u) => this.read(u)], draw: [() => this.place_flags()], drawClear: [(u) => this.draw_band(u)],
      },
    }, table(curves), target);
    this.flags = { a: this.flag("a"), b: this.flag("b") };
    this.listen();
    if (options.equal) queueMicrotask(() => this.update(this.curves));  // the size of the axes is known only after the first drawing
  }

  /** New numbers of the same curves. */
  update(curves: Curve[]) {
    this.curves = curves;
    this.plot.setData(table(curves), true);
  }
  show(range: { from: number; to: number } | null, cursors: { a: number; b: number } | null, band: Band | null) {
    const changed = this.range?.from !== range?.from || this.range?.to !== range?.to || this.band?.high !== band?.high;
    this.range = range;
    this.cursors = cursors;
    this.band = band;
    if (changed) this.plot.setData(this.plot.data, true); else this.place_flags();
  }
  resize(width: number, height: number) {
    if (width <= 100 || (width === this.plot.width && height === this.plot.height)) return;
    this.plot.setSize({ width, height });
    if (this.options.equal) this.update(this.curves);
  }
  /** Colours and fonts follow the theme. */
  repaint() { this.plot.redraw(false, true); }
  picture(): HTMLCanvasElement { return this.plot.ctx.canvas; }
  destroy() { this.plot.destroy(); }

  private x_range(_u: uPlot, min: number | null, max: number | null): uPlot.Range.MinMax {
    if (this.range) return [this.range.from, this.range.to];
    if (min === null || max === null) return [0, 1];
    return min === max ? [min - 0.5, max + 0.5] : [min, max];
  }
  private y_range(min: number | null, max: number | null): uPlot.Range.MinMax {
    if (min === null || max === null || !isFinite(min) || !isFinite(max)) return [-1, 1];
    if (this.band) { min = Math.min(min, this.band.low); max = Math.max(max, this.band.high); }
    // A constant is drawn in the middle, not blown up to its last digit.
    const least = Math.max(Math.abs(min), Math.abs(max)) * 1e-6 || 1;
    const margin = max - min < least ? least : 0.07 * (max - min);
    return [min - margin, max + margin];
  }

  /** Everything that is drawn, with a unit as long on the one axis as on the other. */
  private equal_ranges(u: uPlot): { x: uPlot.Range.MinMax; y: uPlot.Range.MinMax } {
    const middle_and_size = (values: (number | null)[]) => {
      let low = Infinity, high = -Infinity;
      for (const value of values) if (value !== null) { low = Math.min(low, value); high = Math.max(high, value); }
      return low <= high ? { middle: (low + high) / 2, size: high - low } : { middle: 0, size: 0 };
    };
    const x = middle_and_size(this.curves.flatMap((curve) => [...curve.x])), y = middle_and_size(this.curves.flatMap((curve) => [...curve.y]));
    const width = u.bbox.width || 1, height = u.bbox.height || 1;
    const half = 0.54 * Math.max(x.size / width, y.size / height) || 1 / width;  // of a pixel, with a margin
    return { x: [x.middle - half * width, x.middle + half * width], y: [y.middle - half * height, y.middle + half * height] };
  }

  private selected(u: uPlot) {
    const { left, width } = u.select;
    if (width > 4) this.events.zoom(u.posToVal(left, "x"), u.posToVal(left + width, "x"));
    if (width) u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  }

  private read(u: uPlot) {
    const index = u.cursor.idx;
    if (index === null || index === undefined || (u.cursor.left ?? -1) < 0) { this.events.read(null, null); return; }
    const values = this.curves.map((_, k) => {
      const column = u.data[k + 1]!;
      for (let i = index; i >= 0; --i) if (column[i] !== undefined) return column[i];   // joined: the last value of this curve
      return null;
    });
    this.events.read(values, u.data[0][index] ?? null);
  }

  private draw_band(u: uPlot) {
    if (!this.band) return;
    const top = u.valToPos(this.band.high, "y", true), bottom = u.valToPos(this.band.low, "y", true);
    u.ctx.save();
    u.ctx.fillStyle = variable("--band");
    u.ctx.fillRect(u.bbox.left, top, u.bbox.width, bottom - top);
    u.ctx.fillStyle = variable("--soft");
    u.ctx.font = font(11 * devicePixelRatio);
    if (bottom - top > 12 * devicePixelRatio) u.ctx.fillText(this.band.label, u.bbox.left + 6 * devicePixelRatio, top + 12 * devicePixelRatio);
    u.ctx.restore();
  }

  private flag(which: "a" | "b"): HTMLDivElement {
    const flag = document.createElement("div");
    flag.className = `flag ${which}`;
    flag.dataset["name"] = which.toUpperCase();
    flag.tabIndex = 0;
    flag.setAttribute("role", "slider");
    flag.setAttribute("aria-label", `cursor ${which.toUpperCase()}`);
    flag.hidden = true;
    const move = (x: number) => this.events.cursor(which, x);
    flag.addEventListener("pointerdown", (event) => {
      event.stopPropagation();
      event.preventDefault();
      flag.setPointerCapture(event.pointerId);
      const box = this.plot.over.getBoundingClientRect();
      const follow = (moved: PointerEvent) => move(this.plot.posToVal(Math.max(0, Math.min(box.width, moved.clientX - box.left)), "x"));
      flag.onpointermove = follow;
      flag.onpointerup = () => { flag.onpointermove = null; };
    });
    flag.addEventListener("mousedown", (event) => event.stopPropagation());
    flag.addEventListener("keydown", (event) => {
      const step = (this.plot.scales["x"]!.max! - this.plot.scales["x"]!.min!) / (event.shiftKey ? 20 : 200);
      const direction = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
      if (direction && this.cursors) { event.preventDefault(); event.stopPropagation(); move(this.cursors[which] + direction * step); }
    });
    this.plot.over.appendChild(flag);
    return flag;
  }

  private place_flags() {
    for (const which of ["a", "b"] as const) {
      const flag = this.flags?.[which];
      if (!flag) continue;
      const x = this.cursors?.[which], left = x === undefined ? -1 : this.plot.valToPos(x, "x");
      flag.hidden = x === undefined || left < -1 || left > this.plot.over.clientWidth + 1;
      flag.style.left = `${left}px`;
      flag.setAttribute("aria-valuenow", String(x ?? 0));
      flag.setAttribute("aria-valuetext", quantity(x, this.options.x_unit));
    }
  }

  private listen() {
    const over = this.plot.over;
    const scale = () => ({ min: this.plot.scales["x"]!.min!, max: this.plot.scales["x"]!.max! });
    const zoom_at = (x: number, factor: number) => {
      const { min, max } = scale();
      if (this.options.logarithmic) return;
      const from = x - (x - min) * factor, to = x + (max - x) * factor;
      if (to - from > LEAST_RANGE) this.events.zoom(from, to);
    };
    over.addEventListener("dblclick", () => this.events.reset());
    over.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && !event.shiftKey) return;   // the page scrolls as everywhere
      event.preventDefault();
      zoom_at(this.plot.posToVal(event.offsetX, "x"), event.deltaY + event.deltaX < 0 ? WHEEL_STEP : 1 / WHEEL_STEP);
    }, { passive: false });
    over.addEventListener("mousedown", (event) => {
      if (!event.shiftKey && event.button !== 1) return;
      event.preventDefault();
      event.stopImmediatePropagation();
      const { min, max } = scale(), from = event.clientX, per_pixel = (max - min) / over.clientWidth;
      const move = (moved: MouseEvent) => { const by = (from - moved.clientX) * per_pixel; this.events.zoom(min + by, max + by); };
      window.addEventListener("mousemove", move);
      window.addEventListener("mouseup", () => window.removeEventListener("mousemove", move), { once: true });
    }, { capture: true });
    this.target.addEventListener("keydown", (event) => {
      const { min, max } = scale(), middle = (min + max) / 2, step = (max - min) / 10;
      const actions: Record<string, () => void> = {
        "+": () => zoom_at(middle, WHEEL_STEP), "=": () => zoom_at(middle, WHEEL_STEP), "-": () => zoom_at(middle, 1 / WHEEL_STEP), "0": () => this.events.reset(),
        ArrowLeft: () => this.events.zoom(min - step, max - step), ArrowRight: () => this.events.zoom(min + step, max + step),
      };
      const action = actions[event.key];
      if (action && !event.ctrlKey && !event.metaKey) { event.preventDefault(); action(); }
    });
  }
}
