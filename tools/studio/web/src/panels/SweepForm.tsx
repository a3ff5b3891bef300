// A sweep of two numbers over ranges that can be changed.
import { useState } from "react";
import { prettyUnit } from "../numbers";
import { sweep, sweepable, type Swept } from "../state/run";
import { useStudio } from "../state/store";
import type { View } from "../protocol/types";

type Side = "x" | "y";
const FIGURES = ["rms", "peak", "maximum", "minimum", "mean", "final"];

function Axis({ side, choices, chosen, choose }: { side: Side; choices: Swept[]; chosen: Swept; choose: (set: string) => void }) {
  const title = side === "x" ? "across" : "up";
  // New fields for another number: they begin with its range.
  return (
    <fieldset className="swept">
      <legend className="hidden">{title}</legend>
      <label className="row"><span className="name">{title}</span><select name={side} value={chosen.set} onChange={(event) => choose(event.target.value)}>{choices.map((entry) => <option key={entry.set}>{entry.set}</option>)}</select></label>
      <div className="row" key={`${chosen.set} ${chosen.low} ${chosen.high}`}>
        <span className="name soft">from, to</span>
        <input className="field mono" name={`${side}_low`} defaultValue={chosen.low} required aria-label={`${chosen.set} from`} />
        <input className="field mono" name={`${side}_high`} defaultValue={chosen.high} required aria-label={`${chosen.set} to`} />
        <span className="unit">{prettyUnit(chosen.unit)}</span>
      </div>
    </fieldset>
  );
}

/** What is swept is of interest in what it changes: the compared signal, or else the first that does not come from a source. */
function first_choice(view: View, signals: string[], compared: string | undefined): string | undefined {
  if (compared && signals.includes(compared)) return compared;
  const sources = view.blocks.filter((block) => !block.inputs.length).map((block) => `${block.name}.`);
  return signals.find((signal) => !sources.some((source) => signal.startsWith(source))) ?? signals[0];
}

export function SweepForm({ view, signals }: { view: View; signals: string[] }) {
  const compared = useStudio((state) => state.comparison?.signals[0]?.name);
  const overrides = useStudio((state) => state.overrides);
  const [names, setNames] = useState({ x: "", y: "" }), [fault, setFault] = useState("");
  const choices = sweepable(view, overrides);
  if (choices.length < 2) return null;
  const find = (set: string) => choices.find((entry) => entry.set === set);
  const x = find(names.x) ?? choices[0]!, y = find(names.y) ?? choices.find((entry) => entry.set !== x.set)!;
  const start = (form: HTMLFormElement) => {
    const data = new FormData(form), number = (key: string) => Number(String(data.get(key)).replace("−", "-"));
    const ranged = (entry: Swept, side: Side): Swept => ({ ...entry, low: number(`${side}_low`), high: number(`${side}_high`) });
    const across = ranged(x, "x"), up = ranged(y, "y");
    const wrong = [across, up].find(({ low, high }) => !(Number.isFinite(low) && Number.isFinite(high) && low < high));
    setFault(x.set === y.set ? "Choose two different numbers." : wrong ? `The range of ${wrong.set} is two numbers, the smaller first.` : "");
    if (x.set !== y.set && !wrong) void sweep(across, up, `${String(data.get("figure"))}(${String(data.get("signal"))})`);
  };
  return (
    <form className="section" noValidate onSubmit={(event) => { event.preventDefault(); start(event.currentTarget); }}>
      <h3>Sweep of two numbers</h3>
      <Axis side="x" choices={choices} chosen={x} choose={(set) => setNames({ x: set, y: y.set === set ? "" : y.set })} />
      <Axis side="y" choices={choices} chosen={y} choose={(set) => setNames({ x: x.set === set ? "" : x.set, y: set })} />
      <label className="row"><span className="name">figure</span><select name="figure">{FIGURES.map((figure) => <option key={figure} value={figure}>{figure === "peak" ? "peak (greatest magnitude)" : figure}</option>)}</select></label>
      <label className="row"><span className="name">of</span><select name="signal" defaultValue={first_choice(view, signals, compared)}>{signals.map((signal) => <option key={signal}>{signal}</option>)}</select></label>
      {fault && <p className="error-text" role="alert">{fault}</p>}
      <button type="submit">Sweep</button>
    </form>
  );
}
