// The mouse on a plot: points at the cursor, zoom and pan, plots that share their x axis.
/** The point of a cloud that is nearest to the cursor on the screen. */
export function nearestPoint(u, index, column) {
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
export function lastPoint(u, index, column) {
  const x = u.data[0], y = u.data[column], here = u.posToVal(u.cursor.left, "x");
  let i = x[index] > here ? index - 1 : index;
  while (i >= 0 && y[i] === undefined) --i;
  return i >= 0 ? i : null;
}

/** The point of a curve nearest to the cursor along x; rows of other curves are skipped. */
export function closestPoint(u, index, column) {
  const x = u.data[0], y = u.data[column];
  let before = index, after = index;
  while (before >= 0 && y[before] === undefined) --before;
  while (after < x.length && y[after] === undefined) ++after;
  if (before < 0) return after < x.length ? after : null;
  return after < x.length && x[after] - x[index] < x[index] - x[before] ? after : before;
}

export function pointAtCursor(plot) {
  return (u, column, index) => {
    if (column === 0) return index;
    if (plot.cloud) return nearestPoint(u, index, column);
    return plot.series[column - 1].shape === "steps" ? lastPoint(u, index, column) : closestPoint(u, index, column);
  };
}

/** Moves the range of an axis; on a logarithmic one by a factor. */
function shifted({ min, max, distr }, part) {
  if (distr === 3) return { min: min * (max / min) ** part, max: max * (max / min) ** part };
  return { min: min + part * (max - min), max: max + part * (max - min) };
}

function setY(plot, u, { min, max }) {
  plot.rangeY = [min, max];
  u.redraw(true, true);
}

export function pan(plot, u, start) {
  const x = { ...u.scales.x }, y = { ...u.scales.y };
  const move = (event) => {
    if (plot.rangeY) plot.rangeY = Object.values(shifted(y, (event.clientY - start.clientY) / u.over.clientHeight));
    u.setScale("x", shifted(x, (start.clientX - event.clientX) / u.over.clientWidth));
  };
  const stop = () => { removeEventListener("mousemove", move); removeEventListener("mouseup", stop); };
  addEventListener("mousemove", move);
  addEventListener("mouseup", stop);
  start.preventDefault();
}

function zoomed({ min, max, distr }, centre, factor) {
  const to = distr === 3 ? Math.log : Number, from = distr === 3 ? Math.exp : Number, c = to(centre);
  return { min: from(c + (to(min) - c) * factor), max: from(c + (to(max) - c) * factor) };
}

/** Ctrl and wheel zoom x; with Shift, or beside the y axis, y. */
export function zoomByWheel(plot, u, event) {
  if (!event.ctrlKey && !event.metaKey) return;  // a plain wheel scrolls the page
  event.preventDefault();
  const delta = event.deltaY || event.deltaX, factor = Math.exp(0.002 * delta);
  if (event.shiftKey || plot.equal) setY(plot, u, zoomed(u.scales.y, u.posToVal(u.cursor.top, "y"), factor));
  if (!event.shiftKey) u.setScale("x", zoomed(u.scales.x, u.posToVal(u.cursor.left, "x"), factor));
}

/** The part that was selected with the mouse becomes the range, in x, in y or in both. */
export function zoomToSelection(plot, u) {
  const { left, top, width, height } = u.select;
  if (width < 4 && height < 4) return;
  if (height < u.over.clientHeight - 1) plot.rangeY = [u.posToVal(top + height, "y"), u.posToVal(top, "y")];
  if (width < u.over.clientWidth - 1) u.setScale("x", { min: u.posToVal(left, "x"), max: u.posToVal(left + width, "x") });
  else u.redraw(true, true);
  u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
}

/** The full range of x and y. */
export function showAll(plot, u) {
  plot.rangeY = null;
  u.setScale("x", { min: u.data[0][0], max: u.data[0].at(-1) });
}

export const linked = new Map();  // group → its uPlot instances

export function followX(u, group) {
  const { min, max } = u.scales.x;
  for (const other of linked.get(group) || [])
    if (other !== u && other.status === 1 && (other.scales.x.min !== min || other.scales.x.max !== max)) other.setScale("x", { min, max });
}
