// The picture follows a held slider before the graph is evaluated.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Bench, type LivePage } from "./support.ts";

const bench = new Bench();

/** Rings on both sides of a wavy roof, which directions leave at a slant. */
const GRAPH = `Graph(
    version: 1,
    params: {
        "depth": Number(default: 0.2, min: 0.05, max: 1.5, unit: Length),
        "rise": Number(default: 0.5, min: 0, max: 2, unit: Length),
    },
    nodes: {
        "roof": ParametricSurface(x: "8 * u", y: "6 * v", z: "rise * sin(6 * u) * cos(5 * v)", cells: [8, 6]),
        "normals": VertexNormals(mesh: "roof"),
        "smooth": SmoothNormals(mesh: "roof", iterations: 5),
        "ring": ReadMesh(path: "meshes/ring.obj"),
        "fitted": FitComponent(component: "ring", height: "depth", anchor: Centre),
        "panels": ArrayComponents(base: "roof", component: "fitted", directions: "smooth", fit: Unit, height: Relative, join: Weld),
    },
    outputs: {"out/panels.glb": "panels"},
)
`;

/** Takes hold of a slider and moves it from one part of its way to another. */
async function hold(page: LivePage, name: string, from: number, to: number): Promise<void> {
  const slider = page.page.locator(`.parameter[data-name="${name}"] input[type=range]`);
  const box = await slider.boundingBox();
  assert.ok(box);
  const x = (part: number): number => box.x + 7 + part * (box.width - 14);
  const y = box.y + box.height / 2;
  await page.page.mouse.move(x(from), y);
  await page.page.mouse.down();
  for (let i = 1; i <= 4; i += 1) await page.page.mouse.move(x(from + ((to - from) * i) / 4), y);
}

/** Nothing is evaluated before the slider is let go. */
async function onRelease(page: LivePage): Promise<void> {
  await page.page.locator(".parameters header select").selectOption("release");
}

test("a held slider is followed at once, and the evaluated picture is the same", async () => {
  const { page, file } = await bench.open("graphs/panels.ron", GRAPH);
  await onRelease(page);
  const before = await page.picture();
  const version = await page.version();
  await hold(page, "depth", 0.1, 0.7);
  await page.chip(/^Preview \(instanced\)$/);
  await page.changes(before, "the picture follows", 0.02);
  assert.equal(readFileSync(file, "utf8"), GRAPH, "nothing is written while it is held");
  assert.equal(await page.version(), version, "nothing was evaluated");
  const preview = await page.picture();
  await page.page.mouse.up();
  await page.newPicture(version);
  await page.chip(/^Up to date/);
  const exact = await page.picture();
  const off = await preview.difference(exact, page.page);
  console.log(`${(100 * off).toFixed(4)} % of the pixels differ`);
  assert.ok(off < 0.0005, `${off} of the pixels differ`);
  assert.notEqual(readFileSync(file, "utf8"), GRAPH);
  assert.deepEqual(page.complaints, []);
});

test("a slider that comes back to its value leaves the picture that was there", async () => {
  const { page, file } = await bench.open("graphs/panels.ron", GRAPH);
  await onRelease(page);
  const before = await page.picture();
  const start = (0.2 - 0.05) / (1.5 - 0.05);
  await hold(page, "depth", start, 0.7);
  await page.chip(/^Preview/);
  await page.changes(before, "the picture follows", 0.02);
  const box = await page.page.locator('.parameter[data-name="depth"] input[type=range]').boundingBox();
  assert.ok(box);
  await page.page.mouse.move(box.x + 7 + start * (box.width - 14), box.y + box.height / 2);
  await page.page.mouse.up();
  await page.chip(/^Up to date/);
  await page.becomes(before, "the picture is the old one");
  assert.equal(readFileSync(file, "utf8"), GRAPH);
});

test("what depends on more than heights waits, and what nearly follows says so", async () => {
  const { page } = await bench.open("graphs/panels.ron", GRAPH);
  await onRelease(page);
  const before = await page.picture();
  await hold(page, "rise", 0.25, 0.7);
  await page.page.waitForTimeout(500);
  await page.chip(/^Up to date/);
  assert.ok((await before.difference(await page.picture(), page.page)) < 0.0005);
  await page.page.mouse.up();
  await page.changes(before, "evaluated on release", 0.02);
  const facade = (await bench.open("graphs/facade.ron")).page;
  await onRelease(facade);
  await hold(facade, "thickness", 0.4, 0.8);
  await facade.chip(/^Preview \(instanced, approximate\)$/);
  await facade.page.mouse.up();
  await facade.chip(/^Up to date/);
  assert.deepEqual(facade.complaints, []);
});
