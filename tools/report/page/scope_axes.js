// Axes, colors and ranges of a plot.
import { exponentFor, scaledUnit, superscript, decimalsFor, withMinus } from "./scope_numbers.js";

export const AXIS_WIDTH = 64;

/** Colors come from the style sheet, so that they follow the color scheme of the screen. */
export const variable = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
export const font = (size) => `${size}px ${getComputedStyle(document.body).fontFamily}`;

export function axis(key, description, plot) {
  const exponent = (u) => exponentFor(Math.max(Math.abs(u.scales[key].min), Math.abs(u.scales[key].max)), description.unit);
  const tick = (value, decimals) => withMinus(value.toFixed(decimals));
  const linear = (u, splits, _axis, _space, step) => {
    const power = 10 ** exponent(u);
    const decimals = decimalsFor(step / power);
    return splits.map((value) => tick(Math.abs(value) < step * 1e-6 ? 0 : value / power, decimals));
  };
  const logarithmic = (u, splits) => splits.map((value) => {
    if (value === null) return "";
    const power = Math.round(Math.log10(value));
    return power >= -3 && power <= 4 ? String(+value.toPrecision(3)) : "10" + superscript(power);
  });
  const title = (u) => {
    const unit = description.logarithmic ? description.unit : scaledUnit(exponent(u), description.unit);
    return description.label && unit ? `${description.label} (${unit})` : description.label || unit;
  };
  const isX = key === "x";
  const hidden = isX && plot.continues;  // the plot below shows the numbers
  return {
    scale: key,
    stroke: () => variable("--soft"),
    font: font(12), labelFont: font(12),
    label: hidden ? null : title,
    labelSize: isX ? 22 : 20, labelGap: isX ? 2 : 0,
    size: isX ? (hidden ? 8 : 30)
              : (u, values) => Math.max(AXIS_WIDTH - 20, 14 + 7 * Math.max(0, ...(values || []).map((v) => (v || "").length))),
    gap: 5, space: isX ? 70 : 32,
    ...(description.counts ? { incrs: [1, 2, 5, 10, 20, 50, 100, 1000] } : {}),
    values: hidden ? (u, splits) => splits.map(() => "") : description.logarithmic ? logarithmic : linear,
    grid: { stroke: () => variable("--grid"), width: 1 },
    ticks: { show: !hidden, stroke: () => variable("--rule"), width: 1, size: 5 },
    border: { show: true, stroke: () => variable("--rule"), width: 1 },
  };
}

/** The range that shows all data from `low` to `high`, with a margin of `padding` times its width. */
export function wholeRange(description, padding, low, high) {
  if (low === null || high === null) return [0.1, 1];
  // uPlot does not find the lines of a grid below this, and does not end. No page shows such numbers on purpose.
  const least = 1e-18;
  if (description.logarithmic) [low, high] = [Math.max(low, least), Math.max(high, least)];
  if (description.logarithmic) return low === high ? [low / 10, high * 10] : uPlot.rangeLog(low, high, 10, false);
  return padding || low === high ? uPlot.rangeNum(low, high, padding || 0.1, true) : [low, high];
}

/** Ranges of both axes in which a unit has the same length on the screen: the shorter one is widened. */
function equalRanges(u, x, y) {
  const width = u.over?.clientWidth || u.width - 80, height = u.over?.clientHeight || u.height - 60;
  const scale = Math.max((x[1] - x[0]) / width, (y[1] - y[0]) / height);
  const widened = ([low, high], pixels) => [(low + high - scale * pixels) / 2, (low + high + scale * pixels) / 2];
  return { x: widened(x, width), y: widened(y, height) };
}

/** The ranges that a plot shows: those chosen by the user, or all. uPlot asks after every change. */
export function ranges(plot) {
  const first = plot.table[0][0], last = plot.table[0].at(-1);
  plot.whole = wholeRange(plot.x, plot.cloud ? 0.04 : 0, first, last);
  const all = plot.table.slice(1).flat().filter((y) => y != null);
  const wholeY = plot.equal ? wholeRange(plot.y, 0.08, all.reduce((a, b) => Math.min(a, b), Infinity), all.reduce((a, b) => Math.max(a, b), -Infinity)) : null;
  return {
    x: (u, low, high) => {
      const wanted = low === first && high === last ? plot.whole : [low, high];
      plot.seenX = wanted;
      return plot.equal ? equalRanges(u, wanted, plot.rangeY ?? wholeY).x : wanted;
    },
    y: (u, low, high) => {
      if (plot.equal) return equalRanges(u, plot.seenX ?? plot.whole, plot.rangeY ?? wholeY).y;
      return plot.rangeY ?? wholeRange(plot.y, 0.08, low, high);
    },
  };
}

/** Lines at given values, with their names: crossovers, margins, limits. A hook of uPlot. */
export function drawMarks(plot, u) {
  const { ctx, bbox } = u, ratio = uPlot.pxRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.strokeStyle = ctx.fillStyle = variable("--soft");
  ctx.lineWidth = ratio;
  ctx.font = font(11 * ratio);
  ctx.textAlign = "left";
  ctx.setLineDash([5 * ratio, 4 * ratio]);
  (plot.marks ?? []).forEach(({ axis: key, value, label }, k) => {
    const at = u.valToPos(value, key, true);
    ctx.beginPath();
    if (key === "x") { ctx.moveTo(at, bbox.top); ctx.lineTo(at, bbox.top + bbox.height); }
    else { ctx.moveTo(bbox.left, at); ctx.lineTo(bbox.left + bbox.width, at); }
    ctx.stroke();
    const width = ctx.measureText(label).width, right = bbox.left + bbox.width;
    const left = key === "x" ? (at + width + 8 * ratio > right ? at - width - 4 * ratio : at + 4 * ratio) : right - width - 6 * ratio;
    // Names of neighbouring lines stand below each other.
    ctx.fillText(label, left, key === "x" ? bbox.top + bbox.height - (6 + 14 * (k % 3)) * ratio : at - 4 * ratio);
  });
  ctx.restore();
}
