// Bundles the page into one folder:  node build.mjs [FOLDER] [--development]
// Writes index.html, studio.js, studio.css, layout-worker.js and licenses.txt, each also compressed (.gz), and checks the
// size of the first page.
import { build } from "esbuild";
import { cpSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const options = process.argv.slice(2);
const development = options.includes("--development");
const folder = options.find((option) => !option.startsWith("--")) ?? join(here, "build");
const largest_first_page = 350 * 1024;  // bytes after gzip, without the layout worker: what a slow link can bear

mkdirSync(folder, { recursive: true });
const common = {
  absWorkingDir: here, bundle: true, minify: !development, sourcemap: development ? "inline" : false, target: "es2022",
  format: "esm", legalComments: "none", logLevel: "warning",
  define: { "process.env.NODE_ENV": JSON.stringify(development ? "development" : "production") },
};
await build({ ...common, entryPoints: { studio: "src/main.tsx" }, outdir: folder, loader: { ".svg": "dataurl" } });
await build({ ...common, entryPoints: { "layout-worker": "src/layout/worker.ts" }, outdir: folder, format: "iife" });
cpSync(join(here, "index.html"), join(folder, "index.html"));
writeFileSync(join(folder, "licenses.txt"), licenses());

// The program serves the compressed files.
const files = ["index.html", "studio.js", "studio.css", "layout-worker.js", "licenses.txt"];
const compressed = new Map(files.map((name) => [name, gzipSync(readFileSync(join(folder, name)), { level: 9 })]));
for (const [name, bytes] of compressed) writeFileSync(join(folder, name + ".gz"), bytes);
const size = (name) => compressed.get(name).length;
const first_page = size("index.html") + size("studio.js") + size("studio.css");
console.log(`first page: ${(first_page / 1024).toFixed(0)} KB gzip, layout worker: ${(size("layout-worker.js") / 1024).toFixed(0)} KB gzip`);
if (!development && first_page > largest_first_page) {
  console.error(`the first page is larger than ${largest_first_page / 1024} KB`);
  process.exit(1);
}

/** The licenses of all packages whose code is in the bundle. */
function licenses() {
  const lock = JSON.parse(readFileSync(join(here, "package-lock.json"), "utf8"));
  const packages = Object.entries(lock.packages).filter(([path, entry]) => path && !entry.dev && !entry.optional);
  return packages.map(([path, entry]) => {
    let text = "";
    for (const name of ["LICENSE", "LICENSE.md", "LICENSE.txt", "license"]) {
      try { text = readFileSync(join(here, path, name), "utf8"); break; } catch { /* the next name */ }
    }
    return `${path.replace(/^.*node_modules\//, "")} ${entry.version} (${entry.license})\n\n${text}`;
  }).join("\n\n" + "-".repeat(80) + "\n\n");
}
