// The selected wire: its unit, its scope, linear analysis from it to another.
import { prettyUnit } from "../numbers";
import { edit } from "../state/document";
import { linearize, toggle_signal } from "../state/run";
import { patch, useStudio } from "../state/store";
import { signal_name } from "../state/signals";
import type { View, WireEntry } from "../protocol/types";

export function WirePanel({ wire, view }: { wire: WireEntry; view: View }) {
  const plots = useStudio((state) => state.plots);
  const name = signal_name(view.inside, wire.from);
  const prefix = view.inside ? `${view.inside}.` : "";
  const others = [...new Set(view.wires.map((other) => signal_name(view.inside, other.from)).filter((other) => other && other !== name))];
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
      {others.length > 0 && wire.to.includes(".") && (
        <form className="section" onSubmit={(event) => { event.preventDefault(); void linearize(prefix + wire.to, String(new FormData(event.currentTarget).get("to"))); }}>
          <h3>Linear analysis</h3>
          <p className="soft">From {wire.to}, where the loop is cut, to</p>
          <div className="row"><select name="to" aria-label="Output of the linear analysis">{others.map((other) => <option key={other}>{other}</option>)}</select><button type="submit">Bode</button></div>
        </form>
      )}
    </>
  );
}
