// Lays out a block diagram with ELK: signals run from left to right, feedback returns below, wires are orthogonal.
import { FONT, fitted, lastName, textWidth } from "./diagram_text.js";
import { readingOrder } from "./diagram_order.js";
import { layOutChart } from "./chart_layout.js";

const PORT_PITCH = 17, HEAD = 20, TYPE_LINE = 13, LINE = 15, MARGIN = 8, CURVE = { width: 44, height: 30 }, CIRCLE = 30;
const WIDEST_TEXT = 170;

const parent = (path) => path.slice(0, Math.max(0, path.lastIndexOf(".")));

/** The part of the graph that is seen when the subdiagrams in `open` (a set of paths) are open. */
export function visibleGraph(graph, open) {
  const byPath = new Map(graph.nodes.map((node, index) => [node.path, index]));
  const isOpen = (path) => path === "" || (open.has(path) && isOpen(parent(path)));
  const seen = new Set(graph.nodes.map((_, i) => i).filter((i) => isOpen(parent(graph.nodes[i].path))));
  const opened = (i) => graph.nodes[i].room === "subdiagram" && isOpen(graph.nodes[i].path);
  const edges = graph.edges.map(([from, to], index) => ({ index, from, to }))
    .filter(({ from, to }) => seen.has(from[0]) && seen.has(to[0]) &&
                              (from[1] === "o" || opened(from[0])) && (to[1] === "i" || opened(to[0])));
  return { nodes: [...seen], edges, opened, parentOf: (i) => byPath.get(parent(graph.nodes[i].path)) ?? -1 };
}

const showsSigns = (node) => node.inputs.some((port) => port.sign !== "");
const named = (ports) => ports.length > 1 || /^[a-z]{2}/.test(ports[0]?.name ?? "");

/** Texts beside the ports, inside of the box. */
function portTexts(node) {
  const left = node.inputs.map((port) => port.sign || (named(node.inputs) ? port.name : ""));
  return { left, right: node.outputs.map((port) => (named(node.outputs) ? port.name : "")) };
}

const widest = (texts, size, bold) => Math.max(0, ...texts.map((text) => textWidth(text, size, bold)));

/** What a block shows and how large it is. `chart`: of an open state machine, laid out. */
function measured(node, chart) {
  const { face } = node;
  if (face.shape === "circle") return { width: CIRCLE, height: CIRCLE, outside: true };
  const lines = chart ? [] : face.text ? face.text.split("\n").slice(0, 4).map((line) => fitted(line, FONT.face, WIDEST_TEXT)) : [];
  if (face.shape === "gain") {
    const width = Math.max(40, widest(lines, FONT.face) + 26);
    return { width, height: 32, lines, outside: true };
  }
  const fraction = face.denominator ? { width: widest([face.numerator, face.denominator], FONT.face) + 8, height: 34 } : null;
  const curve = face.strokes.length > 0 ? CURVE : null;
  const middle = {
    width: Math.max(fraction?.width ?? 0, curve?.width ?? 0, chart?.width ?? 0, widest(lines, FONT.face)),
    height: (fraction?.height ?? 0) + (curve ? curve.height + 4 : 0) + (chart?.height ?? 0) + LINE * lines.length,
  };
  const type = fraction || ["Constant", "Expression"].includes(node.type) ? "" : fitted(node.type, FONT.type, WIDEST_TEXT);
  const head = HEAD + (type ? TYPE_LINE : 0);
  const { left, right } = portTexts(node);
  const sides = [widest(left, FONT.port), widest(right, FONT.port)];
  const body = Math.max(middle.height, PORT_PITCH * Math.max(left.filter(Boolean).length ? left.length : 1, right.length, 1));
  const width = Math.max(56, textWidth(lastName(node.path), FONT.name, true) + 16, textWidth(type, FONT.type) + 16,
                         sides[0] + sides[1] + middle.width + 2 * MARGIN + (sides[0] ? 8 : 0) + (sides[1] ? 8 : 0));
  return { width, height: head + body + MARGIN, head, type, lines, fraction, curve, chart, left, right, sides };
}

const portId = ([node, side, port]) => `${node}${side}${port}`;

function elkPort(id, side, unit, place) {
  const port = { id, width: 0, height: 0, ...place, layoutOptions: { "elk.port.side": side } };
  if (unit) port.labels = [{ text: unit, width: textWidth(unit, FONT.unit) + 6, height: FONT.unit + 3 }];
  return port;
}

/** A round block takes its first input from the left, and what returns from below. */
function roundPorts(index, node, feedback, unit) {
  const returning = node.inputs.findIndex((_, k) => feedback.has(`${index}i${k}`));
  const below = node.inputs.length < 2 ? -1 : returning >= 0 ? returning : node.inputs.length - 1;
  const r = CIRCLE / 2;
  return [...node.inputs.map((_, k) => (k === below ? elkPort(`${index}i${k}`, "SOUTH", "", { x: r, y: CIRCLE })
                                                    : elkPort(`${index}i${k}`, "WEST", "", { x: 0, y: r }))),
          elkPort(`${index}o0`, "EAST", unit(0), { x: CIRCLE, y: r })];
}

/** Ports at both sides of a box, evenly in its body. `order`: of the ports from the top; as declared when left out. */
function boxPorts(index, node, size, unit, order) {
  const top = size.head ?? 0, body = size.height - top - (size.head ? MARGIN : 0);
  const side = (ports, letter, x, name) => {
    const sequence = ports.map((_, k) => k);
    if (order) sequence.sort((a, b) => order.get(`${index}${letter}${a}`) - order.get(`${index}${letter}${b}`));
    const pitch = Math.min(PORT_PITCH * 1.6, body / ports.length), first = top + (body - pitch * (ports.length - 1)) / 2;
    return sequence.map((k, row) => elkPort(`${index}${letter}${k}`, name, letter === "o" ? unit(k) : "", { x, y: first + pitch * row }));
  };
  return [...side(node.inputs, "i", 0, "WEST"), ...side(node.outputs, "o", size.width, "EAST")];
}

const SPACING = {
  "elk.spacing.nodeNode": "26", "elk.spacing.edgeNode": "14", "elk.spacing.edgeEdge": "10",
  "elk.layered.spacing.nodeNodeBetweenLayers": "34", "elk.layered.spacing.edgeNodeBetweenLayers": "14",
  "elk.layered.spacing.edgeEdgeBetweenLayers": "9", "elk.spacing.portPort": String(PORT_PITCH), "elk.spacing.labelPort": "2",
  "elk.spacing.labelNode": "2",
};

const LAYERED = {
  "elk.algorithm": "layered", "elk.direction": "RIGHT", "elk.edgeRouting": "ORTHOGONAL",
  "elk.hierarchyHandling": "INCLUDE_CHILDREN",
  "elk.layered.cycleBreaking.strategy": "GREEDY",
  "elk.layered.nodePlacement.strategy": "NETWORK_SIMPLEX",
  "elk.layered.nodePlacement.favorStraightEdges": "true",
  "elk.layered.thoroughness": "10",
  "elk.json.edgeCoords": "ROOT", "elk.json.shapeCoords": "ROOT",
  ...SPACING,
};

/** `portOrder`: of the ports of closed subdiagrams; while it is not known, ELK finds one. */
function elkLeaf(index, node, chart, feedback, unit, portOrder) {
  const size = measured(node, chart), isFree = node.room === "subdiagram" && !portOrder;
  const ports = node.face.shape === "circle" ? roundPorts(index, node, feedback, unit)
    : boxPorts(index, node, size, unit, node.room === "subdiagram" ? portOrder : null);
  const elk = {
    id: String(index), width: size.width, height: size.height, ports,
    layoutOptions: { "elk.portConstraints": isFree ? "FIXED_SIDE" : "FIXED_POS", "elk.portLabels.placement": "OUTSIDE" },
  };
  if (size.outside) {
    elk.labels = [{ text: lastName(node.path), width: textWidth(lastName(node.path), FONT.name, true) + 2, height: FONT.name + 4 }];
    elk.layoutOptions["elk.nodeLabels.placement"] = `OUTSIDE ${node.face.shape === "circle" ? "V_TOP" : "V_BOTTOM"} H_CENTER`;
  }
  return { elk, size };
}

function elkContainer(index, node, unit) {
  const { left, right } = portTexts(node);
  const title = `${lastName(node.path)}  ${node.type}`;
  const padding = { left: widest(left, FONT.port) + 26, right: widest(right, FONT.port) + 30 };
  return {
    id: String(index), children: [],
    ports: [...node.inputs.map((_, k) => elkPort(`${index}i${k}`, "WEST", "")), ...node.outputs.map((_, k) => elkPort(`${index}o${k}`, "EAST", unit(k)))],
    layoutOptions: {
      ...LAYERED,
      "elk.portConstraints": "FIXED_SIDE", "elk.portLabels.placement": "OUTSIDE",
      "elk.padding": `[top=36,left=${padding.left},bottom=20,right=${padding.right}]`,
      "elk.nodeSize.constraints": "PORTS MINIMUM_SIZE",
      "elk.nodeSize.minimum": `(${textWidth(title, FONT.name, true) + 50},60)`,
      "elk.spacing.portsSurrounding": "[top=36,left=0,bottom=14,right=0]",
    },
  };
}

/** How much a wire looks like a reference: it decides where a loop begins. */
function weightOf(graph, from, isContainer) {
  if (isContainer) return 3;
  const { room, type } = graph.nodes[from];
  if (type === "Noise" || type === "Constant" || type === "ConstantForce") return 1;
  return room === "sources" || room === "motion" ? 4 : 2;
}

/** Reading order of every level, and the input ports that are reached by wires that lead back. */
function arrange(graph, seen) {
  const levels = new Map();
  for (const i of seen.nodes) levels.set(seen.parentOf(i), [...(levels.get(seen.parentOf(i)) ?? []), i]);
  const order = new Map(), feedback = new Set();
  for (const [container, nodes] of levels) {
    const members = new Set(nodes);
    const edges = seen.edges.filter(({ to }) => members.has(to[0]) && to[1] === "i")
      .map(({ from, to }) => ({ from: from[0], to: to[0], weight: weightOf(graph, from[0], from[0] === container) }));
    const sequence = readingOrder(nodes, edges);
    order.set(container, sequence);
    const rank = new Map(sequence.map((n, k) => [n, k]));
    for (const { from, to } of seen.edges)
      if (members.has(to[0]) && to[1] === "i" && members.has(from[0]) && rank.get(from[0]) >= rank.get(to[0])) feedback.add(portId(to));
  }
  return { order, feedback };
}

const isReversed = ({ from, to }, feedback) => to[1] === "i" && from[0] !== to[0] && from[1] === "o" && feedback.has(portId(to));

/** The graph as input of ELK, and the sizes of the contents of its blocks. `charts`: of open state machines, by node. */
export function elkGraph(graph, open, charts, portOrder = null) {
  const seen = visibleGraph(graph, open), { order, feedback } = arrange(graph, seen);
  const wired = new Set(seen.edges.map(({ from }) => portId(from)));
  const sizes = new Map();
  const children = (container) => (order.get(container) ?? []).map((i) => {
    const node = graph.nodes[i], unit = (k) => (wired.has(`${i}o${k}`) ? node.outputs[k].unit : "");
    if (seen.opened(i)) {
      const elk = elkContainer(i, node, unit);
      elk.children = children(i);
      return elk;
    }
    const { elk, size } = elkLeaf(i, node, charts.get(i), feedback, unit, portOrder);
    sizes.set(i, size);
    return elk;
  });
  // A wire that leads back is given to ELK the other way round: what remains has no cycles for it to break elsewhere.
  const edges = seen.edges.map(({ index, from, to }) => (isReversed({ from, to }, feedback)
    ? { id: `r${index}`, sources: [portId(to)], targets: [portId(from)] }
    : { id: `e${index}`, sources: [portId(from)], targets: [portId(to)] }));
  const root = { id: "root", layoutOptions: { ...LAYERED, "elk.padding": "[top=12,left=12,bottom=12,right=12]" },
                 children: children(-1), edges };
  return { root, sizes, seen, hasFreePorts: [...sizes.keys()].some((i) => graph.nodes[i].room === "subdiagram") };
}

/** Height of every port in a layout. */
function portHeights(elk, heights = new Map()) {
  for (const port of elk.ports ?? []) heights.set(port.id, port.y);
  for (const child of elk.children ?? []) portHeights(child, heights);
  return heights;
}

/** Wires in the direction of their signals again. */
function restored(laidOut) {
  for (const edge of laidOut.edges) {
    if (edge.id[0] !== "r") continue;
    edge.id = `e${edge.id.slice(1)}`;
    for (const section of edge.sections ?? []) {
      [section.startPoint, section.endPoint] = [section.endPoint, section.startPoint];
      section.bendPoints?.reverse();
    }
  }
  return laidOut;
}

/** Lays out the graph with `elk`, an instance of ELK; the result is what drawDiagram needs. */
export async function layOut(elk, graph, open) {
  const charts = new Map();
  for (const i of visibleGraph(graph, open).nodes) {
    const { chart, path } = graph.nodes[i];
    if (chart && open.has(path)) charts.set(i, await layOutChart(elk, chart));
  }
  // Twice, if there are closed subdiagrams: first for the order of their ports, then with ports in their places.
  const first = elkGraph(graph, open, charts);
  let laidOut = await elk.layout(first.root);
  if (first.hasFreePorts) laidOut = await elk.layout(elkGraph(graph, open, charts, portHeights(laidOut)).root);
  return { graph, laidOut: restored(laidOut), sizes: first.sizes, seen: first.seen };
}
