// Pictures of scenes as the page draws them, for `lab/run chart drivers --driver DIR`: node pictures.mjs HOST FOLDER DIR SCENE...
import { mkdir, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { open, serve } from "./browser.mjs";

const [host, folder, output, ...scenes] = process.argv.slice(2);
const server = await serve(host, folder);
const { browser, close } = await open();
try {
  await mkdir(output, { recursive: true });
  const page = await browser.newPage();
  // The page without its game.
  await page.route("**/page.js", (route) => route.abort());
  await page.goto(server.address);
  for (const scene of scenes) {
    const bytes = await page.evaluate(async (scene) => {
      globalThis.lensrunner ??= { breath: () => new Promise((resolve) => setTimeout(resolve)), ended: console.error };
      const game = await import("./lensrunner_page.js");
      await game.default({ module_or_path: await fetch("lensrunner_page_bg.wasm") });
      const table = new Uint8Array(await (await fetch("table.bin")).arrayBuffer());
      const shaders = await (await fetch("shaders.json")).text();
      return Array.from(await game.shot(table, shaders, scene, 640, 360));
    }, scene);
    await writeFile(join(output, `${scene}.png`), Buffer.from(bytes));
    console.log(scene);
  }
} finally {
  await close();
  server.stop();
}
