// The state of the page: one immutable object, changed by patches. Components select the parts that they show.
import { useSyncExternalStore } from "react";
import type { ChartPart } from "./chart";
import type { Columns, Comparison, Diagnosis, Document, FileEntry, FitAnswer, LeftOver, Linear, Preview, RunAnswer, RunEntry, Step, SweepAnswer } from "../protocol/types";

export type Panel = "inspect" | "runs" | "measure" | "diagnose" | "problems";
export type ScopeTab = "run" | "compare" | "linear" | "sweep";
/** Narrow screens show one of these at a time. */
export type Place = "diagram" | "scopes" | "panel";
export type Theme = "system" | "light" | "dark";

export interface Note { id: number; tone: "note" | "good" | "error"; text: string }
export interface Range { from: number; to: number }

/** Between two ports. `to` is shown as `to_name`; `cut`: the loop is cut at `from`. */
export interface LinearRequest { from: string; to: string; to_name: string; cut: boolean }

/** A long job that is under way. */
export interface Busy { what: string; stage: string; done: number | null; cancel: () => void }

export interface State {
  connection: "connecting" | "open" | "lost";
  folder: string;
  files: FileEntry[];
  left_over: LeftOver[];
  document: Document | null;
  text: string;                          // of the document
  text_from_program: number;             // counts changes of the text that did not come from the text view
  inside: string;
  file_inside: string;                   // the file that was entered last
  variants: Record<string, string>;
  selected: string[];                    // names of blocks of the present level
  selected_wire: string;                 // "axis.force#0"; empty: none
  highlighted: string[];                 // blocks that were just changed or added
  jump: { offset: number; end: number; count: number } | null;  // for the text view

  overrides: Record<string, string>;     // settings of the next run that are not in the file: "mass" → "0.3 kg"
  run: RunAnswer | null;
  ghost: RunAnswer | null;               // the run before
  pinned: RunAnswer[];                   // further runs that stay in the scopes
  runs: RunEntry[];
  plots: string[][];                     // names of the signals of each plot
  plots_chosen: boolean;                 // by the user; else they follow the log
  range: Range | null;                   // of time, of all plots; null: everything
  cursors: { a: number; b: number } | null;
  scope_tab: ScopeTab;
  linear: (Linear & LinearRequest & { set: Record<string, string> }) | null;
  sweep: (SweepAnswer & { x_set: string; y_set: string; x_unit: string; y_unit: string; set: Record<string, string>; file?: { file: string; command: string } }) | null;

  columns: Columns | null;               // to be confirmed
  experiment: string;                    // path; empty: none
  comparison: Comparison | null;
  comparison_before: Comparison | null;
  diagnosis: Diagnosis | null;
  diagnosed_with: string[];              // experiments
  diagnosed_set: Record<string, string>; // overrides
  staircase: Step[];                     // while the search runs
  preview: (Preview & { effects: string[] }) | null;
  added: string[];                       // effects of the diagnosis that are in the diagram now
  fit_chosen: string[];                  // parameters, as `set` names them
  fit: FitAnswer | null;

  chart: string;                         // the state machine of this level whose chart is open; empty: none
  chart_part: ChartPart | null;          // what is selected in it

  busy: Record<string, Busy>;
  panel: Panel;
  place: Place;
  show_palette: boolean;
  show_text: boolean;
  show_commands: boolean;
  theme: Theme;
  dark: boolean;                         // what the theme amounts to
  notes: Note[];
}

const initial: State = {
  connection: "connecting", folder: "", files: [], left_over: [], document: null, text: "", text_from_program: 0, inside: "", file_inside: "", variants: {},
  selected: [], selected_wire: "", highlighted: [], jump: null,
  overrides: {}, run: null, ghost: null, pinned: [], runs: [], plots: [], plots_chosen: false, range: null, cursors: null,
  scope_tab: "run", linear: null, sweep: null,
  columns: null, experiment: "", comparison: null, comparison_before: null, diagnosis: null, diagnosed_with: [], diagnosed_set: {}, staircase: [], preview: null, added: [],
  fit_chosen: [], fit: null,
  chart: "", chart_part: null,
  busy: {}, panel: "inspect", place: "diagram", show_palette: false, show_text: false, show_commands: false,
  theme: "system", dark: false, notes: [],
};

let state = initial;
const listeners = new Set<() => void>();

export const get = (): State => state;

export function patch(change: Partial<State>): void {
  state = { ...state, ...change };
  for (const listener of listeners) listener();
}

export function subscribe(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** A part of the state. `select` must return the same object as long as that part is unchanged. */
export const useStudio = <T,>(select: (state: State) => T): T => useSyncExternalStore(subscribe, () => select(state));

let last_note = 0;
const NOTE_TIME = 7000;  // ms: long enough to read three lines

/** A message for a few seconds. Errors stay until they are closed. */
export function tell(tone: Note["tone"], text: string): void {
  const note = { id: ++last_note, tone, text };
  patch({ notes: [...state.notes.filter((other) => other.text !== text).slice(-3), note] });
  if (tone !== "error") setTimeout(() => close_note(note.id), NOTE_TIME);
}
/** Errors that were about a file as it is no more. */
export const close_errors = (): void => { if (state.notes.some((note) => note.tone === "error")) patch({ notes: state.notes.filter((note) => note.tone !== "error") }); };
export const close_note = (id: number): void => patch({ notes: state.notes.filter((note) => note.id !== id) });
