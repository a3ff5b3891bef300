// Fit: which parameters, what came out, and a button that writes it.
import { prettyUnit, quantity } from "../numbers";
import { choose_for_fit, fit, write_fit } from "../state/fit";
import { tell, useStudio } from "../state/store";
import type { FitAnswer } from "../protocol/types";

/** Beside a slider, while a record is compared. */
export function FitChoice({ set, label }: { set: string; label: string }) {
  const is_offered = useStudio((state) => state.experiment !== ""), chosen = useStudio((state) => state.fit_chosen.includes(set));
  if (!is_offered) return null;
  return <label className="fit-choice" title="Fit it to the record that is compared"><input type="checkbox" checked={chosen} aria-label={`Fit ${label}`} onChange={(event) => choose_for_fit(set, event.target.checked)} /> fit</label>;
}

export function Fit() {
  const chosen = useStudio((state) => state.fit_chosen), found = useStudio((state) => state.fit), busy = useStudio((state) => state.busy["fit"]);
  return (
    <div className="section fit">
      <h3>Fit parameters</h3>
      {chosen.length === 0 && <p className="soft small-text">Tick <i>fit</i> beside the sliders of the diagram or of a block. Their values are then moved until the simulation comes as close to the record as it can.</p>}
      {chosen.length > 0 && <ul className="plain">{chosen.map((name) => (
        <li key={name} className="row"><span className="name mono">{name}</span><button type="button" className="small quiet" aria-label={`Do not fit ${name}`} onClick={() => choose_for_fit(name, false)}>×</button></li>))}</ul>}
      {busy && <div className="progress" role="status"><span>{busy.stage || "simulating"}</span><progress value={busy.done ?? undefined} max={1} aria-label="Progress of the fit" /><button type="button" onClick={busy.cancel}>Stop</button></div>}
      {!busy && chosen.length > 0 && <p className="buttons"><button type="button" onClick={() => void fit()}>Fit {chosen.length === 1 ? chosen[0] : `${chosen.length} parameters`}</button></p>}
      {found && <Found found={found} />}
    </div>
  );
}

function Found({ found }: { found: FitAnswer }) {
  const held_out = found.signals.some((signal) => signal.held_out_after > 0);
  return (
    <div className="card fitted" aria-label="Fitted values">
      <dl>{found.parameters.map((entry) => (
        <div key={entry.name} data-fitted={entry.name}><dt className="mono">{entry.name}</dt>
          <dd><span className="soft">{prettyUnit(entry.start)} →</span> <b>{prettyUnit(entry.value)}</b>{entry.at_limit && <span className="doubt"> at its limit</span>}</dd>
          <dd className="soft small-text">{entry.determined ? `95 % interval ${prettyUnit(entry.interval)}` : "not determined by the record"}</dd></div>))}</dl>
      <table className="merit"><thead><tr><th scope="col">error, rms</th><th scope="col">before</th><th scope="col">fitted</th>{held_out && <th scope="col">rows held out</th>}</tr></thead><tbody>
        {found.signals.map((signal) => (
          <tr key={signal.name}><th scope="row">{signal.name}</th><td className="soft">{quantity(signal.before, signal.unit, 3)}</td><td>{quantity(signal.after, signal.unit, 3)}</td>
            {held_out && <td className="soft">{quantity(signal.held_out_before, signal.unit, 3)} → {quantity(signal.held_out_after, signal.unit, 3)}</td>}</tr>))}
      </tbody></table>
      {found.warnings.map((warning, i) => <p key={i} className="doubt">{warning}</p>)}
      {!found.converged && <p className="doubt">The optimizer did not settle.</p>}
      <p className="buttons"><button type="button" className="primary" onClick={() => void write_fit()}>Write into the file</button></p>
      <p className="command"><code>{found.command}</code><button type="button" className="small quiet" aria-label="Copy the command of the fit" onClick={() => void navigator.clipboard.writeText(found.command).then(() => tell("good", "Copied."))}>copy</button></p>
    </div>
  );
}
