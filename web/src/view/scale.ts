// The scale bar: a round length in the file's unit, about 100 pixels long.
import { element, setText } from "../core/dom.ts";
import { roundStep } from "../core/slider.ts";
import { formatNumber } from "../core/units.ts";

/** Round length in file units that is at most `pixels` long, and its length in pixels. */
export function scaleLength(unitsPerPixel: number, pixels = 120): { length: number; pixels: number } {
  const length = roundStep(unitsPerPixel * pixels);
  return { length, pixels: length / unitsPerPixel };
}

export class ScaleBar {
  readonly root = element("div", { class: "scale-bar", title: "Length at the middle of the model" });
  private readonly label = element("span", { class: "scale-label" });
  private readonly bar = element("span", { class: "scale-line" });

  constructor() {
    this.root.append(this.label, this.bar);
  }

  update(metresPerPixel: number, unitsPerMetre: number, unit: string): void {
    const { length, pixels } = scaleLength(metresPerPixel * unitsPerMetre);
    if (!Number.isFinite(pixels)) return;
    setText(this.label, `${formatNumber(length)} ${unit}`);
    this.bar.style.width = `${pixels.toFixed(1)}px`;
  }
}
