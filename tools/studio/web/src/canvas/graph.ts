// From a view of the diagram to what the canvas draws: nodes with places for wires, and edges between them.
import type { LayoutEdge, LayoutNode, LayoutPort, Side } from "../layout/messages";
import type { Block, View, WireEntry } from "../protocol/types";
import { flow_of, group } from "./flow";
import { look, terminalLook, type Look } from "./symbols";

export interface Place {
  id: string;             // "in:terms:0", "out:y": unique within its node
  port: string;
  index: number;          // of a wire into a port that takes several
  side: Side;
  x: number; y: number;   // relative to the node
  unit: string; sentence: string;
  sign: string;           // of a sum
  connected: boolean;
}
export interface GraphNode {
  id: string;             // "block:axis", "input:force", "output:position"
  name: string;
  kind: "block" | "input" | "output";
  block: Block | null;
  look: Look;
  places: Place[];
  unit: string; description: string;   // of an input or output of the diagram
}
export interface GraphEdge extends LayoutEdge {
  wire: WireEntry;
  signal: string;         // what feeds it, as the log names it: "stage.velocity"
  input: string;          // "axis.force", or the name of an output of the diagram
}
export interface Graph { nodes: GraphNode[]; edges: GraphEdge[] }

export const block_id = (name: string): string => `block:${name}`;
const output_place = (port: string): string => `out:${port}`;
const input_place = (port: string, index: number): string => `in:${port}:${index}`;
const LABEL_CHARACTER = 6.2;  // px

/** "gain.y[2]" → block "gain", port "y[2]"; "force" → no block. */
function split(source: string): { block: string; port: string } {
  const dot = source.indexOf(".");
  return dot < 0 ? { block: "", port: source } : { block: source.slice(0, dot), port: source.slice(dot + 1) };
}

const looks = new WeakMap<Block, Look>();
function look_of(block: Block): Look {
  const known = looks.get(block) ?? look(block);
  looks.set(block, known);
  return known;
}

/** With the nodes and edges of `before` that are the same now, as the same objects: only the others are drawn again. */
export function graph_of(view: View, before: Graph | null): Graph {
  const graph = new_graph(view);
  if (!before) return graph;
  const old_nodes = new Map(before.nodes.map((node) => [node.id, node])), old_edges = new Map(before.edges.map((edge) => [edge.id, edge]));
  const nodes = graph.nodes.map((node) => { const old = old_nodes.get(node.id); return old && is_same_node(old, node) ? old : node; });
  const edges = graph.edges.map((edge) => { const old = old_edges.get(edge.id); return old && is_same_edge(old, edge) ? old : edge; });
  return { nodes, edges };
}
const is_same_place = (a: Place, b: Place | undefined): boolean =>
  b !== undefined && a.id === b.id && a.side === b.side && a.x === b.x && a.y === b.y && a.unit === b.unit && a.sign === b.sign && a.connected === b.connected && a.sentence === b.sentence;
const is_same_node = (a: GraphNode, b: GraphNode): boolean =>
  a.block === b.block && a.unit === b.unit && a.description === b.description && a.places.length === b.places.length && a.places.every((place, i) => is_same_place(place, b.places[i]));
const is_same_edge = (a: GraphEdge, b: GraphEdge): boolean =>
  a.from === b.from && a.from_port === b.from_port && a.to === b.to && a.to_port === b.to_port && a.back === b.back && a.signal === b.signal &&
  (a.wire === b.wire || (a.wire.unit === b.wire.unit && a.wire.clash === b.wire.clash));

function new_graph(view: View): Graph {
  const nodes = new Map<string, GraphNode>();
  for (const input of view.inputs)
    nodes.set(`input:${input.name}`, { id: `input:${input.name}`, name: input.name, kind: "input", block: null, look: terminalLook(input.name), places: [], unit: input.unit, description: input.description });
  for (const block of view.blocks)
    nodes.set(block_id(block.name), { id: block_id(block.name), name: block.name, kind: "block", block, look: look_of(block), places: [], unit: "", description: block.description });
  for (const output of view.outputs)
    nodes.set(`output:${output.name}`, { id: `output:${output.name}`, name: output.name, kind: "output", block: null, look: terminalLook(output.name), places: [], unit: output.unit, description: output.description });

  const edges = edges_of(view, nodes);
  const { order, returning } = flow_of([...nodes.keys()], edges);
  const entering = group(edges, (edge) => edge.to), leaving = group(edges, (edge) => edge.from);
  for (const node of nodes.values()) {
    place_ports(node, entering.get(node.id) ?? [], leaving.get(node.id) ?? []);
    if (returning.has(node.id)) turn_around(node);
  }
  return { nodes: order.map((id) => nodes.get(id)!), edges: edges.filter((edge) => has_place(nodes, edge.from, edge.from_port) && has_place(nodes, edge.to, edge.to_port)) };
}

const has_place = (nodes: Map<string, GraphNode>, id: string, place: string): boolean =>
  nodes.get(id)?.places.some((entry) => entry.id === place) ?? false;

function edges_of(view: View, nodes: Map<string, GraphNode>): GraphEdge[] {
  const wired = new Set(view.wires.map((wire) => wire.to));
  const outputs = view.outputs.filter((output) => output.source && !wired.has(output.name))
    .map((output): WireEntry => ({ from: output.source, to: output.name, index: 0, unit: output.unit, clash: "" }));
  return [...view.wires, ...outputs].flatMap((wire): GraphEdge[] => {
    const source = split(wire.from), target = split(wire.to);
    const from = source.block ? block_id(source.block) : `input:${source.port}`;
    const to = target.block ? block_id(target.block) : `output:${target.port}`;
    if (!nodes.has(from) || !nodes.has(to)) return [];
    return [{
      id: `${wire.to}#${wire.index}`, wire, from, to, from_port: output_place(source.port), back: false,
      to_port: input_place(target.block ? target.port : "", wire.index), signal: wire.from, input: wire.to,
    }];
  });
}

/** A block of the return path has its inputs on the right. */
function turn_around(node: GraphNode): void {
  for (const place of node.places) {
    if (place.side === "SOUTH") continue;
    place.side = place.side === "WEST" ? "EAST" : "WEST";
    place.x = node.look.width - place.x;
  }
}

/** Inputs on the left, outputs on the right; what a circle subtracts from behind enters it from below. */
function place_ports(node: GraphNode, entering: GraphEdge[], leaving: GraphEdge[]): void {
  const { width, height, shape } = node.look, block = node.block;
  if (!block) {
    const base = { port: node.name, index: 0, y: height / 2, unit: node.unit, sentence: node.description, sign: "", connected: true };
    node.places.push(node.kind === "input" ? { ...base, id: output_place(node.name), side: "EAST", x: width } : { ...base, id: input_place("", 0), side: "WEST", x: 0 });
    return;
  }
  const back = new Set(entering.filter((edge) => edge.back).map((edge) => edge.to_port));
  const signs = block.picture.kind === "signs" ? block.picture.signs : "";
  const inputs = block.inputs.flatMap((port) => Array.from({ length: Math.max(1, port.wires) }, (_, index): Place => ({
    id: input_place(port.name, index), port: port.name, index, side: "WEST", x: 0, y: 0, unit: port.unit, sentence: port.sentence,
    sign: block.type === "Sum" ? (signs[index] ?? "+") : "", connected: index < port.wires,
  })));
  const below = shape === "circle" ? inputs.find((place) => back.has(place.id)) : undefined;
  const left = inputs.filter((place) => place !== below);
  if (below) Object.assign(below, { side: "SOUTH", x: width / 2, y: height });
  left.forEach((place, i) => { place.y = spread(i, left.length, below ? 0.8 * height : height, shape); place.x = shape === "circle" ? circle_edge(place.y, height) : 0; });
  const names = block.outputs.map((port) => ({ ...port }));
  // A wire may start inside a subdiagram or at one element of a vector: it gets a place of its own.
  for (const edge of leaving)
    if (!names.some((port) => output_place(port.name) === edge.from_port))
      names.push({ name: edge.from_port.slice(4), unit: edge.wire.unit, sentence: "", logged: false });
  const outputs = names.map((port, i): Place => ({
    id: output_place(port.name), port: port.name, index: 0, side: "EAST", x: width, y: spread(i, names.length, height, shape), unit: port.unit,
    sentence: port.sentence, sign: "", connected: leaving.some((edge) => edge.from_port === output_place(port.name)),
  }));
  node.places.push(...left, ...(below ? [below] : []), ...outputs);
}

const spread = (i: number, count: number, height: number, shape: string): number =>
  shape === "circle" && count > 1 ? Math.round(height * (0.2 + (0.6 * i) / (count - 1))) : Math.round((height * (i + 0.5)) / count);
const circle_edge = (y: number, size: number): number => {
  const from_middle = y - size / 2;
  return Math.round(size / 2 - Math.sqrt(Math.max(0, (size / 2) ** 2 - from_middle ** 2)));
};

const layout_node = (node: GraphNode): LayoutNode => ({
  id: node.id, width: node.look.width, height: node.look.height, label_width: node.block ? node.name.length * LABEL_CHARACTER : 0,
  label_above: label_above(node), ports: node.places.map(({ id, side, x, y }): LayoutPort => ({ id, side, x, y })),
  end: node.kind === "input" ? "first" : node.kind === "output" ? "last" : "",
  fixed: node.block?.position ? { x: node.block.position[0], y: node.block.position[1] } : null,
});
const layout_edge = ({ id, from, from_port, to, to_port, back }: GraphEdge): LayoutEdge => ({ id, from, from_port, to, to_port, back });

export const layout_request = (graph: Graph): { nodes: LayoutNode[]; edges: LayoutEdge[] } =>
  ({ nodes: graph.nodes.map(layout_node), edges: graph.edges.map(layout_edge) });

/** The name stands above where a wire comes from below. */
export const label_above = (node: GraphNode): boolean => node.places.some((place) => place.side === "SOUTH");

const keys = new WeakMap<GraphNode | GraphEdge, string>();
function key_of<T extends GraphNode | GraphEdge>(part: T, describe: (part: T) => object): string {
  const known = keys.get(part) ?? JSON.stringify(describe(part));
  keys.set(part, known);
  return known;
}
/** What must be the same for the same layout: a change of numbers must not move anything. */
export const layout_key = (graph: Graph): string =>
  [...graph.nodes.map((node) => key_of(node, layout_node)), ...graph.edges.map((edge) => key_of(edge, layout_edge))].join();
