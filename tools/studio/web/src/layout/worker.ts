// Arranges blocks and routes wires, off the main thread. elkjs places and routes what nobody moved; wires of moved blocks
// are routed here.
import ELK, { type ElkExtendedEdge, type ElkNode } from "elkjs/lib/elk.bundled.js";
import { layOutChart } from "../../../../report/page/chart_layout.js";
import type { ChartAnswer, ChartRequest, Layout, LayoutAnswer, LayoutNode, LayoutRequest, Point, Side } from "./messages";
import { piece, route, straighten } from "./route";

const OPTIONS = {
  "elk.algorithm": "layered", "elk.direction": "RIGHT", "elk.edgeRouting": "ORTHOGONAL",
  "elk.layered.spacing.nodeNodeBetweenLayers": "44", "elk.spacing.nodeNode": "30", "elk.spacing.edgeNode": "18", "elk.spacing.edgeEdge": "12",
  "elk.layered.spacing.edgeNodeBetweenLayers": "18", "elk.layered.spacing.edgeEdgeBetweenLayers": "12",
  "elk.layered.nodePlacement.strategy": "NETWORK_SIMPLEX", "elk.layered.considerModelOrder.strategy": "NODES_AND_EDGES",
  "elk.layered.cycleBreaking.strategy": "MODEL_ORDER", "elk.layered.feedbackEdges": "true", "elk.separateConnectedComponents": "false",
  "elk.padding": "[top=20,left=20,bottom=20,right=20]",
};
/** Should the layout by signal flow fail. */
const PLAIN_OPTIONS = { "elk.algorithm": "layered", "elk.direction": "RIGHT", "elk.edgeRouting": "ORTHOGONAL", "elk.spacing.nodeNode": "30" };
const LABEL_HEIGHT = 16;    // px, of the name below a block
const VECTORS: Record<Side, Point> = { WEST: { x: -1, y: 0 }, EAST: { x: 1, y: 0 }, SOUTH: { x: 0, y: 1 } };

const elk = new ELK();
let newest = 0;

self.onmessage = async ({ data }: MessageEvent<LayoutRequest | ChartRequest>) => {
  if ("chart" in data) self.postMessage({ count: data.count, chart: await layOutChart(elk, data.chart) } satisfies ChartAnswer);
  else await answer(data);
};

async function answer(request: LayoutRequest): Promise<void> {
  newest = request.count;
  await Promise.resolve();                       // requests that wait behind this one come first
  if (request.count !== newest) return;
  const layout = await arrange(request, OPTIONS).catch(() => arrange(request, PLAIN_OPTIONS)).catch(() => in_rows(request));
  self.postMessage({ count: request.count, layout } satisfies LayoutAnswer);
}

/** Whatever happens, every block is shown: in rows, with wires routed around them. */
function in_rows({ nodes, edges }: LayoutRequest): Layout {
  const columns = Math.ceil(Math.sqrt(nodes.length)), pitch = { x: Math.max(...nodes.map((node) => node.width)) + 70, y: Math.max(...nodes.map((node) => node.height)) + 50 };
  const placed = nodes.map((node, i) => ({ ...node, fixed: node.fixed ?? { x: (i % columns) * pitch.x, y: Math.floor(i / columns) * pitch.y } }));
  return reroute(placed, edges, { positions: {}, routes: {}, junctions: [] });
}

async function arrange({ nodes, edges }: LayoutRequest, options: Record<string, string>): Promise<Layout> {
  const graph: ElkNode = {
    id: "diagram", layoutOptions: options,
    children: nodes.map((node) => ({
      id: node.id, width: node.width, height: node.height,
      layoutOptions: { "elk.portConstraints": "FIXED_POS", "elk.nodeLabels.placement": `OUTSIDE ${node.label_above ? "V_TOP" : "V_BOTTOM"} H_CENTER`,
                       ...(node.end && options === OPTIONS ? { "elk.layered.layering.layerConstraint": node.end === "first" ? "FIRST" : "LAST" } : {}) },
      labels: [{ text: node.id, width: node.label_width, height: LABEL_HEIGHT }],
      ports: node.ports.map((port) => ({ id: `${node.id}/${port.id}`, width: 0, height: 0, x: port.x, y: port.y, layoutOptions: { "elk.port.side": port.side } })),
    })),
    edges: edges.map((edge): ElkExtendedEdge => ({
      id: edge.id, sources: [`${edge.from}/${edge.from_port}`], targets: [`${edge.to}/${edge.to_port}`],
      layoutOptions: { "elk.layered.priority.straightness": edge.back ? "0" : edge.to.startsWith("output:") ? "1" : "10" },
    })),
  };
  const result = await elk.layout(graph);
  const positions: Record<string, Point> = {};
  for (const child of result.children ?? []) positions[child.id] = { x: Math.round(child.x ?? 0), y: Math.round(child.y ?? 0) };
  const routes: Record<string, Point[]> = {};
  const junctions: Point[] = [];
  for (const edge of result.edges ?? []) {
    const section = edge.sections?.[0];
    if (section) routes[edge.id] = straighten([section.startPoint, ...(section.bendPoints ?? []), section.endPoint]);
    junctions.push(...(edge.junctionPoints ?? []));
  }
  return reroute(nodes, edges, { positions, routes, junctions });
}

/** Puts moved blocks where they belong, and routes the wires that this concerns. */
function reroute(nodes: LayoutNode[], edges: LayoutRequest["edges"], layout: Layout): Layout {
  const moved = nodes.filter((node) => node.fixed);
  if (!moved.length) return layout;
  for (const node of moved) layout.positions[node.id] = node.fixed!;
  const by_id = new Map(nodes.map((node) => [node.id, node]));
  const boxes = nodes.map((node) => ({ ...layout.positions[node.id]!, width: node.width, height: node.height }));
  const moved_boxes = moved.map((node) => ({ ...node.fixed!, width: node.width, height: node.height }));
  const moved_ids = new Set(moved.map((node) => node.id));
  const taken = new Set<string>();
  const again: typeof edges = [];
  for (const edge of edges) {
    const path = layout.routes[edge.id];
    if (!path || moved_ids.has(edge.from) || moved_ids.has(edge.to) || crosses(path, moved_boxes)) again.push(edge);
    else for (let i = 1; i < path.length; ++i) taken.add(piece(path[i - 1]!, path[i]!));
  }
  for (const edge of again) {
    const from = end_of(by_id.get(edge.from), edge.from_port, layout), to = end_of(by_id.get(edge.to), edge.to_port, layout);
    if (!from || !to) continue;
    const path = route(from.point, VECTORS[from.side], to.point, VECTORS[to.side], boxes, taken);
    layout.routes[edge.id] = path;
    for (let i = 2; i < path.length - 1; ++i) taken.add(piece(path[i - 1]!, path[i]!));
  }
  const rerouted = new Set(again.map((edge) => edge.id));
  const kept = Object.entries(layout.routes).filter(([id]) => !rerouted.has(id)).map(([, path]) => path);
  layout.junctions = layout.junctions.filter((point) => kept.some((path) => path.some((corner) => corner.x === point.x && corner.y === point.y)));
  return layout;
}

function end_of(node: LayoutNode | undefined, port_id: string, layout: Layout): { point: Point; side: Side } | null {
  const port = node?.ports.find((entry) => entry.id === port_id), at = node && layout.positions[node.id];
  return port && at ? { point: { x: at.x + port.x, y: at.y + port.y }, side: port.side } : null;
}

function crosses(path: Point[], boxes: { x: number; y: number; width: number; height: number }[]): boolean {
  return path.some((b, i) => {
    const a = path[i - 1];
    return a !== undefined && boxes.some((box) => Math.max(a.x, b.x) > box.x && Math.min(a.x, b.x) < box.x + box.width &&
      Math.max(a.y, b.y) > box.y && Math.min(a.y, b.y) < box.y + box.height);
  });
}
