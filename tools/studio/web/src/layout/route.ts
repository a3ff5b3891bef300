// Orthogonal wires around boxes: the shortest path with the fewest bends, by A* on the lines that matter. For wires of
// blocks that a person moved; all others have the routes of the automatic layout.
import type { Point } from "./messages";

export interface Box { x: number; y: number; width: number; height: number }

const CLEARANCE = 14;   // px between a wire and a box
const BEND = 40;        // px that a bend costs
const CROWD = 60;       // px that running along another wire costs

/** `leave` and `arrive`: unit vectors of the sides of both ports. Falls back to a line with two bends. */
export function route(from: Point, leave: Point, to: Point, arrive: Point, boxes: Box[], taken: Set<string>): Point[] {
  const start = { x: from.x + CLEARANCE * leave.x, y: from.y + CLEARANCE * leave.y };
  const end = { x: to.x + CLEARANCE * arrive.x, y: to.y + CLEARANCE * arrive.y };
  const grown = boxes.map((box) => ({ left: box.x - CLEARANCE + 1, right: box.x + box.width + CLEARANCE - 1, top: box.y - CLEARANCE + 1, bottom: box.y + box.height + CLEARANCE - 1 }));
  const xs = lines([start.x, end.x, (start.x + end.x) / 2, ...grown.flatMap((box) => [box.left - 1, box.right + 1])]);
  const ys = lines([start.y, end.y, (start.y + end.y) / 2, ...grown.flatMap((box) => [box.top - 1, box.bottom + 1])]);
  const path = search(xs, ys, start, end, leave, (a, b) => {
    const left = Math.min(a.x, b.x), right = Math.max(a.x, b.x), top = Math.min(a.y, b.y), bottom = Math.max(a.y, b.y);
    return grown.some((box) => right > box.left && left < box.right && bottom > box.top && top < box.bottom);
  }, taken);
  const middle = (start.x + end.x) / 2;
  return straighten([from, ...(path ?? [start, { x: middle, y: start.y }, { x: middle, y: end.y }, end]), to]);
}

const lines = (values: number[]): number[] => [...new Set(values.map(Math.round))].sort((a, b) => a - b);
export const piece = (a: Point, b: Point): string => (a.x === b.x ? `x${a.x}` : `y${a.y}`);

interface Step { cost: number; guess: number; i: number; j: number; direction: number; before: Step | null }

function search(xs: number[], ys: number[], start: Point, end: Point, leave: Point, blocked: (a: Point, b: Point) => boolean, taken: Set<string>): Point[] | null {
  const nearest = (values: number[], value: number) => values.indexOf(Math.round(value));
  const goal = { i: nearest(xs, end.x), j: nearest(ys, end.y) };
  const heap = new Heap();
  const best = new Map<number, number>();
  const directions = [[1, 0], [0, 1], [-1, 0], [0, -1]] as const;
  const distance = (i: number, j: number) => Math.abs(xs[i]! - end.x) + Math.abs(ys[j]! - end.y);
  const first = { i: nearest(xs, start.x), j: nearest(ys, start.y) };
  heap.push({ cost: 0, guess: distance(first.i, first.j), ...first, direction: directions.findIndex(([x, y]) => x === leave.x && y === leave.y), before: null });
  for (let step = heap.pop(); step; step = heap.pop()) {
    if (step.i === goal.i && step.j === goal.j) {
      const path: Point[] = [];
      for (let at: Step | null = step; at; at = at.before) path.unshift({ x: xs[at.i]!, y: ys[at.j]! });
      return path;
    }
    for (let direction = 0; direction < 4; ++direction) {
      if ((direction + 2) % 4 === step.direction) continue;
      const i = step.i + directions[direction]![0], j = step.j + directions[direction]![1];
      if (i < 0 || j < 0 || i >= xs.length || j >= ys.length) continue;
      const a = { x: xs[step.i]!, y: ys[step.j]! }, b = { x: xs[i]!, y: ys[j]! };
      const cost = step.cost + Math.abs(a.x - b.x) + Math.abs(a.y - b.y) + (direction === step.direction ? 0 : BEND) + (taken.has(piece(a, b)) ? CROWD : 0);
      const key = (i * ys.length + j) * 4 + direction;
      if ((best.get(key) ?? Infinity) <= cost || blocked(a, b)) continue;
      best.set(key, cost);
      heap.push({ cost, guess: cost + distance(i, j), i, j, direction, before: step });
    }
  }
  return null;
}

/** Without points in the middle of straight pieces. */
export function straighten(points: Point[]): Point[] {
  const result: Point[] = [];
  for (const point of points) {
    const a = result.at(-2), b = result.at(-1);
    if (b && b.x === point.x && b.y === point.y) continue;
    if (a && b && ((a.x === b.x && b.x === point.x) || (a.y === b.y && b.y === point.y))) result.pop();
    result.push(point);
  }
  return result;
}

class Heap {
  private readonly list: Step[] = [];
  push(step: Step) {
    const list = this.list;
    list.push(step);
    for (let k = list.length - 1; k > 0;) {
      const parent = (k - 1) >> 1;
      if (list[parent]!.guess <= list[k]!.guess) break;
      [list[parent], list[k]] = [list[k]!, list[parent]!];
      k = parent;
    }
  }
  pop(): Step | undefined {
    const list = this.list, first = list[0], last = list.pop();
    if (list.length && last) {
      list[0] = last;
      for (let k = 0;;) {
        let least = k;
        for (const child of [2 * k + 1, 2 * k + 2]) if (child < list.length && list[child]!.guess < list[least]!.guess) least = child;
        if (least === k) break;
        [list[least], list[k]] = [list[k]!, list[least]!];
        k = least;
      }
    }
    return first;
  }
}
