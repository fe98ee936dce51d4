import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { colourAt, contrast, decode, encode, fromOklab, mapBytes, type MapName, oklab, type Rgb } from "../../src/core/colour.ts";
import { fullRange, histogram, RangeBook, suitableMap } from "../../src/core/legend.ts";

const SAMPLES = Array.from({ length: 65 }, (_, i) => i / 64);

/** What is seen without the long or the middle cones: Viénot, Brettel and Mollon 1999, linear light. */
const BLIND: Record<string, number[][]> = {
  protanopia: [[0.11238, 0.88762, 0], [0.11238, 0.88762, 0], [0.00401, -0.00401, 1]],
  deuteranopia: [[0.29275, 0.70725, 0], [0.29275, 0.70725, 0], [-0.02234, 0.02234, 1]],
};

function seen(colour: Rgb, matrix: number[][]): Rgb {
  const linear = decode(colour);
  return encode(matrix.map((row) => row.reduce((sum, m, k) => sum + m * (linear[k] as number), 0)) as Rgb);
}

function difference(a: Rgb, b: Rgb): number {
  const [p, q] = [oklab(decode(a)), oklab(decode(b))];
  return Math.hypot(...p.map((c, k) => c - (q[k] as number)));
}

test("OKLab goes there and back, and knows white", () => {
  const white = oklab([1, 1, 1]);
  assert.ok(Math.abs(white[0] - 1) < 1e-3 && Math.hypot(white[1], white[2]) < 1e-3);
  const colour: Rgb = [0.2, 0.5, 0.7];
  fromOklab(oklab(colour)).forEach((c, k) => assert.ok(Math.abs(c - (colour[k] as number)) < 1e-4));
});

test("maps for ordered values get lighter evenly, for every kind of colour vision", () => {
  for (const map of ["sequential", "blue_yellow"] satisfies MapName[]) {
    for (const [vision, matrix] of [["usual", undefined] as const, ...Object.entries(BLIND)]) {
      const lightness = SAMPLES.map((t) => oklab(decode(matrix ? seen(colourAt(map, t), matrix) : colourAt(map, t)))[0]);
      for (let i = 1; i < lightness.length; i += 1) {
        assert.ok((lightness[i] as number) > (lightness[i - 1] as number), `${map}, ${vision}, at ${SAMPLES[i]}`);
      }
    }
  }
});

test("the two sides of the diverging map are told apart by all", () => {
  for (const matrix of Object.values(BLIND)) {
    for (const t of [0, 0.1, 0.2, 0.3]) {
      const apart = difference(seen(colourAt("diverging", t), matrix), seen(colourAt("diverging", 1 - t), matrix));
      assert.ok(apart > 0.1, `${t}: ${apart}`);
    }
  }
});

test("what must not be gets darker the more there is, and nothing stays plain", () => {
  for (const matrix of [undefined, ...Object.values(BLIND)]) {
    const look = (t: number): Rgb => (matrix ? seen(colourAt("alarm", t), matrix) : colourAt("alarm", t));
    const lightness = SAMPLES.slice(1).map((t) => oklab(decode(look(t)))[0]);
    for (let i = 1; i < lightness.length; i += 1) assert.ok((lightness[i] as number) < (lightness[i - 1] as number), String(SAMPLES[i + 1]));
    assert.ok(difference(look(0), look(1 / 255)) > 0.08, "one is told from none");
  }
});

test("a map's texture begins and ends with its ends", () => {
  const bytes = mapBytes("sequential");
  const end = (t: number): number[] => colourAt("sequential", t).map((c) => Math.round(255 * c));
  assert.deepEqual([...bytes.slice(0, 3)], end(0));
  assert.deepEqual([...bytes.slice(-4, -1)], end(1));
  assert.equal(bytes[3], 255);
});

test("text of both themes is readable on its ground", () => {
  const css = readFileSync(new URL("../../src/app.css", import.meta.url), "utf8");
  const tokens = (selector: string): Map<string, Rgb> => {
    const block = css.slice(css.indexOf(selector), css.indexOf("}", css.indexOf(selector)));
    return new Map([...block.matchAll(/--([\w-]+): #([0-9a-f]{6});/g)].map(([, name = "", hex = ""]) => [name, [0, 2, 4].map((i) => Number.parseInt(hex.slice(i, i + 2), 16) / 255) as Rgb]));
  };
  for (const selector of [":root {", ':root[data-theme="light"] {']) {
    const theme = tokens(selector);
    for (const ground of ["panel", "raised", "stage"]) {
      for (const text of ["text", "muted", "accent", "good", "bad", "warn", "code-text", "code-number", "code-comment", "code-word"]) {
        const [a, b] = [theme.get(text), theme.get(ground)];
        assert.ok(a && b, `${text} on ${ground}`);
        const ratio = contrast(a, b);
        assert.ok(ratio >= 4.5, `${selector} ${text} on ${ground}: ${ratio.toFixed(2)}`);
      }
    }
    const [accent, on] = [theme.get("accent"), theme.get("on-accent")];
    assert.ok(accent && on && contrast(accent, on) >= 4.5);
  }
});

test("signed fields get a diverging map and a range about zero", () => {
  const signed = { min: -1, max: 3, categorical: false };
  assert.equal(suitableMap(signed), "diverging");
  assert.deepEqual(fullRange(signed, "diverging"), { min: -3, max: 3 });
  const plain = { min: 1, max: 3, categorical: false };
  assert.equal(suitableMap(plain), "sequential");
  assert.deepEqual(fullRange(plain, "sequential"), { min: 1, max: 3 });
  const counts = { min: 0, max: 9, categorical: false };
  assert.equal(suitableMap(counts, new Float32Array([0, 0, 0, 9])), "alarm");
  assert.equal(suitableMap(counts, new Float32Array([0, 1, 2, 9])), "sequential");
  assert.equal(suitableMap({ min: 0, max: 0, categorical: false }, new Float32Array(3)), "alarm", "no crossing anywhere is plain too");
  assert.deepEqual(fullRange({ min: 2, max: 2, categorical: false }, "sequential"), { min: 2, max: 4 });
  assert.deepEqual(fullRange({ min: 0, max: 0, categorical: false }, "alarm"), { min: 0, max: 1 });
});

test("a locked range stays while the model changes", () => {
  const book = new RangeBook();
  const before = book.rangeOf("error", { min: 0, max: 1, categorical: false }, "sequential");
  assert.deepEqual(book.rangeOf("error", { min: 0, max: 9, categorical: false }, "sequential"), before);
  book.locked = false;
  assert.deepEqual(book.rangeOf("error", { min: 0, max: 9, categorical: false }, "sequential"), { min: 0, max: 9 });
  assert.ok(!book.hold("error", { min: 1, max: 1 }), "an empty range is refused");
  assert.ok(!book.hold("error", { min: Number.NaN, max: 1 }));
  assert.ok(book.hold("error", { min: 1, max: 2 }));
  assert.deepEqual(book.rangeOf("error", { min: 0, max: 9, categorical: false }, "sequential"), { min: 1, max: 2 });
  book.release("error");
  assert.deepEqual(book.rangeOf("error", { min: 0, max: 9, categorical: false }, "sequential"), { min: 0, max: 9 });
});

test("histograms count every finite value once", () => {
  const values = new Float32Array([0, 0.1, 0.5, 0.99, 1, -5, 7, Number.NaN, Number.POSITIVE_INFINITY]);
  const counts = histogram(values, { min: 0, max: 1 }, 4);
  assert.deepEqual([...counts], [3, 0, 1, 3]);
});
