// The data of a plot, and how its curves are drawn.
/** x may be given as start, step and count. */
export function expand(x) {
  if (Array.isArray(x)) return x;
  return Array.from({ length: x.count }, (_, i) => x.from + i * x.step);
}

export const rises = (x) => x.every((value, i) => value !== null && (i === 0 || value >= x[i - 1]));

/** One table over a common increasing x, as uPlot requires. A series without a value at some x is undefined there. */
export function align(series) {
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

/** A cloud of dots. Dense clouds use small, translucent dots. */
export function drawPoints(series) {
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
export function drawTrace(series) {
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

export function drawer(series) {
  if (series.shape === "points") return drawPoints(series);
  if (!series.rises) return drawTrace(series);
  return series.shape === "steps" ? uPlot.paths.stepped({ align: 1 }) : uPlot.paths.linear();
}
