// Builds the page into the three files that crates/view embeds: fixed names,
// no hashes, no times, so that the same sources give the same bytes.
import { existsSync, readFileSync } from "node:fs";
import { defineConfig, type Plugin } from "vite";

/** The libraries that end up in app.js; their licences ask to travel with them. */
const BUNDLED = ["three", "camera-controls", "@dagrejs/dagre", "qrcode-generator"];

/** The licence of a package: its file, or the comment its script begins with. */
function licence(folder: URL): string {
  const file = new URL("LICENSE", folder);
  if (existsSync(file)) return readFileSync(file, "utf8").trim();
  const { module } = JSON.parse(readFileSync(new URL("package.json", folder), "utf8")) as { module: string };
  const head = /^(?:\/\/.*\r?\n)+/.exec(readFileSync(new URL(module, folder), "utf8"))?.[0] ?? "";
  if (!head.includes("MIT")) throw new Error(`${folder.pathname} names no licence`);
  return head.replaceAll(/^\/\/-*\s?/gm, "").trim();
}

/** Puts the licence texts of the bundled libraries at the top of app.js. */
function licences(): Plugin {
  return {
    name: "licences",
    enforce: "post",
    generateBundle(_options, bundle) {
      const texts = BUNDLED.map((name) => {
        const folder = new URL(`node_modules/${name}/`, import.meta.url);
        const { version } = JSON.parse(readFileSync(new URL("package.json", folder), "utf8")) as { version: string };
        return `${name} ${version}\n${licence(folder)}`;
      });
      for (const chunk of Object.values(bundle)) {
        if (chunk.type === "chunk") {
          chunk.code = `/*!\n${texts.join("\n\n").replaceAll("*/", "* /").replaceAll("\r", "")}\n*/\n${chunk.code}`;
        }
      }
    },
  };
}

export default defineConfig({
  base: "./",
  plugins: [licences()],
  build: {
    outDir: "../crates/view/page",
    emptyOutDir: true,
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: 1 << 20,
    chunkSizeWarningLimit: 2000,
    rollupOptions: {
      output: {
        codeSplitting: false,
        entryFileNames: "app.js",
        assetFileNames: "app.[ext]",
      },
    },
  },
});
