// The runs so far, with names, notes and the commands that repeat them.
import { useEffect } from "react";
import { prettyUnit, quantity } from "../numbers";
import { list_runs, name_run, overlay, unpin } from "../state/run";
import { tell, useStudio } from "../state/store";
import { Field } from "./fields";

export function Runs() {
  const runs = useStudio((state) => state.runs), run = useStudio((state) => state.run), pinned = useStudio((state) => state.pinned);
  const latest = run?.run;
  const revision = useStudio((state) => state.document?.revision);
  useEffect(() => { void list_runs(); }, [latest, revision]);
  if (!runs.length) return <p className="empty">No runs yet. Press Run, or move a slider.</p>;
  return (
    <ul className="plain runs">
      {[...runs].reverse().map((entry) => {
        const shown = pinned.some((other) => other.run === entry.run), present = entry.run === latest;
        const changes = Object.entries(entry.set).map(([key, value]) => `${key} = ${prettyUnit(value)}`).join(", ");
        return (
          <li key={entry.run} className={present ? "section present" : "section"}>
            <div className="row"><b className="number">{entry.run}</b>
              <Field mono={false} value={entry.name} label={`Name of run ${entry.run}`} placeholder="name it to keep it" send={(name) => void name_run(entry.run, name, entry.note, name !== "")} />
              {!present && <label title="Show beside the present run"><input type="checkbox" checked={shown} onChange={() => (shown ? unpin(entry.run) : void overlay(entry))} /> scope</label>}
              {present && <span className="soft">in the scopes</span>}
            </div>
            {changes && <p className="soft small-text">{changes}</p>}
            {entry.merit.length > 0 && <table className="merit"><thead><tr><th scope="col">signal</th><th scope="col">rms</th><th scope="col">largest</th></tr></thead><tbody>{entry.merit.slice(0, 6).map((merit) => (
              <tr key={merit.name}><th scope="row">{merit.name}</th><td>{quantity(merit.rms, merit.unit, 3)}</td><td className="soft">{quantity(merit.max, merit.unit, 3)}</td></tr>))}</tbody></table>}
            {entry.file_changed && <p className="doubt small-text">The file has changed since: the command gives another run now.</p>}
            <p className="command"><code>{entry.command}</code>
              <button type="button" className="small quiet" title="Copy the command" aria-label={`Copy the command of run ${entry.run}`} onClick={() => void navigator.clipboard.writeText(entry.command).then(() => tell("good", "Copied."))}>copy</button></p>
          </li>
        );
      })}
    </ul>
  );
}
