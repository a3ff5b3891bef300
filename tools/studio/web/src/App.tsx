// The page: diagram above, scopes below, panel on the right; on narrow screens one of them at a time.
import { useEffect, useRef, useState, type PointerEvent } from "react";
import { Boundary } from "./Boundary";
import { Canvas } from "./canvas/Canvas";
import { ChartView } from "./chart/ChartView";
import { Palette } from "./canvas/Palette";
import { Commands } from "./panels/Commands";
import { Diagnose } from "./panels/Diagnose";
import { Inspect } from "./panels/Inspect";
import { Measure } from "./panels/Measure";
import { Problems } from "./panels/Problems";
import { Runs } from "./panels/Runs";
import { TextView } from "./panels/TextView";
import { Scopes } from "./scopes/Scopes";
import { go_to } from "./state/address";
import { listen_to_keys } from "./state/keys";
import { remove_left_over, resolve, restore } from "./state/document";
import { drop_record } from "./state/measure";
import { close_note, patch, useStudio, type Panel, type Place } from "./state/store";
import { TopBar } from "./TopBar";

const PANELS: { panel: Panel; title: string }[] = [
  { panel: "inspect", title: "Inspect" }, { panel: "runs", title: "Runs" }, { panel: "measure", title: "Measure" }, { panel: "diagnose", title: "Diagnose" }, { panel: "problems", title: "Problems" }];
const PLACES: { place: Place; title: string }[] = [{ place: "diagram", title: "Diagram" }, { place: "scopes", title: "Scopes" }, { place: "panel", title: "Panel" }];

function SidePanel() {
  const panel = useStudio((state) => state.panel), problems = useStudio((state) => state.document?.problems.length ?? 0);
  return (
    <aside className="side" aria-label="Panel">
      <div role="tablist" aria-label="Panels" className="tabs">
        {PANELS.map((entry) => (
          <button key={entry.panel} id={`tab-${entry.panel}`} role="tab" type="button" aria-selected={panel === entry.panel} aria-controls="panel" onClick={() => patch({ panel: entry.panel })}>
            {entry.title}{entry.panel === "problems" && problems > 0 && <span className="count">{problems}</span>}</button>
        ))}
      </div>
      <div className="panel" id="panel" role="tabpanel" aria-labelledby={`tab-${panel}`} tabIndex={0}>
        <Boundary key={panel} part="This panel">
          {panel === "inspect" && <Inspect />}
          {panel === "runs" && <Runs />}
          {panel === "measure" && <Measure />}
          {panel === "diagnose" && <Diagnose />}
          {panel === "problems" && <Problems />}
        </Boundary>
      </div>
    </aside>
  );
}

/** A line between two parts that can be moved by mouse and by keys. */
function Divider({ direction, label, share, change }: { direction: "row" | "column"; label: string; share: number; change: (share: number) => void }) {
  const drag = (event: PointerEvent<HTMLDivElement>) => {
    const line = event.currentTarget, area = line.parentElement!.getBoundingClientRect();
    line.setPointerCapture(event.pointerId);
    line.onpointermove = (moved) => change(direction === "column" ? (moved.clientY - area.top) / area.height : (moved.clientX - area.left) / area.width);
    line.onpointerup = () => { line.onpointermove = null; };
  };
  return (
    <div className={`divider ${direction}`} role="separator" tabIndex={0} aria-label={label} aria-orientation={direction === "column" ? "horizontal" : "vertical"} aria-valuenow={Math.round(100 * share)} aria-valuemin={15} aria-valuemax={85}
      onPointerDown={drag} onKeyDown={(event) => {
        const step = { ArrowUp: -0.03, ArrowLeft: -0.03, ArrowDown: 0.03, ArrowRight: 0.03 }[event.key];
        if (step) { event.preventDefault(); change(share + step); }
      }} />
  );
}
const bounded = (share: number): number => Math.max(0.15, Math.min(0.85, share));

function Banners() {
  const connection = useStudio((state) => state.connection), conflict = useStudio((state) => state.document?.conflict ?? null), path = useStudio((state) => state.document?.path);
  const left_over = useStudio((state) => state.left_over);
  return (
    <>
      {connection === "lost" && <div className="banner error" role="alert">The connection to the program is lost. Every file is as it was last saved. Trying again …</div>}
      {conflict && (
        <div className="banner warning" role="alert">{path} was changed by another program, and the text here is not JSON yet.
          <button type="button" onClick={() => void resolve("mine")}>Keep mine</button><button type="button" onClick={() => void resolve("theirs")}>Take theirs</button></div>
      )}
      {left_over.map((left) => (
        <div key={left.file} className="banner warning" role="alert">A studio that was killed left a text of {left.path}, of {left.when.replace("T", " ").replace("Z", " UTC")}, in {left.file}.
          <button type="button" onClick={() => void restore(left)}>Put it into the file</button><button type="button" onClick={() => void remove_left_over(left)}>Remove it</button></div>
      ))}
    </>
  );
}

function Notes() {
  const notes = useStudio((state) => state.notes);
  return (
    <div className="notes" role="status" aria-live="polite">
      {notes.map((note) => (
        <div key={note.id} className={`note ${note.tone}`}><span>{note.text}</span><button type="button" className="quiet" aria-label="Close" onClick={() => close_note(note.id)}>×</button></div>
      ))}
    </div>
  );
}

export function App() {
  const place = useStudio((state) => state.place), show_text = useStudio((state) => state.show_text), document_open = useStudio((state) => state.document !== null);
  const [above, setAbove] = useState(0.54), [left, setLeft] = useState(0.6), [dropping, setDropping] = useState(false);
  const depth = useRef(0);
  useEffect(() => listen_to_keys(), []);
  useEffect(() => {
    const has_files = (event: DragEvent) => Boolean(event.dataTransfer?.types.includes("Files"));
    const enter = (event: DragEvent) => { if (has_files(event)) { ++depth.current; setDropping(true); } };
    const leave = (event: DragEvent) => { if (has_files(event) && --depth.current <= 0) setDropping(false); };
    const over = (event: DragEvent) => { if (has_files(event)) event.preventDefault(); };
    const drop = (event: DragEvent) => {
      if (!has_files(event)) return;
      event.preventDefault();
      depth.current = 0;
      setDropping(false);
      const file = event.dataTransfer!.files[0];
      if (file) void drop_record(file);
    };
    window.addEventListener("dragenter", enter);
    window.addEventListener("dragleave", leave);
    window.addEventListener("dragover", over);
    window.addEventListener("drop", drop);
    return () => { window.removeEventListener("dragenter", enter); window.removeEventListener("dragleave", leave); window.removeEventListener("dragover", over); window.removeEventListener("drop", drop); };
  }, []);
  return (
    <div className={`app at-${place}`}>
      <Boundary part="The bar at the top"><TopBar /></Boundary>
      <Banners />
      <div className="body">
        <main className="work" style={{ gridTemplateRows: `minmax(0, ${above}fr) auto minmax(0, ${1 - above}fr)` }}>
          <div className="diagram" style={show_text ? { gridTemplateColumns: `minmax(0, ${left}fr) auto minmax(0, ${1 - left}fr)` } : {}}>
            <div className="canvas-area">
              <Boundary part="The diagram">
                {document_open ? <Canvas /> : <p className="empty">Opening …</p>}
                <ChartView />
                <Palette />
              </Boundary>
            </div>
            {show_text && <><Divider direction="row" label="Between diagram and text" share={left} change={(share) => setLeft(bounded(share))} /><Boundary part="The text"><TextView /></Boundary></>}
          </div>
          <Divider direction="column" label="Between diagram and scopes" share={above} change={(share) => setAbove(bounded(share))} />
          <Boundary part="The scopes"><Scopes /></Boundary>
        </main>
        <SidePanel />
      </div>
      <nav className="places" aria-label="Parts of the page">
        {PLACES.map((entry) => <button key={entry.place} type="button" aria-pressed={place === entry.place} onClick={() => go_to(entry.place)}>{entry.title}</button>)}
      </nav>
      {dropping && <div className="dropping" aria-hidden="true"><p>Drop the recording to compare it with the diagram</p></div>}
      <Notes />
      <Commands />
    </div>
  );
}
