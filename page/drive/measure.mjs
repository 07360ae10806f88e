// Measures the page and writes docs/lab/web.md: node measure.mjs HOST FOLDER
import { readFile, stat, writeFile } from "node:fs/promises";
import { cpus } from "node:os";
import { join } from "node:path";
import { open, screen, serve, watched } from "./browser.mjs";

const [host, folder] = process.argv.slice(2);
const server = await serve(host, folder);
const PARTS = {
  "lensrunner_page_bg.wasm": "the game, with sky, models, scenes, words",
  "table.bin": "the table of lensing, packed",
  "shaders.json": "texts of the shaders",
  "lensrunner_sound_bg.wasm": "the sound",
};
const mega = (bytes) => (bytes / 1e6).toFixed(2);

async function sizes() {
  const { files } = JSON.parse(await readFile(join(folder, "files.json"), "utf8"));
  const rows = [];
  let [plain, small] = [0, 0];
  let other = [0, 0];
  for (const [name, size] of Object.entries(files)) {
    const packed = (await stat(join(folder, `${name}.br`))).size;
    [plain, small] = [plain + size, small + packed];
    if (PARTS[name]) rows.push([PARTS[name], mega(size), mega(packed)]);
    else other = [other[0] + size, other[1] + packed];
  }
  return [...rows, ["the page itself", ...other.map(mega)], ["all", mega(plain), mega(small)]];
}

// Until a picture of the disk fills the screen: pictures of a menu on black are small.
async function pictured(page) {
  while ((await page.screenshot()).length < 120_000) await page.waitForTimeout(100);
  return page.evaluate(() => performance.now());
}

// One loading: when what is there, and what stood still.
async function loading() {
  const { browser, close } = await open();
  const { page } = await watched(browser, server.address);
  await screen(page, "warning");
  const arrived = await page.evaluate(() => Math.max(...performance.getEntriesByType("resource").map((entry) => entry.responseEnd)));
  const begun = await page.evaluate(() => performance.now());
  await page.waitForFunction(() => document.body.dataset.drawn, null, { polling: 50 });
  const drawn = Number(await page.evaluate(() => document.body.dataset.drawn));
  const picture = await pictured(page);
  await page.keyboard.press("Enter");
  await screen(page, "title");
  const pressed = await page.evaluate(() => performance.now());
  await page.keyboard.press("Enter");
  await screen(page, "playing");
  await page.waitForTimeout(1000);
  const flying = (await pictured(page)) - pressed;
  const blocks = await page.evaluate(() => globalThis.blocks);
  return { page, close, arrived, begun, drawn, picture, flying, blocks };
}

// Frames and the thread's work in a flight by the autopilot, and the sound's own clock against the page's.
async function flight(page, seconds) {
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable");
  const busy = async () => Object.fromEntries((await session.send("Performance.getMetrics")).metrics.map(({ name, value }) => [name, value]));
  await page.keyboard.press("KeyP");
  await page.waitForTimeout(2000);
  const before = await busy();
  const result = await page.evaluate(async (seconds) => {
    const { context, node } = globalThis.lensrunnerSound;
    const stream = context.createMediaStreamDestination();
    node.connect(stream);
    const reader = new MediaStreamTrackProcessor({ track: stream.stream.getAudioTracks()[0] }).readable.getReader();
    const begin = performance.now();
    let [frames, longest, last, chunks, gaps, loud, next] = [0, 0, begin, 0, 0, 0, undefined];
    const count = () => {
      const now = performance.now();
      [frames, longest, last] = [frames + 1, Math.max(longest, now - last), now];
      if (now - begin < seconds * 1000) requestAnimationFrame(count);
    };
    requestAnimationFrame(count);
    while (performance.now() - begin < seconds * 1000) {
      const { value } = await reader.read();
      // In microseconds; a sample is 21.
      if (next !== undefined && Math.abs(value.timestamp - next) > 100) gaps += 1;
      next = value.timestamp + value.duration;
      const samples = new Float32Array(value.numberOfFrames);
      value.copyTo(samples, { planeIndex: 0 });
      loud = Math.max(loud, ...samples.map(Math.abs));
      chunks += 1;
      value.close();
    }
    return { frames, longest, chunks, gaps, loud, seconds: (performance.now() - begin) / 1000 };
  }, seconds);
  const after = await busy();
  return { ...result, share: (after.TaskDuration - before.TaskDuration) / (after.Timestamp - before.Timestamp) };
}

const table = (head, rows) => [head, head.map(() => "---"), ...rows].map((row) => `| ${row.join(" | ")} |`).join("\n");
try {
  const { page, close, arrived, begun, drawn, picture, flying, blocks } = await loading();
  const after = blocks.filter(([at]) => at > drawn);
  const flown = await flight(page, 20);
  await close();
  const second = (ms) => (ms / 1000).toFixed(1);
  const longest = (list) => Math.max(0, ...list.map(([, duration]) => duration)).toFixed(0);
  const text = `# The game in a browser

    ./test-web && node page/drive/measure.mjs HOST out/web     # HOST: the page's server, as ./test-web has built it

Chromium with its software adapter, 640 × 360, ${cpus().length} cores (${cpus()[0].model.trim()}), files from this machine.

## Size

${table(["part", "MB", "MB by brotli"], await sizes())}

The table is shipped and not baked: baking it takes 570,000 rays, and packed it is half as large as brotli alone makes it.

## Loading

${table(
    ["until", "s after the address was opened"],
    [
      ["the last byte is there", second(arrived)],
      ["the game's first frame", second(begun)],
      ["the scene is handed to the adapter", second(drawn)],
      ["the title's picture is on the screen", second(picture)],
    ],
  )}

From the key to the first flight's picture: ${second(flying)} s. Longest block of the page's thread: ${longest(blocks)} ms while it loads;
${longest(after)} ms after the scene was handed over; ${blocks.filter(([, duration]) => duration > 100).length} over 100 ms in all.

## Flying

${table(
    ["", ""],
    [
      ["frames a second", (flown.frames / flown.seconds).toFixed(1)],
      ["longest frame, ms", flown.longest.toFixed(0)],
      ["share of its time that the page's thread works", `${(100 * flown.share).toFixed(0)} %`],
      ["the same, ms a frame", ((1000 * flown.share * flown.seconds) / flown.frames).toFixed(0)],
      ["blocks of sound received; gaps between them", `${flown.chunks}; ${flown.gaps}`],
      ["loudest sample", flown.loud.toFixed(2)],
    ],
  )}
`;
  await writeFile("docs/lab/web.md", text);
  console.log(text);
} finally {
  server.stop();
}
