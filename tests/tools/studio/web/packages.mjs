// The packages of the studio's page (tools/studio/web/package-lock.json), for tests that stand elsewhere in the tree.
import { createRequire } from "node:module";

export const packages = createRequire(new URL("../../../../tools/studio/web/package.json", import.meta.url));
