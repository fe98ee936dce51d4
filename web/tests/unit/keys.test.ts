import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { actionOf, GROUPS, KEYS, keyLabel, keysMarkdown, strokeNames, type Stroke } from "../../src/core/keys.ts";

function stroke(part: Partial<Stroke>): Stroke {
  return { key: "", code: "", ctrlKey: false, metaKey: false, shiftKey: false, altKey: false, ...part };
}

test("no key and no action stands twice in the table", () => {
  const keys = KEYS.flatMap((binding) => [...binding.keys]);
  assert.equal(new Set(keys).size, keys.length);
  assert.equal(new Set(KEYS.map((b) => b.action)).size, KEYS.length);
});

test("every binding has a group of the sheet and a title of its own", () => {
  for (const binding of KEYS) assert.ok(GROUPS.includes(binding.group), binding.action);
  assert.equal(new Set(KEYS.map((b) => b.title)).size, KEYS.length);
});

test("strokes find their action", () => {
  assert.equal(actionOf(stroke({ key: "f", code: "KeyF" })), "fit");
  assert.equal(actionOf(stroke({ key: "1", code: "Digit1" })), "front");
  assert.equal(actionOf(stroke({ key: "1", code: "Numpad1" })), "front");
  assert.equal(actionOf(stroke({ key: "!", code: "Digit1", shiftKey: true })), "back");
  assert.equal(actionOf(stroke({ key: "?", code: "Slash", shiftKey: true })), "help");
  assert.equal(actionOf(stroke({ key: "/", code: "Slash" })), "search");
  assert.equal(actionOf(stroke({ key: "/", code: "Digit7", shiftKey: true })), "bottom", "a German slash is Shift 7; the view wins, Ctrl K searches too");
  assert.equal(actionOf(stroke({ key: " ", code: "Space" })), "next_output");
  assert.equal(actionOf(stroke({ key: "Z", code: "KeyZ", ctrlKey: true, shiftKey: true })), "redo");
  assert.equal(actionOf(stroke({ key: "z", code: "KeyZ", metaKey: true })), "undo");
  assert.equal(actionOf(stroke({ key: "z", code: "KeyZ" })), "fit_selection");
  assert.equal(actionOf(stroke({ key: "f", code: "KeyF", altKey: true })), undefined);
  assert.equal(actionOf(stroke({ key: "f", code: "KeyF", ctrlKey: true })), undefined, "the browser's own search stays");
});

test("the browser's own keys are left alone", () => {
  for (const key of ["r", "w", "t", "n", "p", "l", "f", "s"]) {
    assert.equal(actionOf(stroke({ key, code: `Key${key.toUpperCase()}`, ctrlKey: true })), undefined, `Ctrl ${key}`);
  }
});

test("labels are what is printed on keys", () => {
  assert.equal(keyLabel("Control+Shift+z"), "Ctrl Shift Z");
  assert.equal(keyLabel("Shift+Digit1"), "Shift 1");
  assert.equal(keyLabel("Escape"), "Esc");
  assert.deepEqual(strokeNames(stroke({ key: "a", code: "KeyA" })), ["a"]);
});

test("docs/keys.md is made from the table", () => {
  const page = readFileSync(new URL("../../../docs/keys.md", import.meta.url), "utf8");
  assert.equal(page, keysMarkdown(), "run `npm run keys` in web/");
});
