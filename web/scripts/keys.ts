// Writes docs/keys.md from the page's table of keys.
import { writeFileSync } from "node:fs";
import { keysMarkdown } from "../src/core/keys.ts";

writeFileSync(new URL("../../docs/keys.md", import.meta.url), keysMarkdown());
