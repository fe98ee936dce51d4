// A study's table as axes of parallel coordinates.

export type StudyAxis = {
  name: string;
  /** Place of each row in [0, 1], NaN where it has no value. */
  places: Float64Array;
  low: string;
  high: string;
};

/** One axis per column that varies or is a number; text is placed by its order. */
export function studyAxes(columns: string[], rows: (number | string | null)[][], format: (value: number) => string): StudyAxis[] {
  return columns.map((name, column) => {
    const values = rows.map((row) => row[column] ?? null);
    const numbers = values.map((v) => (typeof v === "number" ? v : v !== null && v !== "" && Number.isFinite(Number(v)) ? Number(v) : Number.NaN));
    const numeric = values.every((v, i) => v === null || v === "" || !Number.isNaN(numbers[i]));
    if (numeric) {
      const finite = numbers.filter((n) => Number.isFinite(n));
      const low = finite.reduce((a, b) => Math.min(a, b), Number.POSITIVE_INFINITY);
      const high = finite.reduce((a, b) => Math.max(a, b), Number.NEGATIVE_INFINITY);
      const span = high - low;
      const places = Float64Array.from(numbers, (n) => (span > 0 ? (n - low) / span : Number.isNaN(n) ? n : 0.5));
      return { name, places, low: finite.length ? format(low) : "–", high: finite.length ? format(high) : "–" };
    }
    const words = [...new Set(values.filter((v) => v !== null).map(String))].sort();
    const places = Float64Array.from(values, (v) => (v === null ? Number.NaN : words.length > 1 ? words.indexOf(String(v)) / (words.length - 1) : 0.5));
    return { name, places, low: words[0] ?? "–", high: words.at(-1) ?? "–" };
  });
}

/** The row whose polyline passes nearest to a point; axes lie at 0, 1, 2, ... */
export function nearestRow(axes: StudyAxis[], x: number, y: number, allowed: (row: number) => boolean): number | undefined {
  const left = Math.min(axes.length - 2, Math.max(0, Math.floor(x)));
  const [a, b] = [axes[left], axes[left + 1]];
  if (!a || !b) return undefined;
  let best: number | undefined;
  let least = 0.05;
  for (let row = 0; row < a.places.length; row += 1) {
    const from = a.places[row] as number;
    const to = b.places[row] as number;
    const distance = Math.abs(from + (x - left) * (to - from) - y);
    if (distance < least && allowed(row)) {
      least = distance;
      best = row;
    }
  }
  return best;
}
