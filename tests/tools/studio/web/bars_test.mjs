// The bars by which a curve that fills its plot is drawn, against the line itself:  node --test bars_test.mjs
import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { packages } from "./packages.mjs";

const source = fileURLToPath(new URL("../../../../tools/studio/web/src/scopes/bars.ts", import.meta.url));
const { outputFiles } = packages("esbuild").buildSync({ entryPoints: [source], bundle: true, format: "esm", write: false });
const { bars_of } = await import(`data:text/javascript,${encodeURIComponent(outputFiles[0].text)}`);

let seed = 1;
const random = () => { seed = (seed * 48271) % 2147483647; return seed / 2147483647; };
const LEFT = 40, WIDTH = 120, HEIGHT = 200, to_y = (y) => HEIGHT * (1 - y), to_x = (x) => LEFT + x;
const bars = (xs, ys, steps = false) => bars_of(xs, ys, 0, xs.length - 1, to_x, to_y, LEFT, WIDTH, steps);

/** Every straight piece of the line, in pixels. */
function pieces(xs, ys, steps) {
  const list = [];
  let before = null;
  xs.forEach((x, i) => {
    if (ys[i] === undefined) return;
    if (ys[i] === null) { before = null; return; }
    const here = [to_x(x), to_y(ys[i])];
    if (before && steps) { list.push([before, [here[0], before[1]]], [[here[0], before[1]], here]); } else list.push([before ?? here, here]);
    before = here;
  });
  return list;
}

test("each bar covers what the line covers of its column, no less and no more", () => {
  for (let attempt = 0; attempt < 200; ++attempt) {
    const xs = [], ys = [], steps = attempt % 3 === 0;
    for (let x = -3; x < WIDTH + 3; x += (random() < 0.02 ? 6 : 0.6) * random()) {
      xs.push(x);
      ys.push(random() < 0.03 ? null : random() < 0.1 ? undefined : random());
    }
    const found = bars(xs, ys, steps);
    assert(found, "a curve at random fills the plot");
    const top = Array(WIDTH).fill(Infinity), bottom = Array(WIDTH).fill(-Infinity);
    for (const [[x0, y0], [x1, y1]] of pieces(xs, ys, steps))
      for (let column = Math.max(0, Math.floor(x0 - LEFT)); column <= Math.min(WIDTH - 1, Math.floor(x1 - LEFT)); ++column) {
        const at = (x) => (x1 > x0 ? y0 + ((y1 - y0) * (Math.min(x1, Math.max(x0, x)) - x0)) / (x1 - x0) : y1);
        const ends = x1 > x0 ? [at(LEFT + column), at(LEFT + column + 1)] : [y0, y1];
        top[column] = Math.min(top[column], ...ends);
        bottom[column] = Math.max(bottom[column], ...ends);
      }
    for (let column = 0; column < WIDTH; ++column) {
      if (top[column] === Infinity) { assert.equal(found.top[column], Infinity); continue; }
      assert(Math.abs(found.top[column] - top[column]) < 1e-6 && Math.abs(found.bottom[column] - bottom[column]) < 1e-6, `column ${column} of attempt ${attempt}`);
    }
  }
});

test("one high sample among many stays", () => {
  const xs = Array.from({ length: 1000 }, (_, i) => i * 0.12), ys = xs.map((_, i) => (i % 2 ? 0.4 : 0.6));
  ys[500] = 1;
  const found = bars(xs, ys);
  assert.equal(found.top[60], to_y(1));
  assert.equal(found.bottom[60], to_y(0.4));
});

test("a smooth curve and a short one are drawn as lines", () => {
  const xs = Array.from({ length: 2000 }, (_, i) => i * 0.06);
  assert.equal(bars(xs, xs.map((x) => 0.5 + 0.4 * Math.sin(x / 20))), null);
  assert.equal(bars([0, 1, 2], [0, 1, 0]), null);
  assert.equal(bars([], []), null);
});
