// What a designer types into a number box: `0.12`, `120mm`, `1/8 in`, `5' 6 1/2"`,
// `+10%`. The result is a number in the parameter's own unit.

/** Metres per unit of length. */
const METRES: Record<string, number> = {
  m: 1,
  cm: 0.01,
  mm: 0.001,
  km: 1000,
  ft: 0.3048,
  "'": 0.3048,
  in: 0.0254,
  '"': 0.0254,
};

/** Degrees per unit of angle. */
const DEGREES: Record<string, number> = { "°": 1, deg: 1, rad: 180 / Math.PI };

export type Parsed = { value: number } | { error: string };

const NUMBER = /^\s*(?:(\d+)\s+)?(\d+)\s*\/\s*(\d+)|^\s*(\d+(?:[.,]\d*)?|[.,]\d+)(?:e([+-]?\d+))?/i;
const UNIT = /^\s*(km|cm|mm|m|ft|in|deg|rad|°|'|"|%)/i;

/**
 * Reads a number box. `unit` is the parameter's (a length, "°" or ""), `current`
 * what `+10%` is relative to. Terms with units add up (`5' 6"`); a number without
 * a unit is in the parameter's own.
 */
export function parseQuantity(text: string, unit: string, current: number): Parsed {
  const relative = /^\s*([+-])\s*([\d.,]+)\s*%\s*$/.exec(text);
  if (relative) {
    const percent = decimal(relative[2] ?? "");
    if (!Number.isFinite(percent)) return { error: `'${text.trim()}' is no percentage` };
    const sign = relative[1] === "-" ? -1 : 1;
    return { value: tidy(current * (1 + (sign * percent) / 100)) };
  }
  const signed = /^\s*([+-])?(.*)$/s.exec(text);
  const sign = signed?.[1] === "-" ? -1 : 1;
  let rest = signed?.[2] ?? "";
  if (rest.trim() === "") return { error: "a number is missing" };
  let total = 0;
  let terms = 0;
  while (rest.trim() !== "") {
    const term = readTerm(rest, unit);
    if ("error" in term) return term;
    if (terms > 0 && !term.hasUnit) return { error: `'${rest.trim()}' cannot be read; give one number, such as 0.12 or 120mm` };
    total += term.value;
    terms += 1;
    rest = term.rest;
  }
  return { value: tidy(sign * total) };
}

type Term = { value: number; rest: string; hasUnit: boolean };

function readTerm(text: string, unit: string): Term | { error: string } {
  const match = NUMBER.exec(text);
  if (!match) return { error: `'${text.trim()}' is no number; give one such as 0.12, 120mm or 1/8 in` };
  const number = numberOf(match);
  if (!Number.isFinite(number)) return { error: `'${match[0].trim()}' is no number` };
  let rest = text.slice(match[0].length);
  const named = UNIT.exec(rest);
  if (!named) {
    if (/^\s*[a-z]/i.test(rest)) {
      return { error: `'${rest.trim()}' is no unit; use m, cm, mm, ft, in or °` };
    }
    return { value: number, rest, hasUnit: false };
  }
  rest = rest.slice(named[0].length);
  if (/^[a-z]/i.test(rest)) return { error: `'${(named[1] ?? "") + rest.trim()}' is no unit; use m, cm, mm, ft, in or °` };
  const factor = conversion((named[1] ?? "").toLowerCase(), unit);
  if (factor === undefined) {
    const own = unit === "" ? "this number has no unit" : `this number is in ${unit}`;
    return { error: `'${named[1]}' does not fit: ${own}` };
  }
  return { value: number * factor, rest, hasUnit: true };
}

function numberOf(match: RegExpExecArray): number {
  if (match[3] !== undefined) {
    return Number(match[1] ?? 0) + Number(match[2]) / Number(match[3]);
  }
  return decimal(match[4] ?? "") * 10 ** Number(match[5] ?? 0);
}

function decimal(text: string): number {
  return Number(text.replace(",", "."));
}

/** How many of `to` one of `from` is, where both measure the same thing. */
function conversion(from: string, to: string): number | undefined {
  for (const table of [METRES, DEGREES]) {
    const a = table[from];
    const b = table[to];
    if (a !== undefined && b !== undefined) return a / b;
  }
  return from === "%" && to === "" ? 0.01 : undefined;
}

/** Takes off what binary fractions add: 0.12 and not 0.12000000000000001. */
export function tidy(value: number): number {
  return value === 0 ? 0 : Number(value.toPrecision(12));
}

/** A number as a person would write it: `digits` significant digits, no trailing zeros. */
export function formatNumber(value: number, digits = 6): string {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "–" : value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const rounded = Number(value.toPrecision(digits));
  const size = Math.abs(rounded);
  if (size >= 1e9 || size < 1e-4) return rounded.toExponential().replace("e+", "e").replace("-", "−");
  return String(rounded).replace("-", "−");
}

/** Milliseconds as a chip shows them. */
export function formatTime(ms: number): string {
  if (ms < 1) return "<1 ms";
  if (ms < 1000) return `${Math.round(ms)} ms`;
  return `${(ms / 1000).toFixed(ms < 10_000 ? 2 : 1)} s`;
}

/** A count with thin spaces between thousands. */
export function formatCount(count: number): string {
  return String(count).replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f");
}

/** Bytes in decimal units, as the command line writes them. */
export function formatBytes(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  const power = Math.min(4, Math.floor(Math.log10(bytes) / 3));
  return `${formatNumber(bytes / 1000 ** power, 3)} ${["B", "kB", "MB", "GB", "TB"][power]}`;
}
