// What the canvas asks of the layout worker.
import type { Chart } from "../protocol/types";

export interface Point { x: number; y: number }
export type Side = "WEST" | "EAST" | "SOUTH";
export interface LayoutPort { id: string; side: Side; x: number; y: number }
export interface LayoutNode {
  id: string; width: number; height: number; label_width: number; label_above: boolean; ports: LayoutPort[];
  end: "first" | "last" | "";     // inputs and outputs of the diagram are at its ends
  fixed: Point | null;            // where a person put it
}
export interface LayoutEdge {
  id: string; from: string; from_port: string; to: string; to_port: string;
  back: boolean;                  // closes a loop: is drawn from right to left
}
/** Nodes in the order of the signal flow: wires that go back in it close loops. */
export interface LayoutRequest { count: number; nodes: LayoutNode[]; edges: LayoutEdge[] }
export interface Layout {
  positions: Record<string, Point>;
  routes: Record<string, Point[]>;          // with both ends
  junctions: Point[];
}
export interface LayoutAnswer { count: number; layout: Layout }

/** The chart of a state machine, instead of a diagram. */
export interface ChartRequest { count: number; chart: Chart }
export interface ChartLayout {
  width: number; height: number;
  states: { index: number; x: number; y: number; width: number; height: number; title: string[]; lines: string[]; isOuter: boolean }[];
  dots: Point[]; defaults: Point[][];
  transitions: { index: number; points: Point[][]; label: { x: number; y: number; width: number; height: number; lines: string[] } }[];
}
export interface ChartAnswer { count: number; chart: ChartLayout }
