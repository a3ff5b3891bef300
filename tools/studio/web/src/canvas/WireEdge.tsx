// One wire: the route of the layout while both blocks are where it put them, else a line with right angles.
import { memo } from "react";
import { BaseEdge, ViewportPortal, getSmoothStepPath, type Edge, type EdgeProps } from "@xyflow/react";
import type { Point } from "../layout/messages";
import type { GraphEdge } from "./graph";

export interface WireData extends Record<string, unknown> {
  edge: GraphEdge;
  points: Point[] | null;
  series: number;       // colour of the curve that shows it; -1: not in the scopes
  label: string;
}
export type WireFlowEdge = Edge<WireData, "wire">;

const CORNER = 5;       // px, radius
const NEAR = 7;         // px: an end of the route is where the port is, whose mark has a width

/** A line through points with rounded corners. */
export function rounded(points: Point[]): string {
  let path = `M${points[0]!.x} ${points[0]!.y}`;
  for (let i = 1; i < points.length - 1; ++i) {
    const before = points[i - 1]!, at = points[i]!, after = points[i + 1]!;
    const radius = Math.min(CORNER, distance(before, at) / 2, distance(at, after) / 2);
    const start = towards(at, before, radius), end = towards(at, after, radius);
    path += `L${start.x} ${start.y}Q${at.x} ${at.y} ${end.x} ${end.y}`;
  }
  const last = points.at(-1)!;
  return path + `L${last.x} ${last.y}`;
}
const distance = (a: Point, b: Point): number => Math.abs(a.x - b.x) + Math.abs(a.y - b.y);
function towards(from: Point, to: Point, length: number): Point {
  const whole = distance(from, to) || 1;
  return { x: from.x + ((to.x - from.x) * length) / whole, y: from.y + ((to.y - from.y) * length) / whole };
}

export const WireEdge = memo(function WireEdge(props: EdgeProps<WireFlowEdge>) {
  const { sourceX, sourceY, targetX, targetY, sourcePosition, targetPosition, data, selected } = props;
  const points = data?.points, first = points?.[0], last = points?.at(-1);
  const fits = first && last && Math.abs(first.x - sourceX) < NEAR && Math.abs(first.y - sourceY) < NEAR && Math.abs(last.x - targetX) < NEAR && Math.abs(last.y - targetY) < NEAR;
  const [path, labelX, labelY] = fits ? [rounded(points), ...middle(points)] as const
    : getSmoothStepPath({ sourceX, sourceY, sourcePosition, targetX, targetY, targetPosition, borderRadius: CORNER, offset: 14 });
  const clash = data?.edge.wire.clash;
  const classes = ["wire", selected && "selected", clash && "clash", data && data.series >= 0 && `series-${data.series % 8}`].filter(Boolean).join(" ");
  return (
    <g className={classes}>
      <BaseEdge path={path} interactionWidth={16} {...(props.markerEnd ? { markerEnd: props.markerEnd } : {})} />
      {(clash || selected) && (
        <ViewportPortal><div className={clash ? "wire-label clash" : "wire-label"} style={{ transform: `translate(-50%, -100%) translate(${labelX}px, ${labelY - 4}px)` }}>{clash || data?.label}</div></ViewportPortal>
      )}
      <title>{clash ? `${data!.label}: ${clash}` : data?.label}</title>
    </g>
  );
});

/** The middle of the longest piece. */
function middle(points: Point[]): [number, number] {
  let best = 1;
  for (let i = 1; i < points.length; ++i)
    if (distance(points[i - 1]!, points[i]!) > distance(points[best - 1]!, points[best]!)) best = i;
  return [(points[best - 1]!.x + points[best]!.x) / 2, (points[best - 1]!.y + points[best]!.y) / 2];
}
