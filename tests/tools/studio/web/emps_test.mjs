// The scene on a measured axis, where its data are:  LOOPWRIGHT_DATA=… LOOPWRIGHT=… LOOPWRIGHT_SOURCE=… node --test emps_test.mjs
import assert from "node:assert/strict";
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { launch, open_page } from "./browser.mjs";
import { start_studio } from "./program.mjs";

const SOURCE = process.env.LOOPWRIGHT_SOURCE, record = join(process.env.LOOPWRIGHT_DATA ?? "", "emps/emps_train.csv"), PICTURES = process.env.SCENE_PICTURES;
const FOUND = 300000;  // ms: the longest that a diagnosis of 24,800 rows may take on a slow machine
const skip = process.env.LOOPWRIGHT_DATA && existsSync(record) ? false : "LOOPWRIGHT_DATA names no folder with emps/emps_train.csv";

test("compare, diagnose and add on the measured axis of EMPS; the error falls, and undo brings back the same bytes", { skip }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "loopwright_studio_emps_")), browser = await launch();
  cpSync(join(SOURCE, "diagrams/emps"), folder, { recursive: true });
  cpSync(record, join(folder, "emps_train.csv"));
  const file = join(folder, "nominal.json"), original = readFileSync(file), studio = start_studio(file);
  try {
    const { page, faults, context } = await open_page(browser, await studio.address);
    await page.waitForSelector("[data-block=axis]");
    await page.click("#tab-measure");
    await page.click("button.entry:has-text('open_loop')");
    await page.waitForSelector("[data-rmse]", { timeout: 60000 });
    const rmse = () => page.locator("[data-rmse]").first().getAttribute("data-rmse").then(Number), before = await rmse();
    await page.waitForSelector("[data-block=axis].tinted");
    await page.click("button:has-text('What is missing?')");
    await page.waitForSelector(".card[data-effect]", { timeout: FOUND });
    const found = await page.locator(".card[data-effect]").evaluateAll((cards) => cards.map((card) => card.dataset.effect));
    assert(found.some((effect) => /coulomb|friction/.test(effect)), `the axis has dry friction: ${found}`);
    if (PICTURES) { mkdirSync(PICTURES, { recursive: true }); await page.screenshot({ path: join(PICTURES, "30_emps.png") }); }
    await page.click("button:has-text('Add ')");
    await page.waitForFunction((bound) => Number(document.querySelector("[data-rmse]")?.dataset.rmse) < bound, before / 2, { timeout: 60000 });
    assert.notDeepEqual(readFileSync(file), original);
    await page.click("button[aria-label=Undo]");
    await page.waitForFunction((value) => Number(document.querySelector("[data-rmse]").dataset.rmse) === value, before, { timeout: 60000 });
    assert.deepEqual(readFileSync(file), original);
    assert.deepEqual(faults, []);
    await context.close();
  } finally { await studio.stop(); await browser.close(); rmSync(folder, { recursive: true, force: true }); }
});
