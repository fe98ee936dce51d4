// A browser as people have it. Test drivers have it record whatever a page loads, which
// holds up the page for 20 to 40 ms at the end of a large buffer; here it is only asked
// to evaluate expressions.
import assert from "node:assert/strict";
import { type ChildProcess, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import WebSocket from "ws";
import { browserPath, PATIENCE, SOFTWARE_DRAWING } from "./support.ts";

type Answer = { id: number; result?: { result: { value?: unknown }; exceptionDetails?: { text: string } } };

/** The one page of a browser of its own. */
export class BarePage {
  private requests = 0;

  private constructor(
    private readonly browser: ChildProcess,
    private readonly profile: string,
    private readonly socket: WebSocket,
  ) {}

  static async open(address: string): Promise<BarePage> {
    const profile = mkdtempSync(join(tmpdir(), "tessgraph-browser-"));
    const options = ["--headless", "--remote-debugging-port=0", `--user-data-dir=${profile}`, "--no-first-run", "--window-size=1280,900", ...SOFTWARE_DRAWING];
    const browser = spawn(browserPath(), [...options, address], { stdio: "ignore" });
    // The file may be there before what it says: the whole first line is the port.
    const port = await soon(() => /^(\d+)\n/.exec(readFileSync(join(profile, "DevToolsActivePort"), "utf8"))?.[1]);
    const pages = await soon(async () => {
      const list = (await (await fetch(`http://127.0.0.1:${port}/json`)).json()) as { type: string; webSocketDebuggerUrl: string }[];
      return list.filter(({ type }) => type === "page").map((page) => page.webSocketDebuggerUrl)[0];
    });
    const socket = new WebSocket(pages);
    await new Promise((resolve) => socket.once("open", resolve));
    return new BarePage(browser, profile, socket);
  }

  /** The value of an expression, when it has one if it is a promise. */
  async evaluate<T>(expression: string): Promise<T> {
    this.requests += 1;
    const id = this.requests;
    const answer = new Promise<Answer>((resolve) => {
      const take = (data: WebSocket.RawData): void => {
        const message = JSON.parse(String(data)) as Answer;
        if (message.id !== id) return;
        this.socket.off("message", take);
        resolve(message);
      };
      this.socket.on("message", take);
    });
    this.socket.send(JSON.stringify({ id, method: "Runtime.evaluate", params: { expression, awaitPromise: true, returnByValue: true } }));
    const { result } = await answer;
    assert.equal(result?.exceptionDetails, undefined, expression);
    return result?.result.value as T;
  }

  async close(): Promise<void> {
    this.socket.close();
    const gone = new Promise((resolve) => this.browser.once("exit", resolve));
    this.browser.kill();
    await gone;
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}

/** What `look` finds, asked again until it finds something. */
async function soon<T>(look: () => T | undefined | Promise<T | undefined>): Promise<T> {
  for (const end = Date.now() + PATIENCE; ; ) {
    try {
      const found = await look();
      if (found !== undefined) return found;
    } catch (error) {
      if (Date.now() > end) throw error;
    }
    assert.ok(Date.now() < end, "the browser does not answer");
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}
