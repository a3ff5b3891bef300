// The scene of the studio with the real program in real chromium:  LOOPWRIGHT=… HIDDEN_EFFECTS=… node --test scene_test.mjs
// SCENE_PICTURES names a folder for pictures of it.
import assert from "node:assert/strict";
import { copyFileSync, existsSync, mkdirSync, readFileSync, unlinkSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { contrast_faults, unnamed } from "./accessibility.mjs";
import { launch, open_page } from "./browser.mjs";
import { hidden_axis, start_studio } from "./program.mjs";

const PICTURES = process.env.SCENE_PICTURES;
const FOUND = 120000;                 // ms: the longest that a diagnosis may take on a slow machine
let browser, axis;
before(async () => { browser = await launch(); axis = hidden_axis(); });
after(async () => { await browser.close(); axis.remove(); });

const take = async (page, name) => {
  if (!PICTURES) return;
  mkdirSync(PICTURES, { recursive: true });
  await page.waitForTimeout(700);
  await page.screenshot({ path: join(PICTURES, `${name}.png`) });
};
const rmse = (page) => page.locator("[data-rmse]").first().getAttribute("data-rmse").then(Number);
const falls_below = (page, bound) => page.waitForFunction((limit) => { const shown = document.querySelector("[data-rmse]"); return shown && Number(shown.dataset.rmse) < limit; }, bound, { timeout: 30000 });

async function drop(page, file, name) {
  const bytes = readFileSync(file).toString("base64");
  await page.evaluate(({ bytes, name }) => {
    const data = Uint8Array.from(atob(bytes), (letter) => letter.charCodeAt(0)), transfer = new DataTransfer();
    transfer.items.add(new File([data], name, { type: "text/csv" }));
    for (const kind of ["dragenter", "dragover", "drop"]) document.body.dispatchEvent(new DragEvent(kind, { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }, { bytes, name });
}

test("see the diagram, run it while dragging, compare, diagnose, add both effects, watch the error fall, undo", async () => {
  const original = readFileSync(axis.path("nominal.json"));
  const studio = start_studio(axis.path("nominal.json"));
  try {
    const { page, faults, context } = await open_page(browser, await studio.address);
    await page.waitForSelector(".block[data-block=axis]");
    await page.waitForSelector(".plot canvas");
    assert(!page.url().includes("token"), "the token does not stay in the address");
    await take(page, "1_diagram");

    // The axis from inside; its mass has a slider.
    await page.dblclick("[data-block=axis]");
    await page.waitForSelector("[data-block=mass]");
    await take(page, "2_inside");
    const slider = page.locator("[data-parameter=mass] input[type=range]");
    await slider.focus();
    for (let i = 0; i < 10; ++i) await page.keyboard.press("ArrowRight");
    await page.waitForSelector(".legend li.ghost");
    await page.click(".override button:has-text('Reset')");
    await page.click(".levels button:has-text('top')");
    await page.waitForSelector("[data-block=controller]");

    // The record of the closed loop: another motion than the diagnosis uses.
    await page.click("#tab-measure");
    await page.click("button.entry:has-text('closed_loop')");
    await page.waitForSelector("[data-rmse]", { timeout: 30000 });
    const at_first = await rmse(page);
    assert(at_first > 60e-6 && at_first < 80e-6, `about 71 µm, not ${at_first}`);
    await take(page, "3_compared");

    // It lacks the force; the record of the axis alone says what is missing.
    await page.click("button:has-text('What is missing?')");
    await page.click(".panel button.entry:has-text('train.experiment')");
    await page.waitForSelector(".card[data-effect*=coulomb]", { timeout: FOUND });
    await page.waitForSelector(".card[data-effect=cogging]");
    assert.equal(await page.locator(".card[data-effect]").count(), 2);
    await take(page, "4_diagnosed");
    await page.hover(".card[data-effect=cogging]");
    await page.waitForSelector(".legend li.preview", { timeout: 30000 });
    await take(page, "5_preview");
    await page.click("button:has-text('Add all 2')");
    await page.waitForSelector("[data-block=axis].highlighted", { timeout: 30000 });
    await falls_below(page, 5e-6);
    await take(page, "6_added");
    assert.notDeepEqual(readFileSync(axis.path("nominal.json")), original, "the effects are in the file");
    await page.dblclick("[data-block=axis]");
    await page.waitForSelector("[data-type=PreslidingFriction], [data-type=CoulombFriction]");
    await take(page, "7_inside");
    await page.click(".levels button:has-text('top')");

    await page.click("button[aria-label=Undo]");
    await page.waitForFunction((before) => Math.abs(Number(document.querySelector("[data-rmse]").dataset.rmse) - before) < 1e-12, at_first, { timeout: 30000 });
    assert.deepEqual(readFileSync(axis.path("nominal.json")), original, "undo brings back the same bytes");
    await page.click("button[aria-label=Redo]");
    await falls_below(page, 5e-6);
    await page.click("button[aria-label=Undo]");
    await page.waitForFunction(() => document.querySelector("button[aria-label=Undo]").disabled);
    assert.deepEqual(readFileSync(axis.path("nominal.json")), original);
    assert.deepEqual(await page.evaluate(contrast_faults), []);
    assert.deepEqual(await page.evaluate(unnamed), []);
    assert.deepEqual(faults, []);
    await context.close();
  } finally { await studio.stop(); }
});

test("every analysis is with the numbers of the sliders; a loop is cut or closed as chosen; a sweep has the range that was typed", async () => {
  const studio = start_studio(axis.path("nominal.json"));
  try {
    const address = await studio.address;
    const { page, faults, context } = await open_page(browser, "about:blank", { width: 1280, height: 800 });
    const sent = [];
    page.on("websocket", (socket) => socket.on("framesent", ({ payload }) => sent.push(JSON.parse(String(payload)))));
    await page.goto(address);
    await page.waitForSelector(".plot canvas");
    await page.waitForSelector("[data-id='axis.force#0'] .react-flow__edge-path", { state: "attached" });
    const outcome = page.locator(".outcome").first();
    if (await outcome.count()) assert.equal(await outcome.evaluate((line) => getComputedStyle(line).textOverflow), "ellipsis");

    const select_wire = () => page.evaluate(() => document.querySelector("[data-id='axis.force#0'] .react-flow__edge-path").dispatchEvent(new MouseEvent("click", { bubbles: true })));
    await select_wire();
    assert.match(await page.locator("select[name=to] option").first().textContent(), /controller\.force/, "the wire's own source: once around the loop");
    await page.click("button:has-text('Open loop')");
    await page.waitForSelector(".margins:has-text('Phase margin')");
    assert.match(await page.locator(".outcome").textContent(), /Open loop, cut at axis\.force/);
    assert.match(await page.locator(".lists h3").first().textContent(), /in z, sampled every/);
    assert.equal(await page.locator(".legend li:has-text('circle of radius 1/Ms')").count(), 1);
    await take(page, "11_open_loop");
    const open_loop = sent.filter((message) => message.do === "linearize").at(-1);
    assert.equal(open_loop.break, "axis.force");
    await page.click("button:has-text('Closed loop')");
    await page.waitForSelector(".outcome:has-text('all loops closed')");
    assert.equal(await page.locator(".margins").count(), 0);
    assert.equal(await page.locator(".poles .unstable").count(), 0, "poles in the unit circle are not unstable");
    assert.equal(await page.locator(".plot canvas").count(), 3);
    await take(page, "12_closed_loop");

    // A slider of a part that another file defines: nothing to write here, but the way to that file.
    await page.dblclick("[data-block=axis]");
    await page.waitForSelector("[data-parameter=mass]");
    const analyses = sent.filter((message) => message.do === "linearize").length;
    await page.locator("[data-parameter=mass] input[type=range]").focus();
    for (let i = 0; i < 10; ++i) await page.keyboard.press("ArrowRight");
    await page.waitForSelector(".override button:has-text('Open axis.json')");
    const moved_to = parseFloat(await page.locator("[data-parameter=mass] .override output").textContent());
    assert.equal(await page.locator(".override button:has-text('Write')").count(), 0);
    await page.waitForFunction(() => document.querySelector(".outcome")?.textContent.includes("with axis.mass"));
    assert(sent.filter((message) => message.do === "linearize").length > analyses, "the analysis follows the slider");
    await page.click(".levels button:has-text('top')");
    await page.waitForSelector("[data-block=controller]");
    await page.evaluate(() => document.querySelector(".react-flow__pane").click());

    // The address is written a moment after the page has settled: until then it may name a place that the slider has passed.
    await page.waitForFunction((value) => parseFloat(new URLSearchParams(location.hash.slice(1)).get("set.axis.mass")) === value, moved_to);
    const set = Object.fromEntries([...new URLSearchParams(new URL(page.url()).hash.slice(1))].filter(([key]) => key.startsWith("set.")).map(([key, value]) => [key.slice(4), value]));
    assert.deepEqual(Object.keys(set), ["axis.mass"]);
    const first = sent.length, value = parseFloat(set["axis.mass"]);
    await page.waitForSelector("select[name=x]");
    await page.selectOption("select[name=x]", "axis.mass");
    assert(Math.abs(Number(await page.inputValue("input[name=x_low]")) / value - 0.5) < 1e-3, "from half of the value");
    assert(Math.abs(Number(await page.inputValue("input[name=x_high]")) / value - 2) < 1e-3);
    await page.fill("input[name=x_low]", "-0.1");
    await page.click("button:has-text('Sweep')");
    await page.waitForSelector(".sweep td button.failed", { timeout: 60000 });
    assert(await page.locator(".sweep td button:not(.failed)").count() > 100, "a mass below zero is a gap, the others have values");
    assert(await page.locator(".bar .chip").isVisible());
    await take(page, "13_sweep");
    assert.deepEqual(await page.evaluate(contrast_faults), []);
    assert.deepEqual(await page.evaluate(unnamed), []);

    await page.click("#tab-measure");
    await page.click("button.entry:has-text('train')");
    await page.waitForSelector("[data-rmse]", { timeout: 30000 });
    assert(await page.locator(".bar .chip").isVisible());
    await page.click("button:has-text('What is missing?')");
    await page.click(".panel button:has-text('Search')");
    await page.waitForFunction(() => document.querySelector(".progress"));
    await page.click(".progress button:has-text('Stop')");
    const about = sent.slice(first).filter((message) => ["run", "compare", "diagnose", "linearize", "sweep", "columns", "write_experiment"].includes(message.do));
    for (const kind of ["sweep", "compare", "diagnose"]) assert(about.some((message) => message.do === kind), `${kind} was sent`);
    for (const message of about) assert.deepEqual(message.set, set, `${message.do} is with the sliders`);
    await page.click("#tab-runs");
    await page.waitForSelector(".merit thead");
    await take(page, "14_runs");
    assert.deepEqual(faults, []);
    await context.close();
  } finally { await studio.stop(); }
});

test("a dropped record becomes an experiment after it was confirmed", async () => {
  const dropped = join(axis.folder, "dropped.csv");
  copyFileSync(axis.path("held_out.csv"), dropped);
  const studio = start_studio(axis.path("nominal.json"));
  try {
    const { page, faults, context } = await open_page(browser, await studio.address);
    await page.waitForSelector(".plot canvas");
    await drop(page, dropped, "bench_run.csv");
    await page.waitForSelector("fieldset.column", { timeout: 30000 });
    await take(page, "9_columns");
    assert(!existsSync(axis.path("bench_run.experiment.json")), "nothing is written before it was confirmed");
    // The force drives the axis, the position is compared.
    await page.selectOption("[data-column*=force] select >> nth=0", "drive");
    await page.selectOption("[data-column*=force] select >> nth=1", "axis.force");
    await page.selectOption("[data-column^=position] select >> nth=0", "compare");
    await page.selectOption("[data-column^=position] select >> nth=1", "axis.position");
    for (const other of ["reference", "feedforward", "true_model"]) {
      const column = page.locator(`[data-column*=${other}] select >> nth=0`);
      if (await column.count()) await column.selectOption("ignore");
    }
    await page.click("button[type=submit]:has-text('compare')");
    await page.waitForSelector("[data-rmse]", { timeout: 30000 });
    assert.deepEqual(faults, []);
    await context.close();
  } finally { await studio.stop(); }
});

test("a record that is sent in several parts arrives as it is", async () => {
  const rows = ["time_s,position_m"];
  for (let k = 0; k < 300000; ++k) rows.push(`${(k / 1000).toFixed(3)},${((k * 7919) % 10007) / 1e6}`);
  const large = join(axis.folder, "large.csv");
  writeFileSync(large, rows.join("\n") + "\n");  // more than a part of 4 MiB
  const studio = start_studio(axis.path("nominal.json"));
  try {
    const { page, faults, context } = await open_page(browser, await studio.address);
    await page.waitForSelector(".plot canvas");
    await drop(page, large, "arrived.csv");
    await page.waitForSelector("fieldset.column", { timeout: 60000 });
    assert(readFileSync(axis.path("arrived.csv")).equals(readFileSync(large)));
    assert.deepEqual(faults, []);
    await context.close();
  } finally { await studio.stop(); }
});

test("a killed program leaves the file whole; the page says so and finds the next one", async () => {
  const file = axis.path("nominal.json"), original = readFileSync(file);
  const studio = start_studio(file);
  const { page, context } = await open_page(browser, await studio.address);
  await page.waitForSelector(".plot canvas");
  await studio.stop("SIGKILL");
  await page.waitForSelector(".banner.error");
  assert.deepEqual(readFileSync(file), original);
  await context.close();
});

test("a change by another program is shown, and can be undone", async () => {
  const file = axis.path("nominal.json"), original = readFileSync(file, "utf8");
  const studio = start_studio(file);
  try {
    const { page, context, faults } = await open_page(browser, await studio.address);
    await page.waitForSelector(".plot canvas");
    writeFileSync(file, original.replace("The loop, as believed", "Changed by an editor"));
    await page.waitForSelector(".panel h2:has-text('Changed by an editor')", { timeout: 15000 });
    await page.click("button[aria-label=Undo]");
    await page.waitForSelector(".panel h2:has-text('The loop, as believed')");
    assert.equal(readFileSync(file, "utf8"), original);
    assert.deepEqual(faults, []);
    await context.close();
  } finally { await studio.stop(); writeFileSync(file, original); }
});

test("a file that does not load is shown as far as it can be, with its problems", async () => {
  const file = axis.path("broken.json");
  writeFileSync(file, readFileSync(axis.path("nominal.json"), "utf8").replace('"axis.position"}', '"axs.position"}'));
  const studio = start_studio(file);
  try {
    const { page, context, faults } = await open_page(browser, await studio.address);
    await page.waitForSelector(".block[data-block=controller]");
    await page.click("#tab-problems");
    await page.waitForSelector("button.problem.error");
    await take(page, "10_broken");
    assert(await page.locator("button.run").isDisabled());
    assert.deepEqual(faults, []);
    await context.close();
  } finally { await studio.stop(); unlinkSync(file); }
});
