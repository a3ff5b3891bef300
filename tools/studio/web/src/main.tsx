// Starts the page.
import { createRoot } from "react-dom/client";
import "@xyflow/react/dist/base.css";
import "uplot/dist/uPlot.min.css";
import "./style/theme.css";
import "./style/page.css";
import "./style/canvas.css";
import "./style/scopes.css";
import "./style/panels.css";
import "./style/chart.css";
import { App } from "./App";
import { follow_address, read_address, recall_theme } from "./state/address";
import { changed_outside, greet, list_files, on_change } from "./state/document";
import { compare, compare_after_change, compare_after_slider, note_added } from "./state/measure";
import { linearize_again, on_slider, run_after_change } from "./state/run";
import { connect } from "./state/session";
import { get } from "./state/store";

recall_theme();
const { experiment } = read_address();
let first = true;
on_change(run_after_change);
on_change(compare_after_change);
on_change(note_added);
on_change(() => void linearize_again());
on_slider(compare_after_slider);
on_slider(() => void linearize_again());
connect({
  open: () => void greet().then(() => {
    if (first) {
      if (experiment) void compare(experiment);
      follow_address();
    }
    first = false;
  }),
  document: changed_outside,
});
window.addEventListener("focus", () => { if (get().connection === "open") void list_files(); });
createRoot(document.getElementById("root")!).render(<App />);
