// The drawer at the bottom: graph, table, messages, source and study.
import { button, element, setText } from "../core/dom.ts";
import { tooltip } from "../core/keys.ts";
import type { DrawerSize, DrawerTab } from "../core/settings.ts";

export const TABS: { tab: DrawerTab; label: string }[] = [
  { tab: "graph", label: "Graph" },
  { tab: "table", label: "Table" },
  { tab: "messages", label: "Messages" },
  { tab: "source", label: "Source" },
  { tab: "study", label: "Study" },
];

const SIZES: DrawerSize[] = ["closed", "part", "full"];

/** The size after the next press of the key. */
export function nextSize(size: DrawerSize): DrawerSize {
  return SIZES[(SIZES.indexOf(size) + 1) % SIZES.length] as DrawerSize;
}

export class Drawer {
  readonly root = element("section", { class: "drawer", "aria-label": "Details" });
  private readonly tabs = new Map<DrawerTab, HTMLButtonElement>();
  private readonly toggle: HTMLButtonElement;

  constructor(
    private readonly panels: Record<DrawerTab, HTMLElement>,
    private readonly onChange: (tab: DrawerTab, size: DrawerSize) => void,
    public tab: DrawerTab,
    public size: DrawerSize,
  ) {
    const bar = element("div", { class: "tabs", role: "tablist", "aria-label": "Details" });
    const body = element("div", { class: "drawer-body" });
    for (const { tab, label } of TABS) {
      const node = element("button", { type: "button", role: "tab", id: `tab-${tab}`, "aria-controls": `panel-${tab}` }, label);
      node.addEventListener("click", () => this.open(tab, this.size === "closed" || tab !== this.tab ? undefined : "closed"));
      node.addEventListener("keydown", (event) => this.arrow(event));
      this.tabs.set(tab, node);
      bar.append(node);
      const panel = panels[tab];
      panel.id = `panel-${tab}`;
      panel.setAttribute("role", "tabpanel");
      panel.setAttribute("aria-labelledby", node.id);
      body.append(panel);
    }
    this.toggle = button("", tooltip("drawer"), () => this.open(this.tab, nextSize(this.size)), { class: "icon" });
    bar.append(element("span", { class: "spring" }), this.toggle);
    this.root.append(bar, body);
    this.apply();
  }

  /** Turns to a tab; a closed drawer opens unless a size is given. */
  open(tab: DrawerTab, size?: DrawerSize): void {
    this.tab = tab;
    this.size = size ?? (this.size === "closed" ? "part" : this.size);
    this.apply();
    this.onChange(this.tab, this.size);
  }

  /** Puts a count beside a tab's name. */
  setCount(tab: DrawerTab, text: string, bad: boolean): void {
    const node = this.tabs.get(tab);
    if (!node) return;
    setText(node, `${TABS.find((t) => t.tab === tab)?.label ?? ""}${text ? ` ${text}` : ""}`);
    node.classList.toggle("bad", bad);
  }

  private arrow(event: KeyboardEvent): void {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step === 0) return;
    event.preventDefault();
    const index = TABS.findIndex(({ tab }) => tab === this.tab);
    const next = TABS[(index + step + TABS.length) % TABS.length]?.tab ?? "graph";
    this.open(next);
    this.tabs.get(next)?.focus();
  }

  private apply(): void {
    this.root.dataset["size"] = this.size;
    for (const [tab, node] of this.tabs) {
      const current = tab === this.tab;
      node.setAttribute("aria-selected", String(current && this.size !== "closed"));
      node.tabIndex = current ? 0 : -1;
      this.panels[tab].hidden = !current;
    }
    setText(this.toggle, this.size === "closed" ? "▴" : this.size === "part" ? "▴" : "▾");
  }
}
