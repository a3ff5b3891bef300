// Times of the studio in chromium with the program:  node studio.mjs REPORT.json
// Environment: LOOPWRIGHT, HIDDEN_EFFECTS and LOOPWRIGHT_SOURCE. Adds the keys studio_* to the report, each with its bar; the exit code is 1 if one
// is missed. STUDIO_PARTS names parts, of edits, loop and record; STUDIO_ROWS is the length of the record. Times are taken in the page: from the input event to the answer on the WebSocket, and to the frame after the one that shows it.
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { loadavg, tmpdir } from "node:os";
import { join } from "node:path";
import { launch } from "../tools/studio/web/browser.mjs";
import { start_studio } from "../tools/studio/web/program.mjs";

const SOURCE = process.env.LOOPWRIGHT_SOURCE;
const folder = mkdtempSync(join(tmpdir(), "loopwright_studio_benchmark_"));
const figures = {};
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
function report(key, value, bar, measured, details = {}) {
  figures[key] = { value: Number(value.toPrecision(4)), bar, met: value <= bar, measured, load: Number(loadavg()[0].toFixed(1)), ...details };
  console.log(`${key} ${value.toPrecision(4)}, bar ${bar}${value <= bar ? "" : "  MISSED"}`);
}

/** In the page: `answered` and `painted` of the last request of each kind, in ms since `begun`. */
function take_times() {
  const sent = new Map();
  window.times = { begun: 0, answered: {}, painted: {} };
  for (const kind of ["keydown", "input", "wheel", "mouseup"]) addEventListener(kind, () => { window.times.begun = performance.now(); }, { capture: true });
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (text) {
    const message = JSON.parse(text);
    sent.set(message.id, message.do);
    if (!this.watched) {
      this.watched = true;
      this.addEventListener("message", (event) => {
        const { id, ok } = JSON.parse(event.data), kind = sent.get(id);
        if (!kind || ok === undefined) return;
        const begun = window.times.begun;
        window.times.answered[kind] = performance.now() - begun;
        requestAnimationFrame(() => setTimeout(() => { window.times.painted[kind] = performance.now() - begun; }));
      });
    }
    send.call(this, text);
  };
}

async function open(browser, file) {
  const studio = start_studio(file), address = await studio.address;
  const context = await browser.newContext({ viewport: { width: 1400, height: 900 } });
  const page = await context.newPage();
  await page.addInitScript(take_times);
  await page.goto(address);
  await page.waitForSelector(".block", { timeout: 120000 });
  return { page, studio, close: async () => { await context.close(); await studio.stop(); } };
}
/** Carries out one action, and returns when its request of this kind was answered and painted. */
async function timed(page, kind, act) {
  await page.evaluate((name) => { delete window.times.answered[name]; delete window.times.painted[name]; }, kind);
  await act();
  await page.waitForFunction((name) => window.times.painted[name] !== undefined, kind, { timeout: 60000 });
  return page.evaluate((name) => [window.times.answered[name], window.times.painted[name]], kind);
}
const status_of = (pid, key) => Number(new RegExp(`${key}:\\s*(\\d+)`).exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]);
const ticks_of = (pid) => { const words = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" "); return Number(words[11]) + Number(words[12]); };

/** A chain of gains; every tenth block is a sum that takes what was five blocks earlier, too. */
function chain(count) {
  const blocks = { source: { type: "Sine", amplitude: 1, frequency: { value: 1, unit: "Hz" } } };
  let from = "source.y";
  for (let i = 1; i < count; ++i) {
    const name = `b${i}`;
    blocks[name] = i % 10 ? { type: "Gain", gain: 1.01, in: { u: from } } : { type: "Sum", signs: "+-", in: { terms: [from, `b${i - 5}.y`] } };
    from = i % 10 ? `${name}.y` : `${name}.sum`;
  }
  const path = join(folder, `chain_${count}.json`);
  writeFileSync(path, JSON.stringify({ loopwright: 1, solver: { method: "rk4", step: 0.01, stop: 1 }, blocks, log: [from] }, null, 1));
  return path;
}

async function edits(browser, count) {
  const { page, close } = await open(browser, chain(count));
  await page.waitForSelector(`[data-block=b${count - 1}]`, { timeout: 60000, state: "attached" });
  await page.waitForSelector(".plot canvas", { timeout: 60000, state: "attached" });
  await page.locator("[data-block=b5]").first().dispatchEvent("click");  // too small for the mouse where all blocks are seen
  const field = page.locator("[aria-label='gain of b5']");
  const answered = [], painted = [];
  for (let i = 0; i < 15; ++i) {
    await field.fill(`1.${100 + i}`);
    const [a, p] = await timed(page, "edit", () => field.press("Enter"));
    answered.push(a), painted.push(p);
  }
  await close();
  return { answered: median(answered), painted: median(painted) };
}

async function loop(browser) {
  const { page, studio, close } = await open(browser, join(SOURCE, "diagrams/linear_motor/ps.json"));
  await page.waitForSelector(".plot canvas");
  const bytes = await page.evaluate(() => [...performance.getEntriesByType("navigation"), ...performance.getEntriesByType("resource")]
    .filter((entry) => !/worker/.test(entry.name)).reduce((sum, entry) => sum + entry.encodedBodySize, 0));
  report("studio_first_page_kib", bytes / 1024, 350, "encoded bytes of the first page without the layout worker");
  const slider = page.locator("input[type=range]").first();
  await slider.focus();
  const times = [];
  for (let i = 0; i < 30; ++i) times.push((await timed(page, "run", () => page.keyboard.press(i % 2 ? "ArrowLeft" : "ArrowRight")))[1]);
  report("studio_slider_ms", median(times), 150, "from a step of a slider of the PS loop to the frame with its new curves, median of 30", { slowest: Math.max(...times) });
  await page.waitForTimeout(2000);
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable");
  const busy = async () => (await session.send("Performance.getMetrics")).metrics.find((metric) => metric.name === "TaskDuration").value;
  const before = [ticks_of(studio.pid), await busy()];
  await page.waitForTimeout(5000);
  const used = (ticks_of(studio.pid) - before[0]) / 100, page_used = (await busy()) - before[1];
  report("studio_idle_share", (used + page_used) / 5, 0.005, "processor time of program and page over 5 s in which nobody does anything", { program_s: used, page_s: page_used });
  report("studio_memory_mib", status_of(studio.pid, "VmHWM") / 1024, 150, "largest resident memory of the program with the PS loop open");
  await close();
}

/** 10⁷ rows of a recorded input and a measured position. */
async function long_record(browser, rows = 1e7) {
  const step = 1e-3, text = [];
  const { createWriteStream } = await import("node:fs");
  const out = createWriteStream(join(folder, "record.csv"));
  out.write("time [s],u [N],x [m]\n");
  for (let i = 0; i < rows; ++i) {
    text.push(`${(i * step).toFixed(3)},${Math.sin(i * 0.01).toFixed(4)},${(Math.sin(i * 0.003) * 1e-3).toFixed(7)}`);
    if (text.length === 100000 || i === rows - 1) {
      if (!out.write(text.join("\n") + "\n")) await new Promise((done) => out.once("drain", done));
      text.length = 0;
    }
  }
  await new Promise((done) => out.end(done));
  writeFileSync(join(folder, "mass.json"), JSON.stringify({ loopwright: 1, solver: { method: "rk4", step, stop: 1 },
    blocks: { actuator: { type: "Gain", gain: 1, in: { u: "push.y" } }, push: { type: "Sine", amplitude: { value: 1, unit: "N" }, frequency: { value: 1, unit: "Hz" } },
      spring: { type: "Spring", stiffness: 1000, in: { position: "mass.position" } }, damping: { type: "ViscousFriction", damping: 5, in: { velocity: "mass.velocity" } },
      force: { type: "Sum", signs: "+--", in: { terms: ["actuator.y", "spring.force", "damping.force"] } }, mass: { type: "Mass", mass: 1, in: { force: "force.sum" } } }, log: ["mass.position"] }));
  writeFileSync(join(folder, "record.experiment.json"), JSON.stringify({ loopwright: 1, data: "record.csv", time: "time",
    drive: { "actuator.u": { column: "u" } }, compare: { "mass.position": { column: "x" } } }));
  const { page, close } = await open(browser, join(folder, "mass.json"));
  await page.waitForSelector(".plot canvas");
  await page.click("#tab-measure");
  const begun = Date.now();
  await page.click("button.entry:has-text('record')");
  await page.waitForSelector("[data-rmse]", { timeout: 300000 });
  const opened = (Date.now() - begun) / 1000;
  const plot = page.locator(".plot .u-over").first(), box = await plot.boundingBox(), times = [], answered = [];
  for (let i = 0; i < 12; ++i) {
    const [from, to] = [box.x + box.width * 0.25, box.x + box.width * 0.75], y = box.y + box.height / 2;
    await page.mouse.move(from, y);
    await page.mouse.down();
    await page.mouse.move(to, y, { steps: 3 });
    const [answer, paint] = await timed(page, "signals", () => page.mouse.up());
    answered.push(answer), times.push(paint);
  }
  report("studio_zoom_ms", Math.max(...times), 150, "slowest of 12 zooms, each to half of what is seen, of a compared record of 10^7 rows, to the frame that shows it", { median: median(times), slowest_answer: Math.max(...answered), opened_s: opened, rows });
  await close();
}

async function all_edits(browser) {
  const small = await edits(browser, 200), large = await edits(browser, 1000);
  report("studio_edit_200_answer_ms", small.answered, 50, "from Enter in a field to the answer of the program, diagram of 200 blocks, median of 15");
  report("studio_edit_200_paint_ms", small.painted, 100, "the same, to the frame that shows it");
  report("studio_edit_1000_paint_ms", large.painted, 300, "the same, diagram of 1000 blocks", { answered: large.answered });
}

const browser = await launch();
const parts = { edits: all_edits, loop, record: (opened) => long_record(opened, Number(process.env.STUDIO_ROWS ?? 1e7)) };
try {
  for (const [name, measure] of Object.entries(parts)) if ((process.env.STUDIO_PARTS ?? name).split(",").includes(name)) await measure(browser);
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
const path = process.argv[2];
const all = path && existsSync(path) ? JSON.parse(readFileSync(path, "utf8")) : {};
if (path) writeFileSync(path, JSON.stringify({ ...all, ...figures }, null, 2) + "\n");
process.exit(Object.values(figures).every((figure) => figure.met) ? 0 : 1);
