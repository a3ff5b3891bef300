// The selected wire: its unit, its scope, linear analysis from it to another.
import type { FormEvent } from "react";
import { prettyUnit } from "../numbers";
import { edit } from "../state/document";
import { linearize, toggle_signal } from "../state/run";
import { patch, useStudio } from "../state/store";
import { signal_name } from "../state/signals";
import type { View, WireEntry } from "../protocol/types";

export function WirePanel({ wire, view }: { wire: WireEntry; view: View }) {
  const plots = useStudio((state) => state.plots);
  const name = signal_name(view.inside, wire.from);
  return (
    <>
      <div className="section">
        <h2 className="mono">{wire.from} → {wire.to}</h2>
        <p className="soft">{wire.unit && wire.unit !== "1" ? prettyUnit(wire.unit) : "no unit"}</p>
        {wire.clash && <p className="error-text">{wire.clash}</p>}
        <p className="buttons">
          {name && <button type="button" onClick={() => void toggle_signal(name)}>{plots.some((plot) => plot.includes(name)) ? "Take out of the scopes" : "Show in the scopes"}</button>}
          {view.editable && <button type="button" onClick={() => { patch({ selected_wire: "" }); void edit({ intent: "disconnect", to: wire.to, index: wire.index }); }}>Remove the wire</button>}
        </p>
      </div>
      {wire.to.includes(".") && <LinearForm wire={wire} view={view} />}
    </>
  );
}

/** From where the wire ends to any signal, also the wire's own source: that is once around the loop. */
function LinearForm({ wire, view }: { wire: WireEntry; view: View }) {
  const name = signal_name(view.inside, wire.from);
  const [block, port] = wire.to.split(".");
  const is_many = view.blocks.find((entry) => entry.name === block)?.inputs.find((entry) => entry.name === port)?.many ?? false;
  const from = (view.inside ? `${view.inside}.` : "") + wire.to + (is_many ? `[${wire.index}]` : "");
  const others = [...new Set(view.wires.map((other) => signal_name(view.inside, other.from)).filter((other) => other && other !== name))];
  const start = (event: FormEvent<HTMLFormElement>) => {
    event.preventDefault();
    const pressed = (event.nativeEvent as SubmitEvent).submitter as HTMLButtonElement | null;
    const to = String(new FormData(event.currentTarget).get("to"));
    // The port itself as the target is what feeds it, read before anything is added.
    void linearize({ from, to, to_name: to === from ? wire.from : to, cut: pressed?.value !== "closed" });
  };
  return (
    <form className="section" onSubmit={start}>
      <h3>Linear analysis</h3>
      <label className="row"><span className="name">from</span><span className="mono">{wire.to}</span></label>
      <label className="row"><span className="name">to</span>
        <select name="to" aria-label="Output of the linear analysis">
          <option value={from}>{wire.from} (loop)</option>
          {others.map((other) => <option key={other}>{other}</option>)}
        </select></label>
      <p className="buttons">
        <button type="submit" value="open" title={`The loop is cut at ${wire.to}: with margins`}>Open loop</button>
        <button type="submit" value="closed" title="All loops stay closed">Closed loop</button>
      </p>
    </form>
  );
}
