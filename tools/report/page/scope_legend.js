// Legend and read-out of a plot: the values at the cursor stand beside the names of the curves, never over the curves.
import { readOut } from "./scope_numbers.js";

export const SERIES_COLOURS = 8;

export function element(tag, className, ...children) {
  const made = document.createElement(tag);
  made.className = className;
  made.append(...children);
  return made;
}

export function button(name, title, action) {
  const made = element("button", "", name);
  made.type = "button";
  made.title = title;
  made.onclick = action;
  return made;
}

export function mark(series, k) {
  const made = element("i", series.shape);
  made.style.color = `var(--series-${k % SERIES_COLOURS})`;
  return made;
}

/** A row: the abscissa at the cursor, then every curve with its value, then the tools of the plot. */
export function buildLegend(plot, tools) {
  plot.abscissa = element("output", "abscissa");
  plot.values = plot.series.map(() => element("output", ""));
  plot.buttons = plot.series.map((series, k) => {
    const made = button("", "Show or hide; with Alt: show only this one", (event) => toggle(plot, k, event.altKey));
    made.append(mark(series, k), element("span", "", series.name), plot.values[k]);
    made.setAttribute("aria-pressed", "true");
    return made;
  });
  return element("div", "legend", element("div", "curves", ...plot.buttons, plot.abscissa), element("div", "tools", ...tools));
}

function toggle(plot, k, alone) {
  plot.buttons.forEach((made, other) => {
    const shown = plot.chart.series[other + 1].show;
    const show = alone ? other === k : other === k ? !shown : shown;
    if (show !== shown) plot.chart.setSeries(other + 1, { show });
    made.setAttribute("aria-pressed", String(show));
  });
}

export function readCursor(plot, u) {
  const { left, idx, idxs } = u.cursor;
  const inside = left >= 0 && idx != null;
  plot.abscissa.textContent = inside && !plot.cloud ? `${plot.x.label} ${readOut(u.data[0][idx], plot.x.unit)}`.trim() : "";
  plot.values.forEach((value, k) => {
    const i = inside ? idxs[k + 1] : null;
    const y = i == null || !u.series[k + 1].show ? null : u.data[k + 1][i];
    value.textContent = y == null ? "" : (plot.cloud ? readOut(u.data[0][i], plot.x.unit) + ", " : "") + readOut(y, plot.y.unit);
  });
}
