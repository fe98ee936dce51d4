// Text stands out from what is behind it, on dark and light pages: AA of WCAG 2.2.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { contrast, type Rgb } from "../../src/core/colour.ts";
import { Bench } from "./support.ts";

const bench = new Bench();

/** Least contrast of text, and of large text: from 24 px on, or bold from 18.66 px on. */
const LEAST = 4.5;
const LEAST_LARGE = 3;

type Told = { text: string; place: string; colours: string[]; size: number; weight: number };

/** The texts that are seen, each with its colour and those behind it up to an opaque one. */
function texts(page: Page): Promise<Told[]> {
  return page.evaluate(() => {
    const found: Told[] = [];
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const text = walker.currentNode.textContent?.trim() ?? "";
      const parent = walker.currentNode.parentElement;
      if (!text || !parent?.checkVisibility({ opacityProperty: true, visibilityProperty: true })) continue;
      const box = parent.getBoundingClientRect();
      // What only speaks to screen readers is one pixel large; what is disabled is exempt.
      if (box.width < 2 || box.height < 2 || parent.closest(":disabled, [aria-disabled=true], title, desc, script, style")) continue;
      const style = getComputedStyle(parent);
      const colours = [parent instanceof SVGElement ? style.fill : style.color];
      // In a drawing a shape lies under its text, before it in the tree.
      for (let shape = parent instanceof SVGTextElement ? parent.previousElementSibling : null; shape; shape = shape.previousElementSibling) {
        const under = shape.getBoundingClientRect();
        const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
        if (shape.matches("rect, circle") && under.left <= x && x <= under.right && under.top <= y && y <= under.bottom) colours.push(getComputedStyle(shape).fill);
      }
      for (let node: Element | null = parent; node; node = node.parentElement) colours.push(getComputedStyle(node).backgroundColor);
      found.push({ text: text.slice(0, 40), place: parent.getAttribute("class") || parent.tagName, colours, size: Number.parseFloat(style.fontSize), weight: Number(style.fontWeight) });
    }
    return found;
  });
}

/** `rgb(1, 2, 3)` or `rgba(1, 2, 3, 0.5)`, parts of 1. */
function parse(colour: string): [...Rgb, number] {
  const [r = 0, g = 0, b = 0, alpha = 1] = (colour.match(/[\d.]+/g) ?? []).map(Number);
  return [r / 255, g / 255, b / 255, alpha];
}

/** A colour over one that nothing is seen through. */
function over([r, g, b, alpha]: [...Rgb, number], below: Rgb): Rgb {
  return [r, g, b].map((part, k) => part * alpha + (below[k] ?? 0) * (1 - alpha)) as Rgb;
}

function ratio({ colours }: Told): number {
  const [front, ...behind] = colours.map(parse) as [[...Rgb, number], ...[...Rgb, number][]];
  const ground = behind.reduceRight<Rgb>((below, colour) => over(colour, below), [0, 0, 0]);
  return contrast(over(front, ground), ground);
}

test("text is at least 4.5 times as light as its ground, or as dark", async () => {
  const { page, file } = await bench.open("graphs/facade.ron");
  const seen = new Set<string>();
  const check = async (what: string): Promise<void> => {
    const told = await texts(page.page);
    assert.ok(told.length > 20, `${what}: ${told.length} texts`);
    for (const text of told) {
      seen.add(text.place);
      const isLarge = text.size >= 24 || (text.size >= 18.66 && text.weight >= 700);
      const found = ratio(text);
      assert.ok(found >= (isLarge ? LEAST_LARGE : LEAST), `${what}: "${text.text}" (${text.place}) has ${found.toFixed(2)}: ${text.colours.join(" over ")}`);
    }
  };
  for (const theme of ["dark", "light"]) {
    if (theme === "light") await page.page.locator(".stage canvas").press("t");
    assert.equal(await page.page.locator("html").getAttribute("data-theme"), theme);
    for (const tab of ["Graph", "Table", "Messages", "Source"]) {
      await page.page.getByRole("tab", { name: new RegExp(`^${tab}`) }).click();
      await check(`${theme}, ${tab}`);
    }
    await page.page.locator(".stage canvas").press("?");
    await check(`${theme}, keys`);
    await page.page.keyboard.press("Escape");
    await page.page.keyboard.press("Shift+S");
    await check(`${theme}, share`);
    await page.page.keyboard.press("Escape");
  }
  writeFileSync(file, "Graph(version: 1, nodes: {");
  await page.chip(/^Stale/);
  for (const theme of ["light", "dark"]) {
    await page.page.getByRole("tab", { name: /^Messages/ }).click();
    await check(`${theme}, with errors`);
    await page.page.locator(".stage canvas").press("t");
  }
  assert.ok(seen.size > 25, [...seen].join(", "));
});
