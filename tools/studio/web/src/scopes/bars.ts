// A curve that fills the plot is an area: one bar for each column of pixels shows it. Its line would have thousands of edges across every
// row of pixels, and take the page longer than everything else of a zoom.

type Values = ArrayLike<number | null | undefined>;

/** What a curve covers of each column of pixels, from `left` on; `top` > `bottom`: nothing. */
export interface Bars { left: number; top: Float64Array; bottom: Float64Array }

const FILLS_FROM = 8;  // pixels that the curve rises and falls in a column, on average: a line is drawn faster up to some ten

/**
 * The bars of a curve between the rows `first` and `last`, or null if its line is short enough to be drawn. Every point lies within the bar of
 * its column. Rows without a number: `undefined` is passed over by the line, `null` interrupts it. `to_x`, `to_y`: pixels of a value.
 */
export function bars_of(xs: Values, ys: Values, first: number, last: number, to_x: (x: number) => number, to_y: (y: number) => number,
  left: number, width: number, steps: boolean): Bars | null {
  if (last - first < width / 4) return null;
  const px: number[] = [], py: number[] = [];   // NaN: an interruption
  let travel = 0;
  for (let i = first; i <= last; ++i) {
    const x = xs[i], y = ys[i];
    if (y === undefined || x === null || x === undefined) continue;
    const at = to_x(x), height = y === null ? NaN : to_y(y), before = py.length ? py[py.length - 1]! : NaN;
    if (steps && before === before && height === height) { px.push(at); py.push(before); }
    if (before === before && height === height) travel += Math.abs(height - before);
    px.push(at);
    py.push(height);
  }
  if (travel < FILLS_FROM * width) return null;
  const bars = { left, top: new Float64Array(width).fill(Infinity), bottom: new Float64Array(width).fill(-Infinity) };
  for (let i = 0; i < px.length; ++i) {
    if (py[i] !== py[i]) continue;
    const begins = i === 0 || py[i - 1] !== py[i - 1];
    cover(bars, begins ? px[i]! : px[i - 1]!, begins ? py[i]! : py[i - 1]!, px[i]!, py[i]!);
  }
  return bars;
}

/** Adds a straight line; x0 ≤ x1. */
function cover({ left, top, bottom }: Bars, x0: number, y0: number, x1: number, y1: number): void {
  const from = Math.max(0, Math.floor(x0 - left)), to = Math.min(top.length - 1, Math.floor(x1 - left)), slope = x1 > x0 ? (y1 - y0) / (x1 - x0) : 0;
  for (let column = from; column <= to; ++column) {
    const a = left + column <= x0 ? y0 : y0 + slope * (left + column - x0), b = left + column + 1 >= x1 ? y1 : y0 + slope * (left + column + 1 - x0);
    top[column] = Math.min(top[column]!, a, b);
    bottom[column] = Math.max(bottom[column]!, a, b);
  }
}
