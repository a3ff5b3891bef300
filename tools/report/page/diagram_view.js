// A block diagram on a page: zoom, pan, subdiagrams and state machines that open and close. The layout library is unpacked when the first
// diagram is near the screen.
import { escaped } from "./diagram_text.js";
import { layOut } from "./diagram_layout.js";
import { drawDiagram } from "./diagram_drawing.js";
import { chartPicture } from "./chart_drawing.js";
import { layOutChart } from "./chart_layout.js";

const SMALLEST = 0.92;  // the smallest text, 11 px at full size, stays above 10 px
const LARGEST = 4, MOST_BLOCKS = 300, MOST_CHARTS = 20;
let library = null;

async function unpack(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
}

/** An instance of ELK, whose source stands packed in the page. */
function elk() {
  library ??= unpack(document.getElementById("elk").textContent).then((source) => {
    const script = document.createElement("script");
    script.textContent = source;
    document.head.append(script);
    return new ELK();
  });
  return library;
}

export class DiagramView {
  constructor(figure) {
    this.figure = figure;
    this.graph = JSON.parse(figure.querySelector("script").textContent);
    this.machines = this.graph.nodes.filter((node) => node.chart);
    this.subdiagrams = this.graph.nodes.filter((node) => node.room === "subdiagram" || node.chart).map((node) => node.path);
    this.open = new Set(this.subdiagrams.filter((path) => this.graph.nodes.some((node) => node.room === "added" && node.path.startsWith(`${path}.`))));
    this.scale = 1;
    this.canvas = figure.querySelector(".canvas");
    this.figure.querySelector(".tools")?.remove();
    this.tools = this.buildTools();
    this.canvas.before(this.tools);
    this.canvas.addEventListener("click", (event) => this.clicked(event));
    this.canvas.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") this.clicked(event);
    });
    this.canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    this.canvas.addEventListener("pointerdown", (event) => this.drag(event));
    new ResizeObserver(() => this.resized()).observe(this.canvas);
  }

  buildTools() {
    const tools = document.createElement("div");
    tools.className = "tools";
    const button = (name, title, action) => {
      const made = document.createElement("button");
      made.type = "button"; made.textContent = name; made.title = title; made.onclick = action;
      tools.append(made);
      return made;
    };
    if (this.subdiagrams.length > 0) {
      this.openAll = button("Open all", "Show the blocks inside of all subdiagrams, and the states of all state machines", () => this.show(new Set(this.subdiagrams)));
      this.closeAll = button("Close all", "Show subdiagrams and state machines as blocks", () => this.show(new Set()));
    }
    button("−", "Smaller", () => this.zoom(this.scale / 1.25));
    button("+", "Larger", () => this.zoom(this.scale * 1.25));
    button("Fit", "As wide as the page", () => this.fit());
    button("SVG", "Save this picture", () => this.save());
    return tools;
  }

  count(open) {
    const shown = (path) => { for (let i = path.lastIndexOf("."); i >= 0; i = path.lastIndexOf(".", i - 1)) if (!open.has(path.slice(0, i))) return false; return true; };
    return this.graph.nodes.filter((node) => shown(node.path)).length;
  }

  async show(open) {
    if (this.count(open) > MOST_BLOCKS) {
      this.note(`${this.count(open)} blocks are too many for one picture; open single subdiagrams.`);
      return;
    }
    this.open = open;
    try {
      this.picture = drawDiagram(await layOut(await elk(), this.graph, open));
    } catch (error) {
      this.note(`The diagram could not be laid out: ${error.message}`);
      throw error;
    }
    this.canvas.innerHTML = this.picture.svg;
    if (this.openAll) this.openAll.disabled = this.subdiagrams.every((path) => open.has(path));
    if (this.closeAll) this.closeAll.disabled = open.size === 0;
    this.fit();
    this.figure.dataset.drawn = "";
  }

  /** The charts of all state machines, each as a picture below the diagram. */
  async showCharts() {
    for (const { path, chart } of this.machines.slice(0, MOST_CHARTS)) {
      const frame = document.createElement("div");
      frame.className = "wide chart-frame";
      frame.innerHTML = `<p>States of ${escaped(path)}</p>${chartPicture(await layOutChart(await elk(), chart), `States of ${path}`)}`;
      (this.figure.querySelector("figcaption") ?? this.canvas).before(frame);
    }
  }

  note(text) {
    const line = this.figure.querySelector(".remark") ?? this.tools.appendChild(document.createElement("span"));
    line.className = "remark";
    line.textContent = text;
  }

  /** Shrinks a wide picture to the page, but never so far that its text is hard to read: then it scrolls. */
  fit() { this.zoom(Math.min(1, this.canvas.clientWidth / this.picture.width)); }

  zoom(scale) {
    if (!this.picture) return;
    this.scale = Math.min(LARGEST, Math.max(SMALLEST, scale));
    const svg = this.canvas.firstElementChild;
    svg.setAttribute("width", this.picture.width * this.scale);
    svg.setAttribute("height", this.picture.height * this.scale);
    this.resized();
  }

  resized() {
    const { canvas } = this;
    this.figure.classList.toggle("scrolls", canvas.scrollWidth > canvas.clientWidth + 1 || canvas.scrollHeight > canvas.clientHeight + 1);
  }

  clicked(event) {
    if (this.dragged) return;
    const target = event.target.closest("[role=button][data-node]");
    if (!target) return;
    event.preventDefault();
    const { path } = this.graph.nodes[Number(target.dataset.node)];
    const open = new Set(this.open);
    if (!open.delete(path)) open.add(path);
    this.show(open);
  }

  wheel(event) {
    if (!event.ctrlKey && !event.metaKey) return;  // a plain wheel scrolls
    event.preventDefault();
    const { canvas } = this, box = canvas.getBoundingClientRect();
    const x = event.clientX - box.left, y = event.clientY - box.top, before = this.scale;
    const left = canvas.scrollLeft + x, top = canvas.scrollTop + y;
    this.zoom(this.scale * Math.exp(-0.002 * event.deltaY));
    canvas.scrollLeft = left * this.scale / before - x;
    canvas.scrollTop = top * this.scale / before - y;
  }

  drag(start) {
    if (start.button !== 0 || start.pointerType !== "mouse") return;  // a finger scrolls by itself
    const { canvas } = this, from = { left: canvas.scrollLeft, top: canvas.scrollTop };
    this.dragged = false;
    const move = (event) => {
      const dx = event.clientX - start.clientX, dy = event.clientY - start.clientY;
      if (Math.hypot(dx, dy) > 4) this.dragged = true;
      canvas.scrollLeft = from.left - dx;
      canvas.scrollTop = from.top - dy;
    };
    const stop = () => { removeEventListener("pointermove", move); removeEventListener("pointerup", stop); };
    addEventListener("pointermove", move);
    addEventListener("pointerup", stop);
  }

  save() {
    const link = document.createElement("a");
    const style = document.getElementById("diagram-style").textContent;
    const svg = this.picture.svg.replace(">", `><style>${withValues(style)}</style>`);
    link.href = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
    link.download = "diagram.svg";
    link.click();
    URL.revokeObjectURL(link.href);
  }
}

/** A style with the values of the page's variables in their places. */
function withValues(style) {
  const values = getComputedStyle(document.documentElement);
  return style.replace(/var\((--[\w-]+)\)/g, (_, name) => values.getPropertyValue(name).trim());
}

export function startDiagrams() {
  for (const figure of document.querySelectorAll("figure.block-diagram")) {
    const view = new DiagramView(figure);
    view.showCharts().then(() => view.show(view.open));
  }
}
