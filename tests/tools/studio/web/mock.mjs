// A stand-in for the program, for work on the page alone:  node mock.mjs [FOLDER_OF_THE_PAGE] [PORT]
// It speaks tools/studio/protocol.md with a fixed diagram and invented numbers. No logic of the program is repeated here.
import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import { join, dirname } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { packages } from "./packages.mjs";

const { WebSocketServer } = packages("ws");

const POLICY = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:; worker-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";
const TYPES = { html: "text/html", js: "text/javascript", css: "text/css", txt: "text/plain" };

// ---------- the diagram ----------

const port = (name, unit, sentence = "") => ({ name, unit, sentence });
const input = (name, unit, wires = 1, many = false) => ({ ...port(name, unit), many, wires, optional: false });
const output = (name, unit, logged = false) => ({ ...port(name, unit), logged });
const setting = (name, text, value = text, slider = null) => ({ name, text, value, slider });
const block = (name, type, room, inputs, outputs, more = {}) => ({
  name, type, room, title: type, description: "", subdiagram: false, file: "", variants: [], variant: "", settings: [], inputs, outputs,
  picture: { kind: "none" }, sample_time: null, rate: 0, position: null, problems: [], ...more });
const wire = (from, to, index = 0, unit = "m") => ({ from, to, index, unit, clash: "" });
const slider = (set, value, unit) => ({ low: 0, high: 2 * value, step: value / 200, unit, value, set, logarithmic: false });

const state = { revision: 1, mass: 0.6, undo: [], redo: [], added: [], positions: {} };

function top() {
  const sub = (name, inputs, outputs, file) => block(name, "", "", inputs, outputs, { subdiagram: true, file, title: name });
  return {
    inside: "", editable: true, title: "The loop, as believed", description: "A positioning axis with its controller.", levels: [{ inside: "", title: "The loop, as believed" }],
    blocks: [
      block("reference", "RecordedColumn", "io", [], [output("value", "m", true)], { settings: [setting("file", "train.csv"), setting("column", "reference_m")], sample_time: 0.001, rate: 1 }),
      sub("controller", [input("reference", "m"), input("position", "m")], [output("force", "N", true)], "controller.json"),
      sub("axis", [input("force", "N")], [output("position", "m", true), output("velocity", "m/s", true), output("net_force", "N")], "axis.json"),
      block("error", "Sum", "math", [input("terms", "m", 2, true)], [output("sum", "m")], { picture: { kind: "signs", signs: "+-" } }),
    ],
    wires: [wire("reference.value", "controller.reference"), wire("axis.position", "controller.position"), wire("controller.force", "axis.force", 0, "N"), wire("reference.value", "error.terms", 0), wire("axis.position", "error.terms", 1)],
    inputs: [], outputs: [],
    parameters: [{ name: "mass", text: `${state.mass} kg`, value: state.mass, unit: "kg", description: "Moving mass", slider: slider("mass", 0.6, "kg"), offset: 60, end: 70 },
      { name: "cutoff", text: "=2*pi*40", value: 251.327, unit: "rad/s", description: "", slider: slider("cutoff", 251.327, "rad/s"), offset: 60, end: 70 }],
    solver: [{ name: "method", text: "rk4" }, { name: "step", text: "0.0001" }, { name: "stop", text: "4" }], log: ["axis.position", "controller.force"],
  };
}
function axis() {
  const curve = (name, type) => block(name, type, "mechanics", [input("velocity", "m/s")], [output("force", "N")]);
  const effects = state.added.map((name) => (name === "cogging" ? block("cogging", "CoggingForce", "mechanics", [input("position", "m")], [output("force", "N")], { settings: [setting("pitch", "11.25 mm")] }) : curve(name, "CoulombFriction")));
  const terms = ["force", "viscous.force", ...effects.map((entry) => `${entry.name}.force`)];
  return {
    inside: "axis", editable: false, title: "Axis", description: "", levels: [{ inside: "", title: "The loop, as believed" }, { inside: "axis", title: "Axis" }],
    blocks: [curve("viscous", "ViscousFriction"), ...effects,
      block("applied", "Sum", "math", [input("terms", "N", terms.length, true)], [output("sum", "N")], { picture: { kind: "signs", signs: "+" + "-".repeat(terms.length - 1) } }),
      block("drive", "Gain", "math", [input("u", "N")], [output("y", "N")], { picture: { kind: "text", text: "1.02 N/V" } }),
      block("lag", "TransferFunction", "continuous", [input("u", "N")], [output("y", "N")], { picture: { kind: "fraction", numerator: "1", denominator: "0.001 s + 1" } }),
      block("limit", "Saturation", "math", [input("u", "N")], [output("y", "N")], { picture: { kind: "curve", x: [-2, -1, 1, 2], y: [-1, -1, 1, 1] } }),
      block("mass", "Mass", "mechanics", [input("force", "N")], [output("position", "m"), output("velocity", "m/s")], { picture: { kind: "text", text: "0.6 kg" }, settings: [setting("mass", "=mass", "0.6 kg", slider("axis.mass.mass", 0.6, "kg"))] })],
    wires: [...terms.map((from, i) => wire(from, "applied.terms", i, "N")), wire("applied.sum", "drive.u", 0, "N"), wire("drive.y", "lag.u", 0, "N"), wire("lag.y", "limit.u", 0, "N"), wire("limit.y", "mass.force", 0, "N"), wire("mass.velocity", "viscous.velocity", 0, "m/s"),
      ...effects.map((entry) => wire(entry.name === "cogging" ? "mass.position" : "mass.velocity", `${entry.name}.${entry.inputs[0].name}`))],
    inputs: [{ name: "force", unit: "N", description: "", offset: 0, end: 0 }], outputs: [{ name: "position", unit: "m", description: "", source: "mass.position", offset: 0, end: 0 }, { name: "velocity", unit: "m/s", description: "", source: "mass.velocity", offset: 0, end: 0 }],
    parameters: [], solver: [], log: [],
  };
}

const text = () => JSON.stringify({ loopwright: 1, title: "The loop, as believed", parameters: { mass: { value: state.mass, unit: "kg" } }, blocks: { reference: { type: "RecordedColumn" }, axis: { diagram: "axis.json", effects: state.added } } }, null, 2);
function document(inside, with_text = true) {
  const view = inside === "axis" ? axis() : top();
  view.places = view.blocks.map(() => [0, 0]);
  for (const entry of view.blocks) entry.position = state.positions[`${inside}.${entry.name}`] ?? null;
  const problems = state.mass < 0 ? [{ severity: "error", text: "mass is negative", message: "mass is negative", hint: "a mass is positive", file: "nominal.json", line: 5, column: 7, offset: 70, end: 75, pointer: "/parameters/mass", block: "axis", port: "", here: true }] : [];
  if (problems.length) view.blocks.forEach((entry) => { if (entry.name === "axis") entry.problems = [0]; });
  return { path: "nominal.json", revision: state.revision, ...(with_text ? { text: text() } : {}), saved: true, writable: true, conflict: null, undo: state.undo.at(-1)?.what ?? "", redo: state.redo.at(-1)?.what ?? "",
    loads: !problems.length, runs_alone: !problems.length, summary: "5 blocks, 2 states", problems, view };
}
const content = () => ({ mass: state.mass, added: [...state.added], positions: { ...state.positions } });
function change(what, action) {
  const before = text(), old = content();
  action();
  state.undo.push({ what, content: old });
  state.redo = [];
  return edits(before);
}
function edits(before) {
  ++state.revision;
  return before === text() ? [] : [{ from: 0, to: before.length, text: text() }];
}

// ---------- invented numbers ----------

const times = Array.from({ length: 601 }, (_, i) => i * 0.02);
const position = (t) => 0.15 * Math.sin(0.9 * t) * Math.sin(0.31 * t);
const hidden = () => (state.added.includes("cogging") ? 0 : 1) * 60e-6 + (state.added.includes("coulomb_friction") ? 0 : 1) * 38e-6 + 2e-6;
const noise = (i) => Math.sin(i * 12.9898) * 43758.5453 % 1;
const error = (size = hidden()) => times.map((t, i) => size * 1.3 * Math.sin(40 * position(t) * 20 + t) + 1.5e-6 * noise(i));
const rms = (values) => Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / values.length);
const signal = (name, unit, y, x = times) => ({ name, unit, steps: false, rms: rms(y), min: Math.min(...y), max: Math.max(...y), last: y.at(-1), x, y });
const runs = [];
function run({ set = {} }) {
  const mass = parseFloat(set.mass ?? state.mass);
  const w = 2 / mass, step = (t) => 0.1 * (1 - Math.exp(-w * t) * (Math.cos(3 * w * t) + Math.sin(3 * w * t) / 3));
  const signals = [signal("reference.value", "m", times.map((t) => (t > 0 ? 0.1 : 0))), signal("axis.position", "m", times.map(step)), signal("axis.velocity", "m/s", times.map((t) => (step(t + 0.01) - step(t)) / 0.01)), signal("controller.force", "N", times.map((t) => 3 * (0.1 - step(t))))];
  const answer = { run: runs.length + 1, path: "nominal.json", name: "", status: "finished", message: "", time: 12, wall: 0.0123, hash: "9ad0", command: "loopwright run nominal.json", warnings: [], summary: "", verdict: [{ severity: "good", text: "axis.position follows reference.position" }], set, signals };
  runs.push(answer);
  return answer;
}
function comparison() {
  const e = error(), measured = times.map(position), force = hidden() * 1800;
  return { comparison: 1, title: "The whole loop driven by the recorded reference", status: "finished", message: "", warnings: [], text: "", signals: [{ name: "axis.position", unit: "m", rmse: rms(e), max: Math.max(...e), fit: 99, relative: 0.1, resolution: 2e-7, x: times, measured, simulated: measured.map((m, i) => m + e[i]), error: e }],
    residual: ["time", "position", "velocity"].map((against) => ({ against, unit: { time: "s", position: "m", velocity: "m/s" }[against], of: "missing force", residual_unit: "N", points: against !== "time",
      x: times.map((t) => (against === "time" ? t : against === "position" ? position(t) : (position(t + 0.01) - position(t)) / 0.01)), y: times.map((t, i) => force * Math.sin(2 * Math.PI * position(t) / 0.01125) + 0.006 * noise(i)) })),
    force: { rmse: force, relative: 12, noise_floor: 0.006, unit: "N", where: [], dependence: [{ variable: "position", share: 0.61 }, { variable: "velocity", share: 0.35 }], faults: [] }, why_no_force: "",
    tint: [{ block: "axis", share: 0.94, text: "94 % of the missing force depends on the position of axis" }, { block: "controller", share: 0.06, text: "6 %" }] };
}
const card = (effect, title, parameters, force, more = {}) => ({ effect, form: "", title, physics: "A force periodic in position.", inclusion: 0.995, force, unit: "N", optional: false, parameters, rivals: [], error_with: 0.09, addable: true, why_not: "", ...more });
const value = (name, number, low, high, unit, shown) => ({ name, value: number, low, high, unit, text: shown, at_limit: false });
const diagnosis = () => ({ diagnosis: 1, verdict: "explained", title: "Two effects are missing, and with them the record is explained down to its noise", text: "Missing …", error_before: 0.151, error_after: 0.0057, noise_floor: 0.00576, unit: "N", holds_out: true,
  steps: [{ added: [], error: 0.151 }, { added: ["cogging"], error: 0.0927 }, { added: ["coulomb_friction"], error: 0.0057 }],
  cards: [card("cogging", "Cogging", [value("amplitude", 0.1697, 0.169, 0.1705, "N", "169.7 mN"), value("pitch", 0.01125, 0.0112494, 0.01125, "m", "11.25 mm")], 0.1205), card("coulomb_friction", "Coulomb friction", [value("level", 0.0925, 0.0918, 0.0932, "N", "92.51 mN")], 0.0925, { physics: "Dry friction of constant level.", rivals: ["stribeck_friction"] })],
  other_explanations: [], suggested: [], findings: [], not_looked_for: [{ effects: ["end_stop"], why: "the record does not reach the ends" }], unknown: null, curves: null });

// ---------- the protocol ----------

const columns = { data: "held_out.csv", rows: 12001, time: "time_s", sample_time: 0.001, start: 0, stop: 12, columns: [
  { column: "time_s", name: "time", unit: "s", min: 0, max: 12, use: "time", port: "", why: "rises steadily", resolution: "", interpolation: "", candidates: [] },
  { column: "reference_m", name: "reference", unit: "m", min: -0.1, max: 0.1, use: "drive", port: "controller.reference", why: "name and unit", resolution: "", interpolation: "hold", candidates: ["controller.reference"] },
  { column: "force_N", unit_is_stated: false, name: "force", unit: "N", min: -2, max: 2, use: "ignore", port: "", why: "", resolution: "", interpolation: "hold", candidates: ["axis.force"] },
  { column: "position_m", name: "position", unit: "m", min: -0.1, max: 0.1, use: "compare", port: "axis.position", why: "name and unit", resolution: "200 nm", interpolation: "linear", candidates: ["axis.position"] }],
  ports: [{ port: "axis.position", unit: "m", input: false }, { port: "axis.velocity", unit: "m/s", input: false }, { port: "axis.net_force", unit: "N", input: false }, { port: "axis.force", unit: "N", input: true }, { port: "controller.reference", unit: "m", input: true }],
  roles: [{ role: "position", port: "axis.position", why: "" }, { role: "velocity", port: "axis.velocity", why: "" }, { role: "force", port: "axis.net_force", why: "" }, { role: "input", port: "axis.force", why: "" }], hold_out: 0.25, experiment: "held_out.experiment.json", exists: false };
const PALETTE = [["Gain", "math", "Multiplies a signal by a number."], ["Sum", "math", "Adds and subtracts any number of signals."], ["Saturation", "math", "Holds a signal within limits."], ["CoulombFriction", "mechanics", "Dry friction of constant level."]].map(([type, room, sentence]) => ({ type, room, sentence, why: "" }));
const refuse = (why) => { throw Object.assign(new Error(why), { refused: true }); };

const answers = {
  hello: () => ({ version: "0.1.0", folder: "demo", open: "nominal.json", files: [{ path: "nominal.json", kind: "diagram", title: "The loop, as believed" }, { path: "train.experiment.json", kind: "experiment", title: "The axis driven by the recorded force" }, { path: "held_out.csv", kind: "record", title: "" }] }),
  files: () => ({ files: answers.hello().files }),
  open: ({ inside = "" }) => document(inside),
  edit: ({ intents, inside }) => {
    let blocks = [];
    const made = change(intents[0].intent.replace("_", " "), () => {
      for (const intent of intents) {
        if (intent.intent === "set_parameter") { state.mass = parseFloat(intent.text); }
        else if (intent.intent === "move") for (const [name, place] of Object.entries(intent.positions)) { if (place) state.positions[`${inside}.${name}`] = place; else delete state.positions[`${inside}.${name}`]; }
        else refuse(`the stand-in does not know "${intent.intent}"`);
      }
    });
    return { edits: made, document: document(inside, false), blocks };
  },
  undo: ({ inside = "" }) => step("undo", "redo", inside), redo: ({ inside = "" }) => step("redo", "undo", inside),
  find_blocks: ({ text: words = "" }) => ({ types: PALETTE.filter((entry) => entry.type.toLowerCase().includes(words.toLowerCase())) }),
  type: ({ type }) => ({ type, room: "math", sentence: "A block.", inputs: [{ name: "u", unit: "", sentence: "", many: false, optional: false }], outputs: [port("y", "")], settings: [], help: `${type}\n  as loopwright blocks ${type}` }),
  complete: ({ offset }) => ({ from: offset, to: offset, options: [] }), hover: ({ offset }) => ({ from: offset, to: offset, text: "", block: "" }),
  run, runs: () => ({ runs: runs.map(({ run: number, name, hash, command, set, signals }) => ({ run: number, name, note: "", when: "", hash, command, set, file_changed: false, merit: signals.map((entry) => ({ name: entry.name, unit: entry.unit, rms: entry.rms, max: entry.max })) })) }),
  name_run: ({ run: number, name }) => { runs[number - 1].name = name; return {}; },
  signals: ({ source, names, from = -Infinity, to = Infinity }) => {
    const all = source.startsWith("run:") ? runs[Number(source.slice(4)) - 1].signals : comparison().signals.flatMap((entry) => ["measured", "simulated", "error"].map((what) => signal(`${what} ${entry.name}`, entry.unit, entry[what])));
    return { signals: all.filter((entry) => !names.length || names.includes(entry.name)).map((entry) => { const kept = entry.x.map((_, i) => i).filter((i) => entry.x[i] >= from && entry.x[i] <= to); return signal(entry.name, entry.unit, kept.map((i) => entry.y[i]), kept.map((i) => entry.x[i])); }) };
  },
  columns: () => columns, write_experiment: ({ experiment }) => ({ experiment, text: "{}", problems: [] }), compare: comparison,
  preview: ({ effects }) => { const left = Math.max(2e-6, hidden() - (effects.includes("cogging") ? 60e-6 : 0) - (effects.includes("coulomb_friction") ? 38e-6 : 0)); const y = error(left); return { x: times, y, unit: "m", rmse: rms(y), signal: "axis.position" }; },
  add_effects: ({ effects, inside }) => { const names = effects.length ? effects : ["cogging", "coulomb_friction"]; const made = change(`add ${names.join(" and ")}`, () => { state.added = [...new Set([...state.added, ...names])]; }); return { edits: made, document: document(inside, false), blocks: inside ? names : ["axis"], others: [] }; },
  linearize: ({ from, to, break: cut }) => {
    const frequency = Array.from({ length: 200 }, (_, i) => 10 ** (i / 50));
    return { is_loop_gain: Boolean(cut) && to === from, sampled: true, sample_time: 0.001, frequency, magnitude_db: frequency.map((w) => -20 * Math.log10(w)), phase_deg: frequency.map((w) => -90 - Math.atan(w / 100) * 57.3), nyquist: { re: [0], im: [0], circle: null },
      poles: [{ re: 0.9, im: 0.1, frequency: 23, damping: 0.7, stability: "stable" }, { re: 1.2, im: 0, frequency: 29, damping: -1, stability: "unstable" }], zeros: [],
      margins: cut ? { port: cut, stable: true, gain_db: 12, lower_gain_db: null, phase_deg: 60, crossover: 10, delay: null, Ms: 1.4 } : null, text: "" };
  },
};
function step(from, to, inside) {
  const last = state[from].pop();
  if (!last) refuse(`nothing to ${from}`);
  const before = text();
  state[to].push({ what: last.what, content: content() });
  Object.assign(state, last.content);
  return { edits: edits(before), document: document(inside, false), blocks: [] };
}
async function diagnose(socket, request, cancelled) {
  const steps = diagnosis().steps;
  for (let i = 0; i < steps.length; ++i) {
    socket.send(JSON.stringify({ id: request.id, progress: { stage: "searching", done: i / steps.length } }));
    socket.send(JSON.stringify({ id: request.id, partial: { steps: steps.slice(0, i + 1) } }));
    await new Promise((resolve) => setTimeout(resolve, 500));
    if (cancelled.has(request.id)) { socket.send(JSON.stringify({ id: request.id, dropped: true })); return; }
  }
  socket.send(JSON.stringify({ id: request.id, ok: diagnosis() }));
}

export function serve(folder, port) {
  const server = createServer((request, response) => {
    if (request.method === "PUT") { request.resume(); request.on("end", () => response.end(JSON.stringify({ path: decodeURIComponent(new URL(request.url, "http://x").pathname.slice(6)) }))); return; }
    const name = request.url.split("?")[0] === "/" ? "index.html" : request.url.split("?")[0].slice(1);
    if (!/^[a-z.-]+$/.test(name)) { response.writeHead(404).end(); return; }
    try {
      const body = readFileSync(join(folder, name));
      response.writeHead(200, { "Content-Type": TYPES[name.split(".").pop()] ?? "text/plain", "Content-Security-Policy": POLICY, "Cache-Control": "no-store" }).end(body);
    } catch { response.writeHead(404).end(); }
  });
  const sockets = new WebSocketServer({ server, path: "/socket" });
  sockets.on("connection", (socket) => {
    const cancelled = new Set();
    socket.on("message", (data) => {
      const request = JSON.parse(String(data));
      if (request.do === "cancel") { cancelled.add(request.job); return; }
      if (request.do === "diagnose") { void diagnose(socket, request, cancelled); return; }
      try {
        const answer = answers[request.do];
        if (!answer) refuse(`the stand-in does not know "${request.do}"`);
        socket.send(JSON.stringify({ id: request.id, ok: answer(request) }));
      } catch (failure) {
        if (!failure.refused) console.error(failure);
        socket.send(JSON.stringify({ id: request.id, error: { text: failure.message, problems: [] } }));
      }
    });
  });
  return new Promise((resolve) => server.listen(port, "127.0.0.1", () => resolve({ server, port: server.address().port, close: () => { for (const client of sockets.clients) client.terminate(); server.close(); } })));
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const folder = process.argv[2] ?? join(dirname(fileURLToPath(import.meta.url)), "../../../../tools/studio/web/build");
  const { port } = await serve(folder, Number(process.argv[3] ?? 8095));
  console.log(`http://127.0.0.1:${port}/`);
}
