// Blocks to add: found by name, by field term or by unit; dragged or put on the canvas; or chosen for a wire.
import { useEffect, useRef, useState } from "react";
import { edit } from "../state/document";
import { ask, attempt } from "../state/session";
import { get, patch, useStudio } from "../state/store";
import type { BlockType, EditAnswer, Intent } from "../protocol/types";
import { spaced } from "./symbols";

/** What a block type that is dragged onto the canvas is called there. */
export const DRAGGED_TYPE = "text/x-loopwright-type";

interface Fit { fits: string; from_source: boolean; at: { x: number; y: number } }
const PAUSE = 80;  // ms after the last key

export function Palette() {
  const open = useStudio((state) => state.show_palette), path = useStudio((state) => state.document?.path), files = useStudio((state) => state.files);
  const [text, setText] = useState(""), [types, setTypes] = useState<BlockType[]>([]), [fit, setFit] = useState<Fit | null>(null), [active, setActive] = useState(0);
  const input = useRef<HTMLInputElement>(null), list = useRef<HTMLUListElement>(null);

  useEffect(() => {
    const listen = (event: Event) => { setFit((event as CustomEvent<Fit>).detail); setText(""); };
    window.addEventListener("palette-for", listen);
    return () => window.removeEventListener("palette-for", listen);
  }, []);
  useEffect(() => { if (open) input.current?.focus(); else { setFit(null); setText(""); } }, [open, fit]);
  useEffect(() => {
    if (!open || !path) return;
    let current = true;
    const timer = setTimeout(() => void attempt(ask<{ types: BlockType[] }>("find_blocks", { path, text, ...(fit ? { fits: fit.fits } : {}) })).then((answer) => {
      if (current && answer) { setTypes(answer.types); setActive(0); }
    }), text ? PAUSE : 0);
    return () => { current = false; clearTimeout(timer); };
  }, [open, text, path, fit]);
  useEffect(() => { list.current?.querySelector("[aria-selected=true]")?.scrollIntoView({ block: "nearest" }); }, [active]);
  if (!open) return null;

  const diagrams = fit ? [] : files.filter((file) => file.kind === "diagram" && file.path !== path && (text ? `${file.path} ${file.title}`.toLowerCase().includes(text.toLowerCase()) : false)).slice(0, 8);
  const add = async (intent: Intent) => {
    const position = fit ? { position: [Math.round(fit.at.x), Math.round(fit.at.y)] } : {};
    const wired = fit && fit.from_source ? await wired_input(String(intent["type"]), fit.fits) : {};
    const answer = await edit({ ...intent, ...position, ...wired });
    if (answer && fit && !fit.from_source) await connect_output(answer, fit.fits);
    if (answer) patch({ selected: answer.blocks.slice(0, 1), panel: "inspect", show_palette: false });
  };
  const add_type = (type: string) => void add({ intent: "add_block", type });
  let room = "";
  return (
    <aside className="palette" aria-label="Blocks">
      <div className="search">
        <input ref={input} type="search" value={text} onChange={(event) => setText(event.target.value)} placeholder={fit ? `Blocks for ${fit.fits}` : "Search blocks: friction, transfer fcn, N/m …"}
          role="combobox" aria-expanded="true" aria-controls="palette-list" aria-activedescendant={types[active] ? `palette-${types[active]!.type}` : undefined} aria-label="Search blocks"
          onKeyDown={(event) => {
            if (event.key === "ArrowDown") { event.preventDefault(); setActive(Math.min(active + 1, types.length - 1)); }
            if (event.key === "ArrowUp") { event.preventDefault(); setActive(Math.max(active - 1, 0)); }
            if (event.key === "Enter" && types[active]) add_type(types[active]!.type);
            if (event.key === "Escape") patch({ show_palette: false });
          }} />
        <button type="button" className="quiet" aria-label="Close the palette" title="Close" onClick={() => patch({ show_palette: false })}>×</button>
      </div>
      {fit && <p className="hint">Fits the wire from {fit.fits}. <button type="button" className="link" onClick={() => setFit(null)}>Show all</button></p>}
      <ul className="plain" id="palette-list" role="listbox" aria-label="Blocks found" ref={list}>
        {types.map((entry, i) => {
          const heading = !text && entry.room !== room ? entry.room : "";
          room = entry.room;
          return (
            <li key={entry.type} role="presentation">
              {heading && <h3>{heading}</h3>}
              <div id={`palette-${entry.type}`} role="option" aria-selected={i === active} className={`entry room-${entry.room}`} draggable data-type={entry.type}
                onDragStart={(event) => event.dataTransfer.setData(DRAGGED_TYPE, entry.type)} onClick={() => add_type(entry.type)} onMouseMove={() => setActive(i)}>
                <b>{spaced(entry.type)}</b><span>{entry.why || entry.sentence}</span>
              </div>
            </li>
          );
        })}
        {diagrams.map((file) => (
          <li key={file.path} role="presentation"><div role="option" aria-selected={false} className="entry room-subdiagram" onClick={() => void add({ intent: "add_subdiagram", file: file.path })}>
            <b>{file.path}</b><span>{file.title}</span></div></li>))}
        {!types.length && !diagrams.length && <li className="empty">Nothing found.</li>}
      </ul>
    </aside>
  );
}

/** The wire that was drawn into the open goes to the first input of the new block. */
async function wired_input(type: string, source: string): Promise<{ in?: Record<string, string> }> {
  const help = await attempt(ask<{ inputs: { name: string }[] }>("type", { type }));
  const first = help?.inputs[0]?.name;
  return first ? { in: { [first]: source } } : {};
}
async function connect_output(answer: EditAnswer, to: string): Promise<void> {
  const added = answer.document.view?.blocks.find((block) => block.name === answer.blocks[0]) ?? get().document?.view?.blocks.find((block) => block.name === answer.blocks[0]);
  const port = added?.outputs[0]?.name;
  if (added && port) await edit({ intent: "connect", from: `${added.name}.${port}`, to, index: 0 });
}
