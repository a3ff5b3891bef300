// Debian's chromium, driven by playwright-core, with a profile of its own and without any background network.
import { packages } from "./packages.mjs";

const { chromium } = packages("playwright-core");

const FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];

export const launch = () => chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", headless: true, args: FLAGS });

/** A page that collects what goes wrong in it: exceptions, errors on the console, refusals of the page's policy. */
export async function open_page(browser, url, { width = 1400, height = 900, dark = false } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light", acceptDownloads: true });
  const page = await context.newPage();
  const faults = [];
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("console", (message) => { if (message.type() === "error" || /Content Security Policy/.test(message.text())) faults.push(message.text()); });
  await page.goto(url);
  return { page, context, faults };
}
