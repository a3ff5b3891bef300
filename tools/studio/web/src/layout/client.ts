// Asks the layout worker, which is loaded when the first diagram is shown.
import type { Layout, LayoutAnswer, LayoutRequest } from "./messages";

let worker: Worker | null = null;
let count = 0;
let waiting: { count: number; resolve: (layout: Layout) => void } | null = null;

/** Only the newest request is answered. */
export function arrange(request: Omit<LayoutRequest, "count">): Promise<Layout> {
  if (!worker) {
    worker = new Worker("/layout-worker.js");
    worker.onmessage = ({ data }: MessageEvent<LayoutAnswer>) => {
      if (waiting?.count === data.count) { waiting.resolve(data.layout); waiting = null; }
    };
  }
  return new Promise((resolve) => {
    waiting = { count: ++count, resolve };
    worker!.postMessage({ count, ...request } satisfies LayoutRequest);
  });
}
