// The strip under the picture: what is drawn and how, each with its key.
import { element, setHidden, setText } from "../core/dom.ts";
import { type Action, tooltip } from "../core/keys.ts";
import type { Vec3 } from "../core/protocol.ts";
import { axisOf, planeName, reach, type Section } from "../core/section.ts";
import { formatNumber } from "../core/units.ts";

const TOGGLES: { action: Action; label: string }[] = [
  { action: "fit", label: "Fit" },
  { action: "projection", label: "Ortho" },
  { action: "edges", label: "Edges" },
  { action: "ghost", label: "Ghost" },
  { action: "grid", label: "Grid" },
  { action: "directions", label: "Directions" },
  { action: "measure", label: "Measure" },
  { action: "section", label: "Section" },
];

const STEPS = 400;

export class Viewbar {
  readonly root = element("div", { class: "viewbar", role: "toolbar", "aria-label": "View" });
  private readonly buttons = new Map<Action, HTMLButtonElement>();
  private readonly slider = element("input", { type: "range", min: 0, max: STEPS, step: 1, class: "section-slider", "aria-label": "Place of the section" });
  private readonly place = element("span", { class: "section-place" });
  private readonly profile = element("button", { type: "button", class: "tool profile" });
  private readonly times = element("span", { class: "times" });
  private readonly told = element("span", { class: "section-told", role: "status" });
  private span: [number, number] | undefined;

  constructor(act: (action: Action) => void, moveSection: (at: number) => void) {
    for (const { action, label } of TOGGLES) {
      const node = element("button", { type: "button", class: "tool", title: tooltip(action) }, label);
      if (action !== "fit") node.setAttribute("aria-pressed", "false");
      node.addEventListener("click", () => act(action));
      this.buttons.set(action, node);
      this.root.append(node);
    }
    this.slider.addEventListener("input", () => {
      const at = this.fromSlider(this.slider.valueAsNumber);
      if (at !== undefined) moveSection(at);
    });
    this.profile.title = tooltip("navigation");
    this.profile.addEventListener("click", () => act("navigation"));
    this.root.append(this.slider, this.place, this.told, element("span", { class: "spring" }), this.times, this.profile);
  }

  /** Presses or releases a button; `label` replaces its word where a toggle has more than two states. */
  press(action: Action, pressed: boolean, label?: string): void {
    const node = this.buttons.get(action);
    node?.setAttribute("aria-pressed", String(pressed));
    if (node && label !== undefined) setText(node, label);
  }

  setProfile(label: string): void {
    setText(this.profile, label);
  }

  /** How long the last picture took, for those who wonder. */
  setTimes(text: string, title: string): void {
    setText(this.times, text);
    this.times.title = title;
  }

  private fromSlider(value: number): number | undefined {
    if (!this.span) return undefined;
    const [low, high] = this.span;
    return low + (value / STEPS) * (high - low);
  }

  /** Shows the section's slider; `scale` is file units per metre. */
  setSection(section: Section | undefined, bounds: [Vec3, Vec3] | undefined, scale: number, unit: string): void {
    for (const node of [this.slider, this.place, this.told]) setHidden(node, !section);
    this.press("section", section !== undefined, section ? `Section ${planeName(section)}` : "Section");
    if (!section || !bounds) return;
    const [low, high] = reach(section.normal, bounds);
    this.span = [low, high];
    this.slider.value = String(Math.round((STEPS * (section.at - low)) / (high - low || 1)));
    const axis = axisOf(section);
    const text = `${axis === undefined ? "d" : "xyz"[axis]} = ${formatNumber(section.at * scale, 5)} ${unit}`;
    setText(this.place, text);
    this.slider.setAttribute("aria-valuetext", text);
  }

  /** What the section cuts, in words. */
  setCut(text: string | undefined, title: string | undefined): void {
    setText(this.told, text ?? "");
    this.told.title = title ?? "";
  }
}
