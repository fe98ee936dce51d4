// The graph: what reads what, how each node fared and what it cost.
import { button, element, svg } from "../core/dom.ts";
import { BOX_HEIGHT, BOX_WIDTH, type Layout, type Line, layoutGraph } from "../core/layout.ts";
import type { GraphNode, NodeOutcome, Outcome } from "../core/protocol.ts";
import type { Store } from "../core/store.ts";
import { formatBytes, formatTime } from "../core/units.ts";

/** The word for each outcome; its colour is never alone. */
export const OUTCOME_WORDS: Record<Outcome, string> = {
  computed: "computed",
  cached: "cached",
  cut_off: "cut off",
  failed: "failed",
  blocked: "blocked",
  skipped: "not needed",
  running: "running",
  stale: "stale",
};

export type GraphEvents = {
  show(node: string): void;
  openSource(node: GraphNode): void;
  describe(node: string): void;
};

/** Longest name that fits a box; longer ones end in an ellipsis and have the whole in their tooltip. */
function shorten(text: string, most: number): string {
  return text.length <= most ? text : `${text.slice(0, most - 1)}…`;
}

function path(line: Line): string {
  const [first, ...rest] = line.points;
  if (!first) return "";
  let d = `M${first.x.toFixed(1)} ${first.y.toFixed(1)}`;
  let last = first;
  for (const point of rest) {
    const middle = (last.x + point.x) / 2;
    d += ` C${middle.toFixed(1)} ${last.y.toFixed(1)} ${middle.toFixed(1)} ${point.y.toFixed(1)} ${point.x.toFixed(1)} ${point.y.toFixed(1)}`;
    last = point;
  }
  return d;
}

type Part = { root: SVGGElement; word: SVGTextElement; time: SVGTextElement; bar: SVGRectElement; title: SVGTitleElement };

export class GraphPanel {
  readonly root = element("div", { class: "graph" });
  private readonly scroll = element("div", { class: "graph-scroll", tabindex: 0, role: "region", "aria-label": "Graph" });
  private readonly picture = svg("svg", { class: "graph-picture", role: "group", "aria-label": "Nodes of the graph" });
  private readonly tools: HTMLElement;
  private layout: Layout = { boxes: [], lines: [], width: 0, height: 0 };
  private parts = new Map<string, Part>();
  private shape = "";
  private zoom: number | undefined;
  private selected: string | undefined;

  constructor(
    private readonly store: Store,
    private readonly events: GraphEvents,
  ) {
    this.tools = element(
      "div",
      { class: "graph-tools" },
      button("−", "Smaller", () => this.setZoom((this.zoom ?? this.fitZoom()) / 1.25), { class: "icon" }),
      button("+", "Larger", () => this.setZoom((this.zoom ?? this.fitZoom()) * 1.25), { class: "icon" }),
      button("fit", "The whole graph", () => this.setZoom(undefined), { class: "icon" }),
    );
    this.scroll.append(this.picture);
    this.root.append(this.scroll, this.tools);
    this.scroll.addEventListener("wheel", (event) => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      this.setZoom((this.zoom ?? this.fitZoom()) * Math.exp(-event.deltaY / 300));
    }, { passive: false });
    new ResizeObserver(() => this.applyZoom()).observe(this.scroll);
    store.on("document", ({ nodes }) => this.build(nodes));
    store.on("outcomes", () => this.update());
    store.on("shown", ({ node }) => {
      if (node === this.selected) return;
      this.select(node);
      this.parts.get(node)?.root.scrollIntoView({ block: "nearest", inline: "nearest" });
    });
  }

  private build(nodes: GraphNode[]): void {
    const shape = JSON.stringify(nodes.map((n) => [n.name, n.kind, n.about, n.inputs.map((i) => [i.name, i.from])]));
    if (shape === this.shape) return;
    this.shape = shape;
    this.layout = layoutGraph(nodes);
    const byName = new Map(nodes.map((node) => [node.name, node]));
    const lines = this.layout.lines.map((line) => {
      const kind = byName.get(line.from)?.results.find((r) => r.main)?.kind ?? "";
      const title = svg("title", {}, `${line.from} → ${line.to}: ${line.inputs.join(", ")}${kind ? ` (${kind})` : ""}`);
      return svg("g", { class: "edge" }, title, svg("path", { d: path(line), class: "hit" }), svg("path", { d: path(line), "marker-end": "url(#arrow)" }));
    });
    const marker = svg("marker", { id: "arrow", viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient: "auto" }, svg("path", { d: "M0 0L8 4L0 8z" }));
    this.parts = new Map();
    const boxes = this.layout.boxes.flatMap((box) => {
      const node = byName.get(box.name);
      return node ? [this.box(node, box.x, box.y)] : [];
    });
    this.picture.replaceChildren(svg("defs", {}, marker), ...lines, ...boxes);
    this.picture.setAttribute("viewBox", `0 0 ${this.layout.width || 1} ${this.layout.height || 1}`);
    this.applyZoom();
    this.update();
    this.select(this.selected);
  }

  private box(node: GraphNode, x: number, y: number): SVGGElement {
    const title = svg("title", {});
    const word = svg("text", { x: 10, y: BOX_HEIGHT - 9, class: "outcome-word" });
    const time = svg("text", { x: BOX_WIDTH - 8, y: BOX_HEIGHT - 9, class: "time" });
    const bar = svg("rect", { x: 0, y: BOX_HEIGHT - 3, width: 0, height: 3, class: "share" });
    const root = svg(
      "g",
      { class: "node", transform: `translate(${x} ${y})`, tabindex: 0, role: "button" },
      title,
      svg("rect", { width: BOX_WIDTH, height: BOX_HEIGHT, rx: 4, class: "box" }),
      svg("rect", { width: 4, height: BOX_HEIGHT, class: "stripe" }),
      svg("text", { x: 10, y: 17, class: "name" }, shorten(node.name, 22)),
      svg("text", { x: 10, y: 31, class: "kind" }, shorten(node.kind, 24)),
      word,
      time,
      bar,
    );
    root.dataset["node"] = node.name;
    root.addEventListener("click", () => this.activate(node.name));
    root.addEventListener("dblclick", () => this.events.openSource(node));
    root.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") {
        event.preventDefault();
        event.stopPropagation();
        if (event.shiftKey) this.events.openSource(node);
        else this.activate(node.name);
      }
    });
    this.parts.set(node.name, { root, word, time, bar, title });
    return root;
  }

  private activate(name: string): void {
    this.select(name);
    this.events.show(name);
    this.events.describe(name);
  }

  private update(): void {
    const outcomes = this.store.get("outcomes")?.nodes ?? [];
    const total = Math.max(1, outcomes.reduce((sum, node) => sum + node.ms, 0));
    const byName = new Map(outcomes.map((node) => [node.name, node]));
    for (const [name, part] of this.parts) this.updatePart(name, part, byName.get(name), total);
  }

  private updatePart(name: string, part: Part, outcome: NodeOutcome | undefined, total: number): void {
    const kind = outcome?.outcome ?? "skipped";
    part.root.setAttribute("class", `node ${kind}${name === this.selected ? " selected" : ""}`);
    const warnings = outcome?.warnings.length ?? 0;
    part.word.textContent = `${OUTCOME_WORDS[kind]}${warnings > 0 ? " ⚠" : ""}`;
    const ran = kind === "computed" || kind === "failed" || kind === "running";
    part.time.textContent = outcome && ran ? formatTime(outcome.ms) : "";
    part.bar.setAttribute("width", (ran && outcome ? (BOX_WIDTH * outcome.ms) / total : 0).toFixed(1));
    const about = this.store.get("document")?.nodes.find((n) => n.name === name);
    const size = outcome && outcome.bytes > 0 ? `, ${formatBytes(outcome.bytes)}` : "";
    part.title.textContent = [`${name}: ${about?.kind ?? ""}, ${OUTCOME_WORDS[kind]}${size}`, about?.about, outcome?.explain, ...(outcome?.warnings ?? [])].filter(Boolean).join("\n");
    part.root.setAttribute("aria-label", `${name}, ${about?.kind ?? ""}, ${OUTCOME_WORDS[kind]}${warnings > 0 ? `, ${warnings} warnings` : ""}`);
  }

  /** Marks the node that is shown. */
  select(name: string | undefined): void {
    this.selected = name;
    for (const [other, part] of this.parts) part.root.classList.toggle("selected", other === name);
  }

  /** Scrolls to a node and puts the keyboard on it. */
  focus(name: string): void {
    const part = this.parts.get(name);
    part?.root.scrollIntoView({ block: "center", inline: "center" });
    part?.root.focus();
  }

  private fitZoom(): number {
    const { clientWidth, clientHeight } = this.scroll;
    const fit = Math.min(clientWidth / (this.layout.width || 1), clientHeight / (this.layout.height || 1));
    // Never so small that names cannot be read: then it scrolls.
    return Math.min(1.15, Math.max(0.7, fit));
  }

  private setZoom(zoom: number | undefined): void {
    this.zoom = zoom === undefined ? undefined : Math.min(2.5, Math.max(0.2, zoom));
    this.applyZoom();
  }

  private applyZoom(): void {
    const zoom = this.zoom ?? this.fitZoom();
    this.picture.style.width = `${this.layout.width * zoom}px`;
    this.picture.style.height = `${this.layout.height * zoom}px`;
  }
}
