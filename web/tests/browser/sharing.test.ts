// Sharing, sections, selections and comparing, in a real browser.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { networkInterfaces } from "node:os";
import { test } from "node:test";
import { Bench, eventually, LivePage, program } from "./support.ts";

const bench = new Bench();

/** A graph of one box, 2 by 2 by 1 metres. */
const BOX =
  'Graph(version: 1, params: {"height": Number(default: 1, min: 0.5, max: 3)}, nodes: {"box": Cuboid(size: [2, 2, "height"], cells: [4, 4, 2])}, outputs: {"out/box.obj": "box"})\n';

async function openBox(): Promise<LivePage> {
  return (await bench.open("graphs/box.ron", BOX)).page;
}

test("a copied link opens the same view, section and pick", async () => {
  const { page, address } = await bench.open("graphs/facade.ron");
  const box = await page.page.locator(".stage canvas").boundingBox();
  assert.ok(box);
  await page.page.keyboard.press("7");
  await page.page.keyboard.press("e");
  await page.page.keyboard.press("x");
  await page.page.mouse.click(box.x + 0.45 * box.width, box.y + box.height / 2);
  const title = await page.page.locator(".readout strong").innerText();
  await page.page.locator(".section-told").filter({ hasText: /^cut / }).waitFor();
  await page.page.waitForTimeout(800);
  await page.page.locator(".share-button").click();
  const link = await page.page.locator('.share-dialog input[aria-label="Address of this view"]').inputValue();
  assert.ok(link.startsWith(`${address}#view=`), link);
  await page.page.keyboard.press("Escape");
  const picture = await page.picture();
  const other = await LivePage.open(bench.browser, link);
  try {
    await other.settled();
    await other.page.locator(".readout strong").filter({ hasText: title }).waitFor();
    await other.page.locator(".section-told").filter({ hasText: /^cut / }).waitFor();
    await eventually("the same picture", async () => (await picture.difference(await other.picture(), other.page)) < 0.002);
    assert.equal(new URL(other.page.url()).hash, "", "a reload keeps what is seen by then");
    assert.deepEqual(other.complaints, []);
  } finally {
    await other.close();
  }
});

test("each page sees the node that was chosen on it, and saves that", async () => {
  const { page, address } = await bench.open("graphs/facade.ron");
  const first = await page.counts();
  await page.page.locator('.graph-picture .node[data-node="surface"]').click();
  await eventually("the surface is shown", async () => /256 faces/.test(await page.counts()));
  const other = await LivePage.open(bench.browser, address);
  try {
    await other.settled();
    assert.equal(await other.counts(), first, "a new page begins with the first mesh");
    assert.match(await page.counts(), /256 faces/);
    await page.page.keyboard.press("Shift+S");
    const saving = page.page.waitForEvent("download");
    await page.page.getByRole("button", { name: "Save one file" }).click();
    const path = bench.workshop.path("surface.html");
    await (await saving).saveAs(path);
    const saved = /id="saved">(.*?)<\/script>/s.exec(readFileSync(path, "utf8"))?.[1] ?? "";
    const { messages } = JSON.parse(saved) as { messages: { type: string; node?: string }[] };
    assert.deepEqual(messages.filter(({ type }) => type === "shown").map(({ node }) => node), ["surface"]);
    // A page whose connection breaks off asks for its node again.
    await page.page.reload();
    await eventually("the surface is shown again", async () => /256 faces/.test(await page.counts()));
    assert.equal(await other.counts(), first);
  } finally {
    await other.close();
  }
});

test("an offline page shows the model without a server", async () => {
  const { page } = await bench.open("graphs/torus.ron");
  const picture = await page.picture();
  await page.page.keyboard.press("Shift+S");
  const saving = page.page.waitForEvent("download");
  await page.page.getByRole("button", { name: "Save one file" }).click();
  const download = await saving;
  assert.equal(download.suggestedFilename(), "torus.html");
  const path = bench.workshop.path("torus.html");
  await download.saveAs(path);
  await bench.workshop.stop();
  const offline = await LivePage.open(bench.browser, `file://${path}`);
  try {
    await offline.chip(/^Offline page/);
    await offline.page.waitForFunction(() => document.querySelector(".stage")?.hasAttribute("data-version"));
    await eventually("the same picture", async () => (await picture.difference(await offline.picture(), offline.page)) < 0.002);
    assert.ok(await offline.page.locator(".parameter input").first().isDisabled());
    await offline.page.mouse.click(640, 300);
    await offline.page.locator(".readout").waitFor();
    assert.deepEqual(offline.complaints, []);
  } finally {
    await offline.close();
  }
});

test("a phone is paired by its code, looks on, and is sent away", async (t) => {
  const isIn = Object.values(networkInterfaces()).some((addresses) => addresses?.some(({ family, internal }) => family === "IPv4" && !internal));
  if (!isIn) return t.skip("this machine is in no network");
  const { address } = await bench.workshop.serve("graphs/torus.ron", { more: ["--lan"] });
  const live = await bench.page(address);
  await live.page.keyboard.press("Shift+S");
  await live.page.getByRole("button", { name: "Make an address at" }).click();
  await live.page.locator(".qr path").waitFor();
  const code = live.page.getByRole("button", { name: "Code for device 1" });
  const blur = (): Promise<string> => live.page.locator(".qr").evaluate((qr) => getComputedStyle(qr).filter);
  assert.match(await blur(), /blur/, "nobody scans it over a shoulder");
  await code.click();
  assert.equal(await blur(), "none");
  const url = await live.page.locator('.pairings input[aria-label="Address for device 1"]').inputValue();
  assert.doesNotMatch(url, /127\.0\.0\.1|localhost/);
  const phone = await LivePage.open(bench.browser, url, { width: 390, height: 844 });
  try {
    await phone.settled();
    await phone.chip(/Read only \(shared\)/);
    assert.ok(await phone.page.locator(".parameter input").first().isDisabled());
    await live.page.locator(".pairings").getByText("1 page open").waitFor();
    await live.page.getByRole("button", { name: "Close the address of device 1" }).click();
    await phone.chip(/new address/);
    assert.deepEqual(phone.complaints, []);
  } finally {
    await phone.close();
  }
});

test("a section is filled where the body is closed, dragged, and measured on", async () => {
  const page = await openBox();
  const whole = await page.picture();
  await page.page.keyboard.press("7");
  await page.page.keyboard.press("x");
  await page.page.keyboard.press("x");
  await page.page.keyboard.press("x");
  const told = page.page.locator(".section-told");
  await told.filter({ hasText: "cut 8 m, 4 m²" }).waitFor();
  await page.page.waitForTimeout(1000);
  await page.changes(whole, "the box is open");
  // From above the cut is all that is seen: two clicks at its corners measure its diagonal.
  const corners = await page.page.evaluate(() => {
    const canvas = document.querySelector(".stage canvas")?.getBoundingClientRect();
    return canvas ? { x: canvas.x + canvas.width / 2, y: canvas.y + canvas.height / 2, height: canvas.height } : undefined;
  });
  assert.ok(corners);
  const handle = page.page.locator(".section-handle");
  const before = await page.page.locator(".section-place").innerText();
  await handle.focus();
  await handle.press("ArrowDown");
  await eventually("the plane moves", async () => (await page.page.locator(".section-place").innerText()) !== before);
  await told.filter({ hasText: "cut 8 m, 4 m²" }).waitFor();
  await page.page.keyboard.press("m");
  await page.page.mouse.click(corners.x - 40, corners.y - 60);
  await page.page.locator(".readout dd").filter({ hasText: "a place on the cut" }).waitFor();
  await page.page.mouse.click(corners.x + 40, corners.y + 60);
  await page.page.locator(".readout strong").filter({ hasText: "Distance" }).waitFor();
  assert.match(await page.page.locator(".readout dd").first().innerText(), /^[\d.]+ m$/);
  assert.equal(await page.page.locator(".readout dd").last().innerText(), "0 m", "both lie in the plane");
  assert.deepEqual(page.complaints, []);
});

test("a rectangle selects panels, which are hidden and come back", async () => {
  const { page } = await bench.open("graphs/figures/figure_03.ron");
  const before = await page.picture();
  const box = await page.page.locator(".stage canvas").boundingBox();
  assert.ok(box);
  await page.page.keyboard.press("r");
  await page.page.mouse.move(box.x + 0.3 * box.width, box.y + 0.3 * box.height);
  await page.page.mouse.down();
  await page.page.mouse.move(box.x + 0.7 * box.width, box.y + 0.7 * box.height, { steps: 4 });
  await page.page.mouse.up();
  await page.page.locator(".readout strong").filter({ hasText: /^\d+ panels$/ }).waitFor();
  await page.page.keyboard.press("h");
  await page.changes(before, "a large hole", 0.02);
  await page.page.keyboard.press("Shift+H");
  await page.becomes(before, "the picture before, from the same camera");
});

test("B is seen while its key is held, and never written", async () => {
  const page = await openBox();
  const file = bench.workshop.path("graphs/box.ron");
  const reset = page.page.locator('.parameter[data-name="height"] .reset');
  const box = page.page.locator('.parameter[data-name="height"] input.box');
  await box.fill("3");
  await box.press("Enter");
  await eventually("the file is written", () => readFileSync(file, "utf8").includes("default: 3.0,"));
  await page.settled();
  await reset.click({ modifiers: ["Shift"] });
  await reset.click();
  await eventually("and back", () => readFileSync(file, "utf8").includes("default: 1.0,"));
  await page.settled();
  await page.page.locator(".stage canvas").focus();
  const source = readFileSync(file, "utf8");
  await page.page.keyboard.down("b");
  await eventually("B is shown", async () => (await box.inputValue()) === "3");
  await page.page.keyboard.up("b");
  await eventually("A is shown", async () => (await box.inputValue()) === "1");
  assert.equal(readFileSync(file, "utf8"), source);
});

test("a picture carries its parameters", async () => {
  const { page } = await bench.open("graphs/torus.ron");
  const saving = page.page.waitForEvent("download");
  await page.page.keyboard.press("s");
  const text = readFileSync(await (await saving).path()).toString("latin1");
  assert.match(text, /iTXtTitle\0\0\0\0\0torus\.ron/);
  assert.match(text, /iTXtParameters\0\0\0\0\0\w+ = /);
});

test("an end of the legend is dragged, and the colours follow", async () => {
  const { page } = await bench.open("graphs/facade.ron");
  await page.page.keyboard.press("c");
  await page.page.locator(".legend").waitFor();
  await page.page.waitForTimeout(500);
  const picture = await page.picture();
  const high = page.page.locator('.legend input[aria-label="Highest value of the colours"]');
  const before = await high.inputValue();
  const grip = await page.page.locator(".grip.high").boundingBox();
  assert.ok(grip);
  await page.page.mouse.move(grip.x + 4, grip.y + 6);
  await page.page.mouse.down();
  await page.page.mouse.move(grip.x - 110, grip.y + 6, { steps: 4 });
  await page.page.mouse.up();
  assert.notEqual(await high.inputValue(), before);
  await page.changes(picture, "other colours");
});

test("without WebGL2 the server draws, and parameters go on", async () => {
  const { address } = await bench.workshop.serve("graphs/torus.ron");
  const context = await bench.browser.newContext({ viewport: { width: 1280, height: 800 } });
  await context.addInitScript(`HTMLCanvasElement.prototype.getContext = new Proxy(HTMLCanvasElement.prototype.getContext, {
    apply: (target, canvas, given) => (given[0].startsWith("webgl") ? null : Reflect.apply(target, canvas, given)),
  });`);
  const page = await context.newPage();
  try {
    await page.goto(address);
    const still = page.locator("img.still");
    await still.waitFor();
    const first = await still.getAttribute("src");
    assert.match(first ?? "", /^blob:/);
    await eventually("it is a picture", () => still.evaluate((image) => (image as HTMLImageElement).naturalWidth > 100));
    await page.keyboard.press("7");
    await eventually("seen from above", async () => (await still.getAttribute("src")) !== first);
  } finally {
    await context.close();
  }
});

test("a study shows the pictures of its variants", async () => {
  writeFileSync(bench.workshop.path("graphs/torus_study.ron"), 'Study(version: 1, graph: "torus.ron", axes: {"n": Values(of: [1, 2])}, keep: [])\n');
  const out = bench.workshop.path("graphs/out/torus_study");
  mkdirSync(`${out}/variants/v-b`, { recursive: true });
  writeFileSync(`${out}/results.csv`, "id,n,area\nv-a,1,4.5\nv-b,2,3.5\n");
  const drawn = spawnSync(program(), ["render", bench.workshop.path("graphs/torus.ron"), "-o", `${out}/variants/v-b/torus.png`, "--size", "300x200", "--cache", bench.workshop.path("cache")]);
  assert.equal(drawn.status, 0, drawn.stderr.toString());
  const { address } = await bench.workshop.serve("graphs/torus.ron");
  const live = await bench.page(address);
  await live.page.getByRole("tab", { name: /^Study/ }).click();
  const picture = live.page.locator(".study-pictures img");
  assert.equal(await picture.count(), 1);
  await eventually("it is there", () => picture.evaluate((image) => (image as HTMLImageElement).naturalWidth === 300));
  await live.page.locator(".study-pictures figure").hover();
  await live.page.locator(".study-head").getByText("id v-b").waitFor();
  assert.deepEqual(live.complaints, []);
});

test("two hundred parameters are found by a search", async () => {
  const names = Array.from({ length: 200 }, (_, i) => `${["roof", "wall", "edge", "bay"][i % 4]}_${i}`);
  const parameters = names.map((name) => `"${name}": Number(default: 1, min: 0, max: 2)`).join(", ");
  writeFileSync(bench.workshop.path("graphs/many.ron"), `Graph(version: 1, params: {${parameters}}, nodes: {"grid": Grid(cells: [2, 2], size: ["wall_1", 1])}, outputs: {"out/grid.obj": "grid"})\n`);
  const { address } = await bench.workshop.serve("graphs/many.ron");
  const live = await bench.page(address);
  assert.equal(await live.page.locator(".parameters details.group").count(), 4);
  await live.page.getByRole("searchbox", { name: "Search parameters" }).fill("wall_1");
  const seen = live.page.locator(".parameter:visible");
  assert.ok((await seen.count()) < 50);
  assert.equal(await seen.first().getAttribute("data-name"), "wall_1");
});
