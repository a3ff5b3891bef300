// Actions of measurements and of the diagnosis.
import type { Columns, ColumnUse, Comparison, Diagnosis, Preview, Problem, Step } from "../protocol/types";
import { change_by_program } from "./document";
import { about_document } from "./request";
import { SCOPE_POINTS } from "./run";
import { ask, attempt, start } from "./session";
import { get, patch, tell } from "./store";

const PART = 4 * 1024 * 1024;  // bytes of a record that are sent at once

/** Sends a dropped file to the folder of the diagram and asks what its columns mean. */
export async function drop_record(file: File): Promise<void> {
  patch({ panel: "measure", place: "panel" });
  const cancelled = { value: false };
  const show = (done: number) => patch({ busy: { ...get().busy, upload: { what: `Storing ${file.name}`, stage: "", done, cancel: () => { cancelled.value = true; } } } });
  const hide = () => { const { upload: _done, ...others } = get().busy; patch({ busy: others }); };
  let path = "";
  try {
    for (let offset = 0; offset === 0 || offset < file.size; offset += PART) {
      if (cancelled.value) return;
      show(offset / Math.max(1, file.size));
      const last = offset + PART >= file.size;
      const answer = await fetch(`/data/${encodeURIComponent(file.name)}?offset=${offset}&last=${last ? 1 : 0}`,
        { method: "PUT", body: file.slice(offset, offset + PART), headers: { "Content-Type": "application/octet-stream" } });
      if (!answer.ok) {
        const reason = await answer.json().then((body: { error?: string }) => body.error, () => "");
        tell("error", reason || `The program refused ${file.name} (${answer.status}).`);
        return;
      }
      if (last) path = ((await answer.json()) as { path: string }).path;
    }
  } catch {
    tell("error", `${file.name} could not be sent to the program.`);
    return;
  } finally { hide(); }
  await match_columns(path);
}

export async function match_columns(data: string): Promise<void> {
  const { document } = get();
  if (!document) return;
  const columns = await attempt(start<Columns>("columns", "columns", "Reading the record", about_document({ data })).answer);
  if (columns) patch({ columns, panel: "measure" });
}

export function change_column(index: number, change: { use?: ColumnUse; port?: string; resolution?: string; unit?: string }): void {
  const columns = get().columns;
  if (!columns) return;
  const changed = columns.columns[index];
  // The summary was made with the proposed time and its unit.
  const is_of_time = changed && (change.use !== undefined || change.unit !== undefined) && (changed.use === "time" || change.use === "time");
  const summary = is_of_time ? { start: null, stop: null, sample_time: null } : {};
  const next = columns.columns.map((column, i) => {
    if (i === index) return { ...column, ...change, ...(change.unit === undefined ? {} : { unit_is_stated: false }) };
    return change.use === "time" && column.use === "time" ? { ...column, use: "ignore" as ColumnUse } : column;
  });
  patch({ columns: { ...columns, ...summary, columns: next } });
}
export function change_role(role: string, port: string): void {
  const columns = get().columns;
  if (columns) patch({ columns: { ...columns, roles: columns.roles.map((entry) => (entry.role === role ? { ...entry, port } : entry)) } });
}

/** Writes the experiment as confirmed, and compares. */
export async function confirm_columns(replace: boolean): Promise<void> {
  const { columns, document } = get();
  if (!columns || !document) return;
  const answer = await attempt(ask<{ experiment: string; text: string; problems: Problem[] }>("write_experiment", about_document({
    experiment: columns.experiment, title: "", data: columns.data,
    time: columns.columns.find((column) => column.use === "time")?.column ?? columns.time,
    columns: columns.columns.filter((column) => column.use !== "ignore")
      .map(({ column, use, port, unit, unit_is_stated, resolution, interpolation }) => ({ column, use, port, unit: unit_is_stated === false ? unit : "", resolution, interpolation })),
    roles: Object.fromEntries(columns.roles.filter((role) => role.port).map((role) => [role.role, role.port])),
    hold_out: columns.hold_out, replace,
  })));
  if (!answer) return;
  const errors = answer.problems.filter((problem) => problem.severity === "error");
  if (errors.length) { tell("error", errors.map((problem) => problem.text).join("\n")); return; }
  patch({ columns: null });
  await compare(answer.experiment);
}

export async function compare(experiment = get().experiment): Promise<void> {
  const { document } = get();
  if (!document || !experiment) return;
  const changed = experiment !== get().experiment;
  patch({ experiment, ...(changed ? { comparison: null, comparison_before: null, diagnosis: null, staircase: [], preview: null, added: [] } : {}) });
  const members = about_document({ experiment, points: SCOPE_POINTS, lane: "compare" });
  const comparison = await attempt(start<Comparison>("compare", "compare", "Comparing", members).answer);
  if (!comparison || get().document?.path !== document.path || get().experiment !== experiment) return;
  patch({ comparison, comparison_before: get().comparison, scope_tab: "compare" });
  if (changed) patch({ panel: "measure" });
  if (comparison.status === "failed") tell("error", comparison.message);
}

export function compare_after_change(): void {
  const { experiment, document } = get();
  if (experiment && document?.loads) void compare();
}

const PAUSE = 150;  // ms after the last movement of a slider: the comparison before stays behind whole movements, not steps
let moved = 0;
/** The comparison is with the numbers of the sliders. */
export function compare_after_slider(): void {
  clearTimeout(moved);
  moved = window.setTimeout(compare_after_change, PAUSE);
}

export function close_experiment(): void {
  patch({ experiment: "", comparison: null, comparison_before: null, diagnosis: null, staircase: [], preview: null, added: [], scope_tab: "run" });
}

// ---------- diagnosis ----------

/** With the records of these experiments. The comparison stays with its own. */
export async function diagnose(experiments: string[]): Promise<void> {
  const { document } = get();
  if (!document || !experiments.length) return;
  patch({ panel: "diagnose", diagnosed_with: experiments, diagnosed_set: get().overrides, diagnosis: null, staircase: [], preview: null, added: [] });
  const job = start<Diagnosis, { steps: Step[]; stage?: string }>("diagnose", "diagnose", "Searching for the missing effect",
    about_document({ experiments, lane: "diagnose" }), (partial) => patch({ staircase: partial.steps }));
  const diagnosis = await attempt(job.answer);
  if (diagnosis) patch({ diagnosis, staircase: diagnosis.steps });
}

let previewed = "";
/** The error that the compared signal would have with these effects; an empty list takes the preview away. */
export async function preview(effects: string[]): Promise<void> {
  const { diagnosis } = get();
  previewed = effects.join();
  if (!effects.length || !diagnosis) { patch({ preview: null }); return; }
  const answer = await attempt(ask<Preview>("preview", about_document({ diagnosis: diagnosis.diagnosis, effects, points: SCOPE_POINTS, lane: "preview" })));
  if (answer && previewed === effects.join()) patch({ preview: { ...answer, effects } });
}

/** What was added by the text that resulted: undo brings back the same bytes, by whatever key it is called. */
const added_in = new Map<string, string[]>();

/** Adds effects, all that are necessary if the list is empty. The comparison is repeated by itself. */
export async function add(effects: string[]): Promise<void> {
  const { diagnosis, text: text_before, added: before } = get();
  if (!diagnosis) return;
  void preview([]);
  const answer = await change_by_program("add_effects", { diagnosis: diagnosis.diagnosis, effects });
  if (!answer) return;
  const all = effects.length ? effects : diagnosis.cards.filter((card) => card.addable && !card.optional).map((card) => card.effect);
  added_in.set(text_before, before);
  added_in.set(get().text, [...new Set([...before, ...all])]);
  note_added();
}

/** After any change of the text. */
export function note_added(): void {
  const added = added_in.get(get().text);
  if (added) patch({ added });
}
