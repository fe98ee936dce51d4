// Takes the pictures of docs/view.md in a real browser: `npm run pictures`.
import { spawnSync } from "node:child_process";
import { mkdirSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { launch, LivePage, Workshop } from "../tests/browser/support.ts";

const FOLDER = fileURLToPath(new URL("../../docs/view/", import.meta.url));

type Picture = { name: string; graph: string; width: number; height: number; light: boolean; pose(live: LivePage): Promise<void> };

/** Colours by the first field whose label holds a word. */
async function colourBy(live: LivePage, word: string): Promise<void> {
  const menu = live.page.locator('.topbar select[aria-label="Colour by"]');
  const options = await menu.locator("option").allInnerTexts();
  await menu.selectOption({ index: Math.max(0, options.findIndex((label) => label.includes(word))) });
}

async function show(live: LivePage, node: string): Promise<void> {
  await live.page.keyboard.press("/");
  await live.page.keyboard.type(node);
  await live.page.keyboard.press("Enter");
}

const PICTURES: Picture[] = [
  {
    name: "facade",
    graph: "graphs/facade.ron",
    width: 1280,
    height: 800,
    light: false,
    pose: async (live) => {
      await colourBy(live, "depth");
      const box = await live.page.locator(".stage canvas").boundingBox();
      if (box) await live.page.mouse.click(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
    },
  },
  {
    name: "crossings",
    graph: "graphs/figures/figure_07.ron",
    width: 1920,
    height: 1080,
    light: true,
    pose: async (live) => {
      await show(live, "anticlastic_default");
      await live.page.waitForTimeout(1000);
      await colourBy(live, "anticlastic default crossings");
      // From higher up and more along the fold, where bricks cross.
      await live.page.mouse.move(1200, 150);
      await live.page.mouse.down();
      await live.page.mouse.move(1330, 290, { steps: 8 });
      await live.page.mouse.up();
      await live.page.waitForTimeout(1000);
      await live.page.keyboard.press("f");
    },
  },
];

mkdirSync(FOLDER, { recursive: true });
const browser = await launch();
try {
  for (const { name, graph, width, height, light, pose } of PICTURES) {
    const workshop = new Workshop();
    const server = await workshop.serve(graph);
    const live = await LivePage.open(browser, server.address, { width, height });
    await live.settled();
    if (light) await live.page.keyboard.press("t");
    await pose(live);
    await live.page.waitForTimeout(2500);
    await live.page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
    const path = `${FOLDER}${name}.png`;
    await live.page.screenshot({ path });
    // A palette makes them three times smaller; without pngquant they stay as they are.
    spawnSync("pngquant", ["--force", "--skip-if-larger", "--strip", "--output", path, "256", path]);
    await live.close();
    await workshop.clear();
  }
} finally {
  await browser.close();
}
