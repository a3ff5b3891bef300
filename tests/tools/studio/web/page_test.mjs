// The page against the stand-in for the program, in real chromium:  node --test page_test.mjs
// The folder of the bundled page is that of LOOPWRIGHT_PAGE, or tools/studio/web/build/.
import assert from "node:assert/strict";
import { after, afterEach, before, beforeEach, test } from "node:test";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { contrast_faults, unnamed } from "./accessibility.mjs";
import { launch, open_page } from "./browser.mjs";
import { serve } from "./mock.mjs";

const FOLDER = process.env.LOOPWRIGHT_PAGE ?? join(dirname(fileURLToPath(import.meta.url)), "../../../../tools/studio/web/build");
let browser, program, opened;
before(async () => { browser = await launch(); });
after(async () => { await browser.close(); });
beforeEach(async () => { program = await serve(FOLDER, 0); });
afterEach(async () => {
  const faults = opened?.faults ?? [];
  await opened?.context.close();
  opened = undefined;
  program.close();
  assert.deepEqual(faults, [], "no exception, no error, nothing refused by the page's policy");
});

async function open(options = {}, address = "") {
  opened = await open_page(browser, `http://127.0.0.1:${program.port}/${address}`, options);
  await opened.page.waitForSelector(".block[data-block=axis]");
  await opened.page.waitForSelector(".plot canvas", { state: "attached" });
  return opened.page;
}
const rmse = (page) => page.locator("[data-rmse]").first().getAttribute("data-rmse").then(Number);
async function compare(page) {
  await page.click("#tab-measure");
  await page.click("button.entry:has-text('train')");
  await page.waitForSelector("[data-rmse]");
}

test("blocks stand from left to right in the direction of the signals, and no wire crosses a block", async () => {
  const page = await open();
  const boxes = {};
  for (const name of ["reference", "controller", "axis", "error"]) boxes[name] = await page.locator(`[data-block=${name}] svg.outline`).first().boundingBox();
  assert(boxes.reference.x < boxes.controller.x && boxes.controller.x < boxes.axis.x && boxes.axis.x < boxes.error.x);
  const inside = await page.evaluate(() => {
    const blocks = [...document.querySelectorAll(".block > svg.outline")].map((outline) => outline.getBoundingClientRect());
    const hits = [];
    for (const path of document.querySelectorAll(".react-flow__edge-path")) {
      const matrix = path.getScreenCTM(), length = path.getTotalLength();
      for (let at = 12; at < length - 12; at += 3) {
        const point = path.getPointAtLength(at).matrixTransform(matrix);
        if (blocks.some((box) => point.x > box.left + 2 && point.x < box.right - 2 && point.y > box.top + 2 && point.y < box.bottom - 2)) { hits.push(path.closest(".react-flow__edge").getAttribute("data-id")); break; }
      }
    }
    return hits;
  });
  assert.deepEqual(inside, []);
});

test("a click on a wire shows its signal, a second one takes it away", async () => {
  const page = await open();
  const click = async () => {
    const { x, y } = await page.evaluate(() => {
      const path = document.querySelector("[data-id='axis.force#0'] .react-flow__edge-path");
      const point = path.getPointAtLength(path.getTotalLength() / 2).matrixTransform(path.getScreenCTM());
      return { x: point.x, y: point.y };
    });
    await page.mouse.click(x, y);
  };
  await page.waitForTimeout(300);      // until the diagram is fitted into its place
  await click();                       // the log has it already: it is only selected
  assert.equal(await page.locator(".legend li:has-text('controller.force')").count(), 1);
  await click();
  await page.waitForFunction(() => ![...document.querySelectorAll(".legend li")].some((entry) => entry.textContent.includes("controller.force")));
  await click();
  await page.waitForSelector(".legend li:has-text('controller.force')");
});

test("a slider runs the diagram while it moves, keeps the run before as a ghost, and writes on request only", async () => {
  const page = await open();
  const slider = page.locator("input[data-set=mass]"), box = await slider.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.8 * box.width, box.y + box.height / 2, { steps: 8 });
  await page.mouse.up();
  await page.waitForSelector(".legend li.ghost");
  assert.equal((await slider.boundingBox()).width, box.width);
  const moved = parseFloat(await page.locator(".override output").textContent());
  assert(moved > 0.85 && moved < 1.05, `${moved} kg is where the mouse is`);
  assert.equal(await page.inputValue("[data-parameter=mass] .field"), "0.6 kg");
  await page.click(".override button:has-text('Write')");
  await page.waitForFunction((mass) => parseFloat(document.querySelector("[data-parameter=mass] .field").value) === mass, moved);
  await page.keyboard.press("Control+z");
  await page.waitForFunction(() => document.querySelector("[data-parameter=mass] .field").value === "0.6 kg");
});

test("a fault of one part takes that part away, not the page", async () => {
  const page = await open();
  await page.evaluate(() => { const parse = JSON.parse; JSON.parse = (text) => { const value = parse(text); if (value?.ok?.poles) delete value.ok.poles; return value; }; });
  await page.evaluate(() => document.querySelector("[data-id='axis.force#0'] .react-flow__edge-path").dispatchEvent(new MouseEvent("click", { bubbles: true })));
  await page.click("button:has-text('Open loop')");
  await page.waitForSelector(".broken-part[role=alert] button:has-text('Reload the page')");
  assert.equal(await page.locator(".block[data-block=axis]").count(), 1, "the diagram stays");
  await page.click("[role=tab]:has-text('Run')");
  await page.waitForSelector(".plot canvas");
  assert(opened.faults.length > 0, "and the console has the fault");
  opened.faults.length = 0;
});

test("what was told about a file goes away when the file changes", async () => {
  const page = await open();
  await page.click("[data-parameter=mass]", { position: { x: 1, y: 1 } });
  await page.fill("input[name=name]", "added");
  await page.fill("input[name=text]", "1 m");
  await page.click(".row.add button[type=submit]");       // the stand-in refuses it
  await page.waitForSelector(".note.error");
  await page.fill("[data-parameter=mass] .field", "0.7 kg");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".note.error", { state: "detached" });
});

test("an earlier run is named once in the legend of a plot", async () => {
  const page = await open();
  await page.locator("input[data-set=mass]").focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForSelector(".legend li.ghost");
  for (const plot of await page.locator(".plot").all())
    assert((await plot.locator(".legend li.ghost:visible").count()) <= 1);
});

test("problems are shown while they exist and lead to their place", async () => {
  const page = await open();
  await page.fill("[data-parameter=mass] .field", "-1 kg");
  await page.keyboard.press("Enter");
  await page.waitForSelector("[data-block=axis].error");
  assert(await page.locator("button.run").isDisabled());
  await page.click("#tab-problems");
  await page.click("button.problem");
  await page.waitForSelector("[data-block=axis].selected");
  await page.click("button[aria-label=Undo]");
  await page.waitForSelector("[data-block=axis]:not(.error)");
});

test("the scene: compare, diagnose, preview, add, undo", async () => {
  const page = await open();
  await compare(page);
  const at_first = await rmse(page);
  await page.waitForSelector("[data-block=axis].tinted");
  await page.click("button:has-text('What is missing?')");
  await page.waitForSelector(".staircase.running[data-steps='2']");
  await page.waitForSelector("[data-effect=coulomb_friction]");
  await page.hover("[data-effect=cogging]");
  await page.waitForSelector(".legend li.preview:has-text('cogging')");
  await page.click("button:has-text('Add all 2')");
  await page.waitForSelector("[data-block=axis].highlighted");
  await page.waitForFunction((before) => Number(document.querySelector("[data-rmse]").dataset.rmse) < before / 10, at_first);
  assert.equal(await page.locator(".card.added").count(), 2);
  await page.locator(".legend li.ghost:has-text('error before')").waitFor();
  await page.click("button[aria-label=Undo]");
  await page.waitForFunction((before) => Number(document.querySelector("[data-rmse]").dataset.rmse) === before, at_first);
  assert.equal(await page.locator(".card.added").count(), 0);
});

test("a dropped record is sent, matched, confirmed and compared", async () => {
  const page = await open();
  await page.evaluate(() => {
    const transfer = new DataTransfer();
    transfer.items.add(new File(["time_s,position_m\n0,0\n"], "held_out.csv", { type: "text/csv" }));
    for (const kind of ["dragenter", "dragover", "drop"]) document.body.dispatchEvent(new DragEvent(kind, { dataTransfer: transfer, bubbles: true, cancelable: true }));
  });
  await page.waitForSelector("fieldset[data-column=position]");
  assert.equal(await page.locator("select[aria-label='Port of position']").inputValue(), "axis.position");
  await page.click("button:has-text('Confirm and compare')");
  await page.waitForSelector("[data-rmse]");
});

test("a unit that the heading does not state is typed, and a record without a drive says so before it is written", async () => {
  const page = await open(), sent = [];
  await page.evaluate(() => {
    window.sent = [];
    const send = WebSocket.prototype.send;
    WebSocket.prototype.send = function (text) { window.sent.push(JSON.parse(text)); send.call(this, text); };
  });
  await page.evaluate(() => {
    const transfer = new DataTransfer();
    transfer.items.add(new File(["time_s,position_m\n0,0\n"], "held_out.csv", { type: "text/csv" }));
    for (const kind of ["dragenter", "dragover", "drop"]) document.body.dispatchEvent(new DragEvent(kind, { dataTransfer: transfer, bubbles: true, cancelable: true }));
  });
  await page.waitForSelector("fieldset[data-column=force]");
  assert.equal(await page.locator("[data-column=position] input.unit").count(), 0, "a heading that states its unit is not asked about");
  await page.selectOption("[aria-label='Use of force']", "compare");
  await page.selectOption("[aria-label='Port of force']", "axis.net_force");
  await page.fill("[aria-label='Unit of force']", "kN");
  assert.equal(await page.locator(".no-drive").count(), 0);
  await page.selectOption("[aria-label='Use of reference']", "ignore");
  await page.waitForSelector(".no-drive[role=alert]:has-text('No column drives the diagram')");
  assert.deepEqual(await page.evaluate(contrast_faults), []);
  await page.click("button[type=submit]:has-text('without a drive')");
  await page.waitForSelector("[data-rmse]");
  sent.push(...await page.evaluate(() => window.sent));
  const { columns } = sent.find((message) => message.do === "write_experiment");
  assert.deepEqual(columns.find((column) => column.column === "force_N").unit, "kN");
  assert.equal(columns.find((column) => column.column === "position_m").unit, "", "what the heading states is not written again");
});

test("the label of a wire stands above the blocks beside it", async () => {
  const page = await open();
  await page.waitForTimeout(300);
  await page.evaluate(() => document.querySelector("[data-id='axis.force#0'] .react-flow__edge-path").dispatchEvent(new MouseEvent("click", { bubbles: true })));
  await page.waitForSelector(".wire-label");
  const is_above = await page.evaluate(() => {
    const label = document.querySelector(".wire-label");
    label.style.pointerEvents = "auto";
    const box = label.getBoundingClientRect();
    return [0.05, 0.5, 0.95].every((share) => document.elementFromPoint(box.left + share * box.width, box.top + box.height / 2) === label);
  });
  assert(is_above);
});

test("a change of a number draws no other block again, and leaves the view where it is", async () => {
  const page = await open();
  await page.waitForTimeout(600);      // until the diagram is fitted into its place
  const transform = () => page.evaluate(() => document.querySelector(".react-flow__viewport").style.transform);
  const before = await transform();
  await page.evaluate(() => {
    window.drawn = 0;
    new MutationObserver((changes) => { window.drawn += changes.filter((change) => change.target instanceof Element && change.target.closest("[data-block=reference], [data-block=error]")).length; })
      .observe(document.querySelector(".react-flow__nodes"), { subtree: true, childList: true, attributes: true, characterData: true });
  });
  await page.fill("[data-parameter=mass] .field", "0.7 kg");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelector("button[aria-label=Undo]").disabled === false);
  await page.waitForTimeout(500);
  assert.equal(await transform(), before);
  assert.equal(await page.evaluate(() => window.drawn), 0);
});

test("everything is reached by keys", async () => {
  const page = await open();
  await page.keyboard.press("b");
  await page.waitForSelector(".palette");
  await page.keyboard.type("sat");
  await page.waitForFunction(() => document.querySelectorAll(".palette [role=option]").length === 1);
  await page.keyboard.press("Escape");
  await page.waitForSelector(".palette", { state: "detached" });
  await page.focus(".react-flow__node[data-id='block:axis']");
  await page.keyboard.press("Space");
  await page.waitForSelector("[data-block=axis].selected");
  await page.focus(".react-flow__node[data-id='block:axis']");
  await page.keyboard.press("Enter");
  await page.waitForSelector("[data-block=viscous]");
  await page.keyboard.press("Escape");
  await page.keyboard.press("Backspace");
  await page.waitForSelector("[data-block=controller]");
  await page.keyboard.press("3");
  await page.waitForSelector("#tab-measure[aria-selected=true]");
  await page.keyboard.press("?");
  await page.waitForSelector("dialog[open]");
  await page.keyboard.press("Escape");
  await page.keyboard.press("t");
  await page.waitForSelector(".text-view");
  await page.focus(".plot .canvas");
  await page.keyboard.press("+");
  await page.waitForSelector("button:has-text('Whole range')");
  await page.keyboard.press("0");
  await page.waitForSelector("button:has-text('Whole range')", { state: "detached" });
});

test("the address brings back file, panel, plots and range", async () => {
  const page = await open({}, "#file=nominal.json&plots=axis.position;controller.force&from=1&to=2&panel=runs");
  assert.equal(await page.locator(".plot").count(), 2);
  await page.waitForSelector("#tab-runs[aria-selected=true]");
  await page.waitForSelector("button:has-text('Whole range')");
  await page.click("#tab-inspect");
  await page.waitForFunction(() => !location.hash.includes("panel") && location.hash.includes("from=1"));
});

test("what has stopped is said, and found again", async () => {
  const page = await open();
  const { port } = program;
  program.close();
  await page.waitForSelector(".banner.error");
  program = await serve(FOLDER, port);
  await page.waitForSelector(".banner.error", { state: "detached" });
  opened.faults.length = 0;            // the browser reports the lost connection
  await page.click("button.run");
  await page.waitForSelector(".plot canvas");
});

for (const dark of [false, true])
  test(`contrast and names, ${dark ? "dark" : "light"}`, async () => {
    const page = await open({ dark });
    await compare(page);
    await page.click("button:has-text('What is missing?')");
    await page.waitForSelector("[data-effect=coulomb_friction]");
    for (const panel of ["diagnose", "measure", "inspect", "runs", "problems"]) {
      await page.click(`#tab-${panel}`);
      await page.waitForTimeout(100);
      assert.deepEqual(await page.evaluate(contrast_faults), [], `contrast of the panel ${panel}`);
      assert.deepEqual(await page.evaluate(unnamed), [], `names in the panel ${panel}`);
    }
  });

for (const [width, height] of [[1400, 900], [1280, 800], [400, 800]])
  test(`fits ${width} × ${height}`, async () => {
    const page = await open({ width, height }, width < 700 ? "" : "#panel=inspect");
    const outside = await page.evaluate(() => [...document.querySelectorAll("button, select, input, .panel, .plots")].filter((element) => {
      const box = element.getBoundingClientRect();
      return box.width && getComputedStyle(element).visibility !== "hidden" && !element.closest(".react-flow") && (box.right > innerWidth + 1 || box.left < -1) && !element.closest(".bar");
    }).map((element) => element.outerHTML.slice(0, 80)));
    assert.deepEqual(outside, []);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
  });
