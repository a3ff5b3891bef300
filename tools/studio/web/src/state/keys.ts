// Keys of the whole page. Keys of single letters work where nothing is typed.
import { edit, leave, redo, undo, wrap } from "./document";
import { run_live, zoom } from "./run";
import { ask, attempt } from "./session";
import { get, patch, tell, type Panel } from "./store";

export const KEYS: { keys: string; what: string }[] = [
  { keys: "Ctrl+Enter", what: "run" }, { keys: "Ctrl+Z, Ctrl+Y", what: "undo, redo: diagram, text and effects alike" }, { keys: "B or /", what: "add a block" }, { keys: "T", what: "text beside the diagram" },
  { keys: "Tab, then Space", what: "go from block to block and select one" }, { keys: "Enter, Backspace", what: "enter the selected subdiagram, leave it" }, { keys: "arrows", what: "move the selected block" },
  { keys: "Delete", what: "remove what is selected" }, { keys: "Ctrl+C, Ctrl+V, Ctrl+D", what: "copy, paste, duplicate" }, { keys: "Ctrl+G", what: "wrap the selected blocks into a subdiagram" }, { keys: "1 … 5", what: "panels" }, { keys: "+, −, arrows, 0", what: "in a plot: zoom, move, show everything" },
  { keys: "Shift+drag, Ctrl+wheel", what: "in a plot: move, zoom" }, { keys: "Escape", what: "close, select nothing" }, { keys: "?", what: "these keys" }];
const PANELS: Panel[] = ["inspect", "runs", "measure", "diagnose", "problems"];

function is_typing(event: KeyboardEvent): boolean {
  const target = event.composedPath()[0];
  return target instanceof HTMLElement && (target.isContentEditable || /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName) && (target as HTMLInputElement).type !== "range" && (target as HTMLInputElement).type !== "checkbox");
}

export function listen_to_keys(): () => void {
  const listen = (event: KeyboardEvent) => {
    if (event.defaultPrevented) return;
    const control = event.ctrlKey || event.metaKey, key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (control && key === "Enter") { event.preventDefault(); patch({ scope_tab: "run" }); void run_live(); return; }
    if (key === "Escape") { patch({ show_palette: false, show_commands: false, ...(is_typing(event) ? {} : { selected: [], selected_wire: "" }) }); return; }
    if (is_typing(event)) return;
    const action = control ? CONTROL[event.shiftKey && key === "z" ? "y" : key] : event.altKey ? undefined : PLAIN[key];
    if (!action || (control && (key === "c" || key === "v") && String(getSelection()) !== "")) return;
    if (!control && event.target instanceof HTMLElement && event.target.closest(".plot") && key === "0") return;
    event.preventDefault();
    action();
  };
  window.addEventListener("keydown", listen);
  return () => window.removeEventListener("keydown", listen);
}

const CONTROL: Record<string, () => void> = {
  z: () => void undo(), y: () => void redo(), c: () => void copy(), v: () => void paste(),
  g: () => { const blocks = get().selected; if (blocks.length) void wrap(blocks); },
  d: () => { const blocks = get().selected; if (blocks.length) void edit({ intent: "duplicate", blocks }); },
};
const PLAIN: Record<string, () => void> = {
  b: () => patch({ show_palette: true, place: "diagram" }), "/": () => patch({ show_palette: true, place: "diagram" }), t: () => patch({ show_text: !get().show_text }),
  "?": () => patch({ show_commands: !get().show_commands }), Backspace: () => { if (!get().selected.length && !get().selected_wire) leave(); }, "0": () => void zoom(null),
  ...Object.fromEntries(PANELS.map((panel, i) => [String(i + 1), () => patch({ panel })])),
};

let clipboard = "";
async function copy(): Promise<void> {
  const { document, inside, selected } = get();
  if (!document || !selected.length) return;
  const answer = await attempt(ask<{ text: string }>("copy", { path: document.path, inside, blocks: selected }));
  if (!answer) return;
  clipboard = answer.text;
  try { await navigator.clipboard.writeText(answer.text); } catch { /* refused by the browser: paste works within this page */ }
  tell("note", `${selected.length} ${selected.length === 1 ? "block" : "blocks"} copied.`);
}
async function paste(): Promise<void> {
  let text = clipboard;
  try { text = (await navigator.clipboard.readText()) || clipboard; } catch { /* as above */ }
  if (!text) return;
  const answer = await edit({ intent: "paste", text });
  if (answer) patch({ selected: answer.blocks });
}
