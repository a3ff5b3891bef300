// A diagram as an SVG file that stands alone: colors are written out, as programs for pictures do not know variables.
import { layOut } from "./diagram_layout.js";
import { drawDiagram } from "./diagram_drawing.js";

/** Subdiagrams and state machines down to this depth are open. */
function openPaths(graph, depth) {
  return new Set(graph.nodes.filter((node) => (node.room === "subdiagram" || node.chart) && node.path.split(".").length <= depth).map((node) => node.path));
}

/** `style`: page.css, whose first rule has the colors, and diagram.css. */
export async function diagramFile(elk, graph, depth, style) {
  const colors = new Map([.../:root \{([^}]*)\}/.exec(style.page)[1].matchAll(/(--[\w-]+): ([^;]+);/g)].map((m) => [m[1], m[2]]));
  const rules = style.diagram.replace(/\/\*[^]*?\*\//g, "").replace(/var\((--[\w-]+)\)/g, (_, name) => colors.get(name));
  const { svg, width, height } = drawDiagram(await layOut(elk, graph, openPaths(graph, depth)));
  const ground = `<rect width="${width}" height="${height}" fill="${colors.get("--paper")}"/>`;
  const font = `.diagram { font-family: "DejaVu Sans", Verdana, sans-serif; }`;
  return svg.replace(">", `>\n<style>${rules}${font}</style>\n${ground}\n`) + "\n";
}
