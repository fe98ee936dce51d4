// How long it takes from a saved file to the new picture, for a facade of a million
// vertices whose last node changed. Prints a table; `npm run latency`.
import { readFileSync, writeFileSync } from "node:fs";
import { launch, LivePage, Workshop } from "./support.ts";

const ROUNDS = 7;
const PAUSE_MS = 3000;

/** A wavy roof of 312 x 312 rings; moving the last node changes every vertex. */
const GRAPH = `Graph(
    version: 1,
    params: {"lift": Number(default: 0.5, min: 0, max: 20, unit: Length)},
    nodes: {
        "roof": ParametricSurface(x: "60 * u", y: "60 * v", z: "3 * sin(6 * u) * cos(5 * v)", cells: [312, 312]),
        "normals": VertexNormals(mesh: "roof"),
        "ring": ReadMesh(path: "meshes/ring.obj"),
        "panel": FitComponent(component: "ring", height: 0.1),
        "facade": ArrayComponents(base: "roof", component: "panel", directions: "normals", fit: Unit, join: Weld),
        "lifted": Transform(mesh: "facade", translate: (0, 0, "lift")),
    },
    outputs: {"out/facade.glb": "lifted"},
)
`;

type Parts = Record<"node" | "server" | "fetch" | "upload" | "draw" | "total", number>;

const workshop = new Workshop();
const browser = await launch();
try {
  const file = workshop.path("graphs/million.ron");
  writeFileSync(file, GRAPH);
  const server = await workshop.serve("graphs/million.ron");
  const live = await LivePage.open(browser, server.address);
  live.page.setDefaultTimeout(300_000);
  await live.settled();
  console.log(await live.counts());
  const rounds: Parts[] = [];
  for (let i = 0; i < ROUNDS; i += 1) rounds.push(await round(live, file, 1 + i));
  print(rounds);
} finally {
  await browser.close();
  await workshop.clear();
}

/** Saves a new value and waits for its picture. */
async function round(live: LivePage, file: string, lift: number): Promise<Parts> {
  const version = await live.version();
  // Whatever the software drawing still does must not count into the next round.
  await new Promise((resolve) => setTimeout(resolve, PAUSE_MS));
  const source = readFileSync(file, "utf8").replace(/default: [\d.]+/, `default: ${lift}`);
  const saved = Date.now();
  writeFileSync(file, source);
  await live.newPicture(version);
  const { arrived, painted, detail } = await live.page.evaluate(() => {
    const measure = performance.getEntriesByName("repaint").at(-1) as PerformanceMeasure;
    const start = performance.timeOrigin + measure.startTime;
    return { arrived: start, painted: start + measure.duration, detail: measure.detail as { fetch: number; upload: number; draw: number } };
  });
  const node = await live.page.locator('.graph-picture .node[data-node="lifted"] .time').textContent();
  const ms = Number.parseFloat(node ?? "") || 0;
  return { node: ms, server: arrived - saved - ms, fetch: detail.fetch, upload: detail.upload, draw: detail.draw, total: painted - saved };
}

/** The median of each part. */
function print(rounds: Parts[]): void {
  for (const part of ["node", "server", "fetch", "upload", "draw", "total"] as const) {
    const sorted = rounds.map((r) => r[part]).sort((a, b) => a - b);
    const [low, middle, high] = [sorted[0], sorted[Math.floor(sorted.length / 2)], sorted.at(-1)];
    console.log(`${part.padEnd(8)} ${[middle, low, high].map((ms) => (ms ?? 0).toFixed(0).padStart(7)).join("")} ms (median, least, most)`);
  }
}
