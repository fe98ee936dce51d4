// A study's results as parallel coordinates: a line for each variant, an axis for
// each column. Dragging along an axis keeps the variants within.
import { button, element, setHidden, setText, svg } from "../core/dom.ts";
import { colourAt, css } from "../core/colour.ts";
import type { Study } from "../core/protocol.ts";
import type { Store } from "../core/store.ts";
import { nearestRow, type StudyAxis, studyAxes } from "../core/study.ts";
import { formatNumber } from "../core/units.ts";
import { valueText } from "./checks.ts";

const MARGIN = { left: 70, right: 90, top: 40, bottom: 26 };

/** Height of the strip of pictures, with its margin. */
const PICTURES_HEIGHT = 118;

export class StudyPanel {
  readonly root = element("div", { class: "study" });
  /** Called once there is a study. */
  onStudy: () => void = () => {};
  private readonly canvas = element("canvas", { role: "img", "aria-label": "Parallel coordinates of the study" });
  private readonly axesPicture = svg("svg", { class: "axes" });
  private readonly readout = element("p", { class: "hint" });
  private readonly hint = element("p", { class: "hint" }, "No study of this graph has results yet: `tessgraph study` makes them.");
  private readonly clear: HTMLButtonElement;
  /** Pictures of variants, those within the limits. */
  private readonly pictures = element("div", { class: "study-pictures", hidden: true, role: "list", "aria-label": "Pictures of the variants" });
  private study: Study | undefined;
  private axes: StudyAxis[] = [];
  private brushes = new Map<number, [number, number]>();
  private hovered: number | undefined;

  constructor(store: Store) {
    this.clear = button("all variants", "Take the limits off all axes", () => {
      this.brushes.clear();
      this.draw();
    }, { class: "link" });
    this.root.append(element("div", { class: "study-head" }, this.readout, this.clear, this.hint), this.canvas, this.axesPicture, this.pictures);
    this.clear.hidden = true;
    store.on("study", (study) => this.take(study));
    new ResizeObserver(() => this.draw()).observe(this.root);
    this.axesPicture.addEventListener("pointermove", (event) => this.hover(event));
    this.axesPicture.addEventListener("pointerdown", (event) => this.brush(event));
  }

  private take(study: Study): void {
    this.study = study;
    this.axes = studyAxes(study.columns, study.rows, (n) => formatNumber(n, 4));
    this.brushes.clear();
    this.pictures.hidden = !study.pictures;
    this.pictures.replaceChildren(...(study.pictures ?? []).flatMap((number, row) => (number === null ? [] : [this.picture(number, row)])));
    this.hint.hidden = true;
    this.clear.hidden = false;
    this.onStudy();
    this.draw();
  }

  refresh(): void {
    this.draw();
  }

  private get size(): { width: number; height: number; gap: number; depth: number } {
    const width = this.root.clientWidth;
    const height = Math.max(120, this.root.clientHeight - 34 - (this.pictures.hidden ? 0 : PICTURES_HEIGHT));
    const gap = (width - MARGIN.left - MARGIN.right) / Math.max(1, this.axes.length - 1);
    return { width, height, gap, depth: height - MARGIN.top - MARGIN.bottom };
  }

  private kept(row: number): boolean {
    for (const [axis, [low, high]] of this.brushes) {
      const place = this.axes[axis]?.places[row] ?? Number.NaN;
      if (!(place >= low && place <= high)) return false;
    }
    return true;
  }

  private draw(): void {
    const { study, canvas, axes } = this;
    const context = canvas.getContext("2d");
    if (!study || !context || this.root.clientWidth === 0) return;
    const { width, height, gap, depth } = this.size;
    const ratio = window.devicePixelRatio;
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    canvas.style.width = `${width}px`;
    canvas.style.height = `${height}px`;
    context.scale(ratio, ratio);
    const last = axes.at(-1);
    let kept = 0;
    const line = (row: number): void => {
      context.beginPath();
      axes.forEach((axis, i) => {
        const place = axis.places[row] ?? Number.NaN;
        if (!Number.isNaN(place)) context.lineTo(MARGIN.left + i * gap, MARGIN.top + (1 - place) * depth);
      });
      context.stroke();
    };
    const style = getComputedStyle(this.root);
    for (let row = 0; row < study.rows.length; row += 1) {
      const inside = this.kept(row);
      kept += Number(inside);
      context.globalAlpha = inside ? 0.75 : 0.08;
      context.strokeStyle = css(colourAt("sequential", 0.25 + 0.7 * (last?.places[row] ?? 0.5)));
      context.lineWidth = 1.3;
      line(row);
    }
    if (this.hovered !== undefined) {
      context.globalAlpha = 1;
      context.strokeStyle = style.getPropertyValue("--accent");
      context.lineWidth = 3;
      line(this.hovered);
    }
    this.drawAxes();
    for (const picture of this.pictures.children as HTMLCollectionOf<HTMLElement>) {
      const row = Number(picture.dataset["row"]);
      setHidden(picture, !this.kept(row));
      picture.classList.toggle("hovered", row === this.hovered);
    }
    setText(this.readout, this.hovered === undefined ? `${study.path}: ${kept} of ${study.rows.length} variants` : this.describe(this.hovered));
  }

  private picture(number: number, row: number): HTMLElement {
    const name = String(this.study?.rows[row]?.[0] ?? row);
    // The address is relative to the page's own; the server knows the number, no path.
    const image = element("img", { src: `picture/${number}`, alt: this.describe(row), loading: "lazy" });
    const item = element("figure", { role: "listitem", tabindex: 0, title: this.describe(row) }, image, element("figcaption", {}, name));
    item.dataset["row"] = String(row);
    const hover = (): void => {
      this.hovered = row;
      this.draw();
    };
    for (const event of ["pointerenter", "focus"] as const) item.addEventListener(event, hover);
    return item;
  }

  private describe(row: number): string {
    const { columns = [], rows = [] } = this.study ?? {};
    return columns.map((name, i) => `${name} ${valueText({ value: rows[row]?.[i] ?? null, unit: "" })}`).join(" · ");
  }

  private drawAxes(): void {
    const { width, height, gap, depth } = this.size;
    this.axesPicture.setAttribute("width", String(width));
    this.axesPicture.setAttribute("height", String(height));
    this.axesPicture.replaceChildren(
      ...this.axes.map((axis, i) => {
        const brush = this.brushes.get(i);
        const mark = brush ? [svg("rect", { x: -6, width: 12, y: MARGIN.top + (1 - brush[1]) * depth, height: (brush[1] - brush[0]) * depth, class: "brush" })] : [];
        return svg(
          "g",
          { transform: `translate(${MARGIN.left + i * gap} 0)` },
          svg("title", {}, `${axis.name}: drag along the axis to keep a part`),
          svg("line", { y1: MARGIN.top, y2: height - MARGIN.bottom }),
          ...mark,
          svg("text", { y: i % 2 ? 26 : 12, class: "axis-name" }, axis.name),
          svg("text", { y: MARGIN.top - 3, class: "end", x: 5 }, axis.high),
          svg("text", { y: height - MARGIN.bottom + 13, class: "end", x: 5 }, axis.low),
        );
      }),
    );
  }

  private place(event: PointerEvent): { x: number; y: number } {
    const box = this.axesPicture.getBoundingClientRect();
    const { gap, depth } = this.size;
    return { x: (event.clientX - box.left - MARGIN.left) / gap, y: 1 - (event.clientY - box.top - MARGIN.top) / depth };
  }

  private hover(event: PointerEvent): void {
    const { x, y } = this.place(event);
    const row = nearestRow(this.axes, x, y, (r) => this.kept(r));
    if (row === this.hovered) return;
    this.hovered = row;
    this.draw();
  }

  private brush(event: PointerEvent): void {
    const { x, y } = this.place(event);
    const axis = Math.round(x);
    if (Math.abs(x - axis) * this.size.gap > 14 || !this.axes[axis]) return;
    this.axesPicture.setPointerCapture(event.pointerId);
    const clamp = (v: number): number => Math.min(1.01, Math.max(-0.01, v));
    const move = (moved: PointerEvent): void => {
      const to = this.place(moved).y;
      this.brushes.set(axis, [clamp(Math.min(y, to)), clamp(Math.max(y, to))]);
      this.draw();
    };
    const up = (ended: PointerEvent): void => {
      this.axesPicture.removeEventListener("pointermove", move);
      // A click without a drag takes the limit off.
      if (Math.abs(this.place(ended).y - y) < 0.01) this.brushes.delete(axis);
      this.draw();
    };
    this.axesPicture.addEventListener("pointermove", move);
    this.axesPicture.addEventListener("pointerup", up, { once: true });
  }
}
