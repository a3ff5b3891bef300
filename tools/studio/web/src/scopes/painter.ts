// Draws one series of a plot: as a line, or as bars where it fills the plot.
import uPlot from "uplot";
import { bars_of, type Bars } from "./bars";

export class CurvePainter {
  private bars: Bars | null = null;
  private readonly line: uPlot.Series.PathBuilder;
  constructor(private readonly steps: boolean) { this.line = steps ? uPlot.paths.stepped!({ align: 1 }) : uPlot.paths.linear!(); }

  readonly paths: uPlot.Series.PathBuilder = (u, k, first, last) => {
    const is_linear = u.scales["x"]!.distr !== 3, { left, width } = u.bbox;
    this.bars = is_linear ? bars_of(u.data[0], u.data[k]!, first, last, (x) => u.valToPos(x, "x", true), (y) => u.valToPos(y, "y", true), Math.round(left), Math.round(width), this.steps) : null;
    return this.bars ? null : this.line(u, k, first, last);
  };

  /** After uPlot has drawn the series. */
  draw(u: uPlot, colour: string, thickness: number): void {
    if (!this.bars) return;
    const { left, top, bottom } = this.bars, { ctx, bbox } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.fillStyle = colour;
    for (let column = 0; column < top.length; ++column) {
      if (top[column]! <= bottom[column]!) ctx.fillRect(left + column, top[column]! - thickness / 2, 1, bottom[column]! - top[column]! + thickness);
    }
    ctx.restore();
  }
}
