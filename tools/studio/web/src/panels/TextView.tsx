// The file as text beside the canvas: problems in place, completion and help from the program, selection in both directions.
// The editor lives in a shadow root: its styles are adopted style sheets there, which the page's policy allows.
import { useEffect, useRef } from "react";
import { autocompletion, completionKeymap, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap, indentWithTab } from "@codemirror/commands";
import { json } from "@codemirror/lang-json";
import { HighlightStyle, bracketMatching, foldGutter, foldKeymap, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, setDiagnostics, type Diagnostic } from "@codemirror/lint";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import { EditorState, Transaction, Annotation } from "@codemirror/state";
import { EditorView, drawSelection, highlightActiveLine, hoverTooltip, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { edit_text, redo, undo } from "../state/document";
import { ask } from "../state/session";
import { get, patch, useStudio } from "../state/store";
import type { Completion, Hover, TextEdit } from "../protocol/types";

const from_program = Annotation.define<boolean>();
const PAUSE = 250;  // ms after the last key before the text is sent

const colours = HighlightStyle.define([
  { tag: tags.propertyName, color: "var(--code-key)" }, { tag: tags.string, color: "var(--code-string)" },
  { tag: [tags.number, tags.bool, tags.null], color: "var(--code-number)" }, { tag: tags.punctuation, color: "var(--soft)" },
]);
const look = EditorView.theme({
  "&": { height: "100%", fontSize: "12.5px", backgroundColor: "var(--paper)", color: "var(--ink)" },
  ".cm-scroller": { fontFamily: "var(--mono)", lineHeight: "1.5" },
  ".cm-gutters": { backgroundColor: "var(--panel)", color: "var(--soft)", border: "none" },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "var(--hover)" },
  "&.cm-focused": { outline: "none" }, ".cm-cursor": { borderLeftColor: "var(--ink)" },
  "&.cm-focused .cm-selectionBackground, .cm-selectionBackground": { backgroundColor: "var(--select) !important" },
  ".cm-tooltip": { backgroundColor: "var(--raised)", color: "var(--ink)", border: "1px solid var(--rule)", borderRadius: "5px", maxWidth: "440px" },
  ".cm-tooltip pre": { margin: 0, padding: "6px 9px", whiteSpace: "pre-wrap", font: "12px/1.45 var(--sans)" },
  ".cm-tooltip-autocomplete ul li[aria-selected]": { backgroundColor: "var(--accent)", color: "var(--on-accent)" },
  ".cm-panels": { backgroundColor: "var(--panel)", color: "var(--ink)" },
});

async function complete(context: CompletionContext): Promise<CompletionResult | null> {
  const path = get().document?.path;
  if (!path || (!context.explicit && !context.matchBefore(/["\w.]+$/))) return null;
  await sent();
  try {
    const answer = await ask<Completion>("complete", { path, offset: context.pos });
    return answer.options.length ? { from: answer.from, to: answer.to, options: answer.options.map((option) => ({ label: option.label, detail: option.detail, apply: option.apply, filterText: option.apply })) as CompletionResult["options"], filter: false } : null;
  } catch { return null; }
}

const help = hoverTooltip(async (_view, position) => {
  const path = get().document?.path;
  if (!path) return null;
  try {
    const answer = await ask<Hover>("hover", { path, offset: position });
    if (!answer.text) return null;
    return { pos: answer.from, end: answer.to, create: () => {
      const dom = document.createElement("pre");
      dom.textContent = answer.text;
      return { dom };
    } };
  } catch { return null; }
});

// ---------- what was typed, on its way to the program ----------

let typed: TextEdit[] | null = null;
let view: EditorView | null = null;
let base = "";          // the text that the program has
let sending: Promise<unknown> = Promise.resolve();

/** The one replacement that makes `after` of `before`. */
function difference(before: string, after: string): TextEdit[] {
  let from = 0;
  while (from < before.length && from < after.length && before[from] === after[from]) ++from;
  let tail = 0;
  while (tail < before.length - from && tail < after.length - from && before.at(-1 - tail) === after.at(-1 - tail)) ++tail;
  return from === before.length && from === after.length ? [] : [{ from, to: before.length - tail, text: after.slice(from, after.length - tail) }];
}
function send(): void {
  if (!view) return;
  const text = view.state.doc.toString();
  typed = difference(base, text);
  if (!typed.length) return;
  const edits = typed;
  base = text;
  sending = sending.then(() => edit_text(edits));
}
let timer = 0;
async function sent(): Promise<void> {
  clearTimeout(timer);
  send();
  await sending;
}

export function TextView() {
  const place = useRef<HTMLDivElement>(null);
  const version = useStudio((state) => state.text_from_program), problems = useStudio((state) => state.document?.problems), jump = useStudio((state) => state.jump);
  const selected = useStudio((state) => state.selected), writable = useStudio((state) => state.document?.writable);

  useEffect(() => {
    const root = place.current!.shadowRoot ?? place.current!.attachShadow({ mode: "open" });
    base = get().text;
    const editor = new EditorView({
      root, parent: root as unknown as HTMLElement,
      state: EditorState.create({ doc: base, extensions: [
        lineNumbers(), foldGutter(), drawSelection(), highlightActiveLine(), bracketMatching(), highlightSelectionMatches(), search({ top: true }), lintGutter(), indentUnit.of("  "),
        json(), syntaxHighlighting(colours), look, help, autocompletion({ override: [complete] }), EditorState.readOnly.of(!writable),
        keymap.of([{ key: "Mod-z", run: () => { void sent().then(undo); return true; } }, { key: "Mod-y", run: () => { void redo(); return true; } }, { key: "Mod-Shift-z", run: () => { void redo(); return true; } },
          ...completionKeymap, ...searchKeymap, ...foldKeymap, ...defaultKeymap, indentWithTab]),
        EditorView.contentAttributes.of({ "aria-label": "Text of the diagram" }),
        EditorView.updateListener.of((update) => {
          if (update.docChanged && !update.transactions.some((transaction) => transaction.annotation(from_program))) {
            clearTimeout(timer);
            timer = window.setTimeout(send, PAUSE);
          }
          if (update.selectionSet && !update.docChanged && update.transactions.some((transaction) => transaction.isUserEvent("select"))) select_block(update.state.selection.main.head);
        }),
      ] }),
    });
    view = editor;
    return () => { void sent(); view = null; editor.destroy(); root.replaceChildren(); };
  }, [writable]);

  // The program changed the text: only the difference is exchanged, so that the cursor stays.
  useEffect(() => {
    if (!view) return;
    const text = get().text, changes = difference(view.state.doc.toString(), text).map((edit) => ({ from: edit.from, to: edit.to, insert: edit.text }));
    base = text;
    if (changes.length) view.dispatch({ changes, annotations: [from_program.of(true), Transaction.addToHistory.of(false)] });
  }, [version]);

  useEffect(() => {
    if (!view) return;
    const length = view.state.doc.length;
    const found = (problems ?? []).filter((problem) => problem.here).map((problem): Diagnostic =>
      ({ from: Math.min(problem.offset, length), to: Math.min(Math.max(problem.end, problem.offset), length), severity: problem.severity, message: problem.message + (problem.hint ? "\n" + problem.hint : "") }));
    view.dispatch(setDiagnostics(view.state, found));
  }, [problems, version]);

  useEffect(() => { if (jump) reveal(jump.offset, jump.end); }, [jump]);
  useEffect(() => {
    const shown = get().document?.view, block = selected.length === 1 ? shown?.blocks.findIndex((entry) => entry.name === selected[0]) ?? -1 : -1;
    if (shown?.editable && block >= 0) reveal(shown.places[block]![0], shown.places[block]![0]);
  }, [selected]);
  return <div className="text-view" ref={place} />;
}

function reveal(from: number, to: number): void {
  if (!view || view.hasFocus) return;
  const length = view.state.doc.length;
  view.dispatch({ selection: { anchor: Math.min(from, length), head: Math.min(to, length) }, effects: EditorView.scrollIntoView(Math.min(from, length), { y: "center" }), annotations: from_program.of(true) });
}

/** The block in whose text the cursor is becomes the selected one. */
function select_block(offset: number): void {
  const shown = get().document?.view;
  const block = shown?.editable ? shown.blocks[shown.places.findIndex(([begin, end]) => offset >= begin && offset <= end)] : undefined;
  if (block && get().selected[0] !== block.name) patch({ selected: [block.name], selected_wire: "" });
}
