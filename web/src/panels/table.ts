// A result that is a table or a list of numbers: only the rows in sight exist.
import { element, setHidden, setText } from "../core/dom.ts";
import type { Cell, Shown } from "../core/protocol.ts";
import type { Store } from "../core/store.ts";
import { formatCount } from "../core/units.ts";
import { valueText } from "./checks.ts";
import { VirtualList } from "./virtual.ts";

const ROW = 26;

/** Order of rows by a column: numbers by size, then text, empty cells last. */
export function sortedRows(rows: Cell[][], column: number, descending: boolean): number[] {
  const order = rows.map((_, index) => index);
  const sign = descending ? -1 : 1;
  order.sort((i, j) => {
    const [a, b] = [rows[i]?.[column] ?? null, rows[j]?.[column] ?? null];
    if (a === null || b === null) return Number(a === null) - Number(b === null) || i - j;
    if (typeof a === "number" && typeof b === "number") return sign * (a - b) || i - j;
    return sign * String(a).localeCompare(String(b), "en", { numeric: true }) || i - j;
  });
  return order;
}

type Content = { columns: { name: string; unit: string }[]; rows: Cell[][]; total: number };

export class TablePanel {
  readonly root = element("div", { class: "table" });
  private readonly caption = element("p", { class: "hint" });
  private readonly head = element("div", { class: "table-head", role: "row" });
  private readonly list = new VirtualList(ROW, (index) => this.row(index), "Table");
  private content: Content = { columns: [], rows: [], total: 0 };
  private order: number[] = [];
  private sorted: { column: number; descending: boolean } | undefined;

  constructor(store: Store) {
    this.root.append(this.caption, this.head, this.list.root);
    store.on("shown", (shown) => this.update(shown));
    this.list.root.addEventListener("scroll", () => {
      this.head.style.transform = `translateX(${-this.list.root.scrollLeft}px)`;
    });
  }

  private update(shown: Shown): void {
    const content = contentOf(shown);
    const same = JSON.stringify(content?.columns) === JSON.stringify(this.content.columns);
    if (!same) this.sorted = undefined;
    this.content = content ?? { columns: [], rows: [], total: 0 };
    setHidden(this.head, !content);
    setHidden(this.list.root, !content);
    if (!content) {
      setText(this.caption, `${shown.node || "What is shown"} is no table; show a schedule or a report and its rows stand here.`);
      return;
    }
    const { rows, total } = content;
    const shownRows = rows.length < total ? `the first ${formatCount(rows.length)} of ${formatCount(total)} rows` : `${formatCount(total)} rows`;
    setText(this.caption, `${shown.node}: ${shownRows}`);
    this.sort();
  }

  private sort(): void {
    const { rows, columns } = this.content;
    this.order = this.sorted ? sortedRows(rows, this.sorted.column, this.sorted.descending) : rows.map((_, i) => i);
    const template = `repeat(${columns.length}, minmax(110px, 1fr))`;
    this.root.style.setProperty("--columns", template);
    this.root.style.setProperty("--width", `${columns.length * 110}px`);
    this.head.replaceChildren(
      ...columns.map(({ name, unit }, column) => {
        const mark = this.sorted?.column === column ? (this.sorted.descending ? " ▾" : " ▴") : "";
        const head = element("button", { type: "button", role: "columnheader", title: `Sort by ${name}` }, `${name.replaceAll("_", " ")}${unit ? ` (${unit})` : ""}${mark}`);
        head.addEventListener("click", () => {
          this.sorted = { column, descending: this.sorted?.column === column && !this.sorted.descending };
          this.sort();
        });
        return head;
      }),
    );
    this.list.setCount(rows.length);
  }

  refresh(): void {
    this.list.update(true);
  }

  private row(index: number): HTMLElement {
    const cells = this.content.rows[this.order[index] ?? 0] ?? [];
    return element("div", { class: `row${index % 2 ? " odd" : ""}`, role: "row" }, ...cells.map((value) => element("span", { role: "cell", class: typeof value === "number" ? "numeric" : "" }, valueText({ value, unit: "" }))));
  }
}

function contentOf(shown: Shown): Content | undefined {
  if (shown.table) return shown.table;
  if (!shown.report) return undefined;
  const rows = shown.report.map(({ name, value, unit }): Cell[] => [name.replaceAll("_", " "), value, unit]);
  return { columns: [{ name: "name", unit: "" }, { name: "value", unit: "" }, { name: "unit", unit: "" }], rows, total: rows.length };
}
