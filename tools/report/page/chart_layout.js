// Lays out the chart of a state machine with ELK: time runs downward, states stand inside the states that contain them.
import { FONT, textWidth } from "./diagram_text.js";

const STATE_LINE = 15, STATE_PADDING = 10, DOT = 10, WIDEST_LINE = 190, TITLE = 22;

/** Text in lines of at most `width` px. It breaks at blanks, and inside a word only if that alone is too wide. */
export function wrapped(text, size, width) {
  const lines = [];
  let line = "";
  for (let word of text.split(" ")) {
    const longer = line ? `${line} ${word}` : word;
    if (textWidth(longer, size) <= width) { line = longer; continue; }
    if (line) lines.push(line);
    while (textWidth(word, size) > width) {
      let end = word.length - 1;
      while (end > 1 && textWidth(word.slice(0, end), size) > width) --end;
      lines.push(word.slice(0, end));
      word = word.slice(end);
    }
    line = word;
  }
  if (line) lines.push(line);
  return lines;
}

const widestOf = (lines, size, bold) => Math.max(0, ...lines.map((line) => textWidth(line, size, bold)));

/** What a state shows: its name, and the values that it sets. */
function stateTexts({ name, entries }) {
  const title = wrapped(name, FONT.name, WIDEST_LINE), lines = entries.flatMap((entry) => wrapped(entry, FONT.face, WIDEST_LINE));
  return {
    title, lines,
    width: Math.max(60, widestOf(title, FONT.name, true), widestOf(lines, FONT.face)) + 2 * STATE_PADDING,
    height: TITLE + STATE_LINE * (title.length - 1) + (lines.length > 0 ? 4 + STATE_LINE * lines.length : 0) + 8,
  };
}

/** The text at a transition, "2: jam"; the number is there if the state has several transitions. */
function guardLines({ guard, order }) {
  return wrapped((order > 0 ? `${order}: ` : "") + (guard || "always"), FONT.port, WIDEST_LINE);
}

const CHART = {
  "elk.algorithm": "layered", "elk.direction": "DOWN", "elk.edgeRouting": "ORTHOGONAL", "elk.hierarchyHandling": "INCLUDE_CHILDREN",
  "elk.layered.nodePlacement.strategy": "NETWORK_SIMPLEX", "elk.layered.cycleBreaking.strategy": "GREEDY",
  "elk.json.edgeCoords": "ROOT", "elk.json.shapeCoords": "ROOT", "elk.edgeLabels.placement": "CENTER",
  "elk.spacing.nodeNode": "24", "elk.spacing.edgeNode": "14", "elk.spacing.edgeEdge": "12", "elk.spacing.edgeLabel": "4",
  "elk.layered.spacing.nodeNodeBetweenLayers": "22", "elk.layered.spacing.edgeNodeBetweenLayers": "14",
  "elk.layered.spacing.edgeEdgeBetweenLayers": "12", "elk.spacing.nodeSelfLoop": "14", "elk.spacing.labelLabel": "4",
};

/** The states that contain a state, from the outermost to itself. */
function chainOf(states, index) {
  const chain = [];
  for (let k = index; k >= 0; k = states[k].parent) chain.unshift(k);
  return chain;
}

/** The ends of a transition, lifted to neighbours in one state; nothing if one end contains the other. */
function neighbours(states, { from, to }) {
  const a = chainOf(states, from), b = chainOf(states, to);
  const apart = a.findIndex((state, depth) => depth >= b.length || b[depth] !== state);
  return apart < 0 || apart >= b.length ? null : [a[apart], b[apart]];
}

/** The transitions that lead back: those to a state that is on the way from the initial state to their own. */
function leadsBack({ states, transitions }) {
  const lifted = transitions.map((transition) => neighbours(states, transition)), done = new Set(), onWay = new Set(), back = new Set();
  const visit = (state) => {
    onWay.add(state);
    lifted.forEach((ends, k) => {
      if (!ends || ends[0] !== state) return;
      if (onWay.has(ends[1])) back.add(k);
      else if (!done.has(ends[1])) visit(ends[1]);
    });
    onWay.delete(state);
    done.add(state);
  };
  const first = states.map((_, k) => k).sort((a, b) => states[b].initial - states[a].initial || a - b);
  for (const state of first) if (!done.has(state)) visit(state);
  return back;
}

/**
 * The chart as input of ELK. The states inside a state come after a dot that leads to the one that is entered by default.
 * A transition that leads back is given to ELK the other way round: what remains has no cycles for it to break elsewhere.
 */
function elkChart(chart) {
  const { states, transitions } = chart, texts = states.map(stateTexts), back = leadsBack(chart), edges = [];
  const level = (parent) => {
    const inside = states.map((_, k) => k).filter((k) => states[k].parent === parent);
    const initial = inside.find((k) => states[k].initial);
    const nodes = inside.map((k) => {
      const { width, height } = texts[k], children = level(k);
      if (children.length === 0) return { id: `s${k}`, width, height };
      // ELK gives a state the size of its contents: the padding makes room for its own texts.
      const inner = Math.max(...children.map((child) => child.innerWidth ?? child.width)), side = Math.max(16, (width + 12 - inner) / 2);
      return { id: `s${k}`, children, innerWidth: inner + 2 * side,
               layoutOptions: { ...CHART, "elk.padding": `[top=${height + 8},left=${side},bottom=16,right=${side}]` } };
    });
    if (initial === undefined) return nodes;
    edges.push({ id: `d${initial}`, sources: [`i${parent}`], targets: [`s${initial}`] });
    return [{ id: `i${parent}`, width: DOT, height: DOT, layoutOptions: { "elk.layered.layering.layerConstraint": "FIRST" } }, ...nodes];
  };
  const children = level(-1);
  transitions.forEach((transition, k) => {
    const lines = guardLines(transition);
    const { from, to } = transition, ends = back.has(k) ? [to, from] : [from, to];
    edges.push({ id: `${back.has(k) ? "r" : "t"}${k}`, sources: [`s${ends[0]}`], targets: [`s${ends[1]}`],
                 labels: [{ text: lines.join("\n"), width: widestOf(lines, FONT.port) + 6, height: STATE_LINE * lines.length + 2 }] });
  });
  return { texts, root: { id: "chart", layoutOptions: { ...CHART, "elk.padding": "[top=8,left=8,bottom=8,right=8]" }, children, edges } };
}

/** The points of the parts of a line, in the direction of the transition. */
function pointsOf(edge) {
  const parts = (edge.sections ?? []).map((s) => [s.startPoint, ...(s.bendPoints ?? []), s.endPoint]);
  return edge.id[0] === "r" ? parts.map((points) => points.reverse()).reverse() : parts;
}

/**
 * Lays out a chart with `elk`, an instance of ELK. `chart`: {states: [{name, parent, initial, entries}], transitions:
 * [{from, to, guard, order}]}, as diagram_graph writes it. The result holds numbers and texts only: {width, height,
 * states: [{x, y, width, height, title, lines, isOuter}], dots: [{x, y}], defaults: [[{x, y}]],
 * transitions: [{points: [[{x, y}]], label: {x, y, width, height, lines}}]}, outer states before inner ones.
 */
export async function layOutChart(elk, chart) {
  const { texts, root } = elkChart(chart), laidOut = await elk.layout(root);
  const states = [], dots = [];
  const visit = (parent) => {
    for (const node of parent.children ?? []) {
      const { x, y, width, height } = node, index = Number(node.id.slice(1));
      if (node.id[0] === "i") dots.push({ x: x + width / 2, y: y + height / 2 });
      else states.push({ index, x, y, width, height, title: texts[index].title, lines: texts[index].lines, isOuter: Boolean(node.children) });
      visit(node);
    }
  };
  visit(laidOut);
  const defaults = [], transitions = [];
  for (const edge of laidOut.edges) {
    const points = pointsOf(edge);
    if (edge.id[0] === "d") { defaults.push(...points); continue; }
    const [{ x, y, width, height }] = edge.labels, index = Number(edge.id.slice(1));
    transitions.push({ index, points, label: { x, y, width, height, lines: guardLines(chart.transitions[index]) } });
  }
  return { width: Math.ceil(laidOut.width), height: Math.ceil(laidOut.height), states, dots, defaults, transitions };
}
