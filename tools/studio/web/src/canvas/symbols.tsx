// What a block looks like: its outline, its symbol and its size. Sizes are known before anything is drawn, because the
// layout needs them. Numbers, fractions and curves of a block come from the program; signs that need no number are here.
import type { ReactNode } from "react";
import { prettyUnit } from "../numbers";
import type { Block } from "../protocol/types";

export type Shape = "box" | "circle" | "triangle" | "subdiagram" | "terminal";

export interface Look {
  shape: Shape;
  width: number;
  height: number;
  content: ReactNode;
  named_ports: boolean;   // names of ports are written inside the outline
}

const CHARACTER = 6.9;    // px, mean width of a character of a symbol's text
const PORT_FONT = 10.5, PORT_INSET = 11;  // px, as canvas.css has them
const PORT_PITCH = 22;    // px between ports
const SUM_SIZE = 36;
const MOST_WIRES_OF_CIRCLE = 3;

let canvas: CanvasRenderingContext2D | null = null;
const port_widths = new Map<string, number>();
/** px from the side of a block to the end of the longest of these names of ports; 0 without names. */
export function port_names_width(names: string[]): number {
  canvas ??= document.createElement("canvas").getContext("2d");
  if (canvas) canvas.font = `${PORT_FONT}px ${getComputedStyle(document.body).fontFamily}`;
  const width = (name: string): number => {
    const known = port_widths.get(name) ?? (canvas ? canvas.measureText(name).width : name.length * CHARACTER);
    port_widths.set(name, known);
    return known;
  };
  return names.length ? PORT_INSET + Math.max(...names.map(width)) : 0;
}

const textWidth = (text: string): number => [...text].length * CHARACTER;
/** Multiples of 20, so that the middle of a side lies on the grid of 10. */
const twenties = (size: number): number => 20 * Math.ceil(size / 20);
/** A short text, cut at the end of what would not fit. */
const cut = (text: string, most: number): string => (text.length > most ? text.slice(0, most - 1) + "…" : text);

const EXPONENTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";
/** Text of the file as a formula is printed: 2*pi*f^2 as 2·π·f². */
export const typeset = (text: string): string => (text.trim() === "1" ? "1" : prettyUnit(text.replace(/^=\s*/, ""))).replace(/\bpi\b/g, "π")
  .replace(/\s*·\s*/g, "·").replace(/\^(\d)/g, (_, digit: string) => EXPONENTS[Number(digit)]!).replace(/-/g, "−");

const setting = (block: Block, name: string): string => block.settings.find((entry) => entry.name === name)?.text ?? "";

function Fraction({ over, under }: { over: string; under: string }) {
  return <span className="fraction"><span>{over}</span><span>{under}</span></span>;
}

/** A curve on a cross of axes; points go from (-1, -1) to (1, 1), y up. */
function Curve({ points, axes = true, dashed, dots }: { points: [number, number][]; axes?: boolean; dashed?: boolean; dots?: boolean }) {
  const path = points.map(([x, y], i) => `${i ? "L" : "M"}${(24 + 20 * x).toFixed(1)} ${(16 - 12 * y).toFixed(1)}`).join("");
  return (
    <svg className="curve" viewBox="0 0 48 32" width="48" height="32" aria-hidden="true">
      {axes && <path className="axes" d="M2 16H46M24 2V30" />}
      <path className={dashed ? "line dashed" : "line"} d={path} />
      {dots && points.map(([x, y], i) => <circle key={i} cx={24 + 20 * x} cy={16 - 12 * y} r="1.4" />)}
    </svg>
  );
}

const sampled = (f: (x: number) => number, count = 40): [number, number][] =>
  Array.from({ length: count + 1 }, (_, i): [number, number] => { const x = -1 + (2 * i) / count; return [x, f(x)]; });

/** Waves and characteristics that need no number of the block to be recognised. */
const CURVES: Record<string, { points: [number, number][]; axes?: boolean; dots?: boolean }> = {
  Saturation: { points: [[-1, -0.7], [-0.45, -0.7], [0.45, 0.7], [1, 0.7]] },
  ForceSaturation: { points: sampled((x) => 0.8 * Math.tanh(2.2 * x)) },
  DeadZone: { points: [[-1, -0.8], [-0.35, 0], [0.35, 0], [1, 0.8]] },
  Sign: { points: [[-1, -0.7], [0, -0.7], [0, 0.7], [1, 0.7]] },
  CoulombFriction: { points: [[-1, -0.6], [0, -0.6], [0, 0.6], [1, 0.6]] },
  SmoothCoulombFriction: { points: sampled((x) => 0.65 * Math.tanh(6 * x)) },
  StribeckFriction: { points: sampled((x) => Math.sign(x) * (0.45 + 0.45 * Math.exp(-Math.abs(5 * x)) + 0.2 * Math.abs(x)), 41) },
  LuGreFriction: { points: sampled((x) => Math.sign(x) * (0.45 + 0.45 * Math.exp(-Math.abs(5 * x)) + 0.2 * Math.abs(x)), 41) },
  DahlFriction: { points: [[-0.9, -0.7], [-0.2, -0.62], [0.15, 0], [0.35, 0.5], [0.9, 0.7], [0.2, 0.62], [-0.15, 0], [-0.35, -0.5], [-0.9, -0.7]] },
  PreslidingFriction: { points: [[-0.9, -0.7], [-0.2, -0.62], [0.15, 0], [0.35, 0.5], [0.9, 0.7], [0.2, 0.62], [-0.15, 0], [-0.35, -0.5], [-0.9, -0.7]] },
  DirectionDependentFriction: { points: [[-1, -0.35], [0, -0.35], [0, 0.75], [1, 0.75]] },
  ViscousFriction: { points: [[-1, -0.8], [1, 0.8]] },
  QuadraticDrag: { points: sampled((x) => 0.9 * x * Math.abs(x)) },
  EddyCurrentDrag: { points: sampled((x) => (3 * x) / (1 + (2.2 * x) ** 2) * 0.95) },
  CoggingForce: { points: sampled((x) => 0.7 * Math.sin(2 * Math.PI * x)) },
  ForceRipple: { points: sampled((x) => 0.45 + 0.25 * Math.sin(3 * Math.PI * x)) },
  HardeningSpring: { points: sampled((x) => 0.35 * x + 0.55 * x ** 3) },
  Spring: { points: [[-1, 0], [-0.7, 0], [-0.6, 0.6], [-0.35, -0.6], [-0.1, 0.6], [0.15, -0.6], [0.4, 0.6], [0.6, -0.6], [0.7, 0], [1, 0]], axes: false },
  EndStop: { points: [[-1, -0.9], [-0.55, 0], [0.55, 0], [1, 0.9]] },
  Backlash: { points: [[-0.9, -0.8], [0.3, -0.8], [0.9, 0.8], [-0.3, 0.8], [-0.9, -0.8]] },
  Relay: { points: [[-1, -0.7], [0.35, -0.7], [0.35, 0.7], [1, 0.7], [-0.35, 0.7], [-0.35, -0.7]] },
  Quantizer: { points: [[-1, -0.8], [-0.6, -0.8], [-0.6, -0.3], [-0.2, -0.3], [-0.2, 0.2], [0.2, 0.2], [0.2, 0.6], [0.6, 0.6], [0.6, 0.9], [1, 0.9]] },
  Encoder: { points: [[-1, -0.8], [-0.6, -0.8], [-0.6, -0.3], [-0.2, -0.3], [-0.2, 0.2], [0.2, 0.2], [0.2, 0.6], [0.6, 0.6], [0.6, 0.9], [1, 0.9]], axes: false },
  Absolute: { points: [[-1, 0.9], [0, 0], [1, 0.9]] },
  RateLimiter: { points: [[-1, -0.8], [-0.4, -0.8], [0.4, 0.8], [1, 0.8]], axes: false },
  Step: { points: [[-1, -0.6], [-0.1, -0.6], [-0.1, 0.6], [1, 0.6]], axes: false },
  Ramp: { points: [[-1, -0.6], [-0.4, -0.6], [0.5, 0.6], [1, 0.6]], axes: false },
  Sine: { points: sampled((x) => 0.8 * Math.sin(Math.PI * x)), axes: false },
  Chirp: { points: sampled((x) => 0.8 * Math.sin(2.2 * Math.PI * (x + 1) ** 2), 80), axes: false },
  Multisine: { points: sampled((x) => 0.45 * Math.sin(2 * Math.PI * x) + 0.3 * Math.sin(5 * Math.PI * x + 1), 80), axes: false },
  PulseTrain: { points: [[-1, -0.6], [-0.6, -0.6], [-0.6, 0.6], [-0.2, 0.6], [-0.2, -0.6], [0.2, -0.6], [0.2, 0.6], [0.6, 0.6], [0.6, -0.6], [1, -0.6]], axes: false },
  Noise: { points: [[-1, 0.1], [-0.85, -0.5], [-0.7, 0.4], [-0.55, -0.1], [-0.4, 0.8], [-0.25, -0.7], [-0.1, 0.2], [0.05, -0.3], [0.2, 0.6], [0.35, -0.8], [0.5, 0.3], [0.65, -0.2], [0.8, 0.7], [1, -0.4]], axes: false },
  MotionProfile: { points: sampled((x) => -0.8 + 1.6 / (1 + Math.exp(-5 * x))), axes: false },
  PointToPoint: { points: sampled((x) => -0.8 + 1.6 / (1 + Math.exp(-5 * x))), axes: false },
  RecordedColumn: { points: [[-1, -0.4], [-0.7, 0.1], [-0.4, -0.2], [-0.1, 0.6], [0.2, 0.3], [0.5, 0.7], [0.8, 0.1], [1, 0.2]], axes: false, dots: true },
};

/** Symbols that are a text, where the program gives no number of the block. */
const TEXTS: Record<string, string> = {
  UnitDelay: "z⁻¹", Delay: "z⁻ⁿ", FractionalDelay: "z⁻ᵈ", TransportDelay: "e⁻ᵀˢ", ZeroOrderHold: "hold", SampleAndHold: "S/H",
  Clock: "t", Product: "×", Maximum: "max", Minimum: "min", Power: "xⁿ", Exponential: "eˣ", Logarithm: "ln", SquareRoot: "√",
  Modulo: "mod", Atan2: "atan2", Rounding: "⌊x⌉", PidController: "PID", PdController: "PD", ContinuousPdController: "PD",
  ContinuousPidController: "PID", ContinuousPiController: "PI", DisturbanceObserver: "d̂", ContinuousDisturbanceObserver: "d̂",
  QFilter: "Q(z)", Gpr: "GP", GprDeviation: "GP σ", Notch: "notch", ContinuousNotch: "notch", MovingAverage: "mean",
  MotionFeedforward: "m·a + d·v", NominalInverse: "P⁻¹", VelocityEstimator: "v̂", Comparison: ">", Pack: "[ ]", Unpack: "[i]",
  Selector: "[i]", Mass: "m", TwoMass: "m–m", ActuatorLag: "lag", Trigonometry: "sin", ThermalDrift: "K(t)", MatrixGain: "K·u",
  StateSpace: "ẋ = Ax + Bu", StrictlyProperStateSpace: "ẋ = Ax + Bu", DiscreteStateSpace: "x⁺ = Ax + Bu",
};

const FRACTIONS: Record<string, [string, string]> = {
  Integrator: ["1", "s"], DiscreteIntegrator: ["T", "z − 1"], DiscreteDerivative: ["z − 1", "T z"], Derivative: ["s", "τs + 1"],
  LowPass: ["1", "s/ω + 1"], LeadLag: ["1 + s/ω₁", "1 + s/ω₂"], ContinuousLeadLag: ["1 + s/ω₁", "1 + s/ω₂"],
};

/** A curve scaled to its box. */
function scaled(x: (number | null)[], y: (number | null)[]): [number, number][] | null {
  const points = x.flatMap((value, i): [number, number][] => (value === null || y[i] === null || y[i] === undefined ? [] : [[value, y[i]!]]));
  if (points.length < 2) return null;
  const fit = (values: number[]) => {
    const low = Math.min(...values), high = Math.max(...values), span = high - low;
    return values.map((value) => (span ? -0.9 + (1.8 * (value - low)) / span : 0));
  };
  const left = fit(points.map(([value]) => value)), up = fit(points.map(([, value]) => value));
  return left.map((value, i) => [value, up[i]!]);
}

const CURVE_WIDTH = 48;

function content(block: Block): { node: ReactNode; width: number } {
  const { picture, type } = block;
  const fraction = picture.kind === "fraction" ? [typeset(picture.numerator), typeset(picture.denominator)] as const : FRACTIONS[type];
  if (fraction) {
    const over = cut(fraction[0], 30), under = cut(fraction[1], 30);
    return { node: <Fraction over={over} under={under} />, width: Math.max(textWidth(over), textWidth(under)) + 4 };
  }
  if (picture.kind === "curve") {
    const points = scaled(picture.x, picture.y);
    if (points) return { node: <Curve points={points} axes={false} dots={type.startsWith("Lookup") && points.length <= 12} />, width: CURVE_WIDTH };
  }
  const curve = CURVES[type];
  if (curve) return { node: <Curve {...curve} />, width: CURVE_WIDTH };
  const text = cut(typeset(picture.kind === "text" ? picture.text : type === "Expression" ? setting(block, "formula") : TEXTS[type] ?? spaced(type)), 28);
  return { node: <span className="symbol">{text}</span>, width: textWidth(text) };
}

/** "ElasticCoupling" as "Elastic Coupling". */
export const spaced = (type: string): string => type.replace(/([a-z])([A-Z0-9])/g, "$1 $2");

/** The number of places for wires on the left side: one for each wire of a list, at least one for each port. */
export const inputPlaces = (block: Block): number => block.inputs.reduce((count, port) => count + Math.max(1, port.wires), 0);

export const terminalLook = (name: string): Look =>
  ({ shape: "terminal", width: twenties(textWidth(name) + 26), height: 26, content: null, named_ports: false });

export function look(block: Block): Look {
  const rows = Math.max(inputPlaces(block), block.outputs.length, 1);
  const tall = rows * PORT_PITCH + 10;
  if (block.type === "Sum") {
    if (rows <= MOST_WIRES_OF_CIRCLE) return { shape: "circle", width: SUM_SIZE, height: SUM_SIZE, content: null, named_ports: false };
    return { shape: "box", width: 40, height: twenties(tall), content: <span className="symbol large beside-signs">Σ</span>, named_ports: false };
  }
  if (block.type === "Gain") {
    const text = cut(typeset(block.picture.kind === "text" ? block.picture.text : setting(block, "gain") || "K"), 16);
    return { shape: "triangle", width: twenties(textWidth(text) * 1.3 + 36), height: 50, content: <span className="symbol">{text}</span>, named_ports: false };
  }
  // Names of ports are needed where there is more than one to mix up.
  const named = block.subdiagram || (block.room !== "math" && (block.inputs.length > 1 || block.outputs.length > 1));
  const left = named ? port_names_width(block.inputs.map((port) => port.name)) : 0, right = named ? port_names_width(block.outputs.map((port) => port.name)) : 0;
  if (block.subdiagram)
    return { shape: "subdiagram", width: twenties(Math.max(100, left + right + 24)), height: twenties(Math.max(56, tall)), content: null, named_ports: true };
  const inside = content(block);
  return { shape: "box", width: twenties(Math.max(60, left + right + inside.width + (named ? 12 : 26))), height: twenties(Math.max(40, tall)), content: inside.node, named_ports: named };
}
