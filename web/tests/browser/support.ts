// A real server on a copy of the shipped graphs, and a real browser in front of it.
import assert from "node:assert/strict";
import { type ChildProcess, spawn } from "node:child_process";
import { cpSync, existsSync, mkdtempSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, afterEach, before } from "node:test";
import { fileURLToPath } from "node:url";
import { type Browser, chromium, type Page } from "playwright-core";

const ROOT = fileURLToPath(new URL("../../../", import.meta.url));

/** Longest wait for something the page must show; software drawing on a busy machine is slow. */
export const PATIENCE = 30_000;

/** The program under test: TESSGRAPH, or the newest that was built here. */
export function program(): string {
  const named = process.env["TESSGRAPH"];
  const built = ["release", "debug"].map((profile) => join(ROOT, "target", profile, "tessgraph")).filter(existsSync);
  built.sort((a, b) => statSync(b).mtimeMs - statSync(a).mtimeMs);
  const found = named ?? built[0];
  assert.ok(found, "build tessgraph first (cargo build), or name it in TESSGRAPH");
  return found;
}

export function browserPath(): string {
  const found = [process.env["CHROMIUM"], "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((path) => path && existsSync(path));
  assert.ok(found, "no browser: install Debian's chromium, or name one in CHROMIUM");
  return found;
}

/** Has a browser draw in software, as machines without a graphics card must. */
export const SOFTWARE_DRAWING = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"];

/** A headless browser that draws in software. */
export function launch(): Promise<Browser> {
  return chromium.launch({
    executablePath: browserPath(),
    args: [...SOFTWARE_DRAWING, "--enable-precise-memory-info"],
  });
}

/** A folder of its own with the shipped graphs in it. */
export class Workshop {
  readonly folder = mkdtempSync(join(tmpdir(), "tessgraph-page-"));
  private servers: Server[] = [];

  constructor() {
    cpSync(join(ROOT, "graphs"), this.path("graphs"), { recursive: true, filter: (source) => !source.endsWith("/out") });
  }

  path(...parts: string[]): string {
    return join(this.folder, ...parts);
  }

  /** Starts `tessgraph view` and waits for its address. */
  async serve(graph: string, options: ServerOptions = {}): Promise<Server> {
    const server = await Server.start(this.path(graph), this.path("cache"), options);
    this.servers.push(server);
    return server;
  }

  /** Ends all servers; their folder stays. */
  async stop(): Promise<void> {
    await Promise.all(this.servers.map((server) => server.kill()));
  }

  async clear(): Promise<void> {
    await this.stop();
    rmSync(this.folder, { recursive: true, force: true });
  }
}

type ServerOptions = { port?: number; token?: string; more?: string[] };

export class Server {
  private constructor(
    private readonly child: ChildProcess,
    readonly address: string,
  ) {}

  static async start(graph: string, cache: string, { port, token, more = [] }: ServerOptions): Promise<Server> {
    const args = ["view", graph, "--no-open", "--cache", cache, ...more, ...(port === undefined ? [] : ["--port", String(port)])];
    const child = spawn(program(), args, {
      env: { ...process.env, ...(token === undefined ? {} : { TESSGRAPH_VIEW_TOKEN: token }) },
      stdio: ["ignore", "pipe", "pipe"],
    });
    let said = "";
    const address = await new Promise<string>((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`no address within ${PATIENCE} ms:\n${said}`)), PATIENCE);
      const listen = (chunk: Buffer): void => {
        said += chunk.toString();
        const found = /http:\/\/127\.0\.0\.1:\d+\/[0-9a-f]{32}\//.exec(said);
        if (!found) return;
        clearTimeout(timer);
        resolve(found[0]);
      };
      child.stdout.on("data", listen);
      child.stderr.on("data", listen);
      child.on("exit", (code) => {
        clearTimeout(timer);
        reject(new Error(`tessgraph view ended with ${code}:\n${said}`));
      });
    });
    return new Server(child, address);
  }

  /** The number of its process. */
  get process(): number {
    return this.child.pid ?? 0;
  }

  get port(): number {
    return Number(new URL(this.address).port);
  }

  get token(): string {
    return new URL(this.address).pathname.slice(1, -1);
  }

  /** Ends it as a power cut would. */
  kill(): Promise<void> {
    if (this.child.exitCode !== null || this.child.signalCode !== null) return Promise.resolve();
    return new Promise((resolve) => {
      this.child.once("exit", () => resolve());
      this.child.kill("SIGKILL");
    });
  }
}

/** A page under test: what it complained of, and what it shows. */
export class LivePage {
  readonly complaints: string[] = [];

  constructor(readonly page: Page) {
    page.setDefaultTimeout(PATIENCE);
    page.on("pageerror", (error) => this.complaints.push(String(error)));
    page.on("console", (message) => {
      // A server that is gone makes the browser itself complain of the connection.
      const expected = /ERR_CONNECTION_(REFUSED|RESET)|WebSocket connection|status of 401/.test(message.text());
      if (["error", "warning"].includes(message.type()) && !expected) this.complaints.push(message.text());
    });
  }

  static async open(browser: Browser, address: string, viewport = { width: 1280, height: 800 }): Promise<LivePage> {
    const context = await browser.newContext({ viewport, colorScheme: "dark", reducedMotion: "reduce" });
    const live = new LivePage(await context.newPage());
    await live.page.goto(address);
    return live;
  }

  async close(): Promise<void> {
    await this.page.context().close();
  }

  /** Waits for a chip that says so. */
  async chip(text: string | RegExp): Promise<void> {
    await this.page.locator(".chip-text").filter({ hasText: text }).waitFor();
  }

  /** Waits until the newest result is on the screen. */
  async settled(): Promise<void> {
    await this.chip(/^Up to date/);
    await this.page.waitForFunction(() => document.querySelector(".stage")?.hasAttribute("data-version"));
    // Two frames and what the graphics card still draws.
    await this.page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  }

  /** Waits for the picture of a version other than this one. */
  async newPicture(version: string): Promise<void> {
    await this.page.waitForFunction((old) => document.querySelector<HTMLElement>(".stage")?.dataset["version"] !== old, version);
  }

  version(): Promise<string> {
    return this.page.evaluate(() => document.querySelector<HTMLElement>(".stage")?.dataset["version"] ?? "");
  }

  counts(): Promise<string> {
    return this.page.locator(".counts").innerText();
  }

  /** The picture alone, without what lies over it or marks the focus, as pixels. */
  async picture(): Promise<Picture> {
    const hidden = await this.page.evaluateHandle(() => {
      const sheet = new CSSStyleSheet();
      sheet.replaceSync(".banner, .stage > :not(canvas), .stage::after { visibility: hidden !important } .stage canvas { outline: none !important }");
      document.adoptedStyleSheets.push(sheet);
      return sheet;
    });
    const png = await this.page.locator(".stage canvas").screenshot();
    await hidden.evaluate((sheet) => {
      document.adoptedStyleSheets = document.adoptedStyleSheets.filter((s) => s !== sheet);
    });
    return new Picture(png.toString("base64"));
  }

  /** Waits until the picture is the one from before again. */
  async becomes(picture: Picture, what: string): Promise<void> {
    await eventually(what, async () => (await picture.difference(await this.picture(), this.page)) < 0.002);
  }

  /** Waits until the picture is visibly another one. */
  async changes(picture: Picture, what: string, least = 0.002): Promise<void> {
    await eventually(what, async () => (await picture.difference(await this.picture(), this.page)) > least);
  }

  /** Moves a parameter's slider with the mouse, as a hand does. */
  async drag(name: string, from: number, to: number): Promise<void> {
    const slider = this.page.locator(`.parameter[data-name="${name}"] input[type=range]`);
    const box = await slider.boundingBox();
    assert.ok(box);
    const x = (part: number): number => box.x + 7 + part * (box.width - 14);
    const y = box.y + box.height / 2;
    await this.page.mouse.move(x(from), y);
    await this.page.mouse.down();
    for (let i = 1; i <= 5; i += 1) await this.page.mouse.move(x(from + ((to - from) * i) / 5), y);
    await this.page.mouse.up();
  }
}

/** A browser for the tests of a file, and for each of them a folder of its own; all are let go of in time. */
export class Bench {
  private started: Browser | undefined;
  private folder: Workshop | undefined;
  private pages: LivePage[] = [];

  constructor() {
    before(async () => {
      this.started = await launch();
    });
    after(() => this.browser.close());
    afterEach(async () => {
      await Promise.all(this.pages.splice(0).map((page) => page.close()));
      await this.folder?.clear();
      this.folder = undefined;
    });
  }

  get browser(): Browser {
    assert.ok(this.started);
    return this.started;
  }

  /** The folder of the test that runs. */
  get workshop(): Workshop {
    this.folder ??= new Workshop();
    return this.folder;
  }

  /** A page that has settled. */
  async page(address: string): Promise<LivePage> {
    const page = await LivePage.open(this.browser, address);
    this.pages.push(page);
    await page.settled();
    return page;
  }

  /** A server and a settled page on one of the shipped graphs, or on one of this text. */
  async open(graph: string, text?: string): Promise<{ page: LivePage; address: string; file: string }> {
    const file = this.workshop.path(graph);
    if (text !== undefined) writeFileSync(file, text);
    const { address } = await this.workshop.serve(graph);
    return { page: await this.page(address), address, file };
  }
}

/** Pixels of a screenshot. */
export class Picture {
  constructor(private readonly base64: string) {}

  /** Share of pixels that differ visibly from another picture of the same size. */
  async difference(other: Picture, page: Page): Promise<number> {
    return page.evaluate(
      async (pictures) => {
        // No named function here: the compiler of the tests would mark it with a
        // helper that the page does not have.
        const [p, q] = await Promise.all(
          pictures.map(async (data) => {
            const bytes = Uint8Array.from(atob(data), (c) => c.charCodeAt(0));
            const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
            const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
            if (!context) throw new Error("no canvas");
            context.drawImage(bitmap, 0, 0);
            return context.getImageData(0, 0, bitmap.width, bitmap.height);
          }),
        );
        if (!p || !q) throw new Error("no pixels");
        if (p.width !== q.width || p.height !== q.height) return 1;
        let different = 0;
        for (let i = 0; i < p.data.length; i += 4) {
          let distance = 0;
          for (let k = i; k < i + 3; k += 1) distance += Math.abs((p.data[k] as number) - (q.data[k] as number));
          if (distance > 24) different += 1;
        }
        return different / (p.data.length / 4);
      },
      [this.base64, other.base64],
    );
  }
}

/** Tries until it holds. */
export async function eventually(what: string, holds: () => boolean | Promise<boolean>): Promise<void> {
  const end = Date.now() + PATIENCE;
  while (!(await holds())) {
    assert.ok(Date.now() < end, `${what}: not within ${PATIENCE} ms`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}
