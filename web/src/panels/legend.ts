// The legend of a coloured field: gradient, histogram and a range that can be held.
import { button, element, setHidden, setText, svg } from "../core/dom.ts";
import { CLASSES, MAP_LABELS, type MapName, css, mapGradient } from "../core/colour.ts";
import { tooltip } from "../core/keys.ts";
import { type ColourRange, draggedRange, histogram } from "../core/legend.ts";
import type { ShownField } from "../core/protocol.ts";
import { formatNumber } from "../core/units.ts";

const BINS = 48;

export type LegendEvents = {
  range(range: ColourRange): boolean;
  map(map: MapName): void;
  lock(locked: boolean): void;
  release(): void;
};

export class Legend {
  readonly root = element("section", { class: "legend", "aria-label": "Legend", hidden: true });
  private readonly title = element("h2", {});
  private readonly bars = svg("svg", { viewBox: `0 0 ${BINS} 24`, preserveAspectRatio: "none", class: "histogram", role: "img" });
  private readonly gradient = element("div", { class: "gradient" });
  private readonly low = element("input", { type: "text", class: "end", "aria-label": "Lowest value of the colours", inputmode: "decimal" });
  private readonly high = element("input", { type: "text", class: "end", "aria-label": "Highest value of the colours", inputmode: "decimal" });
  private readonly unit = element("span", { class: "unit" });
  private readonly lock = element("input", { type: "checkbox" });
  private readonly maps = element("select", { "aria-label": "Colours", class: "small" });
  private readonly numbers: HTMLElement;
  private readonly classes = element("div", { class: "classes" });
  private field: ShownField | undefined;
  private range: ColourRange | undefined;

  constructor(private readonly events: LegendEvents) {
    for (const [value, label] of Object.entries(MAP_LABELS)) this.maps.append(element("option", { value }, label));
    this.maps.addEventListener("change", () => events.map(this.maps.value as MapName));
    this.lock.addEventListener("change", () => events.lock(this.lock.checked));
    for (const end of [this.low, this.high]) end.addEventListener("change", () => this.take());
    const lockLabel = element("label", { class: "lock", title: `${tooltip("lock_range")}: colours stay comparable while the model changes` }, this.lock, "hold");
    this.numbers = element(
      "div",
      {},
      this.bars,
      element("div", { class: "scale-of-colours" }, this.gradient, this.grip("low"), this.grip("high")),
      element("div", { class: "ends" }, this.low, this.unit, this.high),
      element("div", { class: "legend-tools" }, lockLabel, button("range of this result", "Let the colours span this result's values", () => events.release(), { class: "link" }), this.maps),
    );
    this.root.append(this.title, this.numbers, this.classes);
  }

  /** An end of the colours that can be dragged; the boxes below do the same for the keyboard. */
  private grip(end: "low" | "high"): HTMLElement {
    const grip = element("span", { class: `grip ${end}`, "aria-hidden": "true", title: "Drag to clamp the colours here; a double click spans this result" });
    grip.addEventListener("dblclick", () => this.events.release());
    grip.addEventListener("pointerdown", (event) => {
      const { range } = this;
      const width = this.gradient.clientWidth;
      if (!range || event.button !== 0) return;
      event.preventDefault();
      grip.setPointerCapture(event.pointerId);
      const move = (moved: PointerEvent): void => {
        this.events.range(draggedRange(range, end, (moved.clientX - event.clientX) / width));
      };
      grip.addEventListener("pointermove", move);
      grip.addEventListener("lostpointercapture", () => grip.removeEventListener("pointermove", move), { once: true });
    });
    return grip;
  }

  hide(): void {
    setHidden(this.root, true);
  }

  show(field: ShownField, values: Float32Array | undefined, map: MapName, range: ColourRange, locked: boolean): void {
    this.field = field;
    setHidden(this.root, false);
    setText(this.title, field.label);
    this.title.title = `${field.name}, one per ${field.on}, from ${field.node}`;
    setHidden(this.numbers, field.categorical);
    setHidden(this.classes, !field.categorical);
    if (field.categorical) {
      this.showClasses(values);
      return;
    }
    this.gradient.style.background = mapGradient(map);
    this.range = range;
    this.low.value = formatNumber(range.min, 5);
    this.high.value = formatNumber(range.max, 5);
    setText(this.unit, field.unit);
    this.lock.checked = locked;
    this.maps.value = map;
    this.drawBars(values, range);
  }

  private drawBars(values: Float32Array | undefined, range: ColourRange): void {
    const counts = values ? histogram(values, range, BINS) : new Uint32Array(BINS);
    const most = Math.max(1, ...counts);
    const bars = [...counts].flatMap((count, i) => {
      const height = count === 0 ? 0 : Math.max(0.8, (24 * count) / most);
      return height === 0 ? [] : [svg("rect", { x: i + 0.1, y: 24 - height, width: 0.8, height })];
    });
    this.bars.replaceChildren(...bars);
    this.bars.setAttribute("aria-label", `Histogram of ${values?.length ?? 0} values`);
  }

  private showClasses(values: Float32Array | undefined): void {
    const counts = new Map<number, number>();
    for (const value of values ?? []) counts.set(value, (counts.get(value) ?? 0) + 1);
    const sorted = [...counts].sort((a, b) => a[0] - b[0]).slice(0, 12);
    const entries = sorted.map(([value, count]) => {
      const colour = CLASSES[((Math.round(value) % 8) + 8) % 8] ?? [0, 0, 0];
      const swatch = element("span", { class: "swatch" });
      swatch.style.background = css(colour);
      return element("div", { class: "class" }, swatch, `${formatNumber(value)} (${count})`);
    });
    if (counts.size > 12) entries.push(element("div", { class: "class" }, `and ${counts.size - 12} more; colours repeat`));
    this.classes.replaceChildren(...entries);
  }

  private take(): void {
    const min = Number(this.low.value.replace("−", "-").replace(",", "."));
    const max = Number(this.high.value.replace("−", "-").replace(",", "."));
    const taken = this.field !== undefined && this.events.range({ min, max });
    for (const end of [this.low, this.high]) end.toggleAttribute("aria-invalid", !taken);
  }
}
