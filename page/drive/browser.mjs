// A browser with WebGPU on the software adapter, and the page's server.
import { spawn } from "node:child_process";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

// Without --use-angle=swiftshader the device is lost as soon as a canvas is drawn on; without the last flags the browser asks its makers'
// servers for updates.
const FLAGS = [
  "--no-sandbox",
  "--enable-unsafe-webgpu",
  "--use-vulkan=swiftshader",
  "--enable-features=Vulkan",
  "--use-angle=swiftshader",
  "--ignore-gpu-blocklist",
  "--autoplay-policy=user-gesture-required",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--disable-quic",
  "--no-first-run",
];

// Serves a folder by the page's own server; `stop` ends it.
export async function serve(host, folder, port = 0) {
  const server = spawn(host, ["serve", folder, "--port", String(port)], { stdio: ["ignore", "pipe", "inherit"] });
  const address = await new Promise((resolve, reject) => {
    server.stdout.once("data", (line) => resolve(String(line).trim()));
    server.once("exit", (code) => reject(new Error(`the server ended with ${code}`)));
  });
  return { address, stop: () => server.kill() };
}

// A browser of its own, empty.
export async function open(options = {}) {
  const profile = await mkdtemp(join(tmpdir(), "lensrunner-browser-"));
  const browser = await chromium.launchPersistentContext(profile, {
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: FLAGS,
    viewport: { width: 640, height: 360 },
    acceptDownloads: true,
    ...options,
  });
  const close = async () => {
    await browser.close();
    await rm(profile, { recursive: true, force: true });
  };
  return { browser, close };
}

// A page that keeps what it says on its console, and the times for which it did not answer, in ms since it was opened.
export async function watched(browser, address) {
  const page = await browser.newPage();
  // A busy machine draws a frame in seconds.
  page.setDefaultTimeout(120_000);
  const said = [];
  page.on("console", (message) => said.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => said.push(`error: ${error.stack ?? error}`));
  page.on("requestfailed", (request) => said.push(`failed: ${request.url()} ${request.failure()?.errorText}`));
  await page.addInitScript(() => {
    globalThis.blocks = [];
    const note = (list) => list.getEntries().forEach((entry) => globalThis.blocks.push([entry.startTime, entry.duration]));
    new PerformanceObserver(note).observe({ type: "longtask", buffered: true });
  });
  const begin = Date.now();
  await page.goto(address);
  return { page, said, begin };
}

// Waits until the game shows this screen.
export const screen = (page, name, seconds = 180) =>
  page.waitForFunction((name) => document.body.dataset.screen === name && document.getElementById("loading").hidden, name, {
    timeout: seconds * 1000,
    polling: 100,
  });

// Fingers on a page, each by its number; places in pixels.
export async function fingers(page) {
  const session = await page.context().newCDPSession(page);
  const down = new Map();
  const send = (type, fingers = [...down]) => {
    const touchPoints = fingers.map(([id, [x, y]]) => ({ id, x, y }));
    return session.send("Input.dispatchTouchEvent", { type, touchPoints });
  };
  return {
    put(id, x, y) {
      down.set(id, [x, y]);
      return send("touchStart");
    },
    move(id, x, y) {
      down.set(id, [x, y]);
      return send("touchMove");
    },
    // Those that are named go, and none named means all.
    lift(id) {
      const at = down.get(id);
      down.delete(id);
      return send("touchEnd", down.size > 0 ? [[id, at]] : []);
    },
  };
}
