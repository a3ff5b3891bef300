// The messages of tools/studio/protocol.md, as types.

export interface FileEntry { path: string; kind: string; title?: string; size?: number }
/** A text of `path` that a studio left behind in a hidden file when it was killed. */
export interface LeftOver { file: string; path: string; when: string; text: string }
export interface Hello { version: string; folder: string; open: string; files: FileEntry[]; left_over?: LeftOver[] }

export interface Problem {
  severity: "error" | "warning"; text: string; message: string; hint: string;
  file: string; line: number; column: number; offset: number; end: number; pointer: string;
  block: string; port: string; here: boolean;
}

export interface Slider { low: number; high: number; step: number; unit: string; value: number; set: string; logarithmic: boolean }
export interface Setting { name: string; text: string; value: string; slider: Slider | null }
export interface InputPort { name: string; unit: string; many: boolean; wires: number; sentence: string; optional: boolean }
export interface OutputPort { name: string; unit: string; sentence: string; logged: boolean }
export type Picture =
  | { kind: "none" }
  | { kind: "text"; text: string }
  | { kind: "fraction"; numerator: string; denominator: string }
  | { kind: "signs"; signs: string }
  | { kind: "curve"; x: (number | null)[]; y: (number | null)[] };

export interface Block {
  name: string; type: string; room: string; title: string; description: string;
  subdiagram: boolean; file: string; variants: string[]; variant: string;
  settings: Setting[]; inputs: InputPort[]; outputs: OutputPort[]; picture: Picture;
  sample_time: number | null; rate: number; position: [number, number] | null; problems: number[]; hardware?: boolean; chart?: Chart | null;
}
/** Of a state machine. `order`: in which the transitions of a state are tested; 0: it is the only one. */
export interface Chart {
  states: { name: string; parent: number; initial: boolean; entries: string[] }[];
  transitions: { from: number; to: number; guard: string; order: number }[];
}
export interface WireEntry { from: string; to: string; index: number; unit: string; clash: string }
export interface DiagramInput { name: string; unit: string; description: string; offset: number; end: number }
export interface DiagramOutput extends DiagramInput { source: string }
export interface Parameter {
  name: string; text: string; value: number | string | boolean | null | unknown[]; unit: string; description: string;
  slider: Slider | null; offset: number; end: number;
}
export interface View {
  inside: string; editable: boolean; title: string; description: string;
  levels: { inside: string; title: string }[];
  blocks: Block[]; places: [number, number][];           // of the blocks in the text: offset and end
  wires: WireEntry[]; inputs: DiagramInput[]; outputs: DiagramOutput[];
  parameters: Parameter[]; solver: { name: string; text: string }[]; log: string[];
}

export interface Document {
  path: string; revision: number; text?: string; saved: boolean; writable: boolean;
  conflict: { theirs: string; mine: string } | null;
  undo: string; redo: string; loads: boolean; runs_alone: boolean; summary: string; problems: Problem[]; view: View | null;
}
export interface TextEdit { from: number; to: number; text: string }
export interface Renamed { kind: "block" | "parameter"; from: string; to: string }
export interface EditAnswer { edits: TextEdit[]; document: Document; blocks: string[]; others?: { path: string; text: string }[]; renamed?: Renamed[] }

export type Intent = { intent: string } & Record<string, unknown>;

export interface Signal {
  name: string; unit: string; steps: boolean;
  rms: number | null; min: number | null; max: number | null; last: number | null;
  x: (number | null)[]; y: (number | null)[];
}
export interface Notice { severity: "note" | "good" | "warning" | "error"; text: string }
export interface RunAnswer {
  run: number; path: string; name: string; status: "finished" | "failed"; message: string; time: number; wall: number;
  hash: string; command: string; warnings: string[]; summary: string; verdict: Notice[]; set: Record<string, string>; signals: Signal[];
}
export interface RunEntry {
  run: number; name: string; note: string; when: string; hash: string; command: string; set: Record<string, string>; file_changed: boolean;
  merit: { name: string; unit: string; rms: number | null; max: number | null }[];
}

export interface PoleEntry { re: number; im: number; frequency: number | null; damping: number | null; stability: "stable" | "boundary" | "unstable" }
export interface Margins {
  port: string; stable: boolean; gain_db: number | null; lower_gain_db: number | null; phase_deg: number | null; crossover: number | null; delay: number | null; Ms: number | null;
}
export interface Linear {
  is_loop_gain: boolean; sampled: boolean; sample_time: number;
  frequency: number[]; magnitude_db: (number | null)[]; phase_deg: (number | null)[];
  nyquist: { re: (number | null)[]; im: (number | null)[]; circle: { re: number[]; im: number[] } | null };  // of a loop gain near −1; around −1, of radius 1/Ms
  poles: PoleEntry[]; zeros: [number, number][];
  margins: Margins | null; text: string;                 // margins: of the loop that was cut; null: none was
}
export interface SweepAnswer { x: number[]; y: number[]; values: (number | null)[][]; metric: string; unit: string }

export type ColumnUse = "time" | "drive" | "compare" | "ignore";
export interface Column {
  column: string; name: string; unit: string; unit_is_stated?: boolean; min: number | null; max: number | null; use: ColumnUse; port: string; why: string;
  resolution: string; interpolation: string; candidates: string[];
}
export interface Columns {
  data: string; rows: number; time: string; sample_time: number | null; start: number | null; stop: number | null;
  columns: Column[]; ports: { port: string; unit: string; input: boolean }[];
  roles: { role: string; port: string; why: string }[]; hold_out: number; experiment: string; exists: boolean;
}

export interface Compared {
  name: string; unit: string; rmse: number | null; max: number | null; fit: number | null; relative: number | null; resolution: number | null;
  x: (number | null)[]; measured: (number | null)[]; simulated: (number | null)[]; error: (number | null)[];
}
export interface Residual {
  against: string; unit: string; of: string; residual_unit: string; x: (number | null)[]; y: (number | null)[]; points: boolean;
}
export interface Force {
  rmse: number | null; relative: number | null; noise_floor: number | null; unit: string;
  where: { axis: string; label?: string; from: number | null; to: number | null; share: number; of_rows: number }[];
  dependence: { variable: string; share: number }[];
  faults: { name: string; text: string; cost: string }[];
}
export interface Comparison {
  comparison: number; title: string; status: string; message: string; warnings: string[]; text: string;
  signals: Compared[]; residual: Residual[]; force: Force | null; why_no_force: string; drives: number;
  tint: { block: string; share: number; text: string }[];
}

export interface Step { added: string[]; error: number | null; simulation?: number | null; optional?: boolean }
export interface EffectParameter { name: string; value: number | null; low: number | null; high: number | null; unit: string; text: string; interval?: string; at_limit: boolean }
export interface Card {
  effect: string; form: string; title: string; physics: string; inclusion: number | null; force: number | null; unit: string; optional: boolean;
  parameters: EffectParameter[]; rivals: string[]; error_with: number | null; addable: boolean; why_not: string;
}
export interface Diagnosis {
  diagnosis: number; verdict: string; title: string; text: string;
  error_before: number | null; error_after: number | null; noise_floor: number | null; unit: string; holds_out: boolean;
  steps: Step[]; cards: Card[]; other_explanations: { in_place_of: string[]; effects: string[] }[];
  suggested: { text: string; between: string; and: string }[];
  findings: { what: string; cost: string; fatal: boolean }[];
  not_looked_for: { effects: string[]; why: string }[];
  unknown: {
    variables: string[]; dependence: { variable: string; share: number }[];
    learned?: { effect: string; title: string; note: string }[]; not_stated?: string[];
  } | null;
  curves: { unit: string; time: (number | null)[]; position: (number | null)[]; velocity: (number | null)[]; before: (number | null)[]; after: (number | null)[] } | null;
}
export interface FitAnswer {
  fit: number; command: string; converged: boolean; simulations: number; text: string; warnings: string[];
  parameters: { name: string; start: string; value: string; interval: string; determined: boolean; at_limit: boolean }[];
  signals: { name: string; unit: string; before: number; after: number; held_out_before: number; held_out_after: number }[];
}
export interface Preview { x: (number | null)[]; y: (number | null)[]; unit: string; rmse: number | null; signal: string }

export interface BlockType { type: string; room: string; sentence: string; why: string }
export interface TypeHelp {
  type: string; room: string; sentence: string; help: string;
  inputs: { name: string; unit: string; sentence: string; many: boolean; optional: boolean }[];
  outputs: { name: string; unit: string; sentence: string }[];
  settings: { name: string; unit: string; sentence: string; kind: string; low: number | null; high: number | null; required: boolean; default: string; choices: string[] }[];
}
export interface Completion { from: number; to: number; options: { label: string; detail: string; apply: string }[] }
export interface Hover { from: number; to: number; text: string; block: string }
