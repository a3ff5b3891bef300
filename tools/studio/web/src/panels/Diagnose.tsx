// Which effect is missing: the staircase of the error, a card for each effect, and what the record cannot tell.
import { prettyUnit, quantity } from "../numbers";
import { add, diagnose, preview } from "../state/measure";
import { useStudio } from "../state/store";
import { undo } from "../state/document";
import { settings_text } from "../state/request";
import type { Card, Diagnosis } from "../protocol/types";
import { Bars } from "./Measure";
import { Staircase } from "./Staircase";

export function Diagnose() {
  const experiment = useStudio((state) => state.experiment), diagnosis = useStudio((state) => state.diagnosis), busy = useStudio((state) => state.busy["diagnose"]);
  const staircase = useStudio((state) => state.staircase), added = useStudio((state) => state.added);
  const usable = useStudio((state) => Boolean(state.comparison) && !state.comparison?.why_no_force), diagnosed_with = useStudio((state) => state.diagnosed_with);
  const overrides = useStudio((state) => state.overrides), set_then = useStudio((state) => state.diagnosed_set);
  if (!experiment) return <p className="empty">A diagnosis needs a record. Drop one on the page, or choose one under Measure.</p>;
  const necessary = diagnosis?.cards.filter((card) => card.addable && !card.optional && !added.includes(card.effect)) ?? [];
  return (
    <>
      <div className="section">
        <h2>{diagnosis ? headline(diagnosis) : "What is missing?"}</h2>
        {busy && (
          <div className="progress" role="status">
            <span>{busy.stage || "searching"}{busy.done !== null ? ` · ${Math.round(100 * busy.done)} %` : ""}</span>
            <progress value={busy.done ?? undefined} max={1} aria-label="Progress of the diagnosis" />
            <button type="button" onClick={busy.cancel}>Stop</button>
          </div>
        )}
        {!busy && !diagnosis && (usable ? <button type="button" className="primary" onClick={() => void diagnose([experiment])}>Search</button> : <OtherRecords />)}
        {staircase.length > 0 && <Staircase steps={staircase} floor={diagnosis?.noise_floor ?? null} unit={diagnosis?.unit ?? "N"} running={Boolean(busy)} />}
        {diagnosis && settings_text(set_then) !== settings_text(overrides) && <p className="hint">The sliders have moved since: this was found with {settings_text(set_then) || "the numbers of the file"}. Search again.</p>}
        {diagnosis && (
          <p className="buttons">
            {necessary.length > 0 && <button type="button" className="primary" onMouseEnter={() => void preview(necessary.map((card) => card.effect))} onMouseLeave={() => void preview([])}
              onClick={() => void add(added.length ? necessary.map((card) => card.effect) : [])}>{necessary.length > 1 ? `Add all ${necessary.length} that are necessary` : `Add ${necessary[0]!.title}`}</button>}
            {added.length > 0 && <button type="button" onClick={() => void undo()}>Undo</button>}
            {!busy && <button type="button" onClick={() => void diagnose(diagnosed_with)}>Search again</button>}
          </p>
        )}
      </div>
      {diagnosis?.cards.map((card) => <EffectCard key={card.effect + card.form} card={card} added={added.includes(card.effect)} />)}
      {diagnosis && <Doubts diagnosis={diagnosis} added={added} />}
    </>
  );
}

/** The record that is compared lacks what a diagnosis needs: the force and the position of the axis. Another one may have both. */
function OtherRecords() {
  const files = useStudio((state) => state.files), experiment = useStudio((state) => state.experiment), why = useStudio((state) => state.comparison?.why_no_force ?? "");
  const folder = experiment.includes("/") ? experiment.slice(0, experiment.lastIndexOf("/") + 1) : "";
  const others = files.filter((file) => file.kind === "experiment" && file.path !== experiment && file.path.startsWith(folder));
  return (
    <>
      {why && <p className="hint">{experiment.slice(folder.length)} does not say enough about the forces: {why}.</p>}
      {others.length > 0 && <h3>Search with the record of</h3>}
      <ul className="plain files">{others.map((file) => (
        <li key={file.path}><button type="button" className="entry" onClick={() => void diagnose([file.path])}><b>{file.path.slice(folder.length)}</b><span>{file.title}</span></button></li>))}</ul>
    </>
  );
}

const NUMBERS: Record<number, string> = { 2: "Two", 3: "Three", 4: "Four", 5: "Five", 6: "Six" };
function headline(diagnosis: Diagnosis): string {
  const count = diagnosis.cards.filter((card) => !card.optional).length;
  const one = count === 1, effects = one ? "One effect is missing" : `${NUMBERS[count] ?? count} effects are missing`;
  switch (diagnosis.verdict) {
    case "nothing_missing": return "Nothing is missing: the diagram explains the record down to its noise";
    case "explained": return count ? `${effects}; with ${one ? "it" : "them"} the record is explained down to its noise` : "Only effects that are not necessary were found";
    case "partly_explained": return count ? `${effects}, but something is left that ${one ? "it does" : "they do"} not explain` : "Something is missing that is only partly explained";
    default: return "Something is missing that no effect of the catalogue explains";
  }
}

function EffectCard({ card, added }: { card: Card; added: boolean }) {
  return (
    <article className={added ? "card added" : "card"} data-effect={card.effect} tabIndex={0} aria-label={card.title}
      onMouseEnter={() => { if (!added) void preview([card.effect]); }} onMouseLeave={() => void preview([])}
      onFocus={() => { if (!added) void preview([card.effect]); }} onBlur={() => void preview([])}>
      <header><h3>{card.title}{card.form && <span className="soft"> · {card.form}</span>}</h3>
        {card.inclusion !== null && <span className="chip" title="Probability that the effect is present">{card.inclusion >= 0.995 ? "99.5 %" : `${Math.round(100 * card.inclusion)} %`}</span>}</header>
      {card.physics && <p className="soft physics">{card.physics}</p>}
      <table className="merit"><tbody>
        {card.parameters.map((parameter) => (
          <tr key={parameter.name}><th scope="row">{parameter.name.replace(/_/g, " ")}</th><td>{parameter.text ? prettyUnit(parameter.text) : quantity(parameter.value, parameter.unit)}</td>
            <td className="soft" title="95 % interval">{parameter.interval ?? (parameter.low !== null && `${quantity(parameter.low, parameter.unit)} … ${quantity(parameter.high, parameter.unit)}`)}{parameter.at_limit && " at its limit"}</td></tr>))}
        {card.force !== null && <tr><th scope="row">force, rms</th><td>{quantity(card.force, card.unit, 3)}</td><td /></tr>}
      </tbody></table>
      {card.rivals.length > 0 && <p className="doubt">Could also be: {card.rivals.map((rival) => rival.replace(/_/g, " ")).join(", ")}</p>}
      {card.optional && <p className="doubt">Not necessary: the error hardly falls.</p>}
      {added ? <p className="good-text">✓ in the diagram</p>
        : card.addable ? <button type="button" onClick={() => void add([card.effect])}>Add</button> : <p className="hint">{card.why_not}</p>}
    </article>
  );
}

/** A function that the search learned without a name for it. */
function Learned({ effect, title, note, added }: { effect: string; title: string; note: string; added: boolean }) {
  return (
    <div className="learned" data-learned={effect}><p>{title}{note && <span className="soft"> · {note}</span>}</p>
      {added ? <p className="good-text">✓ in the diagram</p>
        : <button type="button" onMouseEnter={() => void preview([effect])} onMouseLeave={() => void preview([])} onFocus={() => void preview([effect])} onBlur={() => void preview([])} onClick={() => void add([effect])}>Keep as a lookup block</button>}</div>
  );
}

function Doubts({ diagnosis, added }: { diagnosis: Diagnosis; added: string[] }) {
  const { unknown, other_explanations, suggested, findings, not_looked_for } = diagnosis;
  const words = (names: string[]) => names.map((name) => name.replace(/_/g, " ")).join(", ");
  return (
    <>
      {unknown && (
        <div className="card unknown"><h3>Something remains that no effect of the catalogue explains</h3>
          {unknown.variables.length > 0 && <p>It depends on {words(unknown.variables)}.</p>}
          <Bars rows={unknown.dependence.map((entry) => ({ label: entry.variable, share: entry.share }))} />
          {unknown.learned?.map((entry) => <Learned key={entry.effect} {...entry} added={added.includes(entry.effect)} />)}
          {unknown.not_stated?.map((sentence) => <p key={sentence} className="hint">{sentence}</p>)}</div>
      )}
      {other_explanations.length > 0 && <div className="section"><h3>Other explanations</h3><ul>{other_explanations.map((entry, i) => (
        <li key={i}>{words(entry.effects) || "nothing"}{entry.in_place_of.length > 0 && ` in place of ${words(entry.in_place_of)}`}</li>))}</ul></div>}
      {suggested.length > 0 && <div className="section"><h3>An experiment that would tell</h3>{suggested.map((entry, i) => <p key={i}>{entry.text}</p>)}</div>}
      {findings.length > 0 && <div className="section"><h3>About the record</h3><ul className="plain">{findings.map((entry, i) => <li key={i} className={entry.fatal ? "fault fatal" : "fault"}><b>{entry.what}</b><span>{entry.cost}</span></li>)}</ul></div>}
      {not_looked_for.length > 0 && <details className="section"><summary>What this record cannot tell</summary><ul>{not_looked_for.map((entry, i) => <li key={i}>{words(entry.effects)}: {entry.why}</li>)}</ul></details>}
      <details className="section"><summary>As the command line has it</summary><pre className="help">{diagnosis.text}</pre></details>
    </>
  );
}
