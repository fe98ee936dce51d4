// One parameter: what it looks like for its kind, and what its movements send.
import { button, element, setText } from "../core/dom.ts";
import type { Parameter, Value } from "../core/protocol.ts";
import { type Range, sliderRange, snap } from "../core/slider.ts";
import type { Alternatives } from "../core/alternatives.ts";
import type { Store } from "../core/store.ts";
import { isLive, type Live, Throttle } from "../core/throttle.ts";
import { formatNumber, parseQuantity, tidy } from "../core/units.ts";

export type Row = {
  root: HTMLElement;
  about: string;
  update(parameter: Parameter, readOnly: boolean): void;
};

/** The part of a row that holds the value: shows one, and tells when it changes. */
type Editor = {
  nodes: HTMLElement[];
  show(parameter: Parameter): void;
  disable(disabled: boolean): void;
  /** Whether the person is at it, so that a message must not move it. */
  busy(): boolean;
};

type Changes = { live(value: Value): void; commit(value: Value): void };

/** Arrow keys write after this pause, so that ten strokes are one edit of the file. */
const KEY_PAUSE_MS = 400;

export function makeRow(first: Parameter, store: Store, live: () => Live, alternatives: Alternatives): Row {
  const lastRun = (): number => store.get("status")?.ms ?? 0;
  const throttle = new Throttle<Value>(
    (value) => store.send({ type: "set", name: first.name, value }),
    () => Math.max(16, lastRun()),
  );
  const changes: Changes = {
    live: (value) => {
      if (isLive(live(), lastRun())) throttle.push(value);
    },
    commit: (value) => {
      throttle.cancel();
      store.send({ type: "write", name: first.name, value });
    },
  };
  const editor = makeEditor(first, changes);
  const reset = button("", "Reset", () => {}, { class: "reset" });
  reset.addEventListener("click", (event) => {
    if (event.shiftKey) alternatives.store(current);
    else if (current.value !== current.initial) store.send({ type: "reset", name: first.name });
  });
  const pin = element("span", { class: "pin", title: "Held by --set on the command line; the file's value is not used" }, "⚲ --set");
  let current = first;
  const label = element("label", { class: "name" }, first.name);
  const target = editor.nodes.find((node) => node.matches("input, select"));
  if (target) {
    target.id = `parameter ${first.name}`;
    label.htmlFor = target.id;
  }
  label.addEventListener("dblclick", () => store.send({ type: "reset", name: first.name }));
  const root = element("div", { class: `parameter ${first.kind}` }, label, pin, reset, ...editor.nodes);
  root.dataset["name"] = first.name;

  const update = (parameter: Parameter, readOnly: boolean): void => {
    current = parameter;
    const other = alternatives.of(parameter.name);
    reset.classList.toggle("has-b", other !== undefined);
    const changed = parameter.value !== parameter.initial;
    const initial = typeof parameter.initial === "number" ? formatNumber(parameter.initial) : String(parameter.initial);
    reset.classList.toggle("filled", changed);
    reset.disabled = readOnly || parameter.locked;
    const kept = other === undefined ? "Shift-click keeps this value as B" : `B is ${typeof other === "number" ? formatNumber(other) : String(other)}: hold B to see it, Shift-click at B forgets it`;
    reset.title = `${changed ? `Reset to ${initial}, as the file said when this page began` : "As the file said when this page began"}. ${kept}`;
    reset.setAttribute("aria-label", `Reset ${parameter.name}`);
    const range = parameter.min !== undefined && parameter.max !== undefined ? ` (${formatNumber(parameter.min)} to ${formatNumber(parameter.max)} ${parameter.unit})` : "";
    label.title = `${parameter.about || parameter.name}${range}, line ${parameter.line}. Double click resets it`;
    pin.hidden = !parameter.locked;
    root.classList.toggle("unwritten", parameter.value !== parameter.in_file && !parameter.locked);
    editor.disable(readOnly || parameter.locked);
    if (!editor.busy()) editor.show(parameter);
  };
  return { root, about: first.about, update };
}

function makeEditor(parameter: Parameter, changes: Changes): Editor {
  switch (parameter.kind) {
    case "number":
    case "integer":
      return new NumberEditor(parameter, changes);
    case "bool":
      return boolEditor(parameter, changes);
    case "choice":
      return choiceEditor(parameter, changes);
    case "text":
    case "path":
      return textEditor(parameter, changes);
  }
}

class NumberEditor implements Editor {
  readonly nodes: HTMLElement[];
  private readonly slider = element("input", { type: "range", step: "any" });
  private readonly box = element("input", { type: "text", class: "box", inputmode: "decimal", autocomplete: "off", spellcheck: "false" });
  private readonly message = element("span", { class: "box-error", role: "alert" });
  private range: Range;
  private value: number;
  private dragging = false;
  private alt = false;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private parameter: Parameter,
    private readonly changes: Changes,
  ) {
    this.range = sliderRange(parameter);
    this.value = Number(parameter.value);
    this.slider.setAttribute("aria-label", `${parameter.name} slider`);
    this.nodes = [this.slider, this.box, element("span", { class: "unit" }, parameter.unit), this.message];
    this.listenToSlider();
    this.listenToBox();
  }

  show(parameter: Parameter): void {
    this.parameter = parameter;
    this.range = sliderRange(parameter);
    this.slider.min = String(this.range.min);
    this.slider.max = String(this.range.max);
    this.slider.classList.toggle("open", this.range.open);
    this.display(Number(parameter.value));
  }

  disable(disabled: boolean): void {
    this.slider.disabled = disabled;
    this.box.disabled = disabled;
  }

  busy(): boolean {
    return this.dragging || this.timer !== undefined || document.activeElement === this.box;
  }

  private display(value: number): void {
    this.value = value;
    this.slider.value = String(value);
    const { min, max } = this.range;
    this.slider.style.setProperty("--filled", `${max > min ? (100 * (Math.min(max, Math.max(min, value)) - min)) / (max - min) : 0}%`);
    this.slider.setAttribute("aria-valuetext", `${formatNumber(value)} ${this.parameter.unit}`);
    this.box.value = formatNumber(value, 10);
    setText(this.message, "");
  }

  private listenToSlider(): void {
    const { slider } = this;
    slider.addEventListener("pointerdown", (event) => {
      this.dragging = true;
      this.alt = event.altKey;
    });
    slider.addEventListener("pointermove", (event) => {
      this.alt = event.altKey;
    });
    slider.addEventListener("input", () => {
      const value = snap(slider.valueAsNumber, this.range, this.alt && this.parameter.kind !== "integer");
      if (value === this.value) {
        slider.value = String(value);
        return;
      }
      this.display(value);
      this.changes.live(value);
    });
    slider.addEventListener("change", () => {
      this.dragging = false;
      if (this.value !== Number(this.parameter.in_file)) this.changes.commit(this.value);
      else this.changes.live(this.value);
    });
    // A slider that has come back to its value tells of no change.
    for (const type of ["pointerup", "pointercancel"]) {
      slider.addEventListener(type, () => {
        this.dragging = false;
      });
    }
    slider.addEventListener("keydown", (event) => this.step(event));
    slider.addEventListener("blur", () => this.flush());
  }

  /** Arrow keys: one step, Shift ten; Page keys ten; Home and End the bounds. */
  private step(event: KeyboardEvent): void {
    const steps: Record<string, number> = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 };
    const count = steps[event.key];
    const bound = event.key === "Home" ? this.range.min : event.key === "End" ? this.range.max : undefined;
    if (event.ctrlKey || event.metaKey || (count === undefined && bound === undefined)) return;
    event.preventDefault();
    const size = event.shiftKey && Math.abs(count ?? 0) === 1 ? 10 : 1;
    const fine = event.altKey && this.parameter.kind !== "integer";
    const step = fine ? this.range.step / 10 : this.range.step;
    const value = bound ?? snap(tidy(this.value + size * (count ?? 0) * step), this.range, fine);
    if (value === this.value) return;
    this.display(value);
    this.changes.live(value);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.flush(), KEY_PAUSE_MS);
  }

  private flush(): void {
    if (this.timer === undefined) return;
    clearTimeout(this.timer);
    this.timer = undefined;
    this.changes.commit(this.value);
  }

  private listenToBox(): void {
    const { box } = this;
    box.addEventListener("focus", () => box.select());
    box.addEventListener("change", () => this.take());
    box.addEventListener("blur", () => {
      if (this.message.textContent === "") this.show(this.parameter);
    });
    box.addEventListener("keydown", (event) => {
      if (event.key === "Enter") this.take();
      if (event.key === "Escape") {
        event.stopPropagation();
        this.display(Number(this.parameter.value));
        box.blur();
      }
      if (event.key === "ArrowUp" || event.key === "ArrowDown") this.step(event);
    });
  }

  /** Reads what was typed; the server says whether it is in range, in its own words. */
  private take(): void {
    const parsed = parseQuantity(this.box.value.replace("−", "-"), this.parameter.unit, this.value);
    if ("error" in parsed) {
      setText(this.message, parsed.error);
      this.box.setAttribute("aria-invalid", "true");
      return;
    }
    this.box.removeAttribute("aria-invalid");
    if (this.parameter.kind === "integer" && !Number.isInteger(parsed.value)) {
      setText(this.message, `${formatNumber(parsed.value)} is not a whole number`);
      return;
    }
    setText(this.message, "");
    if (parsed.value === this.value) return;
    this.parameter = { ...this.parameter, value: parsed.value };
    this.display(parsed.value);
    this.changes.commit(parsed.value);
  }
}

function boolEditor(parameter: Parameter, changes: Changes): Editor {
  const box = element("input", { type: "checkbox", class: "switch", "aria-label": parameter.name });
  box.addEventListener("change", () => changes.commit(box.checked));
  return {
    nodes: [box],
    show: ({ value }) => {
      box.checked = value === true;
    },
    disable: (disabled) => {
      box.disabled = disabled;
    },
    busy: () => false,
  };
}

function choiceEditor(parameter: Parameter, changes: Changes): Editor {
  const select = element("select", { "aria-label": parameter.name });
  for (const choice of parameter.of ?? []) select.append(element("option", { value: choice }, choice));
  select.addEventListener("change", () => changes.commit(select.value));
  return {
    nodes: [select],
    show: ({ value }) => {
      select.value = String(value);
    },
    disable: (disabled) => {
      select.disabled = disabled;
    },
    busy: () => false,
  };
}

function textEditor(parameter: Parameter, changes: Changes): Editor {
  const box = element("input", { type: "text", class: "text", "aria-label": parameter.name, spellcheck: "false" });
  box.addEventListener("change", () => changes.commit(box.value));
  return {
    nodes: [box],
    show: ({ value }) => {
      box.value = String(value);
    },
    disable: (disabled) => {
      box.disabled = disabled;
    },
    busy: () => document.activeElement === box,
  };
}
