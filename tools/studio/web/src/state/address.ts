// The address of the page says what it shows, so that it can be sent: file, level, plots, range, panel, selection.
import { get, patch, subscribe, type Panel, type Place, type ScopeTab, type Theme } from "./store";

const PANELS: readonly string[] = ["inspect", "runs", "measure", "diagnose", "problems"];
const TABS: readonly string[] = ["run", "compare", "linear", "sweep"];

export function read_address(): { experiment: string } {
  const address = new URLSearchParams(location.hash.slice(1));
  const plots = (address.get("plots") ?? "").split(";").map((plot) => plot.split(",").filter(Boolean)).filter((plot) => plot.length);
  const from = Number(address.get("from")), to = Number(address.get("to"));
  const panel = address.get("panel") ?? "", tab = address.get("tab") ?? "";
  const set = [...address].filter(([key]) => key.startsWith("set."));
  patch({
    inside: address.get("inside") ?? "",
    ...(plots.length ? { plots, plots_chosen: true } : {}),
    ...(to > from ? { range: { from, to } } : {}),
    ...(PANELS.includes(panel) ? { panel: panel as Panel } : {}),
    ...(TABS.includes(tab) ? { scope_tab: tab as ScopeTab } : {}),
    ...(address.get("text") ? { show_text: true } : {}),
    ...(set.length ? { overrides: Object.fromEntries(set.map(([key, value]) => [key.slice(4), value])) } : {}),
  });
  return { experiment: address.get("experiment") ?? "" };
}

let timer = 0;
export function follow_address(): void {
  subscribe(() => {
    clearTimeout(timer);
    timer = window.setTimeout(write_address, 150);
  });
}

function write_address(): void {
  const state = get();
  if (!state.document) return;
  const parts: [string, string][] = [["file", state.document.path]];
  if (state.inside) parts.push(["inside", state.inside]);
  if (state.experiment) parts.push(["experiment", state.experiment]);
  if (state.plots_chosen) parts.push(["plots", state.plots.map((plot) => plot.join(",")).join(";")]);
  if (state.range) parts.push(["from", String(state.range.from)], ["to", String(state.range.to)]);
  if (state.panel !== "inspect") parts.push(["panel", state.panel]);
  if (state.scope_tab !== "run") parts.push(["tab", state.scope_tab]);
  if (state.show_text) parts.push(["text", "1"]);
  for (const [key, value] of Object.entries(state.overrides)) parts.push(["set." + key, value]);
  const hash = "#" + parts.map(([key, value]) => `${key}=${encodeURIComponent(value).replace(/%2F/g, "/").replace(/%2C/g, ",").replace(/%3B/g, ";")}`).join("&");
  if (hash !== location.hash) history.replaceState(null, "", hash);
}

// ---------- theme: kept in this browser only ----------

export function choose_theme(theme: Theme): void {
  try { localStorage.setItem("loopwright-theme", theme); } catch { /* a private window: the choice lasts as long as the page */ }
  patch({ theme });
  show_theme();
}
const prefers_dark = matchMedia("(prefers-color-scheme: dark)");
prefers_dark.addEventListener("change", show_theme);
function show_theme(): void {
  const { theme } = get(), dark = theme === "dark" || (theme === "system" && prefers_dark.matches);
  document.documentElement.dataset["scheme"] = dark ? "dark" : "light";
  patch({ dark });
}
export function recall_theme(): void {
  let theme: string | null = null;
  try { theme = localStorage.getItem("loopwright-theme"); } catch { /* as above */ }
  choose_theme(theme === "light" || theme === "dark" ? theme : "system");
}

/** On a narrow screen: which part is shown. */
export const go_to = (place: Place): void => patch({ place });
