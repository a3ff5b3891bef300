// Which way the signals of a diagram flow: what is drawn from left to right, what comes back below.

export interface FlowEdge { from: string; to: string; back: boolean }

/**
 * Marks the wires that close a loop, seen from the sources. Returns the nodes in the order of the flow, and those that only
 * feed back: friction fed by a velocity, a sensor in the return path. These are drawn from right to left.
 */
export function flow_of(ids: string[], edges: FlowEdge[]): { order: string[]; returning: Set<string> } {
  const order = mark_loops(ids, edges);
  const returning = returning_nodes(ids, order, edges);
  for (const edge of edges) if (returning.has(edge.from) || returning.has(edge.to)) edge.back = true;
  return { order: between(order, returning, edges), returning };
}

export function group<T>(list: T[], key: (entry: T) => string): Map<string, T[]> {
  const groups = new Map<string, T[]>();
  for (const entry of list) {
    const of_key = groups.get(key(entry));
    if (of_key) of_key.push(entry); else groups.set(key(entry), [entry]);
  }
  return groups;
}

function mark_loops(ids: string[], edges: FlowEdge[]): string[] {
  const leaving = group(edges, (edge) => edge.from), entered = new Set(edges.map((edge) => edge.to));
  const state = new Map<string, "open" | "done">(), order: string[] = [];
  const visit = (id: string): void => {
    state.set(id, "open");
    for (const edge of leaving.get(id) ?? []) {
      const target = state.get(edge.to);
      if (target === "open") edge.back = true;
      else if (target === undefined) visit(edge.to);
    }
    state.set(id, "done");
    order.unshift(id);
  };
  // In reverse, because each visit puts its nodes before those of the visits before it.
  for (const id of [...ids].reverse()) if (!entered.has(id) && !state.has(id)) visit(id);
  for (const id of ids) if (!state.has(id)) visit(id);
  return order;
}

function returning_nodes(ids: string[], order: string[], edges: FlowEdge[]): Set<string> {
  const rank = new Map(order.map((id, i) => [id, i]));
  const leaving = group(edges, (edge) => edge.from), entering = group(edges, (edge) => edge.to);
  // Nodes from which every way leads back, with the first node that it leads to.
  const leads_to = new Map<string, number>();
  for (let changed = true; changed;) {
    changed = false;
    for (const id of ids) {
      const out = leaving.get(id) ?? [], into = entering.get(id) ?? [];
      if (leads_to.has(id) || !out.length || !into.length || !out.every((edge) => edge.back || leads_to.has(edge.to))) continue;
      const goal = Math.max(...out.map((edge) => (edge.back ? rank.get(edge.to)! : leads_to.get(edge.to)!)));
      if (!into.every((edge) => !edge.back && rank.get(edge.from)! > goal)) continue;
      leads_to.set(id, goal);
      changed = true;
    }
  }
  // They return only where the flow also goes on: a loop without any other output has no way back.
  const goes_on = (id: string) => !leads_to.has(id) && (leaving.get(id) ?? []).some((edge) => !leads_to.has(edge.to));
  const returning = new Set<string>();
  for (let changed = true; changed;) {
    changed = false;
    for (const id of leads_to.keys()) {
      if (returning.has(id) || !entering.get(id)!.every((edge) => returning.has(edge.from) || goes_on(edge.from))) continue;
      returning.add(id);
      changed = true;
    }
  }
  return returning;
}

/** The order with each returning node before what feeds it. */
function between(order: string[], returning: Set<string>, edges: FlowEdge[]): string[] {
  const entering = group(edges, (edge) => edge.to);
  const result = order.filter((id) => !returning.has(id));
  for (const id of order.filter((entry) => returning.has(entry))) {
    const at = Math.min(...entering.get(id)!.map((edge) => result.indexOf(edge.from)).filter((index) => index >= 0), result.length);
    result.splice(at, 0, id);
  }
  return result;
}
