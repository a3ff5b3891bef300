// Actions on the open file: open, edit by intents, undo, conflicts, moving between levels.
import type { Document, EditAnswer, FileEntry, Hello, Intent, LeftOver, Problem, TextEdit } from "../protocol/types";
import { Refused } from "../protocol/connection";
import { ask, attempt } from "./session";
import { follow_names } from "./names";
import { about_document } from "./request";
import { close_errors, get, patch, tell } from "./store";

type Listener = () => void;
const after_change: Listener[] = [];
/** Called after the file has changed, by whomever. */
export const on_change = (listener: Listener): void => { after_change.push(listener); };

const HIGHLIGHT_TIME = 4000;  // ms that changed blocks stay highlighted

export async function greet(): Promise<void> {
  const hello = await attempt(ask<Hello>("hello"));
  if (!hello) return;
  patch({ folder: hello.folder, files: hello.files, left_over: hello.left_over ?? [] });
  const wanted = get().document?.path || new URLSearchParams(location.hash.slice(1)).get("file") || hello.open ||
    hello.files.find((file) => file.kind === "diagram")?.path;
  if (wanted) await open(wanted, get().inside);
}

/** Files that other programs put into the folder meanwhile. */
export async function list_files(): Promise<void> {
  const answer = await attempt(ask<{ files: FileEntry[] }>("files"));
  if (answer) patch({ files: answer.files });
}

/** Puts a text that was left behind into its file, as a step that can be undone. The hidden file stays until it is removed. */
export async function restore({ path, text }: LeftOver): Promise<void> {
  if (get().document?.path !== path) await open(path);
  if (get().document?.path === path) await edit({ intent: "replace_text", text });
}
export async function remove_left_over({ file }: LeftOver): Promise<void> {
  const answer = await attempt(ask<{ left_over: LeftOver[] }>("remove_left_over", { file }));
  if (answer) patch({ left_over: answer.left_over });
}

export async function open(path: string, inside = ""): Promise<void> {
  const before = get();
  const document = await attempt(ask<Document>("open", { path, inside, variants: before.variants }));
  if (!document) return;
  const same = before.document?.path === path;
  patch(same || !before.document ? {} : {
    run: null, ghost: null, pinned: [], runs: [], plots: [], plots_chosen: false, range: null, cursors: null, overrides: {}, linear: null,
    sweep: null, columns: null, experiment: "", comparison: null, comparison_before: null, diagnosis: null, staircase: [],
    preview: null, added: [], scope_tab: "run", fit_chosen: [], fit: null,
  });
  patch({ selected: [], selected_wire: "", highlighted: [], chart: "", chart_part: null });
  show(document, inside);
  if (!same || before.document?.revision !== document.revision) for (const listener of after_change) listener();
}

/** Shows what the program says about the file. */
export function show(document: Document, inside = get().inside): void {
  const state = get();
  if (state.document && (state.document.path !== document.path || state.document.revision !== document.revision)) close_errors();
  const names = new Set(document.view?.blocks.map((block) => block.name)), left = state.selected.filter((name) => names.has(name));
  patch({
    document, inside: document.view?.inside ?? inside,
    ...(document.text === undefined ? {} : { text: document.text, text_from_program: state.text_from_program + 1 }),
    selected: left.length === state.selected.length ? state.selected : left,
  });
}

/** The file changed from outside, or through another page. */
export function changed_outside(document: Document): void {
  if (get().document?.path !== document.path) return;
  if (document.revision === get().document?.revision && document.text === get().text && !document.conflict) return;
  const view_of_other_level = (document.view?.inside ?? "") !== get().inside;
  if (view_of_other_level) void open(document.path, get().inside);
  else {
    show(document);
    for (const listener of after_change) listener();
  }
  if (!document.conflict) tell("note", `${document.path} was changed by another program. The change can be undone here.`);
}

export function apply_edits(text: string, edits: TextEdit[]): string {
  let result = "", at = 0;
  for (const edit of edits) {
    result += text.slice(at, edit.from) + edit.text;
    at = edit.to;
  }
  return result + text.slice(at);
}

function take(answer: EditAnswer, from_text_view = false): void {
  const state = get();
  patch({ text: apply_edits(state.text, answer.edits), highlighted: answer.blocks });
  follow_names(answer.renamed ?? []);
  if (answer.others?.length) tell("note", `Changed with it: ${answer.others.map((other) => other.path).join(", ")}.`);
  if (!from_text_view) patch({ text_from_program: get().text_from_program + 1 });
  const { text: _unused, ...document } = answer.document;
  show(document);
  if (answer.blocks.length)
    setTimeout(() => { if (get().highlighted === answer.blocks) patch({ highlighted: [] }); }, HIGHLIGHT_TIME);
  for (const listener of after_change) listener();
}

let queue: Promise<unknown> = Promise.resolve();
/** Edits are sent one after the other: each states the revision that the one before has made. */
function in_order<T>(action: () => Promise<T>): Promise<T> {
  const result = queue.then(action, action);
  queue = result.catch(() => undefined);
  return result;
}

export function edit(...intents: Intent[]): Promise<EditAnswer | null> {
  return in_order(async () => {
    const { document, inside } = get();
    if (!document) return null;
    const send = (more = {}) => ask<EditAnswer>("edit", { path: document.path, revision: document.revision, inside, intents, ...more });
    const answer = await attempt(send().catch((error: unknown) => {
      if (!(error instanceof Refused) || !error.consent) throw error;
      return confirm(`${error.message}\n\nDo it anyway?`) ? send({ despite_others: true }) : null;
    }));
    if (answer) take(answer);
    return answer;
  });
}

/** Puts blocks into a subdiagram of their own, which is then selected. */
export async function wrap(blocks: string[]): Promise<void> {
  const answer = await edit({ intent: "wrap", blocks });
  if (answer) patch({ selected: answer.blocks.slice(0, 1), selected_wire: "", panel: "inspect" });
}

/** What was typed into the text view; the text view already shows it. */
export function edit_text(edits: TextEdit[]): Promise<boolean> {
  return in_order(async () => {
    const { document, inside } = get();
    if (!document) return false;
    const answer = await attempt(ask<EditAnswer>("edit", { path: document.path, revision: document.revision, inside, intents: [{ intent: "text", edits }] }));
    if (answer) take(answer, true);
    return answer !== null;
  });
}

export const undo = (): Promise<void> => in_order(() => step("undo"));
export const redo = (): Promise<void> => in_order(() => step("redo"));
async function step(what: "undo" | "redo"): Promise<void> {
  const document = get().document;
  if (!document || !document[what]) return;
  const answer = await attempt(ask<EditAnswer>(what, { path: document.path, inside: get().inside }));
  if (answer) take(answer);
}

/** A request that changes the diagram: effects of a diagnosis, fitted values. */
export function change_by_program(what: "add_effects" | "write_fit", members: object): Promise<EditAnswer | null> {
  return in_order(async () => {
    const { document, inside } = get();
    if (!document) return null;
    const answer = await attempt(ask<EditAnswer>(what, about_document({ inside, revision: document.revision, ...members })));
    if (answer) take(answer);
    return answer;
  });
}

export async function resolve(keep: "mine" | "theirs"): Promise<void> {
  const document = get().document;
  if (!document) return;
  const answer = await attempt(ask<EditAnswer>("resolve", { path: document.path, keep }));
  if (answer) { take(answer); await open(document.path, get().inside); }
}

/** Enters a subdiagram; one that another file defines is opened as that file. */
export function enter(name: string): void {
  const { document, inside } = get(), block = document?.view?.blocks.find((entry) => entry.name === name && entry.subdiagram);
  if (!document || !block) return;
  if (block.file) patch({ file_inside: block.file });
  void open(document.path, inside ? `${inside}.${name}` : name);
}
export function leave(): void {
  const { document, inside } = get();
  if (document && inside) void open(document.path, inside.includes(".") ? inside.slice(0, inside.lastIndexOf(".")) : "");
}

/** Shows the place of a problem in the diagram and in the text. */
export async function jump_to(problem: Problem): Promise<void> {
  const path = problem.block.split(".").filter(Boolean);
  const block = path.pop() ?? "";
  const inside = path.join(".");
  if (block && inside !== get().inside && get().document) await open(get().document!.path, inside);
  const known = get().document?.view?.blocks.some((entry) => entry.name === block);
  patch({ selected: known ? [block] : [], selected_wire: "", place: "diagram" });
  if (problem.here) patch({ jump: { offset: problem.offset, end: problem.end, count: (get().jump?.count ?? 0) + 1 }, show_text: get().show_text || !known });
}
