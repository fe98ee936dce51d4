// Whether anything piles up while a graph is edited for hours: so many updates of one
// page (`npm run soak`, 2000 unless SOAK says otherwise), and then what the page's
// heap, the graphics card and the server hold.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import WebSocket from "ws";
import { launch, LivePage, Workshop } from "./support.ts";

const UPDATES = Number(process.env["SOAK"] ?? 2000);

/** The browser compiles, and the server learns, until then; what is held then is compared with the end. */
const WARM = Math.min(Math.floor(UPDATES / 2), 700);

/**
 * What the server learns in one update: the keys and digests of five results, and two
 * reports. It keeps 16 MB of them; values have a budget of their own, which is filled by and by.
 */
const KNOWN_BYTES = 16_000;

type Sample = { update: number; heap: number; textures: number; buffers: number; resident: number };

const workshop = new Workshop();
const browser = await launch();
try {
  const server = await workshop.serve("graphs/facade.ron", { more: ["--max-memory", "200MB"] });
  const context = await browser.newContext({ viewport: { width: 800, height: 600 }, reducedMotion: "reduce" });
  // Counts what is made and let go of on the graphics card.
  await context.addInitScript(() => {
    const live = { textures: 0, buffers: 0 };
    (window as unknown as { live: typeof live }).live = live;
    const proto = WebGL2RenderingContext.prototype;
    const { createTexture, deleteTexture, createBuffer, deleteBuffer } = proto;
    proto.createTexture = function () {
      live.textures += 1;
      return createTexture.call(this);
    };
    proto.deleteTexture = function (texture) {
      if (texture) live.textures -= 1;
      deleteTexture.call(this, texture);
    };
    proto.createBuffer = function () {
      live.buffers += 1;
      return createBuffer.call(this);
    };
    proto.deleteBuffer = function (buffer) {
      if (buffer) live.buffers -= 1;
      deleteBuffer.call(this, buffer);
    };
  });
  const live = new LivePage(await context.newPage());
  await live.page.goto(server.address);
  await live.settled();
  const session = await context.newCDPSession(live.page);
  const sample = async (update: number): Promise<Sample> => {
    // Twice: what the first collection finalizes goes with the second.
    for (let i = 0; i < 2; i += 1) await session.send("HeapProfiler.collectGarbage");
    const { usedSize } = (await session.send("Runtime.getHeapUsage")) as { usedSize: number };
    const card = await live.page.evaluate(() => (window as unknown as { live: { textures: number; buffers: number } }).live);
    const resident = /VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${server.process}/status`, "utf8"))?.[1];
    return { update, heap: usedSize, ...card, resident: 1024 * Number(resident) };
  };
  const socket = new WebSocket(`${server.address.replace("http", "ws")}socket`);
  await new Promise((resolve) => socket.once("open", resolve));
  const samples: Sample[] = [];
  for (let update = 1; update <= UPDATES; update += 1) {
    const version = await live.version();
    const value = 0.1 + (0.4 * update) / UPDATES;
    socket.send(JSON.stringify({ type: "set", name: "thickness", value }));
    await live.newPicture(version);
    if (update % Math.max(1, Math.floor(UPDATES / 20)) === 0 || update === WARM) {
      samples.push(await sample(update));
      const { heap, textures, buffers, resident } = samples.at(-1) as Sample;
      console.log(`${update} updates: heap ${(heap / 1e6).toFixed(2)} MB, ${textures} textures, ${buffers} buffers, server ${(resident / 1e6).toFixed(1)} MB`);
    }
  }
  socket.close();
  const warm = samples.find((s) => s.update >= WARM) as Sample;
  const last = samples.at(-1) as Sample;
  assert.ok(last.heap < 1.05 * warm.heap, "the page's heap grows");
  assert.equal(last.textures, warm.textures, "textures are lost");
  assert.equal(last.buffers, warm.buffers, "buffers are lost");
  const more = last.resident - warm.resident;
  assert.ok(more < KNOWN_BYTES * (last.update - warm.update), "the server grows");
  assert.deepEqual(live.complaints, []);
  console.log("nothing piles up");
} finally {
  await browser.close();
  await workshop.clear();
}
