// Opens a page in chromium and prints its title as soon as that begins with "{":  node browse.mjs PAGE.html
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const { chromium } = createRequire(new URL("../../pages/package.json", import.meta.url))("playwright-core");
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", headless: true, args: ["--no-sandbox", "--disable-gpu", "--disable-background-networking"] });
try {
  const page = await browser.newPage({ viewport: { width: 1200, height: 900 } });
  await page.goto(pathToFileURL(process.argv[2]).href);
  await page.waitForFunction(() => document.title.startsWith("{"), undefined, { timeout: 60000 });
  console.log(await page.title());
} finally {
  await browser.close();
}
