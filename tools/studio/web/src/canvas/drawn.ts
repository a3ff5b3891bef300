// From graph and layout to what React Flow draws. What is as it was stays the same object, so that it is not drawn again.
import { MarkerType } from "@xyflow/react";
import type { Layout } from "../layout/messages";
import { prettyUnit } from "../numbers";
import type { Comparison, Problem } from "../protocol/types";
import { signal_colours, signal_name } from "../state/signals";
import type { BlockData, BlockFlowNode } from "./BlockNode";
import type { Graph } from "./graph";
import type { WireFlowEdge } from "./WireEdge";

/** What is shown of the blocks besides themselves. */
export interface NodeState {
  inside: string; editable: boolean; selected: string[]; highlighted: string[];
  tints: Comparison["tint"] | undefined; problems: Problem[] | undefined;
}
const SMALLEST_TINT = 0.005;

/** Whether a block is one of these, or holds one of them. */
const is_within = (paths: string[], path: string): boolean => paths.some((entry) => entry === path || entry.startsWith(path + "."));

export function flow_nodes(before: BlockFlowNode[], graph: Graph, layout: Layout, state: NodeState): BlockFlowNode[] {
  const prefix = state.inside ? state.inside + "." : "", chosen = new Set(state.selected), old = new Map(before.map((node) => [node.id, node]));
  const nodes = graph.nodes.filter((node) => layout.positions[node.id]).map((node): BlockFlowNode => {
    const path = prefix + node.name, is_block = node.kind === "block", was = old.get(node.id);
    const severities = node.block?.problems.map((index) => state.problems?.[index]?.severity) ?? [];
    const data: BlockData = {
      node, highlighted: is_within(state.highlighted, path), tint: (is_block && state.tints?.find((entry) => entry.block === path && entry.share >= SMALLEST_TINT)) || null,
      severity: severities.includes("error") ? "error" : severities.length ? "warning" : "",
    };
    const position = was?.dragging ? was.position : layout.positions[node.id]!, movable = is_block && state.editable, selected = is_block && chosen.has(node.name);
    if (was && is_same(was.data, data) && was.position.x === position.x && was.position.y === position.y && was.draggable === movable && was.selected === selected) return was;
    return {
      ...(was?.measured && was.data.node.look === node.look ? { measured: was.measured } : {}),
      id: node.id, type: "block", position, width: node.look.width, height: node.look.height, draggable: movable, deletable: movable, selected, ariaLabel: node.name, data,
    };
  });
  return as_before(before, nodes);
}
const is_same = (a: BlockData, b: BlockData): boolean => a.node === b.node && a.highlighted === b.highlighted && a.tint === b.tint && a.severity === b.severity;

export function flow_edges(before: WireFlowEdge[], graph: Graph, layout: Layout, inside: string, plots: string[][], selected_wire: string): WireFlowEdge[] {
  const colours = signal_colours(plots), old = new Map(before.map((edge) => [edge.id, edge]));
  const edges = graph.edges.map((edge): WireFlowEdge => {
    const name = signal_name(inside, edge.signal), series = name ? colours.get(name) ?? -1 : -1, selected = edge.id === selected_wire;
    const points = layout.routes[edge.id] ?? null, was = old.get(edge.id);
    if (was?.data && was.data.edge === edge && was.data.points === points && was.data.series === series && was.selected === selected) return was;
    const colour = edge.wire.clash ? "var(--error)" : selected ? "var(--accent)" : series >= 0 ? `var(--series-${series})` : "var(--wire)", size = series >= 0 ? 8 : 11;  // px
    return {
      id: edge.id, type: "wire", source: edge.from, target: edge.to, sourceHandle: edge.from_port, targetHandle: edge.to_port, selected,
      ariaLabel: `wire from ${edge.signal} to ${edge.input}`, interactionWidth: 16,
      data: { edge, points, series, label: edge.signal + (edge.wire.unit && edge.wire.unit !== "1" ? ` [${prettyUnit(edge.wire.unit)}]` : "") },
      markerEnd: { type: MarkerType.ArrowClosed, width: size, height: size, color: colour },
    };
  });
  return as_before(before, edges);
}

/** The list before, if it has the same entries. */
function as_before<T>(before: T[], after: T[]): T[] {
  return before.length === after.length && after.every((entry, i) => entry === before[i]) ? before : after;
}
