// Bode and Nyquist diagrams, poles and zeros between two wires.
import { useMemo } from "react";
import { prettyUnit, quantity, short } from "../numbers";
import { settings_text } from "../state/request";
import { useStudio, type State } from "../state/store";
import type { Margins, PoleEntry } from "../protocol/types";
import { Plot } from "./Plot";
import type { Curve } from "./drawing";

const HEIGHT = 170;  // px
const complex = (re: number, im: number): string => short(re, 3) + (im ? ` ${im < 0 ? "−" : "+"} ${short(Math.abs(im), 3)}i` : "");

type Shown = NonNullable<State["linear"]>;
/** What the curves are, in words. */
function meaning(linear: Shown): string {
  const ratio = `${linear.to_name} per ${linear.from}`;
  if (linear.is_loop_gain) return `Open loop, cut at ${linear.from}: L = −${ratio}`;
  return linear.cut ? `${ratio}, with the loop cut at ${linear.from}` : `${ratio}, all loops closed`;
}

function MarginsLine({ margins }: { margins: Margins }) {
  const { stable, gain_db, lower_gain_db, phase_deg, crossover, delay, Ms } = margins;
  return (
    <div className="verdict margins">
      <span className={stable ? "good" : "bad"}>{stable ? "Closed, this loop is stable" : "Closed, this loop is unstable: the margins are what stability lacks"}</span>
      <span>Gain margin</span><b>{gain_db === null ? "∞" : `${short(gain_db, 3)} dB`}</b>
      {lower_gain_db !== null && <><span>down to</span><b>{short(lower_gain_db, 3)} dB</b></>}
      <span>Phase margin</span><b>{phase_deg === null ? "∞" : `${short(phase_deg, 3)}°`}</b>
      {crossover !== null && <><span>at</span><b>{quantity(crossover / (2 * Math.PI), "Hz", 3)}</b></>}
      <span>Delay margin</span><b>{delay === null ? "∞" : quantity(delay, "s", 3)}</b>
      <span title="largest of the sensitivity 1/(1 + L)">Peak of sensitivity</span><b>{Ms === null ? "∞" : short(Ms, 3)}</b>
    </div>
  );
}

const STABILITY = { stable: "", boundary: "at the boundary of stability", unstable: "unstable" };

function Poles({ poles, sampled }: { poles: PoleEntry[]; sampled: boolean }) {
  return (
    <table className="merit poles">
      <thead><tr><th scope="col">{sampled ? "z" : "s (rad/s)"}</th><th scope="col">frequency</th><th scope="col">damping</th></tr></thead>
      <tbody>{poles.map((pole, i) => (
        <tr key={i} className={pole.stability} title={STABILITY[pole.stability]}>
          <th scope="row">{complex(pole.re, pole.im)}{pole.stability === "unstable" && <span className="bad"> unstable</span>}</th>
          <td>{pole.frequency === null ? "–" : quantity(pole.frequency, "Hz", 3)}</td><td>{pole.damping === null ? "–" : short(pole.damping, 2)}</td></tr>))}</tbody>
    </table>
  );
}

export function LinearScopes() {
  const linear = useStudio((state) => state.linear);
  const curves = useMemo((): Record<"magnitude" | "phase" | "nyquist", Curve[]> | null => linear && {
    magnitude: [{ name: "magnitude", label: linear.is_loop_gain ? "L" : `${linear.to_name} per ${linear.from}`, unit: "dB", x: linear.frequency, y: linear.magnitude_db, colour: 0, style: "line" }],
    phase: [{ name: "phase", label: "phase", unit: "deg", x: linear.frequency, y: linear.phase_deg, colour: 1, style: "line" }],
    nyquist: [
      { name: "nyquist", label: linear.is_loop_gain ? "L, where |L| < 5" : "Nyquist", unit: "", x: linear.nyquist.re, y: linear.nyquist.im, colour: 2, style: "points" },
      ...(linear.nyquist.circle ? [
        { name: "circle", label: "circle of radius 1/Ms", unit: "", x: linear.nyquist.circle.re, y: linear.nyquist.circle.im, colour: 0, style: "points" as const },
        { name: "critical", label: "−1", unit: "", x: [-1], y: [0], colour: 1, style: "points" as const }] : []),
    ],
  }, [linear]);
  if (!linear || !curves) return <p className="empty">Select a wire of the diagram: the panel on the right offers its linear analysis.</p>;
  const plane = linear.sampled ? `in z, sampled every ${quantity(linear.sample_time, "s", 3)}` : "in s (rad/s)";
  const changes = settings_text(linear.set);
  return (
    <div className="comparison">
      <p className="outcome">{meaning(linear)}{changes && `, with ${prettyUnit(changes)}`}</p>
      {linear.margins && <MarginsLine margins={linear.margins} />}
      <Plot title="Magnitude" curves={curves.magnitude} group="bode" logarithmic x_label="" x_unit="rad/s" y_label="magnitude" y_unit="dB" height={HEIGHT} show_x={false} />
      <Plot title="Phase" curves={curves.phase} group="bode" logarithmic x_label="frequency" x_unit="rad/s" y_label="phase" y_unit="°" height={HEIGHT} show_x />
      <div className="residuals">
        <Plot title="Nyquist" curves={curves.nyquist} group="" x_label="real" x_unit="" y_label="imaginary" y_unit="" height={HEIGHT + 110} show_x equal />
        <div className="lists">
          <h3>Poles {plane}{linear.cut && ", with the loop cut"}</h3><Poles poles={linear.poles} sampled={linear.sampled} />
          <h3>Zeros {plane}</h3><ul>{linear.zeros.length ? linear.zeros.map(([re, im], i) => <li key={i}>{complex(re, im)}</li>) : <li>none</li>}</ul>
        </div>
      </div>
      <details className="section"><summary>As the command line prints it</summary><pre className="help">{linear.text}</pre></details>
    </div>
  );
}
