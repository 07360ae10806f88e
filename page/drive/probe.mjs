import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { fingers, open, screen, serve, watched } from "./browser.mjs";
const [host, folder, ...which] = process.argv.slice(2);
const server = await serve(host, folder);
const wants = (name) => which.length === 0 || which.includes(name);
const FRAME = 700;
const press = async (page, ...keys) => { for (const key of keys) { await page.keyboard.press(key, { delay: 50 }); await page.waitForTimeout(FRAME); } };
async function part(name, options, act) {
  if (!wants(name)) return;
  const { browser, close } = await open(options);
  const { page, said } = await watched(browser, server.address);
  try { await act(page, browser); console.log(name, "good", said); } catch (error) { console.log(name, "FAILED", error.message.slice(0, 800), said, await page.evaluate(() => ({...document.body.dataset})).catch(()=>0)); await page.screenshot({ path: `/tmp/me/probe-${name}.png` }).catch(()=>0); } finally { await close(); }
}
await part("pad", {}, async (page) => {
  await page.addInitScript(() => {
    const buttons = Array.from({ length: 17 }, () => ({ pressed: false, touched: false, value: 0 }));
    globalThis.pad = { id: "test pad", index: 0, connected: true, mapping: "standard", axes: [0, 0, 0, 0], buttons, timestamp: 1 };
    navigator.getGamepads = () => [globalThis.pad, null, null, null];
  });
  await page.reload();
  await screen(page, "warning");
  const push = async (k) => { for (const on of [true, false]) { await page.evaluate(([k, on]) => { Object.assign(pad.buttons[k], { pressed: on, value: on ? 1 : 0 }); }, [k, on]); await page.waitForTimeout(FRAME); } };
  await push(0);
  await screen(page, "title", 20);
  await push(0);
  await screen(page, "playing", 30);
  await page.evaluate(() => { pad.axes[1] = -1; });
  await page.waitForFunction(() => globalThis.lensrunnerSound.last[1] > 0.5, undefined, { timeout: 20000 });
  await page.waitForTimeout(2000);
  console.log(await page.evaluate(() => ({ ...document.body.dataset })));
  await page.screenshot({ path: "/tmp/me/pad.png" });
});
await part("bring", {}, async (page) => {
  await screen(page, "warning");
  await press(page, "Enter");
  await screen(page, "title");
  const [download] = await Promise.all([page.waitForEvent("download"), page.evaluate(() => lensrunner.save_all())]);
  const path = await download.path();
  const text = await readFile(path, "utf8");
  console.log(Object.keys(JSON.parse(text)));
  await page.evaluate(() => localStorage.clear());
  page.on("dialog", (d) => { console.log("dialog", d.message()); d.accept(); });
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.evaluate(() => lensrunner.bring_all())]);
  await chooser.setFiles(path);
  await page.waitForTimeout(3000);
  await screen(page, "title");
  const kept = await page.evaluate(() => Object.fromEntries(Object.entries(localStorage)));
  assert.deepEqual(kept, JSON.parse(text));
  const [chooser2] = await Promise.all([page.waitForEvent("filechooser"), page.evaluate(() => lensrunner.bring_all())]);
  await chooser2.setFiles({ name: "x.json", mimeType: "application/json", buffer: Buffer.from("{\"a\":1}") });
  await page.waitForTimeout(1000);
});
await part("memory", {}, async (page, browser) => {
  await page.close();
  const other = await browser.newPage();
  await other.addInitScript(() => { WebAssembly.instantiateStreaming = WebAssembly.instantiate = async () => { throw new RangeError("WebAssembly.Memory(): could not allocate memory"); }; });
  await other.goto(server.address);
  await other.waitForFunction(() => document.getElementById("word").textContent.includes("not enough memory"), undefined, { timeout: 60000 });
  await other.screenshot({ path: "/tmp/me/probe-memory-shown.png" });
});
await part("upright", { hasTouch: true, isMobile: true, viewport: { width: 820, height: 1180 } }, async (page) => {
  const touch = await fingers(page);
  const tap = async (x, y) => { await touch.put(0, x, y); await page.waitForTimeout(80); await touch.lift(0); await page.waitForTimeout(2 * FRAME); };
  await screen(page, "warning");
  await page.waitForFunction(() => document.body.dataset.drawn);
  await page.waitForTimeout(3000);
  await page.screenshot({ path: "/tmp/me/upright-1.png" });
  await tap(150, 371);
  await page.waitForTimeout(3000);
  await page.screenshot({ path: "/tmp/me/upright-2.png" });
  await tap(171, 193);
  await page.waitForTimeout(5000);
  await page.screenshot({ path: "/tmp/me/upright-3.png" });
});
await part("hidden", { headless: false }, async (page, browser) => {
  await screen(page, "warning");
  await page.waitForTimeout(3000);
  await press(page, "Enter");
  await screen(page, "title");
  await page.waitForTimeout(3000);
  await press(page, "Enter");
  await screen(page, "playing");
  await page.waitForTimeout(3000);
  const state = () => page.evaluate(() => ({ hidden: document.hidden, screen: document.body.dataset.screen, drawn: document.body.dataset.drawn, sound: globalThis.lensrunnerSound.context?.state, now: performance.now() }));
  console.log(await state());
  const other = await browser.newPage();
  await other.bringToFront();
  await other.waitForTimeout(4000);
  console.log(await state());
  await other.waitForTimeout(4000);
  console.log(await state());
  await other.close();
  await page.bringToFront();
  await page.waitForTimeout(3000);
  console.log(await state());
  await page.screenshot({ path: "/tmp/me/hidden-back.png" });
});
server.stop();
