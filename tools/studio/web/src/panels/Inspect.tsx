// The selected block, or, with nothing selected, the diagram itself: its parameters with their sliders, its solver.
import { prettyUnit } from "../numbers";
import { edit, open, wrap } from "../state/document";
import { useStudio } from "../state/store";
import type { Parameter, View } from "../protocol/types";
import { BlockPanel } from "./BlockPanel";
import { Field, SliderField } from "./fields";
import { SweepForm } from "./SweepForm";
import { WirePanel } from "./WirePanel";

export function Inspect() {
  const view = useStudio((state) => state.document?.view ?? null);
  const selected = useStudio((state) => state.selected);
  const wire = useStudio((state) => state.selected_wire);
  if (!view) return <p className="empty">The text is not a diagram yet. The text view shows it.</p>;
  const block = selected.length === 1 ? view.blocks.find((entry) => entry.name === selected[0]) : undefined;
  if (block) return <BlockPanel key={block.name} block={block} view={view} />;
  const entry = wire ? view.wires.find((other) => `${other.to}#${other.index}` === wire) : undefined;
  if (entry) return <WirePanel wire={entry} view={view} />;
  if (selected.length > 1) return <Several names={selected} editable={view.editable} />;
  return <DiagramPanel view={view} />;
}

function Several({ names, editable }: { names: string[]; editable: boolean }) {
  return (
    <div className="section">
      <h2>{names.length} blocks</h2>
      <p className="soft">{names.join(", ")}</p>
      {editable && (
        <p className="buttons">
          <button type="button" title="Put these blocks into a subdiagram of their own (Ctrl+G)" onClick={() => void wrap(names)}>Wrap into a subdiagram</button>
          <button type="button" onClick={() => void edit({ intent: "duplicate", blocks: names })}>Duplicate</button>
          <button type="button" onClick={() => void edit({ intent: "remove_blocks", blocks: names })}>Remove</button>
        </p>
      )}
    </div>
  );
}

function ParameterRow({ parameter, editable }: { parameter: Parameter; editable: boolean }) {
  const evaluated = parameter.text.trim().startsWith("=") && typeof parameter.value === "number" ? `= ${+parameter.value.toPrecision(6)} ${prettyUnit(parameter.unit)}` : "";
  return (
    <li className="parameter" data-parameter={parameter.name}>
      <div className="row">
        <span className="name" title={parameter.description}>{parameter.name}</span>
        <Field value={parameter.text} label={`Value of ${parameter.name}`} disabled={!editable} send={(text) => void edit({ intent: "set_parameter", name: parameter.name, text })} />
      </div>
      {evaluated && <div className="evaluated">{evaluated}</div>}
      {parameter.slider && <SliderField slider={parameter.slider} label={parameter.name} />}
      {parameter.description && <div className="soft small-text">{parameter.description}</div>}
    </li>
  );
}

function DiagramPanel({ view }: { view: View }) {
  const run = useStudio((state) => state.run);
  const writable = useStudio((state) => state.document?.writable ?? false) && view.editable;
  const file_inside = useStudio((state) => state.file_inside);
  return (
    <>
      <div className="section">
        <h2>{view.title || "Diagram"}</h2>
        {view.description && <p className="soft description">{view.description}</p>}
        {!view.editable && <p className="hint">This part is defined by another file. Open that file to change it.</p>}
        {!view.editable && file_inside && <p className="buttons"><button type="button" onClick={() => void open(file_inside)}>Open {file_inside.split("/").pop()}</button></p>}
      </div>
      <div className="section">
        <h3>Parameters</h3>
        {view.parameters.length === 0 && <p className="soft">None. Numbers of blocks have sliders too: select a block.</p>}
        <ul className="plain">{view.parameters.map((parameter) => <ParameterRow key={parameter.name} parameter={parameter} editable={writable} />)}</ul>
        {writable && <AddParameter />}
      </div>
      {!view.inside && (
        <div className="section">
          <h3>Solver</h3>
          <ul className="plain">{view.solver.map((entry) => (
            <li key={entry.name} className="row"><span className="name">{entry.name}</span>
              <Field value={entry.text} label={`Solver ${entry.name}`} disabled={!writable} send={(text) => void edit({ intent: "set_solver", name: entry.name, text })} /></li>
          ))}</ul>
        </div>
      )}
      {run && <SweepForm key={view.inside} view={view} signals={run.signals.map((signal) => signal.name)} />}
    </>
  );
}

function AddParameter() {
  return (
    <form className="row add" onSubmit={(event) => {
      event.preventDefault();
      const form = event.currentTarget, data = new FormData(form);
      void edit({ intent: "add_parameter", name: String(data.get("name")), text: String(data.get("text")), description: "" }).then((answer) => { if (answer) form.reset(); });
    }}>
      <input className="field mono" name="name" placeholder="name" aria-label="Name of the new parameter" required pattern="[A-Za-z_][A-Za-z0-9_]*" />
      <input className="field mono" name="text" placeholder="25 mm" aria-label="Value of the new parameter" required />
      <button type="submit" title="Add a parameter">Add</button>
    </form>
  );
}

