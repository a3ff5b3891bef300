// A page of another origin in the same browser tries to read and to change what the studio serves: everything fails.
//   LOOPWRIGHT=… HIDDEN_EFFECTS=… node --test attack_test.mjs
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { after, before, test } from "node:test";
import { launch, open_page } from "./browser.mjs";
import { hidden_axis, start_studio } from "./program.mjs";

let browser, axis, studio, victim, context, original, evil, evil_url, studio_url, reached = [];
before(async () => {
  browser = await launch();
  axis = hidden_axis();
  original = readFileSync(axis.path("nominal.json"));
  studio = start_studio(axis.path("nominal.json"));
  ({ page: victim, context } = await open_page(browser, await studio.address));
  await victim.waitForSelector(".plot canvas");
  studio_url = new URL(victim.url()).origin;
  // Another port of the same host: the same site, so that even a strict cookie is sent along.
  evil = createServer((request, response) => { reached.push(request.url); response.writeHead(200, { "Content-Type": "text/html" }).end("<!doctype html><title>evil</title><body>evil"); });
  await new Promise((resolve) => evil.listen(0, "127.0.0.1", resolve));
  evil_url = `http://127.0.0.1:${evil.address().port}/`;
});
after(async () => {
  assert.deepEqual(readFileSync(axis.path("nominal.json")), original, "no attack changed the file");
  await browser.close();
  evil.close();
  await studio.stop();
  axis.remove();
});
async function on_evil_page(action, argument) {
  const page = await context.newPage();
  await page.goto(evil_url);
  try { return await page.evaluate(action, argument); } finally { await page.close(); }
}

test("fetch reads nothing, with and without credentials", async () => {
  for (const path of ["/", "/studio.js", "/data/stolen.csv"])
    for (const credentials of ["include", "omit"]) {
      const answer = await on_evil_page(async ({ url, credentials }) => { try { return await (await fetch(url, { credentials })).text(); } catch (error) { return `refused: ${error.name}`; } }, { url: studio_url + path, credentials });
      assert.equal(answer, "refused: TypeError", path);
    }
});

test("nothing is written by fetch, PUT or POST, simple requests included", async () => {
  const requests = [
    { method: "PUT", body: "1,2" }, { method: "POST", body: "1,2", mode: "no-cors", headers: { "Content-Type": "text/plain" } }, { method: "PUT", body: "1,2", credentials: "include", headers: { "Content-Type": "application/octet-stream" } },
  ];
  for (const options of requests)
    await on_evil_page(async ({ url, options }) => { try { await fetch(url, { credentials: "include", ...options }); } catch { /* as it should be */ } }, { url: `${studio_url}/data/planted.csv?offset=0&last=1`, options });
  assert(!existsSync(axis.path("planted.csv")));
});

test("a WebSocket is refused", async () => {
  const answer = await on_evil_page((url) => new Promise((resolve) => {
    const socket = new WebSocket(url.replace("http", "ws") + "/socket");
    socket.onopen = () => resolve("open");
    socket.onerror = () => resolve("refused");
  }), studio_url);
  assert.equal(answer, "refused");
});

test("the page cannot be framed, nor read through a window", async () => {
  const page = await context.newPage();
  await page.goto(evil_url);
  await page.evaluate((url) => { const frame = document.createElement("iframe"); frame.src = url; document.body.append(frame); }, studio_url);
  await page.waitForTimeout(1500);
  const frames = page.frames().slice(1);
  for (const frame of frames) assert.equal(await frame.locator(".app, #root").count().catch(() => 0), 0, "nothing of the studio is in the frame");
  const opener = await page.evaluate((url) => new Promise((resolve) => {
    const other = window.open(url);
    setTimeout(() => { try { resolve(String(other?.document?.title)); } catch (error) { resolve(error.name); } }, 1500);
  }), studio_url);
  assert(["SecurityError", "undefined", "null", ""].includes(opener), `"${opener}"`);
  await page.close();
});

test("a form cannot be sent to it", async () => {
  for (const encoding of ["application/x-www-form-urlencoded", "multipart/form-data", "text/plain"]) {
    const page = await context.newPage();
    await page.goto(evil_url);
    const sent = page.waitForResponse((response) => response.url().startsWith(studio_url), { timeout: 10000 }).catch(() => null);
    await page.evaluate(({ url, encoding }) => {
      const form = document.createElement("form");
      Object.assign(form, { method: "post", action: `${url}/data/planted.csv?offset=0&last=1`, enctype: encoding });
      form.innerHTML = '<input name="a" value="1,2">';
      document.body.append(form);
      form.submit();
    }, { url: studio_url, encoding });
    const response = await sent;
    if (response) assert(response.status() >= 400, `${encoding}: ${response.status()}`);
    await page.close();
  }
  assert(!existsSync(axis.path("planted.csv")));
});

test("script and style of the studio do not load elsewhere", async () => {
  const loaded = await on_evil_page((url) => new Promise((resolve) => {
    const script = Object.assign(document.createElement("script"), { src: url + "/studio.js", type: "text/javascript" });
    script.onload = () => resolve("loaded");
    script.onerror = () => resolve("refused");
    document.body.append(script);
  }), studio_url);
  assert.equal(loaded, "refused");
});

test("a browser without the cookie, and a token that was used, get nothing", async () => {
  const stranger = await browser.newContext();
  const page = await stranger.newPage();
  for (const url of [studio_url, await studio.address]) {
    const response = await page.goto(url);
    assert(response.status() >= 400, `${url}: ${response.status()}`);
  }
  await stranger.close();
});

test("the page that is attacked still works, and its policy holds", async () => {
  const response = await victim.reload();
  const headers = response.headers();
  assert.match(headers["content-security-policy"], /default-src 'none'.*frame-ancestors 'none'/s);
  assert.doesNotMatch(headers["content-security-policy"], /unsafe/);
  assert.equal(headers["access-control-allow-origin"], undefined);
  await victim.waitForSelector(".plot canvas");
  assert.deepEqual(reached.filter((url) => url !== "/" && url !== "/favicon.ico"), []);
});
