// Bode and Nyquist diagrams, poles and zeros between two wires.
import { useMemo } from "react";
import { quantity, short } from "../numbers";
import { useStudio } from "../state/store";
import { Plot } from "./Plot";
import type { Curve } from "./drawing";

const HEIGHT = 170;  // px
const complex = ([re, im]: [number, number]): string => short(re, 3) + (im ? ` ${im < 0 ? "−" : "+"} ${short(Math.abs(im), 3)}i` : "");

export function LinearScopes() {
  const linear = useStudio((state) => state.linear);
  const curves = useMemo((): Record<"magnitude" | "phase" | "nyquist", Curve[]> | null => linear && {
    magnitude: [{ name: "magnitude", label: `${linear.to} per ${linear.from}`, unit: "dB", x: linear.frequency, y: linear.magnitude_db, colour: 0, style: "line" }],
    phase: [{ name: "phase", label: "phase", unit: "deg", x: linear.frequency, y: linear.phase_deg, colour: 1, style: "line" }],
    nyquist: [{ name: "nyquist", label: "Nyquist", unit: "", x: linear.nyquist.re, y: linear.nyquist.im, colour: 2, style: "points" }],
  }, [linear]);
  if (!linear || !curves) return null;
  const { gain_db, phase_deg, crossover } = linear.margins;
  return (
    <div className="comparison">
      <div className="verdict">
        <span>Gain margin</span><b>{gain_db === null ? "–" : `${short(gain_db, 3)} dB`}</b>
        <span>Phase margin</span><b>{phase_deg === null ? "–" : `${short(phase_deg, 3)}°`}</b>
        <span>Crossover</span><b>{quantity(crossover, "rad/s", 3)}</b>
      </div>
      <Plot title="Magnitude" curves={curves.magnitude} group="bode" logarithmic x_label="" x_unit="rad/s" y_label="magnitude" y_unit="dB" height={HEIGHT} show_x={false} />
      <Plot title="Phase" curves={curves.phase} group="bode" logarithmic x_label="frequency" x_unit="rad/s" y_label="phase" y_unit="°" height={HEIGHT} show_x />
      <div className="residuals">
        <Plot title="Nyquist" curves={curves.nyquist} group="" x_label="real" x_unit="" y_label="imaginary" y_unit="" height={HEIGHT + 40} show_x />
        <div className="lists">
          <h3>Poles (rad/s)</h3><ul>{linear.poles.map((pole, i) => <li key={i} className={pole[0] > 0 ? "bad" : ""}>{complex(pole)}</li>)}</ul>
          <h3>Zeros (rad/s)</h3><ul>{linear.zeros.length ? linear.zeros.map((zero, i) => <li key={i}>{complex(zero)}</li>) : <li>none</li>}</ul>
        </div>
      </div>
    </div>
  );
}
