// How long it takes from a saved file to the new picture, for a facade of a million
// vertices whose last node changed. Prints a table; `npm run latency`. It judges
// nothing: times are those of the machine, and of what else it does.
import { readFileSync, writeFileSync } from "node:fs";
import { BarePage } from "./bare.ts";
import { Workshop } from "./support.ts";

const ROUNDS = Number(process.env["LATENCY"] ?? 9);
const PAUSE_MS = 3000;
const LOOK_MS = 300;

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

/**
 * Of one save: the node itself; until the page was told of the picture, and then waited
 * for its positions, which it began to fetch before; all until the graphics card has
 * them, over the node; drawing, which takes seconds in software; the sum.
 */
type Parts = Record<(typeof PARTS)[number], number>;
const PARTS = ["node", "told", "fetch", "upload", "over", "draw", "total"] as const;

const workshop = new Workshop();
let page: BarePage | undefined;
try {
  const file = workshop.path("graphs/million.ron");
  writeFileSync(file, GRAPH);
  const server = await workshop.serve("graphs/million.ron");
  page = await BarePage.open(server.address);
  await pictureAfter(page, "");
  console.log(await page.evaluate<string>("document.querySelector('.counts').textContent"));
  const rounds: Parts[] = [];
  for (let i = 0; i < ROUNDS; i += 1) rounds.push(await round(page, file, 1 + i));
  print(rounds);
} finally {
  await page?.close();
  await workshop.clear();
}

/** Waits for the picture of a version other than this one; seldom asks, so as not to disturb. */
async function pictureAfter(page: BarePage, version: string): Promise<string> {
  for (;;) {
    const now = await page.evaluate<string>("document.querySelector('.stage')?.dataset.version ?? ''");
    if (now !== version) return now;
    await pause(LOOK_MS);
  }
}

function pause(ms: number): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, ms));
}

/** What the page noted of its last picture. */
type Repaint = { arrived: number; painted: number; detail: { fetch: number; upload: number; draw: number }; node: string };

/** Saves a new value and waits for its picture. */
async function round(page: BarePage, file: string, lift: number): Promise<Parts> {
  const version = await pictureAfter(page, "");
  // Whatever the software drawing still does must not count into the next round.
  await pause(PAUSE_MS);
  const source = readFileSync(file, "utf8").replace(/default: [\d.]+/, `default: ${lift}`);
  const saved = Date.now();
  writeFileSync(file, source);
  await pictureAfter(page, version);
  const { arrived, painted, detail, node } = await page.evaluate<Repaint>(`(() => {
    const measure = performance.getEntriesByName("repaint").at(-1);
    const arrived = performance.timeOrigin + measure.startTime;
    const node = document.querySelector('.graph-picture .node[data-node="lifted"] .time').textContent;
    return { arrived, painted: arrived + measure.duration, detail: measure.detail, node };
  })()`);
  const { fetch, upload, draw } = detail;
  const ms = Number.parseFloat(node) || 0;
  const total = painted - saved;
  return { node: ms, told: arrived - saved - ms, fetch, upload, over: total - draw - ms, draw, total };
}

/** The median of each part. */
function print(rounds: Parts[]): void {
  for (const part of PARTS) {
    const sorted = rounds.map((r) => r[part]).sort((a, b) => a - b);
    const [low, middle, high] = [sorted[0], sorted[Math.floor(sorted.length / 2)], sorted.at(-1)];
    console.log(`${part.padEnd(8)} ${[middle, low, high].map((ms) => (ms ?? 0).toFixed(0).padStart(7)).join("")} ms (median, least, most)`);
  }
}
