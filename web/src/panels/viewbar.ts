// The strip under the picture: what is drawn and how, each with its key.
import { element, setHidden, setText } from "../core/dom.ts";
import { type Action, tooltip } from "../core/keys.ts";
import type { Vec3 } from "../core/protocol.ts";
import { formatNumber } from "../core/units.ts";
import type { Section } from "../view/viewer.ts";

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
  private bounds: [Vec3, Vec3] | undefined;

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
    this.root.append(this.slider, this.place, element("span", { class: "spring" }), this.times, this.profile);
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

  private axis: 0 | 1 | 2 = 0;

  private fromSlider(value: number): number | undefined {
    if (!this.bounds) return undefined;
    const [low, high] = this.bounds;
    return low[this.axis] + (value / STEPS) * (high[this.axis] - low[this.axis]);
  }

  /** Shows the section's slider; `scale` is file units per metre. */
  setSection(section: Section | undefined, bounds: [Vec3, Vec3] | undefined, scale: number, unit: string): void {
    setHidden(this.slider, !section);
    setHidden(this.place, !section);
    this.press("section", section !== undefined, section ? `Section ${"XYZ"[section.axis]}` : "Section");
    if (!section || !bounds) return;
    this.bounds = bounds;
    this.axis = section.axis;
    const [low, high] = bounds;
    const span = high[section.axis] - low[section.axis] || 1;
    this.slider.value = String(Math.round((STEPS * (section.at - low[section.axis])) / span));
    const text = `${"XYZ"[section.axis]?.toLowerCase()} = ${formatNumber(section.at * scale, 4)} ${unit}`;
    setText(this.place, text);
    this.slider.setAttribute("aria-valuetext", text);
  }
}
