// By hand: commands from a pipe, one a line; pictures to /tmp/me/hand-N.png. Not kept.
import { createInterface } from "node:readline";
import { fingers, open, serve, watched } from "./browser.mjs";
const [host, folder, kind] = process.argv.slice(2);
const server = await serve(host, folder);
const options = kind === "touch" ? { hasTouch: true, isMobile: true, viewport: { width: 1180, height: 820 } } : { viewport: { width: 960, height: 540 } };
const { browser, close } = await open(options);
const { page, said, begin } = await watched(browser, server.address);
const touch = await fingers(page);
let n = 0;
const wait = (ms) => page.waitForTimeout(ms);
const acts = {
  put: (id, x, y) => touch.put(+id, +x, +y), move: (id, x, y) => touch.move(+id, +x, +y), lift: (id) => touch.lift(+id),
  tap: async (x, y) => { await touch.put(9, +x, +y); await wait(120); await touch.lift(9); },
  down: (k) => page.keyboard.down(k), up: (k) => page.keyboard.up(k), key: (k) => page.keyboard.press(k, { delay: 80 }),
  mouse: (x, y) => page.mouse.move(+x, +y, { steps: 8 }), click: (x, y) => page.mouse.click(+x, +y),
  wait: (s) => wait(1000 * s),
  shot: async () => { n += 1; await page.screenshot({ path: `/tmp/me/hand-${n}.png` }); },
  eval: async (...code) => console.log(JSON.stringify(await page.evaluate(code.join(" ")))),
  quit: async () => { await close(); server.stop(); process.exit(0); },
};
console.log("ready");
for await (const line of createInterface({ input: process.stdin })) {
  for (const one of line.split(";")) {
    const [name, ...rest] = one.trim().split(/\s+/);
    if (!name) continue;
    try { await acts[name](...rest); } catch (error) { console.log("error", error.message.slice(0, 200)); }
  }
  console.log(`${((Date.now() - begin) / 1000).toFixed(1)} s: ${line} -> ${n}`, said.length ? said.slice(-3) : "");
}
