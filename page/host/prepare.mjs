// Has the game write what a page would else work out each time: its shaders' texts, and the table packed. Called when the page is made:
//   node prepare.mjs FOLDER TABLE
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [folder, table] = process.argv.slice(2);
globalThis.lensrunner = { ended: console.error };
const game = await import(pathToFileURL(join(folder, "lensrunner_page.js")).href);
await game.default({ module_or_path: await readFile(join(folder, "lensrunner_page_bg.wasm")) });
await writeFile(join(folder, "shaders.json"), game.written_shaders());
await writeFile(join(folder, "table.bin"), game.pack(await readFile(table)));
