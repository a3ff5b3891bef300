// Measurements: choose or drop a record, confirm what its columns are, see how far the model is off.
import { useEffect, useRef } from "react";
import { percent, prettyUnit, quantity } from "../numbers";
import type { Column, Columns, ColumnUse } from "../protocol/types";
import { list_files } from "../state/document";
import { change_column, change_role, close_experiment, compare, confirm_columns, diagnose, drop_record, match_columns } from "../state/measure";
import { jump_to_block } from "../state/places";
import { patch, useStudio } from "../state/store";
import { Fit } from "./Fit";

export function Measure() {
  const columns = useStudio((state) => state.columns), experiment = useStudio((state) => state.experiment);
  if (columns) return <Confirm columns={columns} />;
  return experiment ? <Compared /> : <Choose />;
}

function Choose() {
  const files = useStudio((state) => state.files), path = useStudio((state) => state.document?.path ?? "");
  const picker = useRef<HTMLInputElement>(null);
  useEffect(() => { void list_files(); }, []);
  const folder = path.includes("/") ? path.slice(0, path.lastIndexOf("/") + 1) : "";
  const near = (kind: string) => files.filter((file) => file.kind === kind && file.path.startsWith(folder));
  const experiments = near("experiment"), records = near("record");
  return (
    <>
      <div className="section drop-hint">
        <h2>Compare with a measurement</h2>
        <p>Drop a recording (CSV or MAT) anywhere on this page, or</p>
        <button type="button" className="primary" onClick={() => picker.current?.click()}>Choose a file</button>
        <input ref={picker} className="hidden" type="file" accept=".csv,.mat" aria-label="Recording" tabIndex={-1} onChange={(event) => { const file = event.target.files?.[0]; if (file) void drop_record(file); event.target.value = ""; }} />
      </div>
      {experiments.length > 0 && <div className="section"><h3>Experiments of this folder</h3><ul className="plain files">{experiments.map((file) => (
        <li key={file.path}><button type="button" className="entry" onClick={() => void compare(file.path)}><b>{file.path.slice(folder.length)}</b><span>{file.title}</span></button></li>))}</ul></div>}
      {records.length > 0 && <div className="section"><h3>Records of this folder</h3><ul className="plain files">{records.map((file) => (
        <li key={file.path}><button type="button" className="entry" onClick={() => void match_columns(file.path)}><b>{file.path.slice(folder.length)}</b><span>{file.title || (file.size ? `${Math.ceil(file.size / 1024).toLocaleString("en")} KB` : "")}</span></button></li>))}</ul></div>}
    </>
  );
}

const USES: { use: ColumnUse; title: string }[] = [{ use: "compare", title: "compare with" }, { use: "drive", title: "drives" }, { use: "time", title: "time" }, { use: "ignore", title: "not used" }];
const MEANINGS: Record<string, string> = { position: "position", velocity: "velocity", force: "sum of forces", input: "input of the axis" };

/** The unit of a column, typed where the heading does not state it. */
function UnitField({ column, index }: { column: Column; index: number }) {
  if (column.unit_is_stated !== false && column.unit) return <span className="unit" title="stated by the heading of the file">{prettyUnit(column.unit)}</span>;
  return <input className="field mono unit" size={6} value={column.unit} placeholder={column.use === "time" ? "s" : "unit"} aria-label={`Unit of ${column.name}`} title="The heading states no unit. Which one have the numbers?" spellCheck={false}
    onChange={(event) => change_column(index, { unit: event.target.value.trim() })} />;
}

const NO_DRIVE = "No column drives the diagram. It runs along its own reference, not along the measured one, and the errors show that as well.";

function Confirm({ columns }: { columns: Columns }) {
  const drives = columns.columns.some((column) => column.use === "drive");
  return (
    <form onSubmit={(event) => { event.preventDefault(); void confirm_columns(columns.exists); }} className="confirm">
      <div className="section">
        <h2>What was measured?</h2>
        <p className="soft">{columns.data}: {columns.rows.toLocaleString("en")} rows{columns.start !== null && `, ${quantity(columns.start, "s")} to ${quantity(columns.stop, "s")}`}{columns.sample_time ? `, every ${quantity(columns.sample_time, "s")}` : ""}</p>
      </div>
      {columns.columns.map((column, index) => {
        const ports = columns.ports.filter((port) => (column.use === "drive" ? port.input : !port.input));
        const ordered = [...column.candidates.filter((name) => ports.some((port) => port.port === name)), ...ports.map((port) => port.port).filter((name) => !column.candidates.includes(name))];
        if (column.port && !ordered.includes(column.port)) ordered.unshift(column.port);
        return (
          <fieldset key={column.column} className={`section column ${column.use}`} data-column={column.name}>
            <legend>{column.name}</legend>
            <div className="row">
              <select aria-label={`Use of ${column.name}`} value={column.use} onChange={(event) => change_column(index, { use: event.target.value as ColumnUse, ...(event.target.value === "ignore" || event.target.value === "time" ? { port: "" } : {}) })}>
                {USES.map((entry) => <option key={entry.use} value={entry.use}>{entry.title}</option>)}
              </select>
              {(column.use === "compare" || column.use === "drive") && (
                <select aria-label={`Port of ${column.name}`} value={column.port} required onChange={(event) => change_column(index, { port: event.target.value })}>
                  <option value="">choose a port</option>
                  {ordered.map((port, i) => <option key={i} value={port}>{port}{unit_of(columns, port)}</option>)}
                </select>
              )}
              {column.use !== "ignore" && <UnitField column={column} index={index} />}
            </div>
            <p className="soft small-text">{column.min !== null && `${quantity(column.min, column.unit)} … ${quantity(column.max, column.unit)}`}{column.why && ` · ${column.why}`}{column.use === "compare" && column.resolution && ` · resolution ${column.resolution} ${prettyUnit(column.unit)}`}</p>
          </fieldset>
        );
      })}
      {columns.roles.length > 0 && (
        <div className="section">
          <h3>What the ports mean</h3>
          <ul className="plain">{columns.roles.map((role) => (
            <li key={role.role} className="row" title={role.why}><span className="name">{MEANINGS[role.role] ?? role.role}</span>
              <select aria-label={`Port of the ${MEANINGS[role.role] ?? role.role}`} value={role.port} onChange={(event) => change_role(role.role, event.target.value)}>
                <option value="">unknown</option>
                {[...new Set([role.port, ...columns.ports.map((port) => port.port)])].filter(Boolean).map((port) => <option key={port}>{port}</option>)}
              </select></li>))}</ul>
        </div>
      )}
      <div className="section">
        <label className="row"><span className="name">held out for checking</span>
          <select value={String(columns.hold_out)} onChange={(event) => patch({ columns: { ...columns, hold_out: Number(event.target.value) } })}>
            {[...new Set([0, 0.2, 0.25, 0.3, columns.hold_out])].sort().map((share) => <option key={share} value={String(share)}>{Math.round(100 * share)} %</option>)}
          </select></label>
        <label className="row"><span className="name">written to</span>
          <input className="field mono" value={columns.experiment} onChange={(event) => patch({ columns: { ...columns, experiment: event.target.value, exists: false } })} /></label>
        {columns.exists && <p className="hint">This file exists and will be replaced.</p>}
        {!drives && <p className="banner warning no-drive" role="alert">{NO_DRIVE}</p>}
        <p className="buttons"><button type="submit" className="primary">{columns.exists ? "Replace and compare" : "Confirm and compare"}{!drives && " without a drive"}</button>
          <button type="button" onClick={() => patch({ columns: null })}>Cancel</button></p>
      </div>
    </form>
  );
}
const unit_of = (columns: Columns, port: string): string => { const unit = columns.ports.find((entry) => entry.port === port)?.unit; return unit && unit !== "1" ? ` [${prettyUnit(unit)}]` : ""; };

function Compared() {
  const comparison = useStudio((state) => state.comparison), experiment = useStudio((state) => state.experiment), busy = useStudio((state) => state.busy["compare"]);
  const force = comparison?.force;
  return (
    <>
      <div className="section">
        <h2>{comparison?.title || experiment}</h2>
        <p className="soft">{experiment}{busy && " · comparing …"}</p>
        <p className="buttons">
          <button type="button" className="primary" disabled={!comparison} onClick={() => (comparison?.why_no_force ? patch({ panel: "diagnose" }) : void diagnose([experiment]))}>What is missing?</button>
          <button type="button" onClick={() => void compare()}>Again</button>
          <button type="button" onClick={close_experiment}>Close</button>
        </p>
        {comparison?.drives === 0 && <p className="banner warning no-drive" role="alert">{NO_DRIVE}</p>}
        {comparison?.why_no_force && <p className="hint">{comparison.why_no_force}</p>}
      </div>
      {comparison && (
        <div className="section">
          <h3>Errors</h3>
          <table className="merit"><thead><tr><th scope="col">signal</th><th scope="col">rms</th><th scope="col">largest</th><th scope="col">relative</th></tr></thead><tbody>{comparison.signals.map((signal) => (
            <tr key={signal.name}><th scope="row">{signal.name}</th><td>{quantity(signal.rmse, signal.unit, 3)}</td><td>{quantity(signal.max, signal.unit, 3)}</td><td>{signal.relative === null ? "–" : percent(signal.relative)}</td></tr>))}</tbody></table>
        </div>
      )}
      {comparison && <Fit />}
      {comparison && comparison.tint.length > 0 && (
        <div className="section"><h3>Where it lies</h3><ul className="plain">{comparison.tint.map((entry) => (
          <li key={entry.block}><button type="button" className="entry" onClick={() => void jump_to_block(entry.block)}><b>{entry.block}</b><span>{entry.text}</span></button></li>))}</ul></div>
      )}
      {force && force.dependence.length > 0 && (
        <div className="section"><h3>What it depends on</h3><Bars rows={force.dependence.map((entry) => ({ label: entry.variable, share: entry.share }))} />
          <p className="soft small-text">Share of the missing force that a function of this variable alone explains.</p></div>
      )}
      {force && force.faults.length > 0 && (
        <div className="section"><h3>About the record</h3><ul className="plain">{force.faults.map((fault) => <li key={fault.name} className="fault"><b>{fault.text}</b><span>{fault.cost}</span></li>)}</ul></div>
      )}
      {comparison && comparison.warnings.length > 0 && <div className="section">{comparison.warnings.map((warning, i) => <p key={i} className="hint">{warning}</p>)}</div>}
    </>
  );
}

export function Bars({ rows }: { rows: { label: string; share: number }[] }) {
  return (
    <ul className="plain bars">{rows.map((row) => (
      <li key={row.label}><span className="name">{row.label}</span><span className="track"><span style={{ width: `${Math.round(100 * Math.max(0, Math.min(1, row.share)))}%` }} /></span><span className="number">{Math.round(100 * row.share)} %</span></li>))}</ul>
  );
}
