// The diagram: blocks and wires of one level, with everything that can be done to them by mouse and by keys.
import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import {
  Background, BackgroundVariant, Controls, MarkerType, ReactFlow, ReactFlowProvider, SelectionMode, applyNodeChanges, useReactFlow, useStore,
  type Connection as FlowConnection, type FinalConnectionState, type NodeChange,
} from "@xyflow/react";
import { arrange } from "../layout/client";
import type { Layout } from "../layout/messages";
import { prettyUnit } from "../numbers";
import { edit, enter } from "../state/document";
import { toggle_signal } from "../state/run";
import { get, patch, useStudio } from "../state/store";
import { signal_colours, signal_name } from "../state/signals";
import { DRAGGED_TYPE } from "./Palette";
import { BlockNode, type BlockFlowNode } from "./BlockNode";
import { graph_of, layout_key, layout_request, type Graph, type GraphEdge } from "./graph";
import { WireEdge, type WireFlowEdge } from "./WireEdge";

const node_types = { block: BlockNode };
const edge_types = { wire: WireEdge };

/** "block:axis" + "out:y" → "axis.y"; "input:force" → "force". */
const source_of = (node: string, handle: string | null): string => node.startsWith("input:") ? node.slice(6) : `${node.slice(6)}.${(handle ?? "").slice(4)}`;
function target_of(node: string, handle: string | null): { to: string; index: number } {
  const [, port = "", index = "0"] = (handle ?? "").split(":");
  return node.startsWith("output:") ? { to: node.slice(7), index: 0 } : { to: `${node.slice(6)}.${port}`, index: Number(index) };
}

/** Whether a block is one of these, or holds one of them. */
const is_within = (paths: string[], path: string): boolean => paths.some((entry) => entry === path || entry.startsWith(path + "."));

function useLayout(graph: Graph | null): Layout | null {
  const [layout, setLayout] = useState<Layout | null>(null);
  const key = graph ? layout_key(graph) : "";
  useEffect(() => {
    if (!graph) return;
    let current = true;
    void arrange(layout_request(graph)).then((result) => { if (current) setLayout(result); });
    return () => { current = false; };
  // The key holds all of the graph that matters here.
  // eslint-disable-next-line
  }, [key]);
  return layout;
}

function Diagram() {
  const view = useStudio((state) => state.document?.view ?? null);
  const problems = useStudio((state) => state.document?.problems);
  const path = useStudio((state) => state.document?.path);
  const selected = useStudio((state) => state.selected);
  const selected_wire = useStudio((state) => state.selected_wire);
  const highlighted = useStudio((state) => state.highlighted);
  const tints = useStudio((state) => (state.scope_tab === "compare" || state.panel === "measure" || state.panel === "diagnose" ? state.comparison?.tint : undefined));
  const plots = useStudio((state) => state.plots);
  const graph = useMemo(() => (view ? graph_of(view) : null), [view]);
  const layout = useLayout(graph);
  const flow = useReactFlow();
  const [nodes, setNodes] = useState<BlockFlowNode[]>([]);
  const fitted = useRef("");
  const editable = Boolean(view?.editable);

  useEffect(() => {
    if (!graph || !layout) return;
    const prefix = view!.inside ? view!.inside + "." : "";
    setNodes((before) => graph.nodes.filter((node) => layout.positions[node.id]).map((node): BlockFlowNode => {
      const tint = tints?.find((entry) => entry.block === prefix + node.name && entry.share >= 0.005) ?? null;
      const own = node.block?.problems.map((index) => problems?.[index]?.severity) ?? [];
      const old = before.find((entry) => entry.id === node.id);
      return {
        ...(old?.measured ? { measured: old.measured } : {}),
        id: node.id, type: "block", position: old?.dragging ? old.position : layout.positions[node.id]!, width: node.look.width, height: node.look.height,
        draggable: node.kind === "block" && editable, deletable: node.kind === "block" && editable,
        selected: node.kind === "block" && selected.includes(node.name), ariaLabel: node.name,
        data: { node, highlighted: is_within(highlighted, prefix + node.name), tint: node.kind === "block" ? tint : null, severity: own.includes("error") ? "error" : own.length ? "warning" : "" },
      };
    }));
  }, [graph, layout, tints, problems, highlighted, selected, editable, view]);

  const edges = useMemo((): WireFlowEdge[] => {
    if (!graph || !layout) return [];
    const colours = signal_colours(plots);
    return graph.edges.map((edge): WireFlowEdge => {
      const name = signal_name(view!.inside, edge.signal), series = name ? colours.get(name) ?? -1 : -1;
      const colour = edge.wire.clash ? "var(--error)" : edge.id === selected_wire ? "var(--accent)" : series >= 0 ? `var(--series-${series})` : "var(--wire)";
      return {
        id: edge.id, type: "wire", source: edge.from, target: edge.to, sourceHandle: edge.from_port, targetHandle: edge.to_port,
        selected: edge.id === selected_wire, ariaLabel: `wire from ${edge.signal} to ${edge.input}`, interactionWidth: 16,
        data: { edge, points: layout.routes[edge.id] ?? null, series, label: edge.signal + (edge.wire.unit && edge.wire.unit !== "1" ? ` [${prettyUnit(edge.wire.unit)}]` : "") },
        markerEnd: { type: MarkerType.ArrowClosed, width: series >= 0 ? 8 : 11, height: series >= 0 ? 8 : 11, color: colour },
      };
    });
  }, [graph, layout, plots, selected_wire, view]);

  // A new file or level is shown as a whole.
  const level = `${path} ${view?.inside}`;
  const width = useStore((state) => state.width), height = useStore((state) => state.height);
  useEffect(() => {
    if (!nodes.length || !layout || !width || fitted.current === `${level} ${nodes.length > 0}`) return;
    if (graph && graph.nodes.length !== nodes.length) return;
    fitted.current = `${level} ${nodes.length > 0}`;
    requestAnimationFrame(() => void flow.fitView({ padding: 0.08, maxZoom: 1.15, minZoom: 0.35 }));
  }, [nodes, level, layout, graph, flow, width]);
  // So is a canvas whose size has changed a lot, as when another part of the page opens.
  const size = useRef({ width: 0, height: 0 });
  useEffect(() => {
    const before = size.current;
    size.current = { width, height };
    if (before.width && (Math.abs(before.width - width) > 40 || Math.abs(before.height - height) > 40))
      void flow.fitView({ padding: 0.08, maxZoom: 1.15, minZoom: 0.35 });
  }, [width, height, flow]);

  // What was just added is brought into sight.
  useEffect(() => {
    if (highlighted.length && nodes.some((node) => node.data.highlighted)) void flow.fitView({ padding: 0.08, maxZoom: 1.15, duration: 300 });
  // eslint-disable-next-line
  }, [highlighted, layout]);

  const on_nodes = useCallback((changes: NodeChange<BlockFlowNode>[]) => {
    setNodes((before) => applyNodeChanges(changes, before));
    const selections = changes.filter((change) => change.type === "select");
    if (selections.length) {
      const names = new Set(get().selected);
      for (const change of selections) {
        if (!change.id.startsWith("block:")) continue;
        if (change.selected) names.add(change.id.slice(6)); else names.delete(change.id.slice(6));
      }
      patch({ selected: [...names], ...(names.size ? { selected_wire: "", panel: "inspect" } : {}) });
    }
    const moved = changes.filter((change) => change.type === "position" && !change.dragging && change.position);
    if (moved.length) pending_moves(changes);
  // eslint-disable-next-line
  }, []);

  const dragged = useRef(false);
  const pending_moves = (changes: NodeChange<BlockFlowNode>[]) => {
    if (dragged.current) return;   // the end of dragging sends all of them
    const positions = Object.fromEntries(changes.flatMap((change) => change.type === "position" && change.position && change.id.startsWith("block:")
      ? [[change.id.slice(6), [Math.round(change.position.x), Math.round(change.position.y)]]] : []));
    if (Object.keys(positions).length) void edit({ intent: "move", positions });
  };

  const connect = useCallback((connection: FlowConnection) => {
    const target = target_of(connection.target, connection.targetHandle);
    void edit({ intent: "connect", from: source_of(connection.source, connection.sourceHandle), ...target });
  }, []);

  /** A wire that ends on nothing asks for a block that fits there. */
  const connect_end = useCallback((_event: unknown, end: FinalConnectionState) => {
    if (end.isValid || end.toNode || !end.fromNode || !end.fromHandle || !end.to) return;
    const from_source = end.fromHandle.type === "source";
    const port = from_source ? source_of(end.fromNode.id, end.fromHandle.id ?? null) : target_of(end.fromNode.id, end.fromHandle.id ?? null).to;
    patch({ show_palette: true });
    window.dispatchEvent(new CustomEvent("palette-for", { detail: { fits: port, from_source, at: end.to } }));
  }, []);

  const show_wire = (edge: GraphEdge) => {
    const name = signal_name(view!.inside, edge.signal), was_selected = get().selected_wire === edge.id;
    patch({ selected_wire: edge.id, selected: [] });
    if (!name) return;
    const shown = get().plots.some((plot) => plot.includes(name));
    if (!shown || was_selected) void toggle_signal(name);
    else patch({ scope_tab: "run" });
  };

  const remove = () => {
    if (!editable) return;
    const { selected: blocks, selected_wire: wire } = get();
    const edge = wire ? edges.find((entry) => entry.id === wire)?.data?.edge : undefined;
    if (blocks.length) void edit({ intent: "remove_blocks", blocks });
    else if (edge) void edit({ intent: "disconnect", to: edge.wire.to, index: edge.wire.index });
  };

  if (!view) return null;
  return (
    <ReactFlow<BlockFlowNode, WireFlowEdge>
      nodes={nodes} edges={edges} nodeTypes={node_types} edgeTypes={edge_types}
      onNodesChange={on_nodes} onConnect={connect} onConnectEnd={connect_end}
      onEdgeClick={(_event, edge) => show_wire(edge.data!.edge)}
      onNodeDoubleClick={(_event, node) => { if (node.data.node.block?.subdiagram) enter(node.data.node.name); }}
      onDragOver={(event) => { if (editable && event.dataTransfer.types.includes(DRAGGED_TYPE)) event.preventDefault(); }}
      onDrop={(event) => {
        const type = event.dataTransfer.getData(DRAGGED_TYPE);
        if (!type || !editable) return;
        event.preventDefault();
        const { x, y } = flow.screenToFlowPosition({ x: event.clientX, y: event.clientY });
        void edit({ intent: "add_block", type, position: [Math.round(x), Math.round(y)] }).then((answer) => { if (answer) patch({ selected: answer.blocks.slice(0, 1), panel: "inspect" }); });
      }}
      onPaneClick={() => patch({ selected: [], selected_wire: "" })}
      onNodeDragStart={() => { dragged.current = true; }}
      onNodeDragStop={(_event, _node, moved) => {
        dragged.current = false;
        const positions = Object.fromEntries(moved.filter((node) => node.id.startsWith("block:")).map((node) => [node.id.slice(6), [Math.round(node.position.x), Math.round(node.position.y)]]));
        if (Object.keys(positions).length) void edit({ intent: "move", positions });
      }}
      onKeyDown={(event) => {
        if ((event.key === "Delete" || event.key === "Backspace") && !(event.target instanceof HTMLInputElement)) remove();
        if (event.key === "Enter") {
          const only = get().selected.length === 1 ? get().selected[0]! : "";
          if (view.blocks.find((block) => block.name === only)?.subdiagram) enter(only);
        }
      }}
      deleteKeyCode={null} nodesConnectable={editable} edgesFocusable nodesFocusable selectionMode={SelectionMode.Partial}
      snapToGrid snapGrid={[10, 10]} minZoom={0.15} maxZoom={3} zoomOnDoubleClick={false} connectionRadius={24}
      proOptions={{ hideAttribution: true }} aria-label={`Diagram ${view.title || path}`}
    >
      <Background variant={BackgroundVariant.Dots} gap={20} size={1} color="var(--grid-dot)" />
      <Controls showInteractive={false} position="bottom-left" />
      <svg className="junctions" aria-hidden="true"><Junctions points={layout?.junctions ?? []} /></svg>
    </ReactFlow>
  );
}

/** Dots where wires branch. */
function Junctions({ points }: { points: { x: number; y: number }[] }) {
  const [x, y, zoom] = useStore((state) => state.transform);
  return <g transform={`translate(${x} ${y}) scale(${zoom})`}>{points.map((point, i) => <circle key={i} cx={point.x} cy={point.y} r="2.6" />)}</g>;
}

export const Canvas = () => <ReactFlowProvider><Diagram /></ReactFlowProvider>;
