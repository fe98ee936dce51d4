// The graph's text, read only: the place somebody clicked on is lit.
import { element } from "../core/dom.ts";
import type { Span } from "../core/protocol.ts";
import { Offsets, type Token, tokens } from "../core/source.ts";
import type { Store } from "../core/store.ts";
import { VirtualList } from "./virtual.ts";

const ROW = 20;

export class SourcePanel {
  readonly root: HTMLElement;
  private readonly list = new VirtualList(ROW, (index) => this.row(index), "Source");
  private lines: string[] = [];
  private starts: number[] = [];
  private text = "";
  private lit: [number, number] = [0, 0];

  constructor(private readonly store: Store) {
    this.root = element("div", { class: "source" }, this.list.root);
    store.on("document", ({ source }) => this.setText(source));
    store.on("diagnostics", () => this.list.update(true));
  }

  private setText(text: string): void {
    if (text === this.text) return;
    this.text = text;
    this.lines = text.split("\n");
    this.starts = [];
    let start = 0;
    for (const line of this.lines) {
      this.starts.push(start);
      start += line.length + 1;
    }
    this.lit = [0, 0];
    this.list.setCount(this.lines.length);
  }

  /** Lights bytes [start, end) and scrolls to them; `line` counts from 1. */
  reveal(span: Span, line: number): void {
    this.lit = new Offsets(this.text).range(span);
    this.list.reveal(line - 1);
  }

  /** Draws again after the panel was hidden. */
  refresh(): void {
    this.list.update(true);
  }

  private row(index: number): HTMLElement {
    const text = this.lines[index] ?? "";
    const start = this.starts[index] ?? 0;
    const code = element("code", {}, ...lightTokens(tokens(text), this.lit[0] - start, this.lit[1] - start));
    const wrong = (this.store.get("diagnostics")?.items ?? []).some((item) => item.line === index + 1);
    const inside = this.lit[1] > start && this.lit[0] <= start + text.length && this.lit[1] > this.lit[0];
    return element("div", { class: `line${wrong ? " wrong" : ""}${inside ? " lit" : ""}` }, element("span", { class: "number" }, String(index + 1)), code);
  }
}

/** Tokens as spans, those within [from, to) marked; a token is cut where the mark begins or ends. */
function lightTokens(list: Token[], from: number, to: number): HTMLElement[] {
  const spans: HTMLElement[] = [];
  let at = 0;
  for (const { text, kind } of list) {
    const cuts = [0, Math.min(Math.max(from - at, 0), text.length), Math.min(Math.max(to - at, 0), text.length), text.length];
    for (let k = 0; k < 3; k += 1) {
      const part = text.slice(cuts[k], cuts[k + 1]);
      if (part !== "") spans.push(element("span", { class: k === 1 ? `${kind} mark` : kind }, part));
    }
    at += text.length;
  }
  return spans;
}
