// Editing with the real program in real chromium:  LOOPWRIGHT=… HIDDEN_EFFECTS=… LOOPWRIGHT_SOURCE=… node --test edit_test.mjs
// SCENE_PICTURES names a folder for pictures of it.
import assert from "node:assert/strict";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { contrast_faults, unnamed } from "./accessibility.mjs";
import { launch, open_page } from "./browser.mjs";
import { hidden_axis, start_studio } from "./program.mjs";

const SOURCE = process.env.LOOPWRIGHT_SOURCE, PICTURES = process.env.SCENE_PICTURES;
let browser, folder, axis;
before(async () => {
  browser = await launch();
  axis = hidden_axis();
  folder = mkdtempSync(join(tmpdir(), "loopwright_studio_edit_"));
  mkdirSync(join(folder, "examples"));
  for (const name of ["state_machine", "hardware_io"]) cpSync(join(SOURCE, `diagrams/examples/${name}.json`), join(folder, `examples/${name}.json`));
  cpSync(join(SOURCE, "hw/devices"), join(folder, "devices"), { recursive: true });
  const text = readFileSync(join(folder, "examples/hardware_io.json"), "utf8");
  writeFileSync(join(folder, "examples/hardware_io.json"), text.replace(/"[^"]*\/([\w.]+\.json)"/, '"../devices/$1"'));
});
after(async () => { await browser.close(); axis.remove(); rmSync(folder, { recursive: true, force: true }); });

const take = async (page, name) => {
  if (!PICTURES) return;
  mkdirSync(PICTURES, { recursive: true });
  await page.waitForTimeout(700);
  await page.screenshot({ path: join(PICTURES, `${name}.png`) });
};
async function with_page(file, act, options = {}) {
  const studio = start_studio(file);
  try {
    const { page, faults, context } = await open_page(browser, await studio.address, options);
    await page.waitForSelector(".block");
    await act(page);
    assert.deepEqual(faults, []);
    await context.close();
  } finally { await studio.stop(); }
}

for (const [dark, width, height] of [[false, 1400, 900], [true, 1280, 800]])
  test(`a state machine is drawn as a chart, and edited in it, ${dark ? "dark" : "light"}`, async () => {
    const file = join(folder, "examples/state_machine.json"), original = readFileSync(file, "utf8");
    await with_page(file, async (page) => {
      await page.waitForSelector("[data-block=machine]");
      await page.locator("[data-block=machine]").dblclick();
      await page.waitForSelector(".machine .state[data-state=fault]");
      assert.equal(await page.locator(".machine .state").count(), 6);
      assert.equal(await page.locator(".machine [data-transition]").count(), 7);
      // The states inside a state stand inside it.
      const box = async (name) => page.locator(`.machine .state[data-state=${name}] rect`).boundingBox();
      const outer = await box("running"), inner = await box("warming");
      assert(inner.x > outer.x && inner.y > outer.y && inner.x + inner.width < outer.x + outer.width && inner.y + inner.height < outer.y + outer.height);
      await take(page, `20_chart_${dark ? "dark" : "light"}`);

      await page.click(".machine .state[data-state=idle]");
      await page.waitForSelector("[data-panel-of=idle]");
      await page.fill("[aria-label='Name of the state']", "waiting");
      await page.keyboard.press("Enter");
      await page.waitForSelector(".machine .state[data-state=waiting]");
      const renamed = JSON.parse(readFileSync(file, "utf8")).blocks.machine.states;
      assert.deepEqual(renamed.flatMap((state) => state.transitions ?? []).filter((transition) => transition.to === "waiting").length, 2, "transitions follow the name");

      await page.locator(".machine [data-transition]", { hasText: "position > reach" }).first().focus();
      await page.keyboard.press("Enter");
      await page.fill("[aria-label='Guard of the transition']", "position > reach || jam");
      await page.keyboard.press("Enter");
      await page.waitForSelector(".machine .when:has-text('jam')");
      await take(page, `21_transition_${dark ? "dark" : "light"}`);

      await page.click(".machine button:has-text('+ State')");
      await page.waitForSelector("[data-panel-of=state_7]");
      await page.fill("[aria-label='lamp in state_7']", "3");
      await page.keyboard.press("Enter");
      await page.waitForFunction(() => [...document.querySelectorAll(".machine .state[data-state=state_7] text")].some((text) => text.textContent === "lamp = 3"));
      await page.click(".machine .state[data-state=fault]");
      await page.waitForSelector("[data-panel-of=fault]");
      await page.selectOption("[aria-label='New transition to']", "state_7");
      await page.waitForSelector("[aria-label='Guard of the transition']");
      await page.fill("[aria-label='Guard of the transition']", "after(5 s)");
      await page.keyboard.press("Enter");
      await page.waitForSelector(".machine .when:has-text('after(5 s)')");
      assert.equal(await page.locator(".machine [data-transition]").count(), 8);
      const states = JSON.parse(readFileSync(file, "utf8")).blocks.machine.states;
      assert.deepEqual(states.find((state) => state.name === "fault").transitions.at(-1), { when: "after(5 s)", to: "state_7" });
      assert.deepEqual(states.at(-1).set, { lamp: 3 });
      assert.deepEqual(await page.evaluate(contrast_faults), []);
      assert.deepEqual(await page.evaluate(unnamed), []);

      // What was added goes away with the state, and undo brings everything back.
      await page.click(".machine .state[data-state=state_7]");
      await page.click("button:has-text('Remove the state')");
      await page.waitForFunction(() => document.querySelectorAll(".machine [data-transition]").length === 7);
      while (await page.locator("button[aria-label=Undo]").isEnabled()) {
        const title = await page.locator("button[aria-label=Undo]").getAttribute("title");
        await page.click("button[aria-label=Undo]");
        await page.waitForFunction((before) => document.querySelector("button[aria-label=Undo]").title !== before || document.querySelector("button[aria-label=Undo]").disabled, title).catch(() => undefined);
        await page.waitForTimeout(100);
      }
      assert.equal(readFileSync(file, "utf8"), original);
      await page.click("button:has-text('Back to the diagram')");
      await page.waitForSelector(".machine", { state: "detached" });
    }, { dark, width, height });
  });

test("selected blocks are wrapped into a subdiagram that computes the same", async () => {
  const file = axis.path("axis.json"), original = readFileSync(file, "utf8");
  await with_page(file, async (page) => {
    await page.waitForSelector("[data-block=mass]");
    const names = Object.keys(JSON.parse(original).blocks).filter((name) => name !== "mass").slice(0, 2);
    for (const [i, name] of names.entries()) await page.locator(`[data-block=${name}]`).click({ modifiers: i ? ["Control"] : [] });
    await page.waitForSelector(".panel h2:has-text('2 blocks')");
    await page.keyboard.press("Control+g");
    await page.waitForSelector("[data-block=subdiagram].selected");
    assert.equal(await page.locator(".chip.bad").count(), 0, "it loads");
    await take(page, "22_wrapped");
    await page.dblclick("[data-block=subdiagram]");
    for (const name of names) await page.waitForSelector(`[data-block=${name}]`);
    await page.click(".levels button:has-text('top')");
    await page.waitForSelector("[data-block=subdiagram]");
    await page.click("button[aria-label=Undo]");
    await page.waitForSelector("[data-block=subdiagram]", { state: "detached" });
    assert.equal(readFileSync(file, "utf8"), original);
  });
});

test("parameters are ticked beside their sliders, fitted, and written", async () => {
  const file = axis.path("axis.json"), original = readFileSync(file, "utf8");
  // A model whose mass is wrong.
  const parameters = JSON.parse(original).parameters;
  assert(parameters.mass, "the axis has a mass");
  await with_page(axis.path("nominal.json"), async (page) => {
    await page.click("#tab-measure");
    await page.click("button.entry:has-text('closed_loop')");
    await page.waitForSelector("[data-rmse]", { timeout: 30000 });
    await page.dblclick("[data-block=axis]");
    await page.click("#tab-inspect");
    await page.check("[aria-label='Fit mass']");
    await page.click("#tab-measure");
    await page.click(".fit button:has-text('Fit axis.mass')");
    await page.waitForSelector("[data-fitted='axis.mass']", { timeout: 120000 });
    await take(page, "23_fitted");
    assert.match(await page.locator(".fitted code").textContent(), /loopwright fit .*--parameters axis\.mass/);
    assert.deepEqual(await page.evaluate(contrast_faults), []);
    assert.deepEqual(await page.evaluate(unnamed), []);
    // The mass stands in the file of the subdiagram: the command refuses that too, in the same words.
    await page.click("button:has-text('Write into the file')");
    await page.waitForSelector(".note.error", { timeout: 30000 });
  });
  assert.equal(readFileSync(file, "utf8"), original);
});

test("a run with a name is listed by the next program, with its curves", async () => {
  const file = axis.path("nominal.json");
  await with_page(file, async (page) => {
    await page.waitForSelector(".plot canvas");
    await page.click("#tab-runs");
    await page.fill("[aria-label^='Name of run']", "as it was");
    await page.keyboard.press("Enter");
    await page.waitForTimeout(500);
  });
  await with_page(file, async (page) => {
    await page.waitForSelector(".plot canvas");
    await page.click("#tab-runs");
    await page.waitForFunction(() => [...document.querySelectorAll(".runs input")].some((field) => field.value === "as it was"));
    await page.locator(".runs li:not(.present) input[type=checkbox]").first().click();
    await page.waitForFunction(() => [...document.querySelectorAll(".legend li")].some((entry) => /as it was/.test(entry.textContent)));
  });
});

test("a sweep is written as a file with the command that repeats it", async () => {
  await with_page(axis.path("nominal.json"), async (page) => {
    await page.waitForSelector("select[name=x]");
    await page.click("button:has-text('Sweep')");
    await page.waitForSelector(".sweep td button", { timeout: 60000 });
    await page.click("button:has-text('Repeat it in the terminal')");
    await page.waitForSelector(".sweep code:has-text('loopwright sweep')");
    assert.equal(JSON.parse(readFileSync(axis.path("nominal.sweep.json"), "utf8")).diagram, "nominal.json");
  });
});

test("a block of hardware is marked, and its panel says that nothing moves here", async () => {
  await with_page(join(folder, "examples/hardware_io.json"), async (page) => {
    await page.waitForSelector("[data-type=HardwareIo] .badge.hardware");
    await page.locator("[data-type=HardwareIo]").click();
    await page.waitForSelector(".panel .hint:has-text('nothing moves')");
    await take(page, "24_hardware");
    assert.deepEqual(await page.evaluate(contrast_faults), []);
  });
});
