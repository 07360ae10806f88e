// Plays the page in a browser as a player would: by keys, by fingers, with what is kept, without a network.
//   node test.mjs HOST FOLDER
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { open, screen, serve, watched } from "./browser.mjs";

const [host, folder] = process.argv.slice(2);
const server = await serve(host, folder);
// A menu's key is heard in the next frame, and a frame of the software adapter takes a third of a second.
const FRAME = 700;

async function press(page, ...keys) {
  for (const key of keys) {
    await page.keyboard.press(key, { delay: 50 });
    await page.waitForTimeout(FRAME);
  }
}

// A browser that is played in; nothing may be said on the console meanwhile.
async function play(name, options, act) {
  const begin = Date.now();
  const { browser, close } = await open(options);
  const { page, said } = await watched(browser, server.address);
  try {
    await act(page, browser);
    assert.deepEqual(said, [], "the console is silent");
    console.log(`${name}: ${((Date.now() - begin) / 1000).toFixed(0)} s`);
  } catch (error) {
    await page.screenshot({ path: "out/web-failed.png" }).catch(() => undefined);
    console.error(`${name}: failed; out/web-failed.png shows where`, said, await page.evaluate(() => document.body.dataset));
    throw error;
  } finally {
    await close();
  }
}

try {
  await play("by keys: training won by the autopilot, a photo, what is kept, without a network", {}, async (page, browser) => {
    await screen(page, "warning");
    await press(page, "Enter");
    await screen(page, "title");
    await press(page, "Enter");
    await screen(page, "playing");
    // Thrust, then the autopilot, twice as fast.
    await page.keyboard.down("KeyW");
    await page.waitForTimeout(2 * FRAME);
    await page.keyboard.up("KeyW");
    await press(page, "KeyP", "Period");
    await press(page, "F2");
    await screen(page, "photo");
    await press(page, "ArrowDown", "ArrowDown", "ArrowDown", "ArrowDown");
    const [download] = await Promise.all([page.waitForEvent("download"), press(page, "Enter")]);
    assert.match(download.suggestedFilename(), /^lensrunner-.*\.png$/);
    const picture = await readFile(await download.path());
    assert.equal(picture.toString("latin1", 1, 4), "PNG");
    assert.ok(picture.includes("01-training"), "the picture has its moment");
    await press(page, "Escape");
    await screen(page, "playing");
    await screen(page, "result", 240);
    assert.equal(await page.evaluate(() => document.body.dataset.won), "true");
    const kept = await page.evaluate(() => Object.keys(localStorage));
    assert.ok(kept.some((name) => name.includes("settings")), `${kept}`);
    assert.ok(kept.some((name) => name.includes("best")), `${kept}`);
    // What was read once is not shown again.
    await page.evaluate(() => navigator.serviceWorker.ready);
    await page.waitForFunction(async () => (await caches.keys()).length === 1);
    await page.reload();
    await screen(page, "title");
    await browser.setOffline(true);
    await page.reload();
    await screen(page, "title");
  });
  await play("by fingers: training begun, flown and paused", { hasTouch: true, viewport: { width: 1180, height: 820 } }, async (page) => {
    const tap = async (x, y) => {
      await page.touchscreen.tap(x, y);
      await page.waitForTimeout(2 * FRAME);
    };
    await screen(page, "warning");
    await tap(150, 400);
    await screen(page, "title");
  });
} finally {
  server.stop();
}
