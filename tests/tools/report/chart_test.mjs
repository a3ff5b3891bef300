// The layout of charts of state machines: nothing overlaps, whatever the machine is.
//   node --test chart_test.mjs
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { test } from "node:test";
import { drawChart } from "../../../tools/report/page/chart_drawing.js";
import { layOutChart, wrapped } from "../../../tools/report/page/chart_layout.js";
import { FONT, textWidth } from "../../../tools/report/page/diagram_text.js";

const ELK = createRequire(new URL("../../../tools/report/package.json", import.meta.url))("elkjs/lib/elk.bundled.js");
const elk = new ELK(), MACHINES = 150;

/** Numbers in [0, 1), the same in every run (mulberry32). */
function randomNumbers(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

const GUARDS = ["", "start", "position > reach", "switch && after(0.5 s)", "abs(error) > a_long_name_of_a_parameter || temperature > another_long_name && !acknowledge",
  "a_name_without_any_blank_that_is_wider_than_the_widest_line_of_a_guard > 3"];

/** A machine with nested states and transitions between any two of them, also to itself, into and out of others. */
function randomMachine(random) {
  const whole = (n) => Math.floor(random() * n), count = 1 + whole(12), states = [], transitions = [];
  for (let k = 0; k < count; ++k)
    states.push({ name: `state_${k}`, parent: k > 0 && random() < 0.5 ? whole(k) : -1, initial: false,
                  entries: Array.from({ length: whole(4) }, (_, n) => `output_${n} = ${whole(100)} mm/s`) });
  for (let parent = -1; parent < count; ++parent) {
    const first = states.find((state) => state.parent === parent);
    if (first) first.initial = true;
  }
  for (let k = whole(2 * count + 1); k > 0; --k)
    transitions.push({ from: whole(count), to: whole(count), guard: GUARDS[whole(GUARDS.length)], order: whole(3) });
  return { states, transitions };
}

const apart = (a, b) => a.x + a.width <= b.x + 0.1 || b.x + b.width <= a.x + 0.1 || a.y + a.height <= b.y + 0.1 || b.y + b.height <= a.y + 0.1;
const within = (a, b) => a.x >= b.x - 0.1 && a.y >= b.y - 0.1 && a.x + a.width <= b.x + b.width + 0.1 && a.y + a.height <= b.y + b.height + 0.1;

function contains(states, outer, inner) {
  for (let k = inner; k >= 0; k = states[k].parent) if (k === outer) return true;
  return false;
}

/** The room that the texts of a state take: all of a plain state, the head of one that contains others. */
const head = (state) => ({ ...state, height: state.isOuter ? 22 + 15 * (state.title.length - 1 + state.lines.length) : state.height });

function faultsOf(machine, chart) {
  const faults = [], name = (state) => machine.states[state.index].name, picture = { x: 0, y: 0, width: chart.width, height: chart.height };
  assert.equal(chart.states.length, machine.states.length);
  assert.equal(chart.transitions.length, machine.transitions.length);
  for (const state of chart.states) {
    if (!within(state, picture)) faults.push(`${name(state)} is clipped`);
    for (const [lines, isBold] of [[state.title, true], [state.lines, false]])
      for (const line of lines) if (textWidth(line, FONT.name, isBold) > state.width - 4) faults.push(`"${line}" leaves ${name(state)}`);
    for (const other of chart.states) {
      if (other.index <= state.index) continue;
      if (contains(machine.states, state.index, other.index)) {
        if (!within(other, state)) faults.push(`${name(other)} leaves ${name(state)}`);
        if (!apart(head(state), other)) faults.push(`${name(other)} covers the head of ${name(state)}`);
      } else if (!apart(state, other)) faults.push(`${name(state)} overlaps ${name(other)}`);
    }
  }
  chart.transitions.forEach(({ index, label, points }, k) => {
    const { from, to } = machine.transitions[index];
    if (!within(label, picture)) faults.push(`guard ${index} is clipped`);
    for (const state of chart.states) if (!state.isOuter && !apart(label, state)) faults.push(`guard ${index} covers ${name(state)}`);
    for (const other of chart.transitions.slice(k + 1)) if (!apart(label, other.label)) faults.push(`guards ${index} and ${other.index} overlap`);
    const ends = [points[0][0], points.at(-1).at(-1)], boxes = [from, to].map((s) => chart.states.find((state) => state.index === s));
    ends.forEach((end, side) => {
      const box = boxes[side], at = { ...end, width: 0, height: 0 }, grown = { x: box.x - 1, y: box.y - 1, width: box.width + 2, height: box.height + 2 };
      if (!within(at, grown)) faults.push(`transition ${index} does not ${side ? "end" : "begin"} at ${name(box)}`);
    });
  });
  return faults;
}

test("nothing overlaps in charts of random machines, and transitions join their states", async () => {
  const random = randomNumbers(1), faulty = [];
  for (let k = 0; k < MACHINES; ++k) {
    const machine = randomMachine(random), faults = faultsOf(machine, await layOutChart(elk, machine));
    if (faults.length > 0) faulty.push(`machine ${k}: ${faults.join("; ")}`);
  }
  assert.deepEqual(faulty, []);
});

test("the initial state stands at the top, and what follows below", async () => {
  const states = ["last", "first", "second"].map((name, k) => ({ name, parent: -1, initial: k === 1, entries: [] }));
  const chart = await layOutChart(elk, { states, transitions: [
    { from: 1, to: 2, guard: "go", order: 0 }, { from: 2, to: 0, guard: "after(1 s)", order: 0 }, { from: 0, to: 1, guard: "", order: 0 }] });
  const top = (name) => chart.states.find((state) => state.title[0] === name).y;
  assert.ok(chart.dots[0].y < top("first") && top("first") < top("second") && top("second") < top("last"));
  assert.match(drawChart(chart), />always<\/text>/);
});

test("a guard is broken into lines, and nothing of it is lost", () => {
  for (const guard of GUARDS) {
    const lines = wrapped(guard, FONT.port, 120);
    assert.equal(lines.join("").replaceAll(" ", ""), guard.replaceAll(" ", ""));
    for (const line of lines) assert.ok(textWidth(line, FONT.port) <= 120, line);
  }
});

test("names of any kind are harmless", async () => {
  const states = [{ name: "<script>alert(1)</script>", parent: -1, initial: true, entries: ["a = \"<b>\""] }];
  const svg = drawChart(await layOutChart(elk, { states, transitions: [{ from: 0, to: 0, guard: "a < b && c > d", order: 0 }] }));
  assert.doesNotMatch(svg, /<script|<b>/);
  assert.match(svg, /a &lt; b/);
});
