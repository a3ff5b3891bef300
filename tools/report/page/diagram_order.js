// The order in which blocks are read, from references over controllers to plants, and with it the wires that lead back.

/** Strongly connected components of nodes, each after the components that it depends on; within that, in the given order. */
function components(nodes, edges) {
  const next = new Map(nodes.map((n) => [n, []]));
  for (const { from, to } of edges) if (next.has(from) && next.has(to)) next.get(from).push(to);
  const index = new Map(), low = new Map(), stack = [], onStack = new Set(), found = [];
  for (const root of nodes) {
    if (index.has(root)) continue;
    const work = [[root, 0]];
    while (work.length > 0) {
      const top = work.at(-1), [node] = top;
      if (top[1] === 0 && !index.has(node)) {
        index.set(node, index.size); low.set(node, index.get(node));
        stack.push(node); onStack.add(node);
      }
      const to = next.get(node)[top[1]++];
      if (to === undefined) {
        work.pop();
        if (work.length > 0) low.set(work.at(-1)[0], Math.min(low.get(work.at(-1)[0]), low.get(node)));
        if (low.get(node) !== index.get(node)) continue;
        const component = [];
        for (let member; member !== node;) { member = stack.pop(); onStack.delete(member); component.push(member); }
        found.push(component);
      } else if (!index.has(to)) work.push([to, 0]);
      else if (onStack.has(to)) low.set(node, Math.min(low.get(node), index.get(to)));
    }
  }
  return sorted(found.map((c) => nodes.filter((n) => c.includes(n))), edges);
}

/** Components in the order of signals; among those that are ready, the first of the file comes first. */
function sorted(found, edges) {
  const of = new Map();
  found.forEach((component, c) => component.forEach((n) => of.set(n, c)));
  const needs = found.map(() => new Set());
  for (const { from, to } of edges)
    if (of.has(from) && of.has(to) && of.get(from) !== of.get(to)) needs[of.get(to)].add(of.get(from));
  const first = found.map((c) => Math.min(...c)), done = new Set(), out = [];
  while (out.length < found.length) {
    const ready = found.map((_, c) => c).filter((c) => !done.has(c) && [...needs[c]].every((n) => done.has(n)));
    const chosen = ready.reduce((best, c) => (first[c] < first[best] ? c : best));
    done.add(chosen);
    out.push(found[chosen]);
  }
  return out;
}

/**
 * The nodes of one level in reading order. A loop begins at the block that references enter from outside: wires from
 * the loop into that block lead back. `edges`: {from, to, weight}; from may be a node outside of the level, and `weight`
 * says how much the wire looks like a reference.
 */
export function readingOrder(nodes, edges) {
  const order = [];
  for (const component of components(nodes, edges)) {
    if (component.length === 1) { order.push(component[0]); continue; }
    const inside = new Set(component), score = new Map(component.map((n) => [n, 0]));
    for (const { from, to, weight } of edges)
      if (inside.has(to) && !inside.has(from)) score.set(to, Math.max(score.get(to), weight));
    const entry = component.reduce((best, n) => (score.get(n) > score.get(best) ? n : best));
    order.push(...readingOrder(component, edges.filter(({ from, to }) => !(to === entry && inside.has(from)))));
  }
  return order;
}
