// The layout of charts is that of the reports' pages.
declare module "*/report/page/chart_layout.js" {
  import type { Chart } from "../protocol/types";
  import type { ChartLayout } from "../layout/messages";
  export function layOutChart(elk: unknown, chart: Chart): Promise<ChartLayout>;
}
