// The chart of a state machine: which one is open, and edits of its states and transitions as changes of the block's settings.
import type { Block, Intent } from "../protocol/types";
import { edit } from "./document";
import { get, patch, tell } from "./store";

export interface MachineTransition { to: string; when?: string; priority?: number }
export interface MachineState { name: string; inside?: string; initial?: string; set?: Record<string, unknown>; transitions?: MachineTransition[] }
export type ChartPart = { kind: "state"; state: number } | { kind: "transition"; state: number; transition: number };

const setting = (block: Block, name: string): string => block.settings.find((entry) => entry.name === name)?.text ?? "";
function list_of<T>(text: string): T[] {
  try {
    const list: unknown = JSON.parse(text);
    return Array.isArray(list) ? (list as T[]) : [];
  } catch { return []; }
}
/** The states as they are written. */
export const states_of = (block: Block): MachineState[] => list_of<MachineState>(setting(block, "states"));
export const outputs_of = (block: Block): { name: string; unit?: string }[] => list_of(setting(block, "outputs"));

/** The transition of the file that a transition of the chart is: those of a state are drawn in the order in which they are tested. */
export function written_transition(block: Block, index: number): ChartPart | null {
  const drawn = block.chart?.transitions[index], states = states_of(block);
  if (!drawn || !block.chart) return null;
  const names = new Set(states.map((state) => state.name)), nth = block.chart.transitions.slice(0, index).filter((other) => other.from === drawn.from).length;
  const order = (states[drawn.from]?.transitions ?? []).map((transition, i) => ({ transition, i })).sort((a, b) => (a.transition.priority ?? 0) - (b.transition.priority ?? 0));
  const found = order.filter(({ transition }) => names.has(transition.to))[nth];
  return found ? { kind: "transition", state: drawn.from, transition: found.i } : null;
}

export function open_chart(name: string): void { patch({ chart: name, chart_part: null, selected: [name], selected_wire: "", panel: "inspect", place: "diagram" }); }
export function close_chart(): void { patch({ chart: "", chart_part: null }); }
export const choose_part = (part: ChartPart | null): void => patch({ chart_part: part, panel: "inspect", selected: get().chart ? [get().chart] : get().selected });

const set = (block: Block, path: string, text: string): Intent => ({ intent: "set", block: block.name, setting: `states.${path}`, text });
const quoted = (text: string): string => JSON.stringify(text);

/** A member of a state or transition; an empty text removes it. */
export const set_in = (block: Block, path: string, text: string): void => void edit(set(block, path, text));

/** Everything that names the state follows. */
export function rename_state(block: Block, index: number, to: string): void {
  const states = states_of(block), from = states[index]?.name ?? "";
  if (!/^[A-Za-z_]\w*$/.test(to) || states.some((state) => state.name === to)) { tell("error", `"${to}" is no free name of a state.`); return; }
  const intents = [set(block, `${index}.name`, quoted(to))];
  states.forEach((state, i) => {
    state.transitions?.forEach((transition, j) => { if (transition.to === from) intents.push(set(block, `${i}.transitions.${j}.to`, quoted(to))); });
    if (state.inside === from) intents.push(set(block, `${i}.inside`, quoted(to)));
    if (state.initial === from) intents.push(set(block, `${i}.initial`, quoted(to)));
  });
  if (setting(block, "initial") === from) intents.push({ intent: "set", block: block.name, setting: "initial", text: quoted(to) });
  void edit(...intents);
}

/** With the transitions that lead to it. What was inside it stands where it stood. */
export function remove_state(block: Block, index: number): void {
  const states = states_of(block), name = states[index]?.name ?? "", outer = states[index]?.inside ?? "";
  if (states.length < 2) { tell("error", "A machine has at least one state."); return; }
  const intents: Intent[] = [];
  states.forEach((state, i) => {
    if (i === index) return;
    for (let j = (state.transitions?.length ?? 0) - 1; j >= 0; --j) if (state.transitions![j]!.to === name) intents.push(set(block, `${i}.transitions.${j}`, ""));
    if (state.inside === name) intents.push(set(block, `${i}.inside`, outer && quoted(outer)));
    if (state.initial === name) intents.push(set(block, `${i}.initial`, ""));
  });
  if (setting(block, "initial") === name) intents.push({ intent: "set", block: block.name, setting: "initial", text: "" });
  intents.push(set(block, String(index), ""));
  patch({ chart_part: null });
  void edit(...intents);
}

export async function add_state(block: Block): Promise<void> {
  const states = states_of(block), names = new Set(states.map((state) => state.name));
  let count = states.length + 1;
  while (names.has(`state_${count}`)) ++count;
  const answer = await edit(set(block, String(states.length), `{"name": "state_${count}"}`));
  if (answer) choose_part({ kind: "state", state: states.length });
}

export async function add_transition(block: Block, from: number, to: string): Promise<void> {
  const state = states_of(block)[from], count = state?.transitions?.length ?? 0, text = `{"when": "false", "to": ${quoted(to)}}`;
  const answer = await edit(set(block, state?.transitions ? `${from}.transitions.${count}` : `${from}.transitions`, state?.transitions ? text : `[${text}]`));
  if (answer) choose_part({ kind: "transition", state: from, transition: count });
}
export function remove_transition(block: Block, part: ChartPart): void {
  if (part.kind !== "transition") return;
  patch({ chart_part: { kind: "state", state: part.state } });
  void edit(set(block, `${part.state}.transitions.${part.transition}`, ""));
}
/** A value that an output gets on entry. */
export function set_output(block: Block, index: number, output: string, text: string): void {
  const state = states_of(block)[index];
  if (state?.set) set_in(block, `${index}.set.${output}`, text);
  else if (text) void edit(set(block, `${index}.set`, "{}"), set(block, `${index}.set.${output}`, text));
}
