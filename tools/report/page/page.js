// Starts what a page shows: its plots and its diagrams.
import { build, charts } from "./scope.js";
import { startDiagrams } from "./diagram_view.js";

document.querySelectorAll("figure.plot").forEach(build);
startDiagrams();
if (charts.length > 0) {
  const hint = document.createElement("p");
  hint.className = "hint";
  hint.textContent = "Plots: drag to zoom, along the x axis, the y axis or both; Shift and drag to pan; Ctrl and wheel to zoom about the " +
                     "cursor, with Shift in y; click twice for the cursors A and B; double-click for the whole range; click a name to hide " +
                     "its curve, with Alt to hide all others.";
  document.querySelector("main").append(hint);
}
// screenshot.sh reads the height of the drawn page.
addEventListener("load", () => { document.documentElement.dataset.height = document.documentElement.scrollHeight; });
