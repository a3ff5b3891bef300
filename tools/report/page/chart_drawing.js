// Draws the chart of a state machine that has been laid out, as SVG. Colors come from diagram.css.
import { FONT, escaped } from "./diagram_text.js";

const CHART_LINE = 15, ROUND = 8, DOT_RADIUS = 5, TIP = 7, HALF_TIP = 3.2;
const tenth = (x) => Math.round(x * 10) / 10;

function words(x, y, content, size, kind, anchor = "middle") {
  return `<text class="${kind}" x="${tenth(x)}" y="${tenth(y)}" font-size="${size}" text-anchor="${anchor}">${escaped(content)}</text>`;
}

function stateBox({ x, y, width, height, title, lines, isOuter }, dx, dy) {
  const left = x + dx, top = y + dy, middle = left + width / 2;
  const bottomOfTitle = top + 16 + CHART_LINE * (title.length - 1);
  let out = `<g class="state${isOuter ? " outer" : ""}"><rect class="edge" x="${tenth(left)}" y="${tenth(top)}" width="${tenth(width)}" height="${tenth(height)}" rx="${ROUND}"/>`;
  title.forEach((line, k) => { out += words(middle, top + 16 + k * CHART_LINE, line, FONT.name, "name"); });
  lines.forEach((line, k) => { out += words(middle, bottomOfTitle + 4 + (k + 1) * CHART_LINE, line, FONT.face, "face"); });
  return out + "</g>";
}

function polyline(points, dx, dy) {
  return points.map(({ x, y }, k) => `${k === 0 ? "M" : "L"}${tenth(x + dx)} ${tenth(y + dy)}`).join("");
}

/** An arrow head at the end of a line that runs along an axis. */
function head(points, dx, dy) {
  const end = points.at(-1), before = points.at(-2);
  const u = Math.sign(Math.round(end.x - before.x)), v = Math.sign(Math.round(end.y - before.y));
  const x = end.x + dx, y = end.y + dy, bx = x - u * TIP, by = y - v * TIP;
  return `<path class="tip" d="M${tenth(x)} ${tenth(y)}L${tenth(bx - v * HALF_TIP)} ${tenth(by - u * HALF_TIP)}L${tenth(bx + v * HALF_TIP)} ${tenth(by + u * HALF_TIP)}z"/>`;
}

function arrowOf(lines, dx, dy, kind) {
  return `<g class="${kind}">${lines.map((points) => `<path class="line" d="${polyline(points, dx, dy)}"/>`).join("")}${lines.length > 0 ? head(lines.at(-1), dx, dy) : ""}</g>`;
}

/** A picture of its own of the result of layOutChart. */
export function chartPicture(chart, name) {
  const { width, height } = chart;
  return `<svg xmlns="http://www.w3.org/2000/svg" class="diagram" role="img" aria-label="${escaped(name)}" viewBox="0 0 ${width} ${height}" ` +
    `width="${width}" height="${height}">${drawChart(chart)}</svg>`;
}

/** The result of layOutChart as SVG elements, with its upper left corner at (x, y). */
export function drawChart(chart, x = 0, y = 0) {
  let out = chart.states.map((state) => stateBox(state, x, y)).join("");
  for (const points of chart.defaults) out += arrowOf([points], x, y, "transition");
  for (const dot of chart.dots) out += `<circle class="initial" cx="${tenth(x + dot.x)}" cy="${tenth(y + dot.y)}" r="${DOT_RADIUS}"/>`;
  for (const { points } of chart.transitions) out += arrowOf(points, x, y, "transition");
  for (const { label } of chart.transitions) {
    out += `<g class="guard">`;
    label.lines.forEach((line, k) => { out += words(x + label.x + label.width / 2, y + label.y + 12 + k * CHART_LINE, line, FONT.port, "when"); });
    out += "</g>";
  }
  return `<g class="chart">${out}</g>`;
}
