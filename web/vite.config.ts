// Builds the page into the three files that crates/view embeds: fixed names,
// no hashes, no times, so that the same sources give the same bytes.
import { readFileSync } from "node:fs";
import { defineConfig, type Plugin } from "vite";

/** The libraries that end up in app.js; their licences ask to travel with them. */
const BUNDLED = ["three", "camera-controls", "@dagrejs/dagre"];

/** Puts the licence texts of the bundled libraries at the top of app.js. */
function licences(): Plugin {
  return {
    name: "licences",
    enforce: "post",
    generateBundle(_options, bundle) {
      const texts = BUNDLED.map((name) => {
        const folder = new URL(`node_modules/${name}/`, import.meta.url);
        const { version } = JSON.parse(readFileSync(new URL("package.json", folder), "utf8")) as { version: string };
        return `${name} ${version}\n${readFileSync(new URL("LICENSE", folder), "utf8").trim()}`;
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
