// Saves what a plot shows: PNG, SVG, or the numbers as CSV.
import { escaped } from "./diagram_text.js";

function save(bytes, type, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(bytes instanceof Blob ? bytes : new Blob([bytes], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

const shown = (plot) => plot.series.map((series, k) => ({ series, k })).filter(({ k }) => plot.chart.series[k + 1].show);
const fileName = (plot, ending) => `${(plot.title || plot.y.label || "plot").replace(/[^\w.-]+/g, "_").slice(0, 60)}.${ending}`;

/** The points of the visible curves within the visible range, in the units of the data. */
export function csvText(plot) {
  const { min, max } = plot.chart.scales.x, columns = shown(plot);
  const heading = (label, unit) => `"${(label + (unit ? ` (${unit})` : "")).replace(/"/g, '""')}"`;
  const lines = [[heading(plot.x.label, plot.x.unit), ...columns.map(({ series }) => heading(series.name, plot.y.unit))].join(",")];
  const { data } = plot.chart;
  data[0].forEach((x, i) => {
    if (x < min || x > max || columns.every(({ k }) => data[k + 1][i] == null)) return;
    lines.push([x, ...columns.map(({ k }) => data[k + 1][i] ?? "")].join(","));
  });
  return lines.join("\n") + "\n";
}

export const saveCsv = (plot) => save(csvText(plot), "text/csv", fileName(plot, "csv"));

/** The canvas with the names of the curves above it. */
export function savePng(plot, variable, font) {
  const { canvas } = plot.chart.ctx, ratio = uPlot.pxRatio, head = 24 * ratio;
  const picture = document.createElement("canvas");
  picture.width = canvas.width; picture.height = canvas.height + head;
  const ctx = picture.getContext("2d");
  ctx.fillStyle = variable("--paper");
  ctx.fillRect(0, 0, picture.width, picture.height);
  ctx.font = font(12 * ratio);
  let x = 64 * ratio;
  for (const { series, k } of shown(plot)) {
    ctx.fillStyle = plot.chart.series[k + 1].stroke(plot.chart, k + 1);
    ctx.fillRect(x, head / 2 - ratio, 14 * ratio, 3 * ratio);
    ctx.fillStyle = variable("--ink");
    ctx.fillText(series.name, x + 20 * ratio, head / 2 + 4 * ratio);
    x += ctx.measureText(series.name).width + 40 * ratio;
  }
  ctx.drawImage(canvas, 0, head);
  picture.toBlob((bytes) => save(bytes, "image/png", fileName(plot, "png")));
}

function svgCurve(u, series, color) {
  const parts = [];
  let pen = false, last = 0;
  series.x.forEach((x, i) => {
    const y = series.y[i];
    if (x === null || y === null) { pen = false; return; }
    const left = u.valToPos(x, "x").toFixed(2), top = u.valToPos(y, "y").toFixed(2);
    if (series.shape === "points") parts.push(`M${left} ${top}h0`);
    else if (!pen) parts.push(`M${left} ${top}`);
    else parts.push(series.shape === "steps" ? `H${left}V${top}` : `L${left} ${top}`);
    pen = true; last = top;
  });
  return `<path d="${parts.join("")}" fill="none" stroke="${color}" stroke-width="${series.shape === "points" ? 3 : 1.4}" ` +
         `stroke-linejoin="round" stroke-linecap="round"/>`;
}

/** Curves, grid, ticks and titles as vectors. */
export function svgText(plot, variable) {
  const u = plot.chart, ratio = uPlot.pxRatio, head = 24;
  const box = { left: u.bbox.left / ratio, top: u.bbox.top / ratio + head, width: u.bbox.width / ratio, height: u.bbox.height / ratio };
  const text = (x, y, content, anchor, turn = "") => `<text x="${x.toFixed(1)}" y="${y.toFixed(1)}" text-anchor="${anchor}"${turn}>${escaped(content)}</text>`;
  let out = "", grid = "", legend = 64;
  const [ax, ay] = u.axes;
  (ax._splits ?? []).forEach((value, k) => {
    const x = box.left + u.valToPos(value, "x");
    grid += `M${x.toFixed(1)} ${box.top}v${box.height}`;
    out += text(x, box.top + box.height + 16, ax._values[k] ?? "", "middle");
  });
  (ay._splits ?? []).forEach((value, k) => {
    const y = box.top + u.valToPos(value, "y");
    grid += `M${box.left} ${y.toFixed(1)}h${box.width}`;
    out += text(box.left - 6, y + 4, ay._values[k] ?? "", "end");
  });
  const title = (axis) => (typeof axis.label === "function" ? axis.label(u) : axis.label) ?? "";
  out += text(box.left + box.width / 2, box.top + box.height + 36, title(ax), "middle");
  out += text(14, box.top + box.height / 2, title(ay), "middle", ` transform="rotate(-90 14 ${box.top + box.height / 2})"`);
  const curves = shown(plot).map(({ series, k }) => {
    const color = u.series[k + 1].stroke(u, k + 1);
    out += `<path d="M${legend} 12h14" stroke="${color}" stroke-width="3"/>` + text(legend + 20, 16, series.name, "start");
    legend += 40 + 7 * series.name.length;
    return svgCurve(u, series, color);
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${u.width} ${u.height + head}" width="${u.width}" height="${u.height + head}" ` +
    `font-family="DejaVu Sans, Verdana, sans-serif" font-size="12" fill="${variable("--ink")}">` +
    `<rect width="100%" height="100%" fill="${variable("--paper")}"/><path d="${grid}" stroke="${variable("--grid")}"/>` +
    `<svg x="${box.left}" y="${box.top}" width="${box.width}" height="${box.height}">${curves.join("")}</svg>${out}</svg>\n`;
}

export const saveSvg = (plot, variable) => save(svgText(plot, variable), "image/svg+xml", fileName(plot, "svg"));
