import assert from "node:assert/strict";
import { test } from "node:test";
import type { Parameter } from "../../src/core/protocol.ts";
import { roundStep, sliderRange, snap } from "../../src/core/slider.ts";
import { isLive, type Clock, Throttle } from "../../src/core/throttle.ts";

function parameter(part: Partial<Parameter>): Parameter {
  return { name: "t", kind: "number", value: 1, in_file: 1, initial: 1, unit: "m", about: "", locked: false, line: 1, span: [0, 1], ...part };
}

test("steps are 1, 2 or 5 times a power of ten", () => {
  assert.equal(roundStep(0.0058), 0.005);
  assert.equal(roundStep(0.1), 0.1);
  assert.equal(roundStep(99), 50);
  assert.equal(roundStep(0.2), 0.2);
});

test("a declared range gives about a hundred round steps", () => {
  const range = sliderRange(parameter({ min: 0.02, max: 0.6 }));
  assert.deepEqual(range, { min: 0.02, max: 0.6, step: 0.005, open: false });
  assert.equal(snap(0.2512, range), 0.25);
  assert.equal(snap(0.2512, range, true), 0.251);
  assert.equal(snap(9, range), 0.6);
  assert.equal(snap(0.001, range), 0.02);
});

test("whole numbers step by one", () => {
  const range = sliderRange(parameter({ kind: "integer", in_file: 2, min: 0, max: 500 }));
  assert.equal(range.step, 1);
  assert.equal(snap(2.4, range), 2);
});

test("without bounds the range is open and holds the value", () => {
  for (const value of [-3, 0, 0.25, 1000]) {
    const range = sliderRange(parameter({ in_file: value }));
    assert.ok(range.open);
    assert.ok(range.min <= value && value <= range.max && range.min < range.max, `${value}`);
  }
});

/** A clock that stands until it is moved. */
class HandClock implements Clock {
  time = 0;
  private timers: { at: number; act: () => void }[] = [];
  now(): number {
    return this.time;
  }
  after(ms: number, act: () => void): () => void {
    const timer = { at: this.time + ms, act };
    this.timers.push(timer);
    return () => {
      this.timers = this.timers.filter((t) => t !== timer);
    };
  }
  move(ms: number): void {
    this.time += ms;
    const due = this.timers.filter((t) => t.at <= this.time);
    this.timers = this.timers.filter((t) => t.at > this.time);
    for (const timer of due) timer.act();
  }
}

test("a drag sends its first and its newest value, no faster than the pause", () => {
  const clock = new HandClock();
  const sent: number[] = [];
  const throttle = new Throttle<number>((v) => sent.push(v), () => 100, clock);
  throttle.push(1);
  assert.deepEqual(sent, [1]);
  for (const v of [2, 3, 4]) {
    clock.move(20);
    throttle.push(v);
  }
  assert.deepEqual(sent, [1]);
  clock.move(40);
  assert.deepEqual(sent, [1, 4]);
  throttle.push(5);
  throttle.cancel();
  clock.move(1000);
  assert.deepEqual(sent, [1, 4], "what was cancelled is not sent");
  throttle.push(6);
  assert.deepEqual(sent, [1, 4, 6]);
});

test("slow graphs are evaluated on release unless somebody wants it otherwise", () => {
  assert.ok(isLive("auto", 50));
  assert.ok(!isLive("auto", 400));
  assert.ok(isLive("always", 4000));
  assert.ok(!isLive("release", 1));
});
