// File, level, undo, run, views, theme.
import { choose_theme } from "./state/address";
import { open, redo, undo } from "./state/document";
import { run_live } from "./state/run";
import { patch, useStudio, type Theme } from "./state/store";

const NEXT: Record<Theme, Theme> = { system: "light", light: "dark", dark: "system" };
const SYMBOL: Record<Theme, string> = { system: "◐", light: "☀", dark: "☾" };

export function TopBar() {
  const document = useStudio((state) => state.document), files = useStudio((state) => state.files), theme = useStudio((state) => state.theme);
  const show_text = useStudio((state) => state.show_text), show_palette = useStudio((state) => state.show_palette), busy = useStudio((state) => state.busy);
  const connection = useStudio((state) => state.connection);
  const diagrams = files.filter((file) => file.kind === "diagram");
  const levels = document?.view?.levels ?? [];
  const errors = document?.problems.filter((problem) => problem.severity === "error").length ?? 0;
  const jobs = Object.entries(busy).filter(([key]) => key !== "run");
  return (
    <header className="top">
      <span className="brand" aria-hidden="true"><svg viewBox="0 0 24 24" width="22" height="22"><path d="M3 8h7m4 0h7M12 10v6H5V8" /><circle cx="12" cy="8" r="2.6" /></svg></span>
      <h1 className="hidden">Loopwright studio</h1>
      <select className="file" aria-label="Diagram" value={document?.path ?? ""} onChange={(event) => void open(event.target.value)}>
        {document && !diagrams.some((file) => file.path === document.path) && <option value={document.path}>{document.path}</option>}
        {!document && <option value="">No diagram</option>}
        {diagrams.map((file) => <option key={file.path} value={file.path}>{file.path}</option>)}
      </select>
      {levels.length > 1 && (
        <nav className="levels" aria-label="Level of the diagram">
          {levels.map((level, i) => (
            <button key={level.inside} type="button" aria-current={i === levels.length - 1 ? "page" : undefined} onClick={() => void open(document!.path, level.inside)} title={level.title}>{level.inside ? level.inside.split(".").pop() : "top"}</button>
          ))}
        </nav>
      )}
      <div className="group">
        <button type="button" className="icon" disabled={!document?.undo} onClick={() => void undo()} title={document?.undo ? `Undo: ${document.undo} (Ctrl+Z)` : "Nothing to undo"} aria-label="Undo">↶</button>
        <button type="button" className="icon" disabled={!document?.redo} onClick={() => void redo()} title={document?.redo ? `Redo: ${document.redo} (Ctrl+Y)` : "Nothing to redo"} aria-label="Redo">↷</button>
      </div>
      <span className="gap" />
      {jobs.map(([key, job]) => (
        <span key={key} className="job" role="status"><span>{job.what}{job.done !== null && ` ${Math.round(100 * job.done)} %`}</span><button type="button" className="small quiet" onClick={job.cancel} aria-label={`Stop: ${job.what}`} title="Stop">×</button></span>
      ))}
      {connection === "open" && document && <button type="button" className={`chip ${errors ? "bad" : document.saved ? "" : "bad"}`} onClick={() => patch({ panel: "problems", place: "panel" })} title={document.summary}>
        {errors ? `${errors} ${errors === 1 ? "problem" : "problems"}` : document.saved ? "saved" : "not saved"}</button>}
      <div className="group">
        <button type="button" aria-pressed={show_palette} onClick={() => patch({ show_palette: !show_palette, place: "diagram" })} title="Add a block (B)">+ Block</button>
        <button type="button" aria-pressed={show_text} onClick={() => patch({ show_text: !show_text, place: "diagram" })} title="The file as text (T)">Text</button>
        <button type="button" className="icon" onClick={() => choose_theme(NEXT[theme])} title={`Colours: ${theme}`} aria-label={`Colours: ${theme}`}>{SYMBOL[theme]}</button>
        <button type="button" className="icon" onClick={() => patch({ show_commands: true })} title="Keys (?)" aria-label="Keys">?</button>
      </div>
      <button type="button" className="primary run" disabled={!document?.loads} onClick={() => { patch({ scope_tab: "run" }); void run_live(); }} title="Run (Ctrl+Enter)">▶<span> Run</span></button>
    </header>
  );
}
