// What is wrong with a page as it is seen: small texts, things that overflow, blocks of a diagram that overlap.
// These functions run inside of the page.

/** Texts that are seen and smaller than `least` px on the screen. */
export function smallTexts(least) {
  const found = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const text = walker.currentNode.textContent.trim(), parent = walker.currentNode.parentElement;
    if (!text || ["SCRIPT", "STYLE", "NOSCRIPT", "TITLE", "title"].includes(parent.tagName)) continue;
    if (!parent.checkVisibility?.({ visibilityProperty: true }) || parent.getClientRects().length === 0) continue;
    let size = parseFloat(getComputedStyle(parent).fontSize);
    if (parent.ownerSVGElement) { const m = parent.getScreenCTM(); size *= Math.hypot(m.a, m.b); }  // turned texts, too
    if (size < least - 0.01) found.push(`"${text.slice(0, 40)}" is ${size.toFixed(1)} px`);
  }
  return found.slice(0, 10);
}

/** Whether the page is wider than the window, and elements that reach out of a parent that hides or lets them. */
export function overflows() {
  const found = [], { clientWidth, scrollWidth } = document.documentElement;
  if (scrollWidth > clientWidth + 1) {
    found.push(`the page is ${scrollWidth} px wide in a window of ${clientWidth} px`);
    for (const element of document.querySelectorAll("body *")) {
      if (element.closest(".wide, .canvas, pre, .u-wrap")) continue;
      if (element.getBoundingClientRect().right > clientWidth + 1) { found.push(`because of ${element.tagName} .${element.className}: ${element.textContent.slice(0, 40)}`); break; }
    }
  }
  const scrolls = (e) => { const o = getComputedStyle(e).overflowX; return o === "auto" || o === "scroll"; };
  for (const element of document.querySelectorAll("p, dd, dt, td, th, button, figcaption, h1, h2, .between, .curves")) {
    if (element.getClientRects().length === 0 || element.closest("[hidden]")) continue;
    if (element.scrollWidth > element.clientWidth + 1 && element.clientWidth > 0 && getComputedStyle(element).display !== "inline" && !scrolls(element))
      found.push(`${element.tagName} "${element.textContent.slice(0, 40)}" is ${element.scrollWidth} px wide in ${element.clientWidth} px`);
  }
  return found.slice(0, 10);
}

/** States of charts that overlap without one being inside the other, and texts that leave their state or cover another's. */
export function chartFaults() {
  const apart = (a, b) => a.right <= b.left + 0.6 || b.right <= a.left + 0.6 || a.bottom <= b.top + 0.6 || b.bottom <= a.top + 0.6;
  const found = [], name = (g) => g.querySelector(".name").textContent;
  const within = (a, b) => a.left >= b.left - 1 && a.right <= b.right + 1 && a.top >= b.top - 1 && a.bottom <= b.bottom + 1;
  for (const chart of document.querySelectorAll("svg.diagram g.chart")) {
    const states = [...chart.querySelectorAll("g.state")].map((g) => ({ g, name: name(g), box: g.querySelector(".edge").getBoundingClientRect() }));
    states.forEach((a, i) => states.slice(i + 1).forEach((b) => {
      if (!apart(a.box, b.box) && !within(a.box, b.box) && !within(b.box, a.box)) found.push(`state ${a.name} overlaps ${b.name}`);
    }));
    for (const { g, name, box } of states)
      for (const text of g.querySelectorAll("text")) if (!within(text.getBoundingClientRect(), box)) found.push(`"${text.textContent}" leaves state ${name}`);
    const guards = [...chart.querySelectorAll("g.guard")].map((g) => ({ name: g.textContent, box: g.getBoundingClientRect() }));
    guards.forEach((a, i) => guards.slice(i + 1).forEach((b) => { if (!apart(a.box, b.box)) found.push(`guard "${a.name}" overlaps "${b.name}"`); }));
    for (const { name, box } of guards)
      for (const state of states) if (!state.g.classList.contains("outer") && !apart(box, state.box)) found.push(`guard "${name}" covers state ${state.name}`);
  }
  return found.slice(0, 10);
}

/** Blocks of diagrams that overlap, texts that leave their blocks or their picture, wires that cross blocks. */
export function diagramFaults() {
  const found = [];
  const apart = (a, b) => a.right <= b.left + 0.6 || b.right <= a.left + 0.6 || a.bottom <= b.top + 0.6 || b.bottom <= a.top + 0.6;
  for (const svg of document.querySelectorAll("svg.diagram")) {
    const name = (node) => node.querySelector("title").textContent.split("\n")[0];
    const nodes = [...svg.querySelectorAll("g.node")].map((node) => ({ name: name(node), box: node.querySelector(".shape").getBoundingClientRect(), node }));
    const ground = svg.getBoundingClientRect();
    nodes.forEach((a, i) => nodes.slice(i + 1).forEach((b) => { if (!apart(a.box, b.box)) found.push(`${a.name} overlaps ${b.name}`); }));
    for (const { name, box, node } of nodes) {
      const texts = [...node.querySelectorAll("text")];
      for (const text of texts) {
        const t = text.getBoundingClientRect(), outside = t.top >= box.bottom - 1 || t.bottom <= box.top + 5;
        if (!outside && (t.left < box.left - 1 || t.right > box.right + 1 || t.bottom > box.bottom + 1)) found.push(`"${text.textContent}" leaves ${name}`);
        for (const other of nodes) if (other.node !== node && !apart(t, other.box)) found.push(`"${text.textContent}" of ${name} covers ${other.name}`);
      }
    }
    for (const text of svg.querySelectorAll("text")) {
      const t = text.getBoundingClientRect();
      if (t.left < ground.left - 1 || t.right > ground.right + 1 || t.top < ground.top - 1 || t.bottom > ground.bottom + 1) found.push(`"${text.textContent}" is clipped`);
    }
    for (const line of svg.querySelectorAll("g.wire > .line")) {
      const length = line.getTotalLength(), matrix = line.getScreenCTM();
      for (let s = 12; s < length - 12; s += 6) {
        const p = line.getPointAtLength(s).matrixTransform(matrix);
        const hit = nodes.find(({ box }) => p.x > box.left + 2 && p.x < box.right - 2 && p.y > box.top + 2 && p.y < box.bottom - 2);
        if (hit) { found.push(`a wire crosses ${hit.name}: ${line.parentElement.querySelector("title")?.textContent}`); break; }
      }
    }
  }
  return found.slice(0, 10);
}
