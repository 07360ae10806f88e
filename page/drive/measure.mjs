// Measures the page and writes docs/lab/web.md: node measure.mjs HOST FOLDER PROGRAM
import { spawnSync } from "node:child_process";
import { readFile, stat, writeFile } from "node:fs/promises";
import { cpus } from "node:os";
import { join } from "node:path";
import { brotliCompressSync } from "node:zlib";
import { open, screen, serve, watched } from "./browser.mjs";

const [host, folder, program] = process.argv.slice(2);
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
    // Of the sound: samples received, blocks of silence, the largest step from sample to sample within blocks and between them.
    let [frames, longest, last, received, silent, loud, inside, between, before] = [0, 0, begin, 0, 0, 0, 0, 0, undefined];
    const count = () => {
      const now = performance.now();
      [frames, longest, last] = [frames + 1, Math.max(longest, now - last), now];
      if (now - begin < seconds * 1000) requestAnimationFrame(count);
    };
    requestAnimationFrame(count);
    while (performance.now() - begin < seconds * 1000) {
      const { value } = await reader.read();
      const samples = new Float32Array(value.numberOfFrames);
      value.copyTo(samples, { planeIndex: 0 });
      received += samples.length;
      silent += samples.every((sample) => sample === 0) ? 1 : 0;
      loud = Math.max(loud, ...samples.map(Math.abs));
      for (let i = 1; i < samples.length; i++) inside = Math.max(inside, Math.abs(samples[i] - samples[i - 1]));
      if (before !== undefined) between = Math.max(between, Math.abs(samples[0] - before));
      before = samples.at(-1);
      value.close();
    }
    const taken = (performance.now() - begin) / 1000;
    return { frames, longest, silent, loud, inside, between, seconds: taken, share: received / context.sampleRate / taken };
  }, seconds);
  const after = await busy();
  return { ...result, busy: (after.TaskDuration - before.TaskDuration) / (after.Timestamp - before.Timestamp) };
}

// How many pixels of each scene are off by more than 2 of 255, from the laboratory's rows.
async function compared() {
  const lines = (await readFile("out/page/drivers-page.csv", "utf8")).split("\n").filter((line) => line && !line.startsWith("#"));
  const rows = lines.slice(1).map((line) => line.split(","));
  const off = rows.filter(([, , differ]) => Number(differ) > 0).map(([scene, , differ]) => `\`${scene}\` ${differ}`);
  const same = `${rows.length - off.length} of ${rows.length} have no pixel that is off by more than 2 of 255`;
  return off.length > 0 ? `${same}; of 230,400 pixels there are in ${off.join(", in ")}.` : `${same}.`;
}

// Milliseconds a frame of the program on the adapter that VK_DRIVER_FILES names, in the same flight.
function native() {
  const flight = ["--mission", "01-training", "--difficulty", "easy", "--autopilot", "--at-once", "--frames", "300"];
  const place = ["--headless", "--size", "640x360", "--timings", "out/page-native.csv"];
  const { stdout, stderr } = spawnSync(program, ["play", ...place, ...flight], { encoding: "utf8" });
  const mean = /([\d.]+) ms in the mean/.exec(stdout + stderr)?.[1];
  if (!mean) throw new Error(`${program}: ${stderr}`);
  return Number(mean);
}

// Seconds that the program takes to bake the table, on all cores.
function baking() {
  const begin = Date.now();
  const { status, stderr } = spawnSync(program, ["bake", "--points", "1", "-o", "out/page-baked.lut"], { encoding: "utf8" });
  if (status !== 0) throw new Error(`${program}: ${stderr}`);
  return (Date.now() - begin) / 1000;
}

const table = (head, rows) => [head, head.map(() => "---"), ...rows].map((row) => `| ${row.join(" | ")} |`).join("\n");
try {
  const { page, close, arrived, begun, drawn, picture, flying, blocks } = await loading();
  const after = blocks.filter(([at]) => at > drawn);
  const flown = await flight(page, 20);
  await close();
  const pictures = await compared();
  const beside = native();
  const plain = brotliCompressSync(await readFile("tables/default.lut")).length;
  const second = (ms) => (ms / 1000).toFixed(1);
  const longest = (list) => Math.max(0, ...list.map(([, duration]) => duration)).toFixed(0);
  const text = `# The game in a browser

**Verdict:** the game begins, flies and sounds in a browser with one thread; its pictures are those of the program on the same adapter. The
first frame still stands still for longer than asked.

    ./test-web                                             # builds out/web, and plays it; HOST is the page's server that it has built
    node page/drive/pictures.mjs HOST out/web out/page SCENE...
    VK_DRIVER_FILES=SWIFTSHADER.json lab/run chart drivers --driver out/page -o out/page
    VK_DRIVER_FILES=SWIFTSHADER.json node page/drive/measure.mjs HOST out/web lensrunner    # this page, with what the line before has found
    node page/drive/screens.mjs HOST out/web               # docs/screens

Chromium with its software adapter, 640 × 360, ${cpus().length} cores (${cpus()[0].model.trim()}), files from this machine.

## Size

${table(["part", "MB", "MB by brotli"], await sizes())}

The table is shipped and not baked: the program bakes it in ${baking().toFixed(1)} s on ${cpus().length} cores, and a page has one. Brotli alone makes ${mega(plain)} MB of
its file.

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
      ["ms a frame", ((1000 * flown.seconds) / flown.frames).toFixed(0)],
      ["the same of the program beside it, on the same adapter", beside.toFixed(0)],
      ["longest frame, ms", flown.longest.toFixed(0)],
      ["share of its time that the page's thread works", `${(100 * flown.busy).toFixed(0)} %`],
      ["the same, ms a frame", ((1000 * flown.busy * flown.seconds) / flown.frames).toFixed(0)],
      ["sound received, of what was due", `${(100 * flown.share).toFixed(1)} %`],
      ["silent blocks of it, of 10 ms", flown.silent],
      ["loudest sample", flown.loud.toFixed(3)],
      ["largest step between samples within blocks; between blocks", `${flown.inside.toFixed(3)}; ${flown.between.toFixed(3)}`],
    ],
  )}

The sound comes from a thread of its own: a frame of ${flown.longest.toFixed(0)} ms leaves no silence in it, and no step between blocks that is
larger than those within them.

## Pictures

The twelve scenes of [drivers](drivers.md), 640 × 360, drawn in the page and by the program, both on
SwiftShader: ${pictures}

## Tried

By keys, by mouse and by fingers in Chromium (\`page/drive/test.mjs\`, and by hand). Firefox, Safari and cards were not to be had; the page
asks for no more than WebGPU's default limits.
`;
  await writeFile("docs/lab/web.md", text);
  console.log(text);
} finally {
  server.stop();
}
