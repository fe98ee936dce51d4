// What tessgraph has to say: errors as the command line prints them, warnings of
// nodes, and notices about this session.
import { button, element, setText } from "../core/dom.ts";
import type { Diagnostic, Notice, Span } from "../core/protocol.ts";
import type { Store } from "../core/store.ts";

/** Notices beyond this number are dropped, oldest first. */
const MOST_NOTICES = 200;

export class MessagesPanel {
  readonly root = element("div", { class: "messages", tabindex: 0, role: "region", "aria-label": "Messages" });
  private readonly diagnostics = element("div", {});
  private readonly warnings = element("div", {});
  private readonly log = element("div", { class: "log" });
  private readonly empty = element("p", { class: "hint" }, "Nothing to report.");
  /** Called with the number of errors and warnings. */
  onCount: (errors: number, warnings: number) => void = () => {};

  constructor(
    private readonly store: Store,
    private readonly openSource: (span: Span, line: number) => void,
    private readonly show: (node: string) => void,
  ) {
    this.root.append(this.diagnostics, this.warnings, this.log, this.empty);
    store.on("diagnostics", () => this.update());
    store.on("outcomes", () => this.update());
    store.on("notice", (notice) => this.addNotice(notice));
  }

  private update(): void {
    const items = this.store.get("diagnostics")?.items ?? [];
    this.diagnostics.replaceChildren(...items.map((item) => this.diagnostic(item)));
    const nodes = (this.store.get("outcomes")?.nodes ?? []).filter((node) => node.warnings.length > 0);
    this.warnings.replaceChildren(
      ...nodes.flatMap((node) =>
        node.warnings.map((warning) =>
          element("div", { class: "message warning" }, element("span", { class: "sign", "aria-label": "warning", role: "img" }, "⚠"), button(node.name, `Show ${node.name}`, () => this.show(node.name), { class: "link" }), element("span", {}, warning)),
        ),
      ),
    );
    const errors = items.filter((item) => item.severity === "error").length;
    const warnings = items.length - errors + nodes.reduce((sum, node) => sum + node.warnings.length, 0);
    this.empty.hidden = errors + warnings > 0 || this.log.childElementCount > 0;
    this.onCount(errors, warnings);
  }

  private diagnostic(item: Diagnostic): HTMLElement {
    const place = button(`${item.file}:${item.line}:${item.column}`, "Show in the source", () => this.openSource(item.span, item.line), { class: "link" });
    const header = element("div", { class: "diagnostic-head" }, element("strong", { class: item.severity }, `${item.severity}[${item.code.replace("tessgraph::", "")}]`), place);
    return element("article", { class: `diagnostic ${item.severity}` }, header, element("pre", {}, item.rendered));
  }

  private addNotice(notice: Notice): void {
    const time = new Date().toTimeString().slice(0, 8);
    this.log.prepend(element("div", { class: `message ${notice.level}` }, element("time", {}, time), element("span", {}, notice.text)));
    while (this.log.childElementCount > MOST_NOTICES) this.log.lastElementChild?.remove();
    this.empty.hidden = true;
  }
}

/** The line under the top bar that shows the newest notice until it is read. */
export class Banner {
  readonly root = element("div", { class: "banner", role: "alert", hidden: true });
  private readonly text = element("span", {});
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(store: Store) {
    this.root.append(this.text, button("×", "Close", () => this.hide(), { class: "icon" }));
    store.on("notice", ({ level, text }) => this.say(level, text));
  }

  say(level: Notice["level"], text: string): void {
    clearTimeout(this.timer);
    setText(this.text, text);
    this.root.className = `banner ${level}`;
    this.root.hidden = false;
    if (level === "info") this.timer = setTimeout(() => this.hide(), 6000);
  }

  hide(): void {
    this.root.hidden = true;
  }
}
