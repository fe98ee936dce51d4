// A list of which only the visible rows exist.
import { element } from "../core/dom.ts";

export class VirtualList {
  readonly root: HTMLElement;
  private readonly space = element("div", { class: "virtual-space" });
  private count = 0;
  private first = -1;
  private last = -1;

  constructor(
    private readonly rowHeight: number,
    private readonly render: (index: number) => HTMLElement,
    label: string,
  ) {
    this.root = element("div", { class: "virtual", tabindex: 0, role: "region", "aria-label": label }, this.space);
    this.root.addEventListener("scroll", () => this.update(false), { passive: true });
    new ResizeObserver(() => this.update(false)).observe(this.root);
  }

  /** Draws `count` rows anew. */
  setCount(count: number): void {
    this.count = count;
    this.space.style.height = `${count * this.rowHeight}px`;
    this.update(true);
  }

  /** Scrolls until a row is in the middle, unless it is seen already. */
  reveal(index: number): void {
    const { scrollTop, clientHeight } = this.root;
    const top = index * this.rowHeight;
    if (top < scrollTop || top + this.rowHeight > scrollTop + clientHeight) {
      this.root.scrollTop = top - clientHeight / 2;
    }
    this.update(true);
  }

  /** Draws the visible rows; `anew` where their content may have changed. */
  update(anew: boolean): void {
    const { scrollTop, clientHeight } = this.root;
    const first = Math.max(0, Math.floor(scrollTop / this.rowHeight) - 4);
    const last = Math.min(this.count, Math.ceil((scrollTop + clientHeight) / this.rowHeight) + 4);
    if (!anew && first === this.first && last === this.last) return;
    this.first = first;
    this.last = last;
    const rows: HTMLElement[] = [];
    for (let index = first; index < last; index += 1) {
      const row = this.render(index);
      row.style.transform = `translateY(${index * this.rowHeight}px)`;
      rows.push(row);
    }
    this.space.replaceChildren(...rows);
  }
}
