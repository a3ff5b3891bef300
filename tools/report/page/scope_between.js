// Two cursors, A and B: what lies between them. Plots of a group share them.
import { button, element, mark } from "./scope_legend.js";
import { readOut } from "./scope_numbers.js";

const pairs = new Map();  // group, or the plot itself → { times: [a, b], plots }

function pairOf(plot) {
  const key = plot.group || plot;
  if (!pairs.has(key)) pairs.set(key, { times: [], plots: [] });
  return pairs.get(key);
}

/** Joins the plot to the cursors of its group. */
export function buildBetween(plot) {
  plot.between = element("div", "between");
  plot.between.hidden = true;
  pairOf(plot).plots.push(plot);
  return plot.between;
}

/** A click sets A, then B, then moves the nearer one. */
export function setCursor(plot, x) {
  const pair = pairOf(plot);
  if (pair.times.length < 2) pair.times.push(x);
  else pair.times[Math.abs(x - pair.times[0]) < Math.abs(x - pair.times[1]) ? 0 : 1] = x;
  refresh(pair);
}

export function clearCursors(plot) {
  const pair = pairOf(plot);
  pair.times = [];
  refresh(pair);
}

function refresh(pair) {
  for (const plot of pair.plots) {
    plot.chart.redraw(false, false);
    show(plot, pair.times);
  }
}

/** The value of a curve at x: held, or linear between its points. Nothing outside of the curve. */
export function valueAt(series, x) {
  const xs = series.x;
  if (xs.length === 0 || x < xs[0] || x > xs.at(-1)) return null;
  let low = 0, high = xs.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (xs[middle] <= x) low = middle; else high = middle;
  }
  if (xs[high] <= x) low = high;
  if (series.shape === "steps" || low === high || series.y[low] === null || series.y[high] === null || xs[low] === x) return series.y[low];
  return series.y[low] + (series.y[high] - series.y[low]) * (x - xs[low]) / (xs[high] - xs[low]);
}

/** Root of the mean square over the drawn points from a to b. */
function rmsBetween(series, a, b) {
  let sum = 0, count = 0;
  series.x.forEach((x, i) => {
    if (x >= a && x <= b && series.y[i] !== null) { sum += series.y[i] ** 2; ++count; }
  });
  return count > 0 ? Math.sqrt(sum / count) : null;
}

function cells(values) {
  const row = element("tr", "");
  for (const value of values) row.append(element("td", "number", value));
  return row;
}

function show(plot, times) {
  plot.between.hidden = times.length === 0;
  if (times.length === 0) return;
  const [a, b] = times.length === 2 ? [...times].sort((p, q) => p - q) : [times[0], null];
  const text = (value, unit) => (value == null ? "–" : readOut(value, unit));
  const slopeUnit = plot.x.unit ? (plot.y.unit ? `${plot.y.unit}/${plot.x.unit}` : `1/${plot.x.unit}`) : plot.y.unit;
  const head = b === null ? `A ${text(a, plot.x.unit)}; click again for B`
    : `A ${text(a, plot.x.unit)}   B ${text(b, plot.x.unit)}   Δ ${text(b - a, plot.x.unit)}` +
      (plot.x.unit === "s" && b > a ? `   1/Δ ${text(1 / (b - a), "Hz")}` : "");
  const line = element("div", "times", head, button("×", "Remove the cursors", () => clearCursors(plot)));
  const table = element("table", ""), body = element("tbody", "");
  const titles = b === null ? ["", "A"] : ["", "A", "B", "Δ", "slope", "rms between"];
  const top = element("tr", "");
  for (const title of titles) top.append(element("th", "number", title));
  table.append(element("thead", "", top), body);
  plot.series.forEach((series, k) => {
    if (!plot.chart.series[k + 1].show) return;
    const ya = valueAt(series, a), yb = b === null ? null : valueAt(series, b);
    const delta = ya == null || yb == null ? null : yb - ya;
    const row = cells(b === null ? [text(ya, plot.y.unit)]
      : [text(ya, plot.y.unit), text(yb, plot.y.unit), text(delta, plot.y.unit),
         text(delta == null || b === a ? null : delta / (b - a), slopeUnit), text(rmsBetween(series, a, b), plot.y.unit)]);
    row.prepend(element("td", "", mark(series, k), " ", series.name));
    body.append(row);
  });
  plot.between.replaceChildren(line, element("div", "wide", table));
}

/** Draws the cursors of a plot; a hook of uPlot. */
export function drawCursors(plot, u, color, font) {
  const { times } = pairOf(plot), { ctx, bbox } = u;
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = color;
  ctx.lineWidth = uPlot.pxRatio;
  ctx.font = font;
  ctx.textAlign = "left";
  [...times].sort((p, q) => p - q).forEach((time, k) => {
    const x = u.valToPos(time, "x", true);
    if (x < bbox.left || x > bbox.left + bbox.width) return;
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.fillText("AB"[k], x + 3 * uPlot.pxRatio, bbox.top + 11 * uPlot.pxRatio);
  });
  ctx.restore();
}
