// The diagram: blocks and wires of one level, with everything that can be done to them by mouse and by keys.
import { useCallback, useEffect, useMemo, useRef, useState, type DragEvent } from "react";
import { Background, BackgroundVariant, Controls, ReactFlow, ReactFlowProvider, SelectionMode, applyNodeChanges, useReactFlow, useStore, type NodeChange } from "@xyflow/react";
import { arrange } from "../layout/client";
import type { Layout } from "../layout/messages";
import type { View } from "../protocol/types";
import { useStudio } from "../state/store";
import { begin_drag, connect, connect_end, drag_over, drop_block, end_drag, enter_block, follow, press, select_nothing, show_wire } from "./actions";
import { BlockNode, type BlockFlowNode } from "./BlockNode";
import { flow_edges, flow_nodes } from "./drawn";
import { graph_of, layout_key, layout_request, type Graph } from "./graph";
import { WireEdge, type WireFlowEdge } from "./WireEdge";

const node_types = { block: BlockNode };
const edge_types = { wire: WireEdge };
const GRID: [number, number] = [10, 10], PRO_OPTIONS = { hideAttribution: true };  // the same objects at every change
const MOST_SHOWN_WHOLE = 60;  // blocks; more are too small to read when all of them are seen

function useGraph(view: View | null): Graph | null {
  const before = useRef<Graph | null>(null);
  return useMemo(() => (before.current = view ? graph_of(view, before.current) : null), [view]);
}

function useLayout(graph: Graph | null): Layout | null {
  const [layout, setLayout] = useState<Layout | null>(null);
  const key = useMemo(() => (graph ? layout_key(graph) : ""), [graph]);
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
  const graph = useGraph(view), inside = view?.inside ?? "";
  const layout = useLayout(graph);
  const flow = useReactFlow();
  const [nodes, setNodes] = useState<BlockFlowNode[]>([]);
  const fitted = useRef("");
  const editable = Boolean(view?.editable);

  useEffect(() => {
    if (graph && layout) setNodes((before) => flow_nodes(before, graph, layout, { inside, editable, selected, highlighted, tints, problems }));
  }, [graph, layout, tints, problems, highlighted, selected, editable, inside]);

  const edges_before = useRef<WireFlowEdge[]>([]);
  const edges = useMemo(() => (edges_before.current = graph && layout ? flow_edges(edges_before.current, graph, layout, inside, plots, selected_wire) : []), [graph, layout, plots, selected_wire, inside]);

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

  // What was just changed is brought into sight; what is in sight, and the block that the user edits, stay where they are.
  useEffect(() => {
    const { x, y, zoom } = flow.getViewport();
    const is_out_of_sight = ({ data: { node, highlighted: changed }, position, selected: edited }: BlockFlowNode) => changed && !edited &&
      (x + position.x * zoom < 0 || x + (position.x + node.look.width) * zoom > width || y + position.y * zoom < 0 || y + (position.y + node.look.height) * zoom > height);
    if (!highlighted.length || !nodes.some(is_out_of_sight)) return;
    const shown = nodes.length <= MOST_SHOWN_WHOLE ? {} : { nodes: nodes.filter((node) => node.data.highlighted) };
    void flow.fitView({ ...shown, padding: 0.08, maxZoom: 1.15, duration: 300 });
  // eslint-disable-next-line
  }, [highlighted, nodes]);

  const on_nodes = useCallback((changes: NodeChange<BlockFlowNode>[]) => {
    setNodes((before) => applyNodeChanges(changes, before));
    follow(changes);
  }, []);
  const drop = useCallback((event: DragEvent) => drop_block(event, flow.screenToFlowPosition({ x: event.clientX, y: event.clientY })), [flow]);

  if (!view) return null;
  return (
    <ReactFlow<BlockFlowNode, WireFlowEdge>
      nodes={nodes} edges={edges} nodeTypes={node_types} edgeTypes={edge_types}
      onNodesChange={on_nodes} onConnect={connect} onConnectEnd={connect_end} onEdgeClick={show_wire} onNodeDoubleClick={enter_block} onPaneClick={select_nothing}
      onDragOver={drag_over} onDrop={drop} onNodeDragStart={begin_drag} onNodeDragStop={end_drag} onKeyDown={press}
      deleteKeyCode={null} nodesConnectable={editable} edgesFocusable nodesFocusable selectionMode={SelectionMode.Partial}
      snapToGrid snapGrid={GRID} minZoom={0.15} maxZoom={3} zoomOnDoubleClick={false} connectionRadius={24}
      proOptions={PRO_OPTIONS} aria-label={`Diagram ${view.title || path}`}
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
