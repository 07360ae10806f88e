// Plays the page in a browser as a player would: by keys, by fingers, with what is kept, without a network.
//   node test.mjs HOST FOLDER
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { deflateSync, inflateSync } from "node:zlib";
import { fingers, open, screen, serve, watched } from "./browser.mjs";

const [host, folder] = process.argv.slice(2);
const server = await serve(host, folder);
// A menu's key is heard in the next frame, and a frame of the software adapter takes a third of a second.
const FRAME = 700;
// The expert's flight of the first mission, as a link.
const REPLAY = await readFile(new URL("../../assets/replays/01-training-expert.toml", import.meta.url), "utf8");
const VALUES = REPLAY.trim().split("\n").map((line) => line.slice(line.indexOf(" = ") + 3));
const FLIGHT = `#flight=${deflateSync(VALUES.join("\n")).toString("base64url")}`;

async function press(page, ...keys) {
  for (const key of keys) {
    await page.keyboard.press(key, { delay: 50 });
    await page.waitForTimeout(FRAME);
  }
}

// The text inside a picture, a compressed chunk of its own.
function moment(png) {
  const mark = "iTXtlensrunner\0";
  const at = png.indexOf(mark);
  assert.ok(at > 0, "the picture has a text");
  // Two bytes say how it is packed, two empty words follow.
  const text = png.subarray(at + mark.length + 4, at + 4 + png.readUInt32BE(at - 4));
  return inflateSync(text).toString();
}

// A browser that is played in; nothing may be said on the console meanwhile.
// A machine that is too busy for its frames may lose a key: what fails is played once more.
async function play(...part) {
  try {
    await playOnce(...part);
  } catch (error) {
    console.error("once more, after", error);
    await playOnce(...part);
  }
}

async function playOnce(name, options, act) {
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
    assert.match(moment(picture), /01-training/, "the picture has its moment");
    await press(page, "Escape");
    await screen(page, "paused");
    await press(page, "Escape");
    await screen(page, "playing");
    await screen(page, "result", 240);
    assert.equal(await page.evaluate(() => document.body.dataset.won), "true");
    const kept = await page.evaluate(() => Object.keys(localStorage));
    assert.ok(kept.some((name) => name.includes("settings")), `${kept}`);
    // What was read once is not shown again.
    await page.evaluate(() => navigator.serviceWorker.ready);
    await page.waitForFunction(async () => (await caches.keys()).length === 1);
    await page.reload();
    await screen(page, "title");
    await browser.setOffline(true);
    await page.reload();
    await screen(page, "title");
  });
  await play("by mouse: it belongs to the ship, until Esc", {}, async (page) => {
    await screen(page, "warning");
    await press(page, "Enter");
    await screen(page, "title");
    await press(page, "Enter");
    await screen(page, "playing");
    // A busy machine begins the flight so long after the key that the browser refuses; a click asks again.
    const owned = () => page.waitForFunction(() => document.pointerLockElement?.id === "game", null, { timeout: 10_000 });
    await owned().catch(async () => {
      await page.mouse.click(320, 180);
      await owned();
    });
    await page.mouse.move(300, 200);
    await page.mouse.move(340, 190, { steps: 5 });
    // As the browser does it.
    await page.evaluate(() => Document.prototype.exitPointerLock.call(document));
    await screen(page, "paused");
    await press(page, "F11");
    await page.waitForFunction(() => document.fullscreenElement);
    await press(page, "F11");
    await page.waitForFunction(() => !document.fullscreenElement);
  });
  const tablet = { hasTouch: true, isMobile: true, viewport: { width: 1180, height: 820 } };
  await play("by fingers: training begun, flown and paused", tablet, async (page) => {
    const touch = await fingers(page);
    const tap = async (x, y) => {
      await touch.put(0, x, y);
      await page.waitForTimeout(80);
      await touch.lift(0);
      await page.waitForTimeout(2 * FRAME);
    };
    await screen(page, "warning");
    await page.waitForFunction(() => document.body.dataset.drawn);
    // "I have read this", then the first mission, where they are on such a screen.
    await tap(150, 371);
    await screen(page, "title");
    await tap(171, 193);
    await screen(page, "playing");
    await touch.put(1, 90, 430);
    await touch.move(1, 90, 370);
    await touch.put(2, 1090, 430);
    await touch.move(2, 1120, 430);
    await page.waitForFunction(() => globalThis.lensrunnerSound.last[1] > 0.5);
    await page.waitForTimeout(2 * FRAME);
    assert.equal(await page.evaluate(() => document.body.dataset.hands), "touch", "a finger that moves is no mouse");
    await touch.lift(1);
    await touch.lift(2);
    await page.waitForFunction(() => globalThis.lensrunnerSound.last[1] < 0.5);
    await tap(285, 45);
    await screen(page, "paused");
  });
  await play("by pad: training begun, thrust", {}, async (page) => {
    // As a browser shows a pad; there is none here.
    await page.addInitScript(() => {
      const buttons = Array.from({ length: 17 }, () => ({ pressed: false, touched: false, value: 0 }));
      globalThis.pad = { id: "pad", index: 0, connected: true, mapping: "standard", axes: [0, 0, 0, 0], buttons, timestamp: 1 };
      navigator.getGamepads = () => [globalThis.pad];
    });
    await page.reload();
    const push = async () => {
      for (const pressed of [true, false]) {
        await page.evaluate((pressed) => Object.assign(pad.buttons[0], { pressed, value: Number(pressed) }), pressed);
        // A pad has no events: what is shorter than a frame is not seen.
        await page.waitForTimeout(2 * FRAME);
      }
    };
    await screen(page, "warning");
    await page.waitForFunction(() => document.body.dataset.drawn);
    await push();
    await screen(page, "title");
    await push();
    await screen(page, "playing");
    await page.evaluate(() => (pad.axes[1] = -1));
    await page.waitForFunction(() => globalThis.lensrunnerSound.last[1] > 0.5);
    assert.equal(await page.evaluate(() => document.body.dataset.hands), "pad");
  });
  await play("what is kept goes to a file and back; a hidden page is silent", {}, async (page) => {
    await screen(page, "warning");
    await press(page, "Enter");
    await screen(page, "title");
    const [saved] = await Promise.all([page.waitForEvent("download"), page.evaluate(() => lensrunner.save_all())]);
    const kept = await readFile(await saved.path(), "utf8");
    await page.evaluate(() => localStorage.clear());
    page.on("dialog", (question) => question.accept());
    const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.evaluate(() => lensrunner.bring_all())]);
    await chooser.setFiles(await saved.path());
    await page.waitForFunction(() => localStorage.length > 0);
    // It is loaded anew, with what was brought.
    await screen(page, "title");
    assert.deepEqual(await page.evaluate(() => Object.fromEntries(Object.entries(localStorage))), JSON.parse(kept));
    await press(page, "ArrowDown");
    const sounds = (state) => page.waitForFunction((state) => globalThis.lensrunnerSound.context?.state === state, state);
    await sounds("running");
    // Playwright's pages are never hidden.
    const hide = (hidden) =>
      page.evaluate((hidden) => {
        Object.defineProperty(document, "hidden", { value: hidden, configurable: true });
        document.dispatchEvent(new Event("visibilitychange"));
      }, hidden);
    await hide(true);
    await sounds("suspended");
    await hide(false);
    await sounds("running");
  });
  const links = { flight: FLIGHT, forged: `${FLIGHT.slice(0, 60)}A${FLIGHT.slice(61)}` };
  await play("a link: the flight is shown; a forged one is refused", {}, async (page) => {
    const openAt = async (link) => {
      await page.goto("about:blank");
      await page.goto(server.address + link);
    };
    await openAt(links.flight);
    await screen(page, "warning");
    await press(page, "Enter");
    await screen(page, "playing");
    const watched = () => page.evaluate(() => document.body.dataset.watched === "true");
    assert.ok(await watched(), "the flight of the link, and no new one");
    assert.equal(await page.evaluate(() => location.hash), "", "a flight that was opened is opened once");
    await openAt(links.forged);
    await screen(page, "title");
    // Pasted into the address of a game that runs.
    await page.evaluate((link) => (location.hash = link), links.flight);
    await screen(page, "playing");
    assert.ok(await watched());
  });
  await play("refusals: without WebGPU, without an adapter, without a file", {}, async (page, browser) => {
    const refused = async (prepare, sentence) => {
      const other = await browser.newPage();
      await prepare(other);
      await other.goto(server.address);
      await other.waitForFunction((sentence) => document.getElementById("word").textContent.includes(sentence), sentence);
      await other.close();
    };
    await page.close();
    await refused((other) => other.addInitScript(() => delete Navigator.prototype.gpu), "has no WebGPU");
    await refused((other) => other.addInitScript(() => (GPU.prototype.requestAdapter = async () => null)), "no graphics device");
    await refused((other) => other.route("**/table.bin", (route) => route.abort()), "did not arrive");
    const lose = () => setTimeout(() => globalThis.lensrunnerDevice.destroy(), 6000);
    await refused((other) => other.addInitScript(lose), "device was lost");
    const fill = () => {
      const full = () => Promise.reject(new RangeError("WebAssembly.Memory(): could not allocate memory"));
      WebAssembly.instantiateStreaming = WebAssembly.instantiate = full;
    };
    await refused((other) => other.addInitScript(fill), "not enough memory");
    // Tablets have no pointer lock.
    const tablet = await browser.newPage();
    await tablet.addInitScript(() => delete Element.prototype.requestPointerLock);
    await tablet.goto(server.address);
    await screen(tablet, "warning");
  });
} finally {
  server.stop();
}
