// The page in a real browser, against the real server.
import assert from "node:assert/strict";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { test } from "node:test";
import { Bench, eventually, LivePage } from "./support.ts";

const bench = new Bench();

test("every shipped graph opens and is drawn", async () => {
  const names = ["graphs", "graphs/figures"].flatMap((folder) => readdirSync(bench.workshop.path(folder)).filter((n) => n.endsWith(".ron")).map((n) => `${folder}/${n}`));
  assert.ok(names.length >= 18, `${names.length} graphs`);
  for (const name of names) {
    const server = await bench.workshop.serve(name);
    const page = await LivePage.open(bench.browser, server.address);
    await page.settled();
    assert.match(await page.counts(), /^[1-9][\d\u202f]* faces/, name);
    const drawn = await page.picture();
    await page.page.keyboard.press("w");
    await page.changes(drawn, `${name}: there is a model to see through`, 0.005);
    assert.deepEqual(page.complaints, [], name);
    await page.close();
    await server.kill();
  }
});

test("a slider changes counts, picture and one value of the file", async () => {
  const { page, file } = await bench.open("graphs/facade.ron");
  const source = readFileSync(file, "utf8");
  const counts = await page.counts();
  const picture = await page.picture();
  await page.drag("levels", 2 / 5, 1 / 5);
  await eventually("the file is written", () => readFileSync(file, "utf8") !== source);
  assert.equal(readFileSync(file, "utf8"), source.replace("Integer(default: 2,", "Integer(default: 1,"));
  await eventually("the counts change", async () => (await page.counts()) !== counts);
  await page.changes(picture, "another picture", 0.02);
  await page.page.keyboard.press("Control+z");
  await eventually("undo brings the bytes back", () => readFileSync(file, "utf8") === source);
  await eventually("and the counts", async () => (await page.counts()) === counts);
  assert.deepEqual(page.complaints, []);
});

test("a box takes millimetres and writes the file's unit", async () => {
  const { page, file } = await bench.open("graphs/facade.ron");
  const source = readFileSync(file, "utf8");
  const box = page.page.locator('.parameter[data-name="thickness"] input.box');
  await box.fill("300 mm");
  await box.press("Enter");
  await eventually("the file is written", () => readFileSync(file, "utf8") !== source);
  assert.equal(readFileSync(file, "utf8"), source.replace("Number(default: 0.25,", "Number(default: 0.3,"));
  await box.fill("3 parsec");
  await box.press("Enter");
  await page.page.getByText("'parsec' is no unit").waitFor();
});

test("arrow keys move a slider by steps and write once", async () => {
  const { page, file } = await bench.open("graphs/facade.ron");
  const source = readFileSync(file, "utf8");
  const slider = page.page.locator('.parameter[data-name="smooth"] input[type=range]');
  await slider.focus();
  await slider.press("ArrowRight");
  await slider.press("Shift+ArrowRight");
  await eventually("the file is written", () => readFileSync(file, "utf8") !== source);
  await page.page.waitForTimeout(600);
  assert.equal(readFileSync(file, "utf8"), source.replace("Integer(default: 10,", "Integer(default: 21,"));
});

test("a broken file shows its error and the last good picture, marked; mended it is good", async () => {
  const { page, file } = await bench.open("graphs/facade.ron");
  const source = readFileSync(file, "utf8");
  writeFileSync(file, source.replace("SubdivideQuad(", "SubdivideQuat("));
  await page.chip(/^Stale: 1 error \(line \d+\)/);
  await page.page.locator(".diagnostic pre").filter({ hasText: "SubdivideQuat" }).waitFor();
  assert.ok(await page.page.locator(".stage.stale").isVisible());
  // The picture is still there: seen through, it changes.
  const stale = await page.picture();
  await page.page.keyboard.press("w");
  await page.changes(stale, "a model to see through", 0.005);
  await page.page.locator(".diagnostic .link").first().click();
  await page.page.locator(".source .line.lit").first().waitFor();
  assert.match(await page.page.locator(".source .mark").first().innerText(), /SubdivideQuat/);
  writeFileSync(file, source);
  await page.chip(/^Up to date/);
  assert.equal(await page.page.locator(".stage.stale").count(), 0);
  assert.equal(await page.page.locator(".diagnostic").count(), 0);
  assert.deepEqual(page.complaints, []);
});

test("a click on a node shows its result, its inputs and its page", async () => {
  const { page } = await bench.open("graphs/facade.ron");
  const counts = await page.counts();
  await page.page.locator('.graph-picture .node[data-node="surface"]').click();
  await eventually("another mesh is shown", async () => (await page.counts()) !== counts);
  assert.match(await page.counts(), /256 faces/);
  await page.page.locator(".details h2").filter({ hasText: "surface SubdivideQuad" }).waitFor();
  await page.page.locator(".details").getByText("Catmull").first().waitFor();
  await page.page.locator('.graph-picture .node[data-node="surface"]').dblclick();
  await page.page.locator(".source .line.lit").filter({ hasText: '"surface": SubdivideQuad' }).waitFor();
});

test("a click on the model reads out a face, a second one a vertex; Esc lets go", async () => {
  const { page } = await bench.open("graphs/facade.ron");
  await page.page.locator('.graph-picture .node[data-node="surface"]').click();
  await eventually("the surface is shown", async () => /256 faces/.test(await page.counts()));
  await page.settled();
  const box = await page.page.locator(".stage canvas").boundingBox();
  assert.ok(box);
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.page.mouse.click(x, y);
  await page.page.locator(".readout strong").filter({ hasText: /^Face \d+/ }).waitFor();
  assert.ok((await page.page.locator(".readout dt").count()) >= 2);
  await page.page.mouse.click(x, y);
  await page.page.locator(".readout strong").filter({ hasText: /^Vertex \d+/ }).waitFor();
  await page.page.keyboard.press("Escape");
  assert.ok(await page.page.locator(".readout").isHidden());
  await page.page.keyboard.press("m");
  await page.page.mouse.click(x, y);
  await page.page.mouse.click(x + 60, y + 30);
  await page.page.locator(".readout strong").filter({ hasText: "Distance" }).waitFor();
  assert.match(await page.page.locator(".readout dd").first().innerText(), /\d.*m/);
});

test("a panel is hidden and comes back", async () => {
  const { page } = await bench.open("graphs/figures/figure_03.ron");
  const before = await page.picture();
  const box = await page.page.locator(".stage canvas").boundingBox();
  assert.ok(box);
  await page.page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await page.page.locator(".readout strong").filter({ hasText: /^Panel \d+/ }).waitFor();
  await page.page.keyboard.press("h");
  await page.page.locator(".readout").waitFor({ state: "hidden" });
  await page.changes(before, "a hole is seen", 0.005);
  await page.page.keyboard.press("Shift+H");
  await page.becomes(before, "the picture before");
});

test("a saved picture is a PNG named after file and node", async () => {
  const { page } = await bench.open("graphs/torus.ron");
  const saving = page.page.waitForEvent("download");
  await page.page.keyboard.press("s");
  const download = await saving;
  assert.equal(download.suggestedFilename(), "torus_lattice.png");
  const bytes = readFileSync(await download.path());
  assert.deepEqual([...bytes.subarray(1, 4)], [...Buffer.from("PNG")]);
  assert.ok(bytes.length > 20_000, "there is something on it");
});

test("the camera stays across updates, reloads and a killed server", async () => {
  const first = await bench.workshop.serve("graphs/torus.ron");
  const page = await bench.page(first.address);
  const corner = await page.picture();
  await page.page.keyboard.press("7");
  await page.changes(corner, "a look from above");
  await page.page.waitForTimeout(1000);
  const top = await page.picture();
  await page.page.reload();
  await page.settled();
  await page.becomes(top, "the same picture after a reload");
  await first.kill();
  await page.chip(/^Disconnected/);
  await page.becomes(top, "the picture stays without a server");
  await bench.workshop.serve("graphs/torus.ron", { port: first.port, token: first.token });
  await page.chip(/^Up to date/);
  await page.becomes(top, "the same picture from the next server");
  assert.deepEqual(page.complaints, []);
});

test("a server with a new address is told apart from one that is gone", async () => {
  const first = await bench.workshop.serve("graphs/torus.ron");
  const live = await bench.page(first.address);
  await first.kill();
  await bench.workshop.serve("graphs/torus.ron", { port: first.port, token: "f".repeat(32) });
  await live.chip(/new address/);
});

test("names and texts of a file are shown as text, whatever they say", async () => {
  const evil = "<script>window.harmed=1</script><img src=x onerror=window.harmed=2>";
  const graph = bench.workshop.path("graphs/<b>evil.ron");
  const about = JSON.stringify(evil);
  writeFileSync(graph, `Graph(version: 1, params: {"width": Number(default: 1, min: 0.1, max: 3, about: ${about}), "label": Text(default: ${about})}, nodes: {"grid": Grid(cells: [4, 4], size: ["width", 1])}, outputs: {"out/grid.obj": "grid"})\n`);
  const server = await bench.workshop.serve("graphs/<b>evil.ron");
  const live = await bench.page(server.address);
  assert.equal(await live.page.locator('.parameter[data-name="label"] input').inputValue(), evil);
  assert.match((await live.page.locator('.parameter[data-name="width"] label').getAttribute("title")) ?? "", /<script>/);
  assert.equal(await live.page.locator(".topbar .file").innerText(), "<b>evil.ron");
  writeFileSync(graph, readFileSync(graph, "utf8").replace("Grid(cells", `Grid(${evil.slice(0, 8)}cells`));
  await live.chip(/^Stale/);
  await live.page.locator(".diagnostic pre").first().waitFor();
  assert.equal(await live.page.evaluate(() => (window as { harmed?: number }).harmed), undefined);
  assert.equal(await live.page.locator("img, #app script").count(), 0);
});

test("colours, legend, section, directions and edges change the picture", async () => {
  const { page } = await bench.open("graphs/facade.ron");
  let last = await page.picture();
  const changed = async (what: string): Promise<void> => {
    await page.changes(last, what);
    last = await page.picture();
  };
  await page.page.keyboard.press("e");
  await changed("triangle edges");
  await page.page.keyboard.press("e");
  await changed("no edges");
  await page.page.keyboard.press("x");
  await changed("a section");
  await page.page.keyboard.press("Shift+X");
  await changed("its other side");
  await page.page.keyboard.press("5");
  await changed("parallel lines of sight");
  await page.page.keyboard.press("t");
  await changed("a light page");
  await page.page.keyboard.press("c");
  await page.page.locator(".legend").waitFor();
  await changed("colours");
  assert.ok((await page.page.locator(".histogram rect").count()) > 0);
  assert.deepEqual(page.complaints, []);
});

test("a lost graphics context comes back with the same picture", async () => {
  const { page } = await bench.open("graphs/torus.ron");
  const before = await page.picture();
  await page.page.evaluate(async () => {
    const canvas = document.querySelector<HTMLCanvasElement>(".stage canvas");
    const extension = canvas?.getContext("webgl2")?.getExtension("WEBGL_lose_context");
    if (!canvas || !extension) throw new Error("no context to lose");
    const restored = new Promise((resolve) => canvas.addEventListener("webglcontextrestored", resolve, { once: true }));
    extension.loseContext();
    await new Promise((resolve) => setTimeout(resolve, 300));
    extension.restoreContext();
    await restored;
  });
  await page.becomes(before, "the same picture");
});

test("everything is reached by Tab, and the sheet of keys opens and closes", async () => {
  const { page } = await bench.open("graphs/facade.ron");
  const reached = new Set<string>();
  for (let i = 0; i < 120; i += 1) {
    await page.page.keyboard.press("Tab");
    const name = await page.page.evaluate(() => {
      const node = document.activeElement;
      const place = node?.closest(".topbar, .parameters, .checks, .gizmo, .viewbar, .drawer, .stage");
      return place?.getAttribute("class")?.split(" ").at(-1) ?? "";
    });
    reached.add(name);
    const visible = await page.page.evaluate(() => document.activeElement === document.body || document.activeElement?.matches(":focus-visible"));
    assert.ok(visible, `focus is seen in ${name}`);
  }
  for (const part of ["topbar", "parameters", "gizmo", "stage", "viewbar", "drawer"]) assert.ok(reached.has(part), `${part}: ${[...reached].join(" ")}`);
  await page.page.keyboard.press("?");
  await page.page.getByText("Fit the whole model").first().waitFor();
  await page.page.keyboard.press("Escape");
  assert.ok(await page.page.locator("dialog.help").isHidden());
  await page.page.keyboard.press("/");
  await page.page.keyboard.type("smooth_d");
  await page.page.keyboard.press("Enter");
  await page.page.locator(".details h2").filter({ hasText: "smooth_dirs" }).waitFor();
});

test("a hundred updates leave memory as it was", async () => {
  const { page } = await bench.open("graphs/facade.ron");
  const devtools = await page.page.context().newCDPSession(page.page);
  const heap = async (): Promise<number> => {
    await devtools.send("HeapProfiler.collectGarbage");
    const { usedSize } = await devtools.send("Runtime.getHeapUsage");
    return usedSize;
  };
  const slider = page.page.locator('.parameter[data-name="thickness"] input[type=range]');
  await slider.focus();
  const moves = async (count: number): Promise<void> => {
    for (let i = 0; i < count; i += 1) {
      const version = await page.version();
      await slider.press(i % 2 ? "ArrowLeft" : "ArrowRight");
      await page.newPicture(version);
    }
  };
  await moves(20);
  const start = await heap();
  await moves(80);
  const end = await heap();
  assert.ok(end < 1.1 * start + 500_000, `${start} bytes before, ${end} after`);
});
