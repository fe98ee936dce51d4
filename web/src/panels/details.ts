// What is known of one node: inputs as written, results, how it fared, its reference page.
import { button, element } from "../core/dom.ts";
import { blocks, spans } from "../core/markdown.ts";
import type { GraphNode } from "../core/protocol.ts";
import type { Store } from "../core/store.ts";
import { formatBytes, formatTime } from "../core/units.ts";
import { OUTCOME_WORDS } from "./graph.ts";

export type DetailsEvents = {
  show(node: string, result?: string): void;
  openSource(node: GraphNode): void;
};

export class DetailsPanel {
  readonly root = element("aside", { class: "details", "aria-label": "Node", tabindex: 0 });
  private node: string | undefined;

  constructor(
    private readonly store: Store,
    private readonly events: DetailsEvents,
  ) {
    for (const type of ["described", "document", "outcomes", "shown"] as const) store.on(type, () => this.update());
  }

  /** Turns to a node and asks for its page. */
  describe(node: string): void {
    this.node = node;
    this.store.send({ type: "describe", node });
    this.root.scrollTop = 0;
    this.update();
  }

  private update(): void {
    const name = this.node ?? this.store.get("shown")?.node;
    const node = this.store.get("document")?.nodes.find((n) => n.name === name);
    if (!node) {
      this.root.replaceChildren(element("p", { class: "hint" }, "Click a node to see it; double click goes to its line."));
      return;
    }
    const described = this.store.get("described");
    const page = described?.node === node.name ? described : undefined;
    this.root.replaceChildren(
      element("h2", {}, node.name, " ", element("span", { class: "kind" }, node.kind)),
      button(`line ${node.line}`, "Show in the source", () => this.events.openSource(node), { class: "link" }),
      this.outcome(node.name),
      this.inputs(node),
      this.results(node, page?.results ?? []),
      ...(page ? [element("hr", {}), ...markdownNodes(page.markdown)] : [element("p", { class: "hint" }, node.about)]),
    );
  }

  private outcome(name: string): HTMLElement {
    const outcome = this.store.get("outcomes")?.nodes.find((n) => n.name === name);
    if (!outcome) return element("p", { class: "hint" }, "Not run yet.");
    const parts = [OUTCOME_WORDS[outcome.outcome], formatTime(outcome.ms)];
    if (outcome.bytes > 0) parts.push(formatBytes(outcome.bytes));
    return element(
      "div",
      {},
      element("p", { class: `outcome-line ${outcome.outcome}` }, parts.join(" · ")),
      outcome.explain ? element("p", { class: "hint" }, outcome.explain) : null,
      ...outcome.warnings.map((warning) => element("p", { class: "message warning" }, "⚠ ", warning)),
    );
  }

  private inputs(node: GraphNode): HTMLElement {
    const rows = node.inputs.map(({ name, text, from }) => {
      const links = from.flatMap((other) => [" ", button(other, `Show ${other}`, () => this.events.show(other), { class: "link" })]);
      return element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, element("code", {}, text), ...links));
    });
    return element("table", { class: "inputs" }, ...rows);
  }

  private results(node: GraphNode, summaries: { name: string; summary: string }[]): HTMLElement {
    const rows = node.results.flatMap(({ name, kind, main }) => {
      const summary = summaries.find((s) => s.name === name)?.summary ?? "";
      const link = button(main ? `${name} (main)` : name, `Show ${node.name}.${name}`, () => this.events.show(node.name, name), { class: "link" });
      const row = element("tr", {}, element("th", { scope: "row" }, link), element("td", {}, kind));
      return summary ? [row, element("tr", {}, element("td", { class: "summary", colspan: 2 }, summary))] : [row];
    });
    return element("table", { class: "results" }, element("caption", {}, "Gives"), ...rows);
  }
}

/** Elements of a reference page; its text is text, whatever it says. */
function markdownNodes(markdown: string): HTMLElement[] {
  const inline = (text: string): (HTMLElement | string)[] => spans(text).map((part, i) => (i % 2 ? element("code", {}, part) : part));
  const nodes: HTMLElement[] = [];
  let table: HTMLTableElement | undefined;
  for (const block of blocks(markdown)) {
    if (block.kind !== "row") table = undefined;
    switch (block.kind) {
      case "heading":
        nodes.push(element("h3", {}, ...inline(block.text)));
        break;
      case "paragraph":
        nodes.push(element("p", {}, ...inline(block.text)));
        break;
      case "item":
        nodes.push(element("p", { class: "item" }, "• ", ...inline(block.text)));
        break;
      case "code":
        nodes.push(element("pre", {}, block.text));
        break;
      case "row":
        if (!table) {
          table = element("table", {});
          nodes.push(table);
        }
        table.append(element("tr", {}, ...block.cells.map((cell) => element(block.head ? "th" : "td", {}, ...inline(cell)))));
        break;
    }
  }
  return nodes;
}
