// Actions of running: live runs, scopes, the list of runs, linear analysis, sweeps.
import { Disconnected, Dropped, Refused } from "../protocol/connection";
import type { Linear, RunAnswer, RunEntry, Signal, Slider, SweepAnswer, View } from "../protocol/types";
import { about_document, with_unit } from "./request";
import { ask, attempt, start } from "./session";
import { get, patch, tell, type LinearRequest, type Range } from "./store";
import { edit } from "./document";

export const SCOPE_POINTS = 1200;     // px: the width for which the program thins the curves
const LONGEST_AUTOMATIC_RUN = 2;      // s of computing; slower diagrams run when the user asks
const OVERTAKE_AFTER = 400;           // ms: a live run that takes longer is dropped for a later one

let flight: { sent: number; again: boolean } | null = null;
let keep_ghost: RunAnswer | null = null;

/** Runs the diagram with the present overrides. While a run is under way, only the last request counts. */
export async function run_live(): Promise<void> {
  if (flight && performance.now() - flight.sent < OVERTAKE_AFTER) { flight.again = true; return; }
  const mine = { sent: performance.now(), again: false };
  flight = mine;
  const state = get();
  if (!state.document) return;
  const members = about_document({ lane: "live", points: SCOPE_POINTS, signals: wanted_signals() });
  try {
    const answer = await start<RunAnswer>("run", "run", "Running", members).answer;
    if (get().document?.path === state.document.path) take_run(answer);
  } catch (error) {
    if (error instanceof Refused && get().document?.loads) tell("error", error.message);
    else if (!(error instanceof Dropped) && !(error instanceof Refused)) throw error;
  } finally {
    if (flight === mine) {
      flight = null;
      if (mine.again) void run_live();
    }
  }
}

/** All that the scopes show and the log. */
function wanted_signals(): string[] {
  const { plots, plots_chosen, document } = get();
  return plots_chosen ? [...new Set([...(document?.view?.inside ? [] : document?.view?.log ?? []), ...plots.flat()])].filter((name) => !name.includes("*")) : [];
}

function take_run(run: RunAnswer): void {
  const state = get();
  const ghost = keep_ghost ?? (state.run && state.run.status === "finished" ? state.run : state.ghost);
  patch({ run, ghost });
  if (!state.plots_chosen) patch({ plots: plots_by_unit(run.signals) });
  if (state.range) void zoom(state.range);
  if (run.status === "failed") tell("error", run.message);
}

const MOST_PLOTS = 6;
/** One plot for each unit, in the order of the log. */
function plots_by_unit(signals: Signal[]): string[][] {
  const plots = new Map<string, string[]>();
  for (const signal of signals) plots.set(signal.unit, [...(plots.get(signal.unit) ?? []), signal.name]);
  return [...plots.values()].slice(0, MOST_PLOTS);
}

/** After an edit: the run follows by itself where it is quick. A part with inputs waits for what drives them. */
export function run_after_change(): void {
  const { document, run } = get();
  if (document?.runs_alone && (!run || run.wall < LONGEST_AUTOMATIC_RUN)) void run_live();
}

// ---------- sliders ----------

/** The run before a slider was touched stays visible behind all runs of this movement. */
export function begin_sliding(): void { keep_ghost = get().run; }
export function end_sliding(): void { keep_ghost = null; }

const after_slider: (() => void)[] = [];
/** Called after a number was changed by a slider. */
export const on_slider = (listener: () => void): void => { after_slider.push(listener); };
/** All that is shown follows the sliders. */
export function follow_overrides(): void {
  void run_live();
  for (const listener of after_slider) listener();
}

export function slide(slider: Slider, value: number): void {
  patch({ overrides: { ...get().overrides, [slider.set]: with_unit(value, slider.unit) } });
  follow_overrides();
}
export function forget_override(set: string): void {
  const { [set]: _forgotten, ...others } = get().overrides;
  patch({ overrides: others });
  follow_overrides();
}
export function forget_overrides(): void {
  patch({ overrides: {} });
  follow_overrides();
}

/** Writes one override into the file. */
export async function keep_override(set: string): Promise<void> {
  const { overrides, document } = get();
  const text = overrides[set];
  if (text === undefined || !document?.view) return;
  const parameter = document.view.parameters.find((entry) => entry.slider?.set === set);
  const block = document.view.blocks.find((entry) => entry.settings.some((setting) => setting.slider?.set === set));
  const setting = block?.settings.find((entry) => entry.slider?.set === set);
  const answer = parameter ? await edit({ intent: "set_parameter", name: parameter.name, text })
    : block && setting ? await edit({ intent: "set", block: block.name, setting: setting.name, text }) : null;
  if (answer) {
    const { [set]: _kept, ...others } = get().overrides;
    patch({ overrides: others });
  }
}

// ---------- scopes ----------

/** Shows a signal in the scopes, or takes it out of them. */
export async function toggle_signal(name: string): Promise<void> {
  const { plots, run } = get();
  if (plots.some((plot) => plot.includes(name))) {
    patch({ plots: plots.map((plot) => plot.filter((other) => other !== name)).filter((plot) => plot.length), plots_chosen: true });
    return;
  }
  const unit = run?.signals.find((signal) => signal.name === name)?.unit;
  const same = unit === undefined ? -1 : plots.findIndex((plot) => run!.signals.find((signal) => signal.name === plot[0])?.unit === unit);
  patch({ plots: same < 0 ? [...plots, [name]] : plots.map((plot, i) => (i === same ? [...plot, name] : plot)), plots_chosen: true, scope_tab: "run" });
  if (unit === undefined) await run_live();
}

export function move_signal(name: string, plot: number): void {
  const plots = get().plots.map((names, i) => (i === plot ? (names.includes(name) ? names : [...names, name]) : names.filter((other) => other !== name)));
  if (plot === plots.length) plots.push([name]);
  patch({ plots: plots.filter((names) => names.length), plots_chosen: true });
}

let zoom_count = 0;
/** Shows a range of time; the program sends what lies in it in full detail. */
export async function zoom(range: Range | null): Promise<void> {
  const mine = ++zoom_count;
  patch({ range });
  const { run } = get();
  if (!run) return;
  const members = { source: `run:${run.run}`, names: run.signals.map((signal) => signal.name), points: SCOPE_POINTS, ...(range ?? {}) };
  const answer = await attempt(ask<{ signals: Signal[] }>("signals", members));
  if (answer && mine === zoom_count && get().run?.run === run.run) patch({ run: { ...get().run!, signals: answer.signals } });
}

/** Root mean squares and the like between the cursors, of the full data. */
export const between = (source: string, names: string[], from: number, to: number): Promise<{ signals: Signal[] }> =>
  ask("signals", { source, names, from: Math.min(from, to), to: Math.max(from, to), points: 4 });

export function pin_run(): void {
  const { run, pinned } = get();
  if (run && !pinned.some((other) => other.run === run.run)) patch({ pinned: [...pinned, run] });
}
export const unpin = (run: number): void => patch({ pinned: get().pinned.filter((other) => other.run !== run) });

// ---------- list of runs ----------

export async function list_runs(): Promise<void> {
  const document = get().document;
  if (!document) return;
  const answer = await attempt(ask<{ runs: RunEntry[] }>("runs", { path: document.path, lane: "runs" }));
  if (answer) patch({ runs: answer.runs });
}
export async function name_run(run: number, name: string, note: string, keep = true): Promise<void> {
  await attempt(ask("name_run", { run, name, note, keep }));
  await list_runs();
}
/** Puts an earlier run into the scopes beside the present one. */
export async function overlay(entry: RunEntry): Promise<void> {
  const answer = await attempt(ask<{ signals: Signal[] }>("signals", { source: `run:${entry.run}`, names: [], points: SCOPE_POINTS }));
  const { run, pinned } = get();
  if (!answer || pinned.some((other) => other.run === entry.run)) return;
  const base = { path: "", status: "finished" as const, message: "", time: 0, wall: 0, warnings: [], summary: "", verdict: [] };
  patch({ pinned: [...pinned, { ...(run ?? base), ...base, run: entry.run, name: entry.name, hash: entry.hash, command: entry.command, set: entry.set, signals: answer.signals }], scope_tab: "run" });
}

export async function save_data(source: string, names: string[], to_file: string): Promise<void> {
  const range = get().range;
  const answer = await attempt(ask<{ path: string }>("export", { source, names, to_file, ...(range ?? {}) }));
  if (answer) tell("good", `Saved as ${answer.path}.`);
}

// ---------- linear analysis, sweeps ----------

export async function linearize(request: LinearRequest): Promise<void> {
  if (!get().document) return;
  const { from, to, cut } = request, members = about_document({ from, to, ...(cut ? { break: from } : {}), lane: "linear" });
  const linear = await attempt(start<Linear>("linear", "linearize", "Linearizing", members).answer);
  if (linear) patch({ linear: { ...linear, ...request, set: members.set }, scope_tab: "linear", place: "scopes" });
}

/** After an edit or a slider: the same analysis with the present numbers. What cannot be repeated is taken away. */
export async function linearize_again(): Promise<void> {
  const { linear, document } = get();
  if (!linear || !document?.loads) return;
  const { from, to, to_name, cut } = linear, members = about_document({ from, to, ...(cut ? { break: from } : {}), lane: "linear" });
  try {
    const answer = await start<Linear>("linear", "linearize", "Linearizing", members).answer;
    if (get().linear) patch({ linear: { ...answer, from, to, to_name, cut, set: members.set } });
  } catch (error) {
    if (error instanceof Refused) {
      patch({ linear: null });
      tell("error", `The linear analysis is taken away: ${error.message}`);
    } else if (!(error instanceof Dropped) && !(error instanceof Disconnected)) throw error;
  }
}

/** A number that a sweep can vary: where it is set, and its present value. */
export interface Swept { set: string; unit: string; value: number; low: number; high: number }

/** All numbers with a slider at this level, and those that were moved elsewhere. */
export function sweepable(view: View, overrides: Record<string, string>): Swept[] {
  const sliders = [...view.parameters.map((entry) => entry.slider), ...view.blocks.flatMap((block) => block.settings.map((entry) => entry.slider))];
  const found = new Map<string, Swept>();
  for (const slider of sliders) if (slider) found.set(slider.set, swept(slider.set, slider.unit, slider.value, slider));
  const moved = new Map<string, Swept>();
  for (const [set, text] of Object.entries(overrides)) {
    const parts = /^\s*([-+]?[0-9.]+(?:e[-+]?\d+)?)\s*(.*)$/i.exec(text);
    const value = parts ? Number(parts[1]) : NaN;
    if (Number.isFinite(value)) moved.set(set, swept(set, parts![2]!, value, null));
    found.delete(set);
  }
  return [...moved.values(), ...found.values()];
}
/** From half of the value to twice of it: a range around what is there. */
function swept(set: string, unit: string, value: number, slider: Slider | null): Swept {
  const round = (number: number) => +number.toPrecision(4);
  if (value === 0) return { set, unit, value, low: slider?.low ?? -1, high: slider && slider.high > slider.low ? slider.high : 1 };
  return { set, unit, value, low: round(Math.min(value / 2, 2 * value)), high: round(Math.max(value / 2, 2 * value)) };
}

const SWEEP_POINTS = 15;  // per axis: a picture in a second or two
export async function sweep(x: Swept, y: Swept, metric: string): Promise<void> {
  if (!get().document) return;
  const axis = ({ set, low, high, unit }: Swept) => ({ set, low, high, points: SWEEP_POINTS, unit });
  const members = about_document({ x: axis(x), y: axis(y), metric, lane: "sweep" });
  const answer = await attempt(start<SweepAnswer>("sweep", "sweep", "Sweeping", members).answer);
  const { [x.set]: _x, [y.set]: _y, ...set } = members.set;
  if (answer) patch({ sweep: { ...answer, x_set: x.set, y_set: y.set, x_unit: x.unit, y_unit: y.unit, set }, scope_tab: "sweep", place: "scopes" });
}

/** The sweep that is shown as a file for `loopwright sweep`. */
export async function write_sweep(): Promise<void> {
  const { sweep: shown } = get();
  if (!shown) return;
  const axis = (set: string, unit: string, values: number[]) => ({ set, unit, low: values[0], high: values.at(-1), points: values.length });
  const file = await attempt(ask<{ file: string; command: string }>("write_sweep",
    about_document({ set: shown.set, x: axis(shown.x_set, shown.x_unit, shown.x), y: axis(shown.y_set, shown.y_unit, shown.y), metric: shown.metric })));
  if (!file || get().sweep !== shown) return;
  patch({ sweep: { ...shown, file } });
  tell("good", `Written as ${file.file}.`);
}
