// Turns the data of every plot on the page into a scope: zoom, pan, cursor read-out, curves that can be switched off,
// plots of one group linked along x. uPlot does the drawing. This is one file because a page includes it whole: numbers,
// data, drawing, interaction, legend and read-out, then the plot itself.
"use strict";
(() => {
  const PREFIXES = { "-15": "f", "-12": "p", "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T" };
  // A unit takes a prefix if it begins with one of these to the first power.
  const PREFIXABLE = /^(m|s|N|V|A|W|Hz|rad|J|Pa|F|H|Ω|T|C)(?=$|[\/·])/;
  const SUPERSCRIPT = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  const HEIGHT = 250, AXIS_WIDTH = 64, SERIES_COLOURS = 8;

  // ---------- numbers ----------

  /** The power of ten, a multiple of 3, in which values up to `largest` are easy to read. */
  function exponentFor(largest, unit) {
    if (!(largest > 0) || !isFinite(largest)) return 0;
    const exponent = 3 * Math.floor(Math.log10(largest * 1.0000001) / 3);
    if (!PREFIXABLE.test(unit)) return largest < 1e-3 || largest >= 1e6 ? exponent : 0;
    const highest = /^(s|rad)/.test(unit) ? 0 : 12;  // kiloseconds are not in use
    return Math.max(-15, Math.min(highest, exponent));
  }

  const superscript = (n) => String(n).replace("-", "⁻").replace(/\d/g, (d) => SUPERSCRIPT[d]);

  /** Unit with its prefix, or after a power of ten: "µm", "×10⁻⁶ V·s". */
  function scaledUnit(exponent, unit) {
    if (exponent === 0) return unit;
    if (PREFIXABLE.test(unit)) return PREFIXES[exponent] + unit;
    return `×10${superscript(exponent)}${unit ? " " + unit : ""}`;
  }

  const withMinus = (text) => text.replace("-", "−");

  /** Number of decimals that distinguishes multiples of `step`. */
  function decimalsFor(step) {
    for (let decimals = 0; decimals < 15; ++decimals) {
      const scaled = step * 10 ** decimals;
      if (Math.abs(scaled - Math.round(scaled)) < 1e-3 * scaled) return decimals;
    }
    return 15;
  }

  /** One value at the cursor, five significant digits. */
  function readOut(value, unit) {
    const exponent = exponentFor(Math.abs(value), unit);
    const scaled = value / 10 ** exponent;
    const text = scaled === 0 ? "0" : Math.abs(scaled) >= 1e5 ? scaled.toFixed(0) : String(+scaled.toPrecision(5));
    const shown = scaledUnit(exponent, unit);
    return withMinus(text) + (shown ? "\u202f" + shown : "");
  }

  // ---------- data ----------

  /** x may be given as start, step and count. */
  function expand(x) {
    if (Array.isArray(x)) return x;
    return Array.from({ length: x.count }, (_, i) => x.from + i * x.step);
  }

  const rises = (x) => x.every((value, i) => value !== null && (i === 0 || value >= x[i - 1]));

  /** One table over a common increasing x, as uPlot requires. A series without a value at some x is undefined there. */
  function align(series) {
    const first = series[0].x;
    if (series.every((s) => s.rises && s.x.length === first.length && s.x.every((x, i) => x === first[i])))
      return [first, ...series.map((s) => s.y)];
    const sorted = series.map((s) => {
      const order = s.x.map((_, i) => i).filter((i) => s.x[i] !== null);
      return s.rises ? order : order.sort((a, b) => s.x[a] - s.x[b]);
    });
    const next = series.map(() => 0);
    const table = [[], ...series.map(() => [])];
    for (;;) {
      let x = Infinity;
      series.forEach((s, k) => { if (next[k] < sorted[k].length) x = Math.min(x, s.x[sorted[k][next[k]]]); });
      if (x === Infinity) return table;
      table[0].push(x);
      series.forEach((s, k) => {
        const i = sorted[k][next[k]];
        const here = next[k] < sorted[k].length && s.x[i] === x;
        table[k + 1].push(here ? s.y[i] : undefined);
        if (here) ++next[k];
      });
    }
  }

  // ---------- drawing ----------

  /** A cloud of dots. Dense clouds use small, translucent dots. */
  function drawPoints(series) {
    return (u) => {
      const path = new Path2D(), radius = series.dot * uPlot.pxRatio;
      series.x.forEach((x, i) => {
        if (x === null || series.y[i] === null) return;
        const left = u.valToPos(x, "x", true), top = u.valToPos(series.y[i], "y", true);
        path.moveTo(left + radius, top);
        path.arc(left, top, radius, 0, 2 * Math.PI);
      });
      return { fill: path, flags: 0 };
    };
  }

  /** A line in the order of its points; x may decrease. */
  function drawTrace(series) {
    return (u) => {
      const path = new Path2D();
      let pen = false;
      series.x.forEach((x, i) => {
        if (x === null || series.y[i] === null) { pen = false; return; }
        const left = u.valToPos(x, "x", true), top = u.valToPos(series.y[i], "y", true);
        if (pen) path.lineTo(left, top); else path.moveTo(left, top);
        pen = true;
      });
      return { stroke: path, flags: 0 };
    };
  }

  function drawer(series) {
    if (series.shape === "points") return drawPoints(series);
    if (!series.rises) return drawTrace(series);
    return series.shape === "steps" ? uPlot.paths.stepped({ align: 1 }) : uPlot.paths.linear();
  }

  /** Colors come from the style sheet, so that they follow the color scheme of the screen. */
  const variable = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const font = (size) => `${size}px ${getComputedStyle(document.body).fontFamily}`;

  function axis(key, description, plot) {
    const exponent = (u) => exponentFor(Math.max(Math.abs(u.scales[key].min), Math.abs(u.scales[key].max)), description.unit);
    const tick = (value, decimals) => withMinus(value.toFixed(decimals));
    const linear = (u, splits, _axis, _space, step) => {
      const power = 10 ** exponent(u);
      const decimals = decimalsFor(step / power);
      return splits.map((value) => tick(Math.abs(value) < step * 1e-6 ? 0 : value / power, decimals));
    };
    const logarithmic = (u, splits) => splits.map((value) => {
      if (value === null) return "";
      const power = Math.round(Math.log10(value));
      return power >= -3 && power <= 4 ? String(+value.toPrecision(3)) : "10" + superscript(power);
    });
    const title = (u) => {
      const unit = description.logarithmic ? description.unit : scaledUnit(exponent(u), description.unit);
      return description.label && unit ? `${description.label} (${unit})` : description.label || unit;
    };
    const isX = key === "x";
    const hidden = isX && plot.continues;  // the plot below shows the numbers
    return {
      scale: key,
      stroke: () => variable("--soft"),
      font: font(12), labelFont: font(12),
      label: hidden ? null : title,
      labelSize: isX ? 22 : 20, labelGap: isX ? 2 : 0,
      size: isX ? (hidden ? 8 : 30)
                : (u, values) => Math.max(AXIS_WIDTH - 20, 14 + 7 * Math.max(0, ...(values || []).map((v) => (v || "").length))),
      gap: 5, space: isX ? 70 : 32,
      values: hidden ? (u, splits) => splits.map(() => "") : description.logarithmic ? logarithmic : linear,
      grid: { stroke: () => variable("--grid"), width: 1 },
      ticks: { show: !hidden, stroke: () => variable("--rule"), width: 1, size: 5 },
      border: { show: true, stroke: () => variable("--rule"), width: 1 },
    };
  }

  /** The range that shows all data from `low` to `high`, with a margin of `padding` times its width. */
  function wholeRange(description, padding, low, high) {
    if (low === null || high === null) return [0.1, 1];
    if (description.logarithmic) return low === high ? [low / 10, high * 10] : uPlot.rangeLog(low, high, 10, false);
    return padding || low === high ? uPlot.rangeNum(low, high, padding || 0.1, true) : [low, high];
  }

  // uPlot requests the range after every change. Only the full range gets a margin; a range chosen by the user is kept.
  function rangeX(plot) {
    const first = plot.table[0][0], last = plot.table[0].at(-1);
    plot.whole = wholeRange(plot.x, plot.cloud ? 0.04 : 0, first, last);
    return (u, low, high) => low === first && high === last ? plot.whole : [low, high];
  }

  // ---------- interaction ----------

  /** The point of a cloud that is nearest to the cursor on the screen. */
  function nearestPoint(u, index, column) {
    const x = u.data[0], y = u.data[column], reach = 20;
    let best = null, least = reach * reach;
    const measure = (i) => {
      const dx = u.valToPos(x[i], "x") - u.cursor.left;
      if (Math.abs(dx) > reach) return false;
      if (y[i] != null) {
        const dy = u.valToPos(y[i], "y") - u.cursor.top;
        if (dx * dx + dy * dy < least) { least = dx * dx + dy * dy; best = i; }
      }
      return true;
    };
    for (let i = index; i >= 0 && measure(i); --i);
    for (let i = index + 1; i < x.length && measure(i); ++i);
    return best;
  }

  /** The value of a held signal at the cursor: its last earlier point. */
  function lastPoint(u, index, column) {
    const x = u.data[0], y = u.data[column], here = u.posToVal(u.cursor.left, "x");
    let i = x[index] > here ? index - 1 : index;
    while (i >= 0 && y[i] === undefined) --i;
    return i >= 0 ? i : null;
  }

  /** The point of a curve nearest to the cursor along x; rows of other curves are skipped. */
  function closestPoint(u, index, column) {
    const x = u.data[0], y = u.data[column];
    let before = index, after = index;
    while (before >= 0 && y[before] === undefined) --before;
    while (after < x.length && y[after] === undefined) ++after;
    if (before < 0) return after < x.length ? after : null;
    return after < x.length && x[after] - x[index] < x[index] - x[before] ? after : before;
  }

  function pointAtCursor(plot) {
    return (u, column, index) => {
      if (column === 0) return index;
      if (plot.cloud) return nearestPoint(u, index, column);
      return plot.series[column - 1].shape === "steps" ? lastPoint(u, index, column) : closestPoint(u, index, column);
    };
  }

  function pan(u, start) {
    const { min, max } = u.scales.x;
    const log = u.scales.x.distr === 3;
    const move = (event) => {
      const shift = (start.clientX - event.clientX) / u.over.clientWidth;
      const by = log ? (max / min) ** shift : shift * (max - min);
      u.setScale("x", log ? { min: min * by, max: max * by } : { min: min + by, max: max + by });
    };
    const stop = () => { removeEventListener("mousemove", move); removeEventListener("mouseup", stop); };
    addEventListener("mousemove", move);
    addEventListener("mouseup", stop);
    start.preventDefault();
  }

  function zoomByWheel(u, event) {
    if (!event.ctrlKey && !event.metaKey) return;  // a plain wheel scrolls the page
    event.preventDefault();
    const { min, max } = u.scales.x;
    const log = u.scales.x.distr === 3, to = log ? Math.log : Number, from = log ? Math.exp : Number;
    const centre = to(u.posToVal(u.cursor.left, "x")), factor = Math.exp(0.002 * event.deltaY);
    u.setScale("x", { min: from(centre + (to(min) - centre) * factor), max: from(centre + (to(max) - centre) * factor) });
  }

  const linked = new Map();  // group → its uPlot instances

  function followX(u, group) {
    const { min, max } = u.scales.x;
    for (const other of linked.get(group) || [])
      if (other !== u && other.status === 1 && (other.scales.x.min !== min || other.scales.x.max !== max)) other.setScale("x", { min, max });
  }

  // ---------- legend and read-out ----------

  function element(tag, className, ...children) {
    const made = document.createElement(tag);
    made.className = className;
    made.append(...children);
    return made;
  }

  function mark(series, k) {
    const made = element("i", series.shape);
    made.style.color = `var(--series-${k % SERIES_COLOURS})`;
    return made;
  }

  function buildLegend(plot) {
    plot.buttons = plot.series.map((series, k) => {
      const button = element("button", "", mark(series, k), series.name);
      button.type = "button";
      button.title = "Show or hide; with Alt: show only this one";
      button.setAttribute("aria-pressed", "true");
      button.onclick = (event) => toggle(plot, k, event.altKey);
      return button;
    });
    plot.reset = element("button", "reset", "Whole range");
    plot.reset.type = "button";
    plot.reset.hidden = true;
    plot.reset.onclick = () => showAll(plot.chart);
    return element("div", "legend", ...plot.buttons, plot.reset);
  }

  /** The box next to the cursor: x, then a row for each curve. */
  function buildReadOut(plot) {
    plot.abscissa = element("output", "abscissa");
    plot.rows = plot.series.map((series, k) => {
      const value = element("output", "");
      return { row: element("div", "row", mark(series, k), element("span", "", series.name), value), value };
    });
    plot.readOut = element("div", "read-out", plot.abscissa, ...plot.rows.map(({ row }) => row));
    plot.readOut.hidden = true;
    return plot.readOut;
  }

  function toggle(plot, k, alone) {
    plot.buttons.forEach((button, other) => {
      const shown = plot.chart.series[other + 1].show;
      const show = alone ? other === k : other === k ? !shown : shown;
      if (show !== shown) plot.chart.setSeries(other + 1, { show });
      button.setAttribute("aria-pressed", String(show));
    });
  }

  function readCursor(plot, u) {
    const { left, idx, idxs } = u.cursor;
    const inside = left >= 0 && idx != null;
    let any = false;
    plot.abscissa.textContent = inside && !plot.cloud ? `${plot.x.label} ${readOut(u.data[0][idx], plot.x.unit)}`.trim() : "";
    plot.rows.forEach(({ row, value }, k) => {
      const i = inside ? idxs[k + 1] : null;
      const y = i == null || !u.series[k + 1].show ? null : u.data[k + 1][i];
      row.hidden = y == null;
      if (y == null) return;
      any = true;
      value.textContent = (plot.cloud ? readOut(u.data[0][i], plot.x.unit) + ", " : "") + readOut(y, plot.y.unit);
    });
    plot.readOut.hidden = !any;
    const width = u.over.clientWidth, rightHalf = left > width / 2;
    plot.readOut.style.left = rightHalf ? "auto" : `${left + 14}px`;
    plot.readOut.style.right = rightHalf ? `${width - left + 14}px` : "auto";
  }

  /** The full range of x; y follows automatically. */
  const showAll = (u) => u.setScale("x", { min: u.data[0][0], max: u.data[0].at(-1) });

  // ---------- a plot ----------

  function options(plot, width) {
    const several = plot.series.length > 1;
    return {
      width, height: HEIGHT - (plot.continues ? 44 : 0),
      legend: { show: false },
      padding: [8, 14, 0, 0],
      scales: {
        x: { time: false, distr: plot.x.logarithmic ? 3 : 1, range: rangeX(plot) },
        y: { distr: plot.y.logarithmic ? 3 : 1, range: (u, low, high) => wholeRange(plot.y, 0.08, low, high) },
      },
      axes: [axis("x", plot.x, plot), axis("y", plot.y, plot)],
      series: [{}, ...plot.series.map((series, k) => {
        const colour = () => variable(`--series-${k % SERIES_COLOURS}`);
        const points = series.shape === "points";
        return {
          label: series.name, stroke: colour, width: points ? 0 : several ? 1.4 : 1.6,
          fill: points ? () => colour() + (series.y.length > 400 ? "a8" : "e0") : undefined,
          paths: drawer(series), pxAlign: 0, points: { show: !points && series.y.length < 2, size: 6 },
        };
      })],
      cursor: {
        x: true, y: plot.cloud,
        drag: { x: true, y: plot.cloud, uni: 20, dist: 4 },
        points: { size: 7, fill: (u, k) => u.series[k].stroke(u, k), width: 0 },
        // Only the position of the cursor is shared here; followX shares the range.
        sync: plot.group ? { key: plot.group, setSeries: false, scales: ["x", null],
                             filters: { pub: (type) => type === "mousemove" || type === "mouseleave" } } : undefined,
        bind: {
          mousedown: (u, target, handler) => (event) => {
            if (event.button === 0) (event.shiftKey ? pan(u, event) : handler(event));
          },
          dblclick: (u) => () => showAll(u),
        },
        dataIdx: pointAtCursor(plot),
      },
      hooks: {
        setCursor: [(u) => { if (plot.readOut) readCursor(plot, u); }],
        setScale: [(u, key) => {
          if (key !== "x") return;
          if (plot.group) followX(u, plot.group);
          const [low, high] = plot.whole, slack = 1e-6 * (high - low);
          plot.reset.hidden = Math.abs(u.scales.x.min - low) <= slack && Math.abs(u.scales.x.max - high) <= slack;
        }],
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

  function build(figure) {
    const plot = read(figure), scope = figure.querySelector(".scope");
    figure.classList.toggle("continues", plot.continues);
    if (plot.table[0].length === 0) {
      scope.textContent = "No data.";
      return;
    }
    scope.append(buildLegend(plot));
    const chart = plot.chart = new uPlot(options(plot, scope.clientWidth), plot.table, scope);
    chart.over.append(buildReadOut(plot));
    if (plot.group) linked.set(plot.group, [...(linked.get(plot.group) || []), chart]);
    chart.over.addEventListener("wheel", (event) => zoomByWheel(chart, event), { passive: false });
    charts.push({ chart, scope });
    new ResizeObserver(() => fit(chart, scope.clientWidth)).observe(scope);
  }

  const charts = [];

  function fit(chart, width) {
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

  document.querySelectorAll("figure.plot").forEach(build);
  if (charts.length > 0) {
    const hint = document.createElement("p");
    hint.className = "hint";
    hint.textContent = "Plots: drag to zoom, Shift and drag to pan, Ctrl and wheel to zoom about the cursor, " +
                       "double-click for the whole range, click a name to hide its curve.";
    document.querySelector("main").append(hint);
  }
  // screenshot.sh reads the height of the drawn page.
  addEventListener("load", () => { document.documentElement.dataset.height = document.documentElement.scrollHeight; });
})();
