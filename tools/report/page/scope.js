// A plot: zoom, pan, cursors, curves that can be switched off, export. uPlot draws.
import { expand, rises, align, drawer } from "./scope_series.js";
import { axis, drawMarks, font, ranges, variable } from "./scope_axes.js";
import { followX, linked, pan, pointAtCursor, showAll, zoomByWheel, zoomToSelection } from "./scope_cursor.js";
import { SERIES_COLOURS, buildLegend, button, readCursor } from "./scope_legend.js";
import { buildBetween, clearCursors, drawCursors, setCursor } from "./scope_between.js";
import { saveCsv, savePng, saveSvg } from "./scope_export.js";

const HEIGHT = 250, SQUARE_HEIGHT = 440;

function curveOptions(plot) {
  const several = plot.series.length > 1;
  return plot.series.map((series, k) => {
    const colour = () => variable(`--series-${k % SERIES_COLOURS}`);
    const points = series.shape === "points";
    return {
      label: series.name, stroke: colour, width: points ? 0 : several ? 1.4 : 1.6,
      fill: points ? () => colour() + (series.y.length > 400 ? "a8" : "e0") : undefined,
      paths: drawer(series), pxAlign: 0, points: { show: !points && series.y.length < 2, size: 6 },
    };
  });
}

/**
 * A press and release at one place is a click, which sets a cursor; between them lies a zoom.
 * uPlot remembers where a plot stands, and asks again only when the page scrolls. But what is drawn late above a plot
 * moves it too, so every event asks.
 */
function mouse(plot) {
  let pressed = null;
  return {
    mousemove: (u, target, handler) => (event) => {
      u.syncRect(true);
      handler(event);
    },
    mousedown: (u, target, handler) => (event) => {
      if (event.button !== 0) return;
      u.syncRect(true);
      pressed = { x: event.clientX, y: event.clientY };
      if (event.shiftKey) pan(plot, u, event);
      else handler(event);
    },
    mouseup: (u, target, handler) => (event) => {
      handler(event);
      if (pressed && !plot.cloud && !event.shiftKey && Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) < 4)
        setCursor(plot, u.posToVal(event.clientX - u.over.getBoundingClientRect().left, "x"));
      pressed = null;
    },
    dblclick: (u) => () => { clearCursors(plot); showAll(plot, u); },
  };
}

function options(plot, width) {
  const range = ranges(plot);
  return {
    width, height: plot.equal ? Math.min(SQUARE_HEIGHT, Math.max(HEIGHT, width)) : HEIGHT - (plot.continues ? 44 : 0),
    legend: { show: false },
    padding: [8, plot.x.logarithmic ? 20 : 14, 0, 0],  // half of the last number, which may be 10000
    scales: {
      x: { time: false, distr: plot.x.logarithmic ? 3 : 1, range: range.x },
      y: { distr: plot.y.logarithmic ? 3 : 1, range: range.y },
    },
    axes: [axis("x", plot.x, plot), axis("y", plot.y, plot)],
    series: [{}, ...curveOptions(plot)],
    cursor: {
      x: true, y: plot.cloud,
      drag: { x: true, y: true, uni: 24, dist: 4, setScale: false },
      points: { size: 7, fill: (u, k) => u.series[k].stroke(u, k), width: 0 },
      // Only the position of the cursor is shared here; followX shares the range.
      sync: plot.group ? { key: plot.group, setSeries: false, scales: ["x", null],
                           filters: { pub: (type) => type === "mousemove" || type === "mouseleave" } } : undefined,
      bind: mouse(plot),
      dataIdx: pointAtCursor(plot),
    },
    hooks: {
      setCursor: [(u) => { if (plot.chart) readCursor(plot, u); }],
      setSelect: [(u) => zoomToSelection(plot, u)],
      setScale: [(u, key) => {
        if (key === "x" && plot.group) followX(u, plot.group);
        const [low, high] = plot.whole, slack = 1e-6 * (high - low), [from, to] = plot.seenX ?? plot.whole;
        plot.reset.hidden = !plot.rangeY && Math.abs(from - low) <= slack && Math.abs(to - high) <= slack;
      }],
      draw: [(u) => drawMarks(plot, u), (u) => drawCursors(plot, u, variable("--ink"), font(11 * uPlot.pxRatio))],
    },
  };
}

function read(figure) {
  const plot = JSON.parse(figure.querySelector("script").textContent);
  plot.group = figure.dataset.group;
  const next = figure.nextElementSibling;
  plot.continues = plot.group !== "" && next !== null && next.matches(".plot") && next.dataset.group === plot.group;
  for (const series of plot.series) {
    series.x = expand(series.x);
    series.rises = rises(series.x) && series.shape !== "points";
    series.dot = series.x.length > 2000 ? 1.1 : series.x.length > 400 ? 1.6 : 2.4;
  }
  plot.cloud = plot.series.some((series) => !series.rises);
  plot.table = plot.series.length > 0 ? align(plot.series) : [[]];
  return plot;
}

function toolsOf(plot) {
  plot.reset = button("Whole range", "Show everything again; also a double click", () => showAll(plot, plot.chart));
  plot.reset.className = "reset";
  plot.reset.hidden = true;
  return [plot.reset,
          button("CSV", "Save the numbers that are seen", () => saveCsv(plot)),
          button("PNG", "Save this picture", () => savePng(plot, variable, font)),
          button("SVG", "Save this picture as vectors", () => saveSvg(plot, variable))];
}

export function build(figure) {
  const plot = read(figure), scope = figure.querySelector(".scope");
  figure.classList.toggle("continues", plot.continues);
  if (plot.table[0].length === 0) {
    scope.textContent = "No data.";
    return;
  }
  scope.append(buildLegend(plot, toolsOf(plot)));
  const chart = plot.chart = new uPlot(options(plot, scope.clientWidth), plot.table, scope);
  scope.append(buildBetween(plot));
  if (plot.equal) chart.redraw(true, true);  // now that the size of the drawing is known
  if (plot.group) linked.set(plot.group, [...(linked.get(plot.group) || []), chart]);
  chart.over.addEventListener("wheel", (event) => zoomByWheel(plot, chart, event), { passive: false });
  charts.push({ chart, scope });
  new ResizeObserver(() => fit(chart, scope.clientWidth)).observe(scope);
}

export const charts = [];

export function fit(chart, width) {
  if (width > 0 && width !== chart.width) chart.setSize({ width, height: chart.height });
}

const redraw = () => charts.forEach(({ chart }) => chart.redraw(false, true));

// Paper is white and 17 cm wide, independent of the screen.
addEventListener("beforeprint", () => {
  document.documentElement.classList.add("print");
  charts.forEach(({ chart }) => fit(chart, 660));
  redraw();
});
addEventListener("afterprint", () => {
  document.documentElement.classList.remove("print");
  charts.forEach(({ chart, scope }) => fit(chart, scope.clientWidth));
  redraw();
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
