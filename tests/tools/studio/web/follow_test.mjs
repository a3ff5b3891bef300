// Names that other files and the page follow, and texts that a killed studio left, with the real program in real chromium:
//   LOOPWRIGHT=… node --test follow_test.mjs
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { spawnSync } from "node:child_process";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, beforeEach, afterEach, test } from "node:test";
import { launch, open_page } from "./browser.mjs";
import { start_studio } from "./program.mjs";

const AXIS = `{
  "loopwright": 1,
  "solver": {"method": "rk4", "step": 0.001, "stop": 0.2},
  "blocks": {
    "push": {"type": "Step", "time": 0.05, "after": {"value": 1, "unit": "N"}},
    "mass": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "push.y"}}
  },
  "log": ["mass.position"]
}
`;
const SWEEP = `{"loopwright": 1, "diagram": "axis.json", "axes": {"mass.mass": {"values": [1, 2]}}, "metrics": {"end": {"final": "mass.position"}}}\n`;
let browser, folder;
const read = (name) => readFileSync(join(folder, name), "utf8");
before(async () => { browser = await launch(); });
after(async () => { await browser.close(); });
beforeEach(() => {
  folder = mkdtempSync(join(tmpdir(), "loopwright_studio_follow_"));
  writeFileSync(join(folder, "axis.json"), AXIS);
  writeFileSync(join(folder, "axis.sweep.json"), SWEEP);
});
afterEach(() => rmSync(folder, { recursive: true, force: true }));

async function with_page(act) {
  const studio = start_studio(join(folder, "axis.json"));
  try {
    const { page, faults, context } = await open_page(browser, await studio.address);
    await page.waitForSelector("[data-block=mass]");
    await page.waitForSelector(".plot canvas", { state: "attached" });
    await act(page);
    assert.deepEqual(faults, []);
    await context.close();
  } finally { await studio.stop(); }
}
async function rename(page, name, to) {
  const field = page.locator("[aria-label='Name of the block']");
  if (!await field.count()) await page.locator(`[data-block=${name}]`).first().click();
  await field.fill(to);
  await page.keyboard.press("Enter");
}

test("a sweep, the slider and the plots follow a new name, and come back with one undo", () => with_page(async (page) => {
  // A plot that the user has chosen, and a slider that was moved.
  await page.locator("[data-block=mass]").first().click();
  await page.locator("input[type=range]").first().focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForSelector(".chip:has-text('changed by slider')");
  await rename(page, "mass", "stage");
  await page.waitForSelector("[data-block=stage]");
  await page.waitForSelector(".note:has-text('axis.sweep.json')");
  assert.equal(read("axis.sweep.json"), SWEEP.replace('"mass.mass"', '"stage.mass"').replace('"mass.position"', '"stage.position"'));
  // The moved slider is still that of the block. The address is written a moment after the page has settled.
  await page.waitForFunction(() => /set\.stage\.mass=/.test(decodeURIComponent(location.hash)));
  await page.waitForSelector(".legend:has-text('stage.position')");
  assert.equal(await page.locator(".note.error").count(), 0);
  await page.keyboard.press("Escape");
  await page.locator("body").click({ position: { x: 5, y: 5 } });
  await page.keyboard.press("Control+z");
  await page.waitForSelector("[data-block=mass]");
  assert.equal(read("axis.json"), AXIS);
  assert.equal(read("axis.sweep.json"), SWEEP);
  await page.waitForSelector(".legend:has-text('mass.position')");
  assert.equal(await page.locator(".note.error").count(), 0);
}));

test("a file that cannot follow is named first", async () => {
  const elsewhere = mkdtempSync(join(tmpdir(), "loopwright_studio_elsewhere_"));
  writeFileSync(join(elsewhere, "b.sweep.json"), SWEEP);
  symlinkSync(join(elsewhere, "b.sweep.json"), join(folder, "b.sweep.json"));
  await with_page(async (page) => {
    const asked = [];
    let agree = false;
    page.on("dialog", (dialog) => { asked.push(dialog.message()); void (agree ? dialog.accept() : dialog.dismiss()); });
    await rename(page, "mass", "stage");
    await page.waitForTimeout(500);
    assert.equal(asked.length, 1);
    assert.match(asked[0], /"b\.sweep\.json" is read-only, or a link/);
    assert.equal(read("axis.json"), AXIS);
    // Leaving the field does not ask again, and shows the name that the block has.
    await page.keyboard.press("Tab");
    await page.waitForFunction(() => document.querySelector("[aria-label='Name of the block']").value === "mass");
    assert.equal(asked.length, 1);
    agree = true;
    await rename(page, "mass", "stage");
    await page.waitForSelector("[data-block=stage]");
    assert.match(read("axis.sweep.json"), /stage\.position/);
    assert.equal(read("b.sweep.json"), SWEEP);
  });
  rmSync(elsewhere, { recursive: true, force: true });
});

test("a text that a killed studio left is offered, put into the file, and removed", async () => {
  const ended = spawnSync("true").pid, hidden = `.axis.json.studio-${ended}-0`, text = AXIS.replace('"value": 2', '"value": 3');
  writeFileSync(join(folder, hidden), text);
  await with_page(async (page) => {
    await page.waitForSelector(`.banner:has-text('${hidden}')`);
    await page.click(".banner button:has-text('Put it into the file')");
    await page.waitForFunction(() => document.querySelector(".banner"));
    for (let i = 0; i < 50 && read("axis.json") !== text; ++i) await page.waitForTimeout(100);
    assert.equal(read("axis.json"), text);
    await page.click(".banner button:has-text('Remove it')");
    await page.waitForSelector(".banner", { state: "detached" });
    assert(!existsSync(join(folder, hidden)));
  });
});
