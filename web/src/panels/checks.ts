// What the graph's checks found: pass, fail or only measured.
import { element, setText } from "../core/dom.ts";
import type { Check, Checks, Named } from "../core/protocol.ts";
import type { Store } from "../core/store.ts";
import { formatNumber } from "../core/units.ts";

/** Sign and word of a check; never colour alone. */
export function verdict(check: Check): { sign: string; word: string; class: string } {
  if (check.ok === null) return { sign: "–", word: "measured", class: "measured" };
  return check.ok ? { sign: "✓", word: "passes", class: "passes" } : { sign: "✗", word: "fails", class: "fails" };
}

/** A value with its unit, as lists show it. */
export function valueText({ value, unit }: Pick<Named, "value" | "unit">): string {
  if (value === null) return "–";
  const text = typeof value === "number" ? formatNumber(value) : typeof value === "boolean" ? (value ? "yes" : "no") : value;
  return unit ? `${text} ${unit}` : text;
}

export class ChecksPanel {
  readonly root = element("section", { class: "panel checks", "aria-label": "Checks" });
  private readonly count = element("span", { class: "count" });
  private readonly list = element("ul", { class: "check-list" });
  private open = new Set<string>();

  constructor(
    store: Store,
    private readonly show: (node: string) => void,
  ) {
    this.root.append(element("header", {}, element("h2", {}, "Checks"), this.count), this.list);
    store.on("checks", (checks) => this.update(checks));
  }

  private update({ items }: Checks): void {
    const failing = items.filter((check) => check.ok === false).length;
    const judged = items.filter((check) => check.ok !== null).length;
    setText(this.count, failing > 0 ? `${failing} of ${judged} fail` : judged > 0 ? `all ${judged} pass` : "");
    this.count.classList.toggle("fails", failing > 0);
    if (items.length === 0) {
      this.list.replaceChildren(element("li", { class: "hint" }, "No node of this graph measures or checks anything."));
      return;
    }
    // Failing ones first, else as the file has them.
    const order = [...items].sort((a, b) => Number(a.ok !== false) - Number(b.ok !== false));
    this.list.replaceChildren(...order.map((check) => this.item(check)));
  }

  private item(check: Check): HTMLElement {
    const { sign, word, class: name } = verdict(check);
    const details = element(
      "details",
      { class: `check ${name}`, open: this.open.has(check.node) },
      element(
        "summary",
        {},
        element("span", { class: "sign", title: word, role: "img", "aria-label": word }, sign),
        element("span", { class: "check-node" }, check.node),
        element("span", { class: "sentence" }, check.sentence),
      ),
      element("table", {}, ...check.values.map((v) => element("tr", {}, element("th", { scope: "row" }, v.name.replaceAll("_", " ")), element("td", {}, valueText(v))))),
    );
    const link = element("button", { type: "button", class: "link" }, `Show ${check.node}`);
    link.addEventListener("click", () => this.show(check.node));
    details.append(link);
    details.dataset["node"] = check.node;
    details.addEventListener("toggle", () => {
      if (details.open) this.open.add(check.node);
      else this.open.delete(check.node);
    });
    return element("li", {}, details);
  }
}
