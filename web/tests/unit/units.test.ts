import assert from "node:assert/strict";
import { test } from "node:test";
import { formatBytes, formatCount, formatNumber, formatTime, parseQuantity, tidy } from "../../src/core/units.ts";

function value(text: string, unit: string, current = 0): number {
  const parsed = parseQuantity(text, unit, current);
  assert.ok("value" in parsed, `${text}: ${"error" in parsed ? parsed.error : ""}`);
  return parsed.value;
}

function error(text: string, unit: string): string {
  const parsed = parseQuantity(text, unit, 1);
  assert.ok("error" in parsed, `${text} was taken as ${"value" in parsed ? parsed.value : ""}`);
  return parsed.error;
}

test("plain numbers are in the parameter's own unit", () => {
  assert.equal(value("0.12", "m"), 0.12);
  assert.equal(value(" -3 ", "mm"), -3);
  assert.equal(value("0,12", "m"), 0.12);
  assert.equal(value(".5", ""), 0.5);
  assert.equal(value("1e-3", ""), 0.001);
});

test("lengths are converted between units", () => {
  assert.equal(value("120mm", "m"), 0.12);
  assert.equal(value("12 cm", "mm"), 120);
  assert.equal(value("1 ft", "in"), 12);
  assert.equal(value("1in", "mm"), 25.4);
  assert.equal(value("0.5 m", "ft"), tidy(0.5 / 0.3048));
});

test("fractions and feet with inches add up", () => {
  assert.equal(value("1/8 in", "in"), 0.125);
  assert.equal(value("1/8 in", "mm"), 3.175);
  assert.equal(value("1 1/2 in", "in"), 1.5);
  assert.equal(value(`5' 6 1/2"`, "in"), 66.5);
  assert.equal(value(`-5' 6"`, "in"), -66);
});

test("percentages with a sign are relative, without one a part of a plain number", () => {
  assert.equal(value("+10%", "m", 0.2), 0.22);
  assert.equal(value("-50 %", "m", 0.2), 0.1);
  assert.equal(value("50%", ""), 0.5);
  assert.match(error("50%", "m"), /does not fit/);
});

test("angles know degrees and radians", () => {
  assert.equal(value("90", "°"), 90);
  assert.equal(value("90 deg", "°"), 90);
  assert.ok(Math.abs(value("3.14159265359rad", "°") - 180) < 1e-9);
  assert.match(error("90 mm", "°"), /in °/);
  assert.match(error("90 deg", "m"), /in m/);
});

test("what cannot be read is refused with the words at fault", () => {
  assert.match(error("", "m"), /missing/);
  assert.match(error("abc", "m"), /'abc' is no number/);
  assert.match(error("12 parsec", "m"), /'parsec' is no unit/);
  assert.match(error("1 2", "m"), /cannot be read/);
  assert.match(error("12 mm", ""), /has no unit/);
  assert.match(error("1/0", ""), /no number/);
  assert.match(error("12 mm7x", "m"), /no number|no unit|cannot be read/);
});

test("numbers are written as people write them", () => {
  assert.equal(formatNumber(0.1 + 0.2), "0.3");
  assert.equal(formatNumber(-0), "0");
  assert.equal(formatNumber(-1.5), "−1.5");
  assert.equal(formatNumber(0.00001234), "1.234e−5");
  assert.equal(formatNumber(123456.789), "123457");
  assert.equal(formatNumber(Number.NaN), "–");
  assert.equal(formatTime(0.2), "<1 ms");
  assert.equal(formatTime(1234), "1.23 s");
  assert.equal(formatCount(1234567), "1\u202f234\u202f567");
  assert.equal(formatBytes(0), "0 B");
  assert.equal(formatBytes(30_100_000), "30.1 MB");
});
