// Starts the real program on a folder made for the test.
import { spawn, execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const need = (name) => process.env[name] ?? (() => { throw new Error(`${name} must name a program`); })();

/** An axis with two hidden effects, cogging and Coulomb friction: the diagram as believed, and records. */
export function hidden_axis() {
  const folder = mkdtempSync(join(tmpdir(), "loopwright_studio_"));
  execFileSync(need("HIDDEN_EFFECTS"), ["21", join(folder, "axis"), "paper", "coulomb_friction", "cogging"], { stdio: "ignore" });
  return { folder, path: (name) => join(folder, "axis", name), remove: () => rmSync(folder, { recursive: true, force: true }) };
}

/** `address` is what the program prints for the browser: with its token. */
export function start_studio(target, port = 0) {
  const child = spawn(need("LOOPWRIGHT"), ["studio", target, "--no-open", "--port", String(port)], { stdio: ["ignore", "pipe", "pipe"] });
  let printed = "";
  const address = new Promise((resolve, reject) => {
    const read = (data) => {
      printed += data;
      const found = /http:\/\/[^\s"']+token=[^\s"']+/.exec(printed);
      if (found) resolve(found[0]);
    };
    child.stdout.on("data", read);
    child.stderr.on("data", read);
    child.on("exit", (code) => reject(new Error(`the program ended with ${code}:\n${printed}`)));
  });
  const ended = new Promise((resolve) => child.on("exit", (code, signal) => resolve({ code, signal })));
  return { address, pid: child.pid, stop: async (signal = "SIGTERM") => { child.kill(signal); return ended; }, printed: () => printed };
}
