// Asks the layout worker, which is loaded when the first diagram is shown.
import type { Chart } from "../protocol/types";
import type { ChartAnswer, ChartLayout, ChartRequest, Layout, LayoutAnswer, LayoutRequest } from "./messages";

let worker: Worker | null = null;
let count = 0;
let waiting: { count: number; resolve: (layout: Layout) => void } | null = null;

let waiting_chart: { count: number; resolve: (chart: ChartLayout) => void } | null = null;

function running(): Worker {
  if (worker) return worker;
  worker = new Worker("/layout-worker.js");
  worker.onmessage = ({ data }: MessageEvent<LayoutAnswer | ChartAnswer>) => {
    if ("chart" in data) {
      if (waiting_chart?.count === data.count) { waiting_chart.resolve(data.chart); waiting_chart = null; }
    } else if (waiting?.count === data.count) { waiting.resolve(data.layout); waiting = null; }
  };
  return worker;
}

/** Only the newest request is answered. */
export function arrange(request: Omit<LayoutRequest, "count">): Promise<Layout> {
  return new Promise((resolve) => {
    waiting = { count: ++count, resolve };
    running().postMessage({ count, ...request } satisfies LayoutRequest);
  });
}
export function arrange_chart(chart: Chart): Promise<ChartLayout> {
  return new Promise((resolve) => {
    waiting_chart = { count: ++count, resolve };
    running().postMessage({ count, chart } satisfies ChartRequest);
  });
}
