// The range of values that a legend's colours span, and the histogram beside it.
import type { MapName } from "./colour.ts";

export type ColourRange = { min: number; max: number };

/** What is known of a field without its values. */
export type FieldRange = { min: number; max: number; categorical: boolean };

/**
 * The map that suits a field: a diverging one where values lie on both sides of
 * zero; where most are exactly zero, such as counts of crossings, one that leaves
 * those plain.
 */
export function suitableMap(field: FieldRange, values?: Float32Array): MapName {
  if (field.min === 0 && values) {
    let zeros = 0;
    for (const value of values) if (value === 0) zeros += 1;
    if (2 * zeros > values.length) return "alarm";
  }
  return field.min < 0 && field.max > 0 ? "diverging" : "sequential";
}

/** The full range of a field: symmetric about zero for a diverging map, never empty. */
export function fullRange(field: FieldRange, map: MapName): ColourRange {
  if (!Number.isFinite(field.min) || !Number.isFinite(field.max)) return { min: 0, max: 1 };
  if (map === "diverging") {
    const size = Math.max(Math.abs(field.min), Math.abs(field.max)) || 1;
    return { min: -size, max: size };
  }
  // One value everywhere is at the low end of a range it can be compared in.
  return { min: field.min, max: field.max > field.min ? field.max : field.min + (Math.abs(field.min) || 1) };
}

/** The ranges of each field by name; a locked one stays while the model changes. */
export class RangeBook {
  private held = new Map<string, ColourRange>();
  locked = true;

  /** The range to colour with: the held one while locked, else the field's own. */
  rangeOf(name: string, field: FieldRange, map: MapName): ColourRange {
    const held = this.held.get(name);
    if (held && this.locked) return held;
    const range = fullRange(field, map);
    this.held.set(name, range);
    return range;
  }

  /** Holds a range typed by hand; refuses an empty one. */
  hold(name: string, range: ColourRange): boolean {
    if (!(range.max > range.min)) return false;
    this.held.set(name, range);
    this.locked = true;
    return true;
  }

  /** Lets a field's range be its own again. */
  release(name: string): void {
    this.held.delete(name);
  }
}

/** A range of which one end was dragged by a share of its width; the ends never meet. */
export function draggedRange({ min, max }: ColourRange, end: "low" | "high", share: number): ColourRange {
  const width = max - min;
  const least = 0.01 * width;
  return end === "low" ? { min: Math.min(min + share * width, max - least), max } : { min, max: Math.max(max + share * width, min + least) };
}

/** Counts of finite values in `bins` equal parts of a range; values outside fall into the end bins. */
export function histogram(values: Float32Array, range: ColourRange, bins: number): Uint32Array {
  const counts = new Uint32Array(bins);
  const scale = bins / (range.max - range.min);
  for (const value of values) {
    if (!Number.isFinite(value)) continue;
    const bin = Math.floor((value - range.min) * scale);
    const clamped = Math.min(bins - 1, Math.max(0, bin));
    counts[clamped] = (counts[clamped] as number) + 1;
  }
  return counts;
}
