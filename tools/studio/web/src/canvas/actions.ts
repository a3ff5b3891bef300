// What mouse and keys do on the canvas. None of these functions depends on what is drawn: with others at every change,
// React Flow would draw all blocks and wires again.
import type { KeyboardEvent, MouseEvent as ReactMouseEvent, DragEvent } from "react";
import type { Connection, FinalConnectionState, NodeChange, XYPosition } from "@xyflow/react";
import { open_chart } from "../state/chart";
import { edit, enter } from "../state/document";
import { toggle_signal } from "../state/run";
import { signal_name } from "../state/signals";
import { get, patch } from "../state/store";
import type { BlockFlowNode } from "./BlockNode";
import { DRAGGED_TYPE } from "./Palette";
import type { WireFlowEdge } from "./WireEdge";

/** "block:axis" + "out:y" → "axis.y"; "input:force" → "force". */
const source_of = (node: string, handle: string | null): string => node.startsWith("input:") ? node.slice(6) : `${node.slice(6)}.${(handle ?? "").slice(4)}`;
function target_of(node: string, handle: string | null): { to: string; index: number } {
  const [, port = "", index = "0"] = (handle ?? "").split(":");
  return node.startsWith("output:") ? { to: node.slice(7), index: 0 } : { to: `${node.slice(6)}.${port}`, index: Number(index) };
}

/** `id`: of a node of the canvas. */
interface Placed { id: string; position: XYPosition }
function move(placed: Placed[]): void {
  const positions = Object.fromEntries(placed.filter(({ id }) => id.startsWith("block:")).map(({ id, position }) => [id.slice(6), [Math.round(position.x), Math.round(position.y)]]));
  if (Object.keys(positions).length) void edit({ intent: "move", positions });
}
let is_dragging = false;
export function begin_drag(): void { is_dragging = true; }
export function end_drag(_event: unknown, _node: unknown, moved: BlockFlowNode[]): void {
  is_dragging = false;
  move(moved);
}

/** Selection, and movement by keys, follow what React Flow says of its nodes. */
export function follow(changes: NodeChange<BlockFlowNode>[]): void {
  const selections = changes.filter((change) => change.type === "select");
  if (selections.length) {
    const names = new Set(get().selected);
    for (const change of selections) {
      if (!change.id.startsWith("block:")) continue;
      if (change.selected) names.add(change.id.slice(6)); else names.delete(change.id.slice(6));
    }
    patch({ selected: [...names], ...(names.size ? { selected_wire: "", panel: "inspect" } : {}) });
  }
  const is_moved = changes.some((change) => change.type === "position" && !change.dragging && change.position);
  // The end of dragging sends all of them.
  if (is_moved && !is_dragging) move(changes.flatMap((change) => (change.type === "position" && change.position ? [{ id: change.id, position: change.position }] : [])));
}

export function connect(connection: Connection): void {
  const target = target_of(connection.target, connection.targetHandle);
  void edit({ intent: "connect", from: source_of(connection.source, connection.sourceHandle), ...target });
}

/** A wire that ends on nothing asks for a block that fits there. */
export function connect_end(_event: unknown, end: FinalConnectionState): void {
  if (end.isValid || end.toNode || !end.fromNode || !end.fromHandle || !end.to) return;
  const from_source = end.fromHandle.type === "source";
  const port = from_source ? source_of(end.fromNode.id, end.fromHandle.id ?? null) : target_of(end.fromNode.id, end.fromHandle.id ?? null).to;
  patch({ show_palette: true });
  window.dispatchEvent(new CustomEvent("palette-for", { detail: { fits: port, from_source, at: end.to } }));
}

export function show_wire(_event: ReactMouseEvent, { data }: WireFlowEdge): void {
  const edge = data!.edge, name = signal_name(get().inside, edge.signal), was_selected = get().selected_wire === edge.id;
  patch({ selected_wire: edge.id, selected: [] });
  if (!name) return;
  const shown = get().plots.some((plot) => plot.includes(name));
  if (!shown || was_selected) void toggle_signal(name);
  else patch({ scope_tab: "run" });
}

export function enter_block(_event: ReactMouseEvent, { data }: BlockFlowNode): void {
  if (data.node.block?.subdiagram) enter(data.node.name);
  else if (data.node.block?.chart) open_chart(data.node.name);
}
export const select_nothing = (): void => patch({ selected: [], selected_wire: "" });

const is_editable = (): boolean => get().document?.view?.editable ?? false;
export function drag_over(event: DragEvent): void {
  if (is_editable() && event.dataTransfer.types.includes(DRAGGED_TYPE)) event.preventDefault();
}
export function drop_block(event: DragEvent, at: XYPosition): void {
  const type = event.dataTransfer.getData(DRAGGED_TYPE);
  if (!type || !is_editable()) return;
  event.preventDefault();
  void edit({ intent: "add_block", type, position: [Math.round(at.x), Math.round(at.y)] }).then((answer) => { if (answer) patch({ selected: answer.blocks.slice(0, 1), panel: "inspect" }); });
}

function remove(): void {
  const { selected: blocks, selected_wire, document } = get();
  const wire = document?.view?.wires.find((entry) => `${entry.to}#${entry.index}` === selected_wire);
  if (blocks.length) void edit({ intent: "remove_blocks", blocks });
  else if (wire) void edit({ intent: "disconnect", to: wire.to, index: wire.index });
}
export function press(event: KeyboardEvent): void {
  if ((event.key === "Delete" || event.key === "Backspace") && !(event.target instanceof HTMLInputElement) && is_editable()) remove();
  const { selected, document } = get(), only = selected.length === 1 ? selected[0]! : "";
  const block = event.key === "Enter" ? document?.view?.blocks.find((entry) => entry.name === only) : undefined;
  if (block?.subdiagram) enter(only);
  else if (block?.chart) open_chart(only);
}
