// Draws a diagram that has been laid out, as SVG. Colors come from diagram.css.
import { FONT, escaped, fitted, lastName, textWidth } from "./diagram_text.js";
import { drawChart } from "./chart_drawing.js";

const round = (x) => Math.round(x * 10) / 10;
const TEXT_LINE = 15, RATES = 7;

function text(x, y, content, size, kind, anchor = "middle") {
  return `<text class="${kind}" x="${round(x)}" y="${round(y)}" font-size="${size}" text-anchor="${anchor}">${escaped(content)}</text>`;
}

const letters = (room) => room.replace(/[^a-z]/g, "");

/** The class of a wire or a mark: rates of sampled signals have colors, continuous and constant ones are neutral. */
export function rateClass(graph, rate) {
  const name = graph.rates[rate];
  if (name === undefined || name === "constant") return "constant";
  if (name === "continuous") return "continuous";
  return `rate-${graph.rates.slice(0, rate).filter((r) => r !== "continuous").length % RATES}`;
}

// ---------- blocks ----------

function curve(strokes, hasAxes, x, y, { width, height }) {
  const px = (u) => round(x + width * (1 + u) / 2), py = (v) => round(y + height * (1 - v) / 2);
  const axes = hasAxes ? `<path class="axes" d="M${px(-1)} ${py(0)}H${px(1)}M${px(0)} ${py(-1)}V${py(1)}"/>` : "";
  return axes + strokes.map((points) => `<polyline class="curve" points="${points.map(([u, v]) => `${px(u)},${py(v)}`).join(" ")}"/>`).join("");
}

function fraction(face, x, y, width) {
  return text(x, y + 12, face.numerator, FONT.face, "face") +
         `<path class="bar" d="M${round(x - width / 2 + 2)} ${round(y + 17)}h${round(width - 4)}"/>` +
         text(x, y + 30, face.denominator, FONT.face, "face");
}

function boxContents(node, size, box, ports) {
  const middle = box.x + box.width / 2 + (size.sides[0] - size.sides[1]) / 2;
  let out = text(box.x + box.width / 2, box.y + 15, lastName(node.path), FONT.name, "name");
  if (size.type) out += text(box.x + box.width / 2, box.y + 28, size.type, FONT.type, "type");
  const body = box.height - size.head - 8;
  const tall = (size.fraction?.height ?? 0) + (size.chart?.height ?? 0) + (size.curve ? size.curve.height + 4 : 0) + TEXT_LINE * size.lines.length;
  let y = box.y + size.head + Math.max(0, (body - tall) / 2);
  if (size.fraction) { out += fraction(node.face, middle, y, size.fraction.width); y += size.fraction.height; }
  if (size.curve) {
    out += curve(node.face.strokes, node.face.axes, middle - size.curve.width / 2, y, size.curve);
    y += size.curve.height + 4;
  }
  if (size.chart) out += drawChart(size.chart, middle - size.chart.width / 2, y);
  size.lines.forEach((line, k) => { out += text(middle, y + 11 + k * TEXT_LINE, line, FONT.face, "face"); });
  return out + drawPortNames(size, box, ports);
}

function drawPortNames({ left, right }, box, ports) {
  let out = "";
  left.forEach((name, k) => { if (name) out += text(box.x + 6, ports.in[k].y + 4, name, FONT.port, "port", "start"); });
  right.forEach((name, k) => { if (name) out += text(box.x + box.width - 6, ports.out[k].y + 4, name, FONT.port, "port", "end"); });
  return out;
}

/** Signs of a round block stand outside of it, beside the arrow heads. */
function roundBlock(node, box, ports) {
  const r = box.width / 2, x = box.x + r, y = box.y + r;
  let out = `<circle class="shape" cx="${round(x)}" cy="${round(y)}" r="${round(r)}"/>`;
  if (node.face.text) return out + text(x, y + 5, node.face.text, FONT.sign + 2, "face");
  node.inputs.forEach((port, k) => {
    const dx = ports.in[k].x - x, dy = ports.in[k].y - y, inner = 0.56;
    out += text(x + dx * inner, y + dy * inner + 4.2, port.sign, FONT.sign, "sign");
  });
  return out;
}

function drawBlock(graph, index, size, box, ports) {
  const node = graph.nodes[index];
  const closed = node.room === "subdiagram", opens = closed || node.chart;
  const detail = [`${node.path}  (${node.type})`, node.details].filter(Boolean).join("\n");
  let out = `<g class="node ${letters(node.room)}${opens ? " opens" : ""}" data-node="${index}"${opens ? ' role="button" tabindex="0"' : ""}><title>${escaped(detail)}</title>`;
  const under = () => text(box.x + box.width / 2, box.y + box.height + 14, lastName(node.path), FONT.name, "name");
  if (node.face.shape === "circle") out += roundBlock(node, box, ports) + text(box.x + box.width / 2, box.y - 5, lastName(node.path), FONT.name, "name");
  else if (node.face.shape === "gain") {
    const { x, y, width, height } = box, tip = Math.min(16, width / 3);
    out += `<path class="shape" d="M${round(x)} ${round(y)}h${round(width - tip)}l${tip} ${height / 2}l${-tip} ${height / 2}h${round(tip - width)}z"/>`;
    size.lines.forEach((line, k) => { out += text(x + (width - tip / 2) / 2, y + height / 2 + 4.5 + k * TEXT_LINE, line, FONT.face, "face"); });
    out += under();
  } else {
    out += `<rect class="shape" x="${round(box.x)}" y="${round(box.y)}" width="${round(box.width)}" height="${round(box.height)}" rx="${closed ? 3 : 5}"/>`;
    if (closed) out += `<rect class="shape inner" x="${round(box.x + 3)}" y="${round(box.y + 3)}" width="${round(box.width - 6)}" height="${round(box.height - 6)}" rx="2"/>`;
    out += boxContents(node, size, box, ports);
  }
  return out + "</g>";
}

function drawContainer(graph, index, box, ports) {
  const node = graph.nodes[index];
  const head = `${lastName(node.path)}`;
  let out = `<g class="frame" data-node="${index}"><rect class="ground" x="${round(box.x)}" y="${round(box.y)}" width="${round(box.width)}" height="${round(box.height)}" rx="6"/>`;
  out += `<g class="head" data-node="${index}" role="button" tabindex="0"><title>${escaped(`${node.path}  (${node.type})\n${node.details}`)}</title>` +
         `<rect class="cover" x="${round(box.x)}" y="${round(box.y)}" width="${round(box.width)}" height="24"/>` +
         `<path class="minus" d="M${round(box.x + 10)} ${round(box.y + 14)}h9"/>` +
         text(box.x + 26, box.y + 18, head, FONT.name, "name", "start");
  const left = box.width - 26 - textWidth(head, FONT.name, true) - 20;
  if (left > 50) out += text(box.x + 34 + textWidth(head, FONT.name, true), box.y + 18, fitted(node.type, FONT.type, left), FONT.type, "type", "start");
  out += "</g>";
  node.inputs.forEach((port, k) => { out += text(box.x + 6, ports.in[k].y - 4, port.name, FONT.port, "port", "start"); });
  node.outputs.forEach((port, k) => { out += text(box.x + box.width - 6, ports.out[k].y - 4, port.name, FONT.port, "port", "end"); });
  return out + "</g>";
}

// ---------- wires ----------

function path(points) {
  return points.map(({ x, y }, k) => {
    if (k === 0) return `M${round(x)} ${round(y)}`;
    return Math.abs(y - points[k - 1].y) < 0.05 ? `H${round(x)}` : Math.abs(x - points[k - 1].x) < 0.05 ? `V${round(y)}` : `L${round(x)} ${round(y)}`;
  }).join("");
}

/** An arrow head at the end of a wire, in the direction of its last part. */
function arrow(points) {
  const end = points.at(-1), before = points.at(-2);
  const dx = Math.sign(Math.round(end.x - before.x)), dy = Math.sign(Math.round(end.y - before.y)), long = 7, half = 3.2;
  const bx = end.x - dx * long, by = end.y - dy * long;
  return `<path class="tip" d="M${round(end.x)} ${round(end.y)}L${round(bx - dy * half)} ${round(by - dx * half)}L${round(bx + dy * half)} ${round(by + dx * half)}z"/>`;
}

function drawWires(graph, edges) {
  let wires = "";
  for (const edge of edges) {
    const [from, to] = graph.edges[Number(edge.id.slice(1))];
    const source = graph.nodes[from[0]], reader = graph.nodes[to[0]];
    const out = (from[1] === "o" ? source.outputs : source.inputs)[from[2]], into = (to[1] === "o" ? reader.outputs : reader.inputs)[to[2]];
    const unit = out.unit ? ` (${out.unit})` : "", rate = graph.rates[out.rate];
    const title = `${source.path}.${out.name}${unit} → ${reader.path}.${into.name}${rate ? `\n${rate}` : ""}`;
    wires += `<g class="wire ${rateClass(graph, out.rate)}"><title>${escaped(title)}</title>`;
    for (const section of edge.sections ?? []) {
      const points = [section.startPoint, ...(section.bendPoints ?? []), section.endPoint], line = path(points);
      wires += `<path class="reach" d="${line}"/><path class="line" d="${line}"/>` + (to[1] === "i" ? arrow(points) : "");
    }
    for (const { x, y } of edge.junctionPoints ?? []) wires += `<circle class="branch" cx="${round(x)}" cy="${round(y)}" r="2.6"/>`;
    wires += "</g>";
  }
  return wires;
}

// ---------- the picture ----------

/** Positions of the ports of a block, by their place in the lists of inputs and outputs. */
function portPlaces(elk) {
  const places = { in: [], out: [] };
  for (const port of elk.ports ?? []) {
    const [, side, k] = /^\d+([io])(\d+)$/.exec(port.id);
    places[side === "i" ? "in" : "out"][Number(k)] = port;
  }
  return places;
}

function unitTexts(graph, elk) {
  let out = "";
  for (const port of elk.ports ?? [])
    for (const label of port.labels ?? []) out += text(label.x + label.width / 2, label.y + label.height - 3, label.text, FONT.unit, "unit");
  return out;
}

function legend(graph, used, y, width) {
  let out = "", x = 14, row = y;
  for (const rate of used) {
    const name = graph.rates[rate], long = 34 + textWidth(name, FONT.port);
    if (x + long > width - 10 && x > 14) { x = 14; row += 18; }
    out += `<g class="wire ${rateClass(graph, rate)}"><path class="line" d="M${round(x)} ${row}h20"/></g>` + text(x + 26, row + 4, name, FONT.port, "type", "start");
    x += long + 14;
  }
  return { svg: out, bottom: row + 12 };
}

/** The picture as {svg, width, height}. */
export function drawDiagram({ graph, laidOut, sizes, seen }) {
  let frames = "", blocks = "", units = "";
  const visit = (elk) => {
    for (const child of elk.children ?? []) {
      const index = Number(child.id), ports = portPlaces(child);
      const relative = { in: ports.in.map((p) => ({ ...p })), out: ports.out };
      if (sizes.has(index)) blocks += drawBlock(graph, index, sizes.get(index), child, relative);
      else frames += drawContainer(graph, index, child, ports);
      units += unitTexts(graph, child);
      visit(child);
    }
  };
  visit(laidOut);
  const used = graph.rates.map((_, rate) => rate).filter((rate) =>
    seen.edges.some(({ from: [node, side, port] }) => graph.nodes[node][side === "o" ? "outputs" : "inputs"][port].rate === rate));
  const width = Math.ceil(Math.max(laidOut.width, 120));
  const key = used.length > 0 ? legend(graph, used, Math.ceil(laidOut.height) + 8, width) : { svg: "", bottom: Math.ceil(laidOut.height) };
  const height = key.bottom;
  const svg = `<svg xmlns="http://www.w3.org/2000/svg" class="diagram" role="img" aria-label="${escaped(graph.caption || "Block diagram")}" ` +
    `viewBox="0 0 ${width} ${height}" width="${width}" height="${height}">${frames}${drawWires(graph, laidOut.edges)}${blocks}${units}${key.svg}</svg>`;
  return { svg, width, height };
}
