// The selected state or transition of a state machine, and what can be changed about it.
import type { Block } from "../protocol/types";
import { add_transition, outputs_of, remove_state, remove_transition, rename_state, set_in, set_output, states_of, type ChartPart, type MachineState } from "../state/chart";
import { prettyUnit } from "../numbers";
import { useStudio } from "../state/store";
import { Field } from "../panels/fields";

/** A value as a user types it. */
function typed(value: unknown): string {
  if (value === undefined) return "";
  if (typeof value === "object" && value !== null && "value" in value) {
    const { value: number, unit } = value as { value: unknown; unit?: string };
    return unit ? `${String(number)} ${unit}` : String(number);
  }
  return String(value);
}

export function ChartPanel({ block }: { block: Block }) {
  const part = useStudio((state) => state.chart_part), editable = useStudio((state) => state.document?.view?.editable ?? false);
  const states = states_of(block);
  if (!part || !states[part.state]) return <div className="section"><p className="hint">Select a state or a transition in the chart.</p></div>;
  return part.kind === "state" ? <StatePanel key={part.state} block={block} states={states} index={part.state} editable={editable} /> : <TransitionPanel block={block} states={states} part={part} editable={editable} />;
}

function Choice({ label, value, names, none, editable, choose }: { label: string; value: string; names: string[]; none?: string; editable: boolean; choose: (name: string) => void }) {
  return (
    <label className="row"><span className="name">{label}</span>
      <select value={value} disabled={!editable} aria-label={label} onChange={(event) => choose(event.target.value)}>
        {none !== undefined && <option value="">{none}</option>}
        {names.map((name) => <option key={name}>{name}</option>)}
      </select></label>
  );
}

function StatePanel({ block, states, index, editable }: { block: Block; states: MachineState[]; index: number; editable: boolean }) {
  const state = states[index]!, others = states.map((entry) => entry.name).filter((name) => name !== state.name), inner = states.filter((entry) => entry.inside === state.name).map((entry) => entry.name);
  return (
    <div className="section" data-panel-of={state.name}>
      <h3>State</h3>
      <div className="row"><span className="name">name</span><Field value={state.name} label="Name of the state" disabled={!editable} send={(to) => rename_state(block, index, to)} /></div>
      <Choice label="inside" value={state.inside ?? ""} names={others} none="of no other" editable={editable} choose={(name) => set_in(block, `${index}.inside`, name && JSON.stringify(name))} />
      {inner.length > 0 && <Choice label="enters" value={state.initial ?? ""} names={inner} none="the first" editable={editable} choose={(name) => set_in(block, `${index}.initial`, name && JSON.stringify(name))} />}
      {outputs_of(block).map((output) => (
        <div key={output.name} className="row"><span className="name">{output.name}{output.unit && <span className="unit"> {prettyUnit(output.unit)}</span>}</span>
          <Field value={typed(state.set?.[output.name])} label={`${output.name} in ${state.name}`} placeholder="stays" disabled={!editable} send={(text) => set_output(block, index, output.name, text.trim())} /></div>
      ))}
      {editable && (
        <p className="buttons">
          <select aria-label="New transition to" value="" onChange={(event) => void add_transition(block, index, event.target.value)}>
            <option value="">+ transition to …</option>{states.map((entry) => <option key={entry.name}>{entry.name}</option>)}</select>
          <button type="button" onClick={() => remove_state(block, index)}>Remove the state</button></p>
      )}
    </div>
  );
}

function TransitionPanel({ block, states, part, editable }: { block: Block; states: MachineState[]; part: ChartPart & { kind: "transition" }; editable: boolean }) {
  const from = states[part.state]!, transition = from.transitions?.[part.transition], at = `${part.state}.transitions.${part.transition}`;
  if (!transition) return null;
  return (
    <div className="section">
      <h3>Transition from {from.name}</h3>
      <div className="row"><span className="name">when</span><Field value={transition.when ?? ""} label="Guard of the transition" placeholder="always" disabled={!editable} send={(text) => set_in(block, `${at}.when`, text.trim())} /></div>
      <p className="soft small-text">Inputs, parameters, comparisons, &amp;&amp;, ||, !, and after(0.5 s).</p>
      <Choice label="to" value={transition.to} names={states.map((entry) => entry.name)} editable={editable} choose={(name) => set_in(block, `${at}.to`, JSON.stringify(name))} />
      <div className="row"><span className="name" title="1 is tested first; without priorities the order of the file counts">priority</span>
        <Field value={transition.priority === undefined ? "" : String(transition.priority)} label="Priority of the transition" placeholder="order of the file" disabled={!editable} send={(text) => set_in(block, `${at}.priority`, text.trim())} /></div>
      {editable && <p className="buttons"><button type="button" onClick={() => remove_transition(block, part)}>Remove the transition</button></p>}
    </div>
  );
}
