// Opens pages in chromium at several widths, light and dark, and checks what is seen.
//   node look.mjs [--pictures FOLDER] [--open] [--widths 1400,400] PAGE.html …
// --open also looks at diagrams with all subdiagrams open. Exit code 1: something is wrong, and said.
import { mkdirSync } from "node:fs";
import { basename, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { chartFaults, diagramFaults, overflows, smallTexts } from "./checks.mjs";

const SMALLEST = 10;  // px of text

function readArguments(words) {
  const options = { widths: [1400, 1280, 400], pages: [] };
  while (words.length > 0) {
    const word = words.shift();
    if (word === "--pictures") options.pictures = words.shift();
    else if (word === "--widths") options.widths = words.shift().split(",").map(Number);
    else if (word === "--open") options.open = true;
    else options.pages.push(word);
  }
  return options;
}

async function faultsOf(page) {
  return [...await page.evaluate(smallTexts, SMALLEST), ...await page.evaluate(overflows), ...await page.evaluate(diagramFaults), ...await page.evaluate(chartFaults)];
}

async function settled(page) {
  await page.waitForFunction(() => [...document.querySelectorAll("figure.block-diagram")].every((f) => "drawn" in f.dataset), null, { timeout: 60_000 });
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

async function picture(page, options, file, width, colorScheme, suffix) {
  if (!options.pictures) return;
  mkdirSync(options.pictures, { recursive: true });
  await page.screenshot({ path: `${options.pictures}/${basename(file, ".html")}_${width}_${colorScheme}${suffix}.png`, fullPage: true });
}

async function look(browser, file, width, colorScheme, options) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, colorScheme });
  const page = await context.newPage(), faults = [];
  page.on("console", (message) => { if (message.type() === "error") faults.push(`console: ${message.text()}`); });
  page.on("pageerror", (error) => faults.push(`script: ${error.message}`));
  page.on("request", (request) => { if (!/^(file|data|blob):/.test(request.url())) faults.push(`loads ${request.url()}`); });
  try {
    await page.goto(pathToFileURL(resolve(file)).href);
    await settled(page);
    faults.push(...await faultsOf(page));
    await picture(page, options, file, width, colorScheme, "");
    const open = page.getByRole("button", { name: "Open all" });
    if (options.open && await open.count() > 0 && await open.first().isEnabled()) {
      await page.evaluate(() => document.querySelectorAll("figure.block-diagram").forEach((f) => delete f.dataset.drawn));
      for (const one of await open.all()) await one.click();
      await settled(page);
      faults.push(...(await faultsOf(page)).map((fault) => `opened: ${fault}`));
      await picture(page, options, file, width, colorScheme, "_open");
    }
  } catch (error) {
    faults.push(error.message.split("\n")[0]);
  }
  await context.close();
  return [...new Set(faults)];
}

const options = readArguments(process.argv.slice(2));
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"] });
let wrong = 0;
for (const file of options.pages)
  for (const width of options.widths)
    for (const colorScheme of ["light", "dark"])
      for (const fault of await look(browser, file, width, colorScheme, options)) {
        console.log(`${file} at ${width} px, ${colorScheme}: ${fault}`);
        ++wrong;
      }
await browser.close();
console.log(`${options.pages.length} pages, ${wrong} faults`);
process.exitCode = wrong > 0 || options.pages.length === 0 ? 1 : 0;
