// Ranges and steps of a parameter's slider: values a person would write.
import type { Parameter } from "./protocol.ts";
import { tidy } from "./units.ts";

export type Range = { min: number; max: number; step: number; open: boolean };

/** The largest of 1, 2, 5 times a power of ten that is not above `value` (> 0). */
export function roundStep(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value) + 1e-9);
  const lead = value / power + 1e-9;
  return tidy(power * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1));
}

/**
 * The slider of a numeric parameter. Where the file declares no bound the range
 * is a guess about its value, marked `open`: the box takes values beyond it.
 */
export function sliderRange(parameter: Parameter): Range {
  const value = Number(parameter.in_file);
  const size = Math.abs(value) || 1;
  const min = parameter.min ?? (value >= 0 ? 0 : -2 * size);
  const max = parameter.max ?? Math.max(min + size, value >= 0 ? 2 * size : 0);
  const open = parameter.min === undefined || parameter.max === undefined;
  const span = Math.max(max - min, 0);
  const step = parameter.kind === "integer" ? 1 : span > 0 ? roundStep(span / 100) : 1;
  return { min, max: parameter.kind === "integer" ? Math.round(max) : max, step, open };
}

/** The value nearest to `value` on the grid of steps through zero, within the range. */
export function snap(value: number, range: Range, fine = false): number {
  const step = fine ? range.step / 10 : range.step;
  const snapped = tidy(Math.round(value / step) * step);
  return Math.min(range.max, Math.max(range.min, snapped));
}
