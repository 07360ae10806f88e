// Loads the game with a bar, says in one sentence what keeps it from beginning, and does for it what a program in WebAssembly cannot.
import begin, { play } from "./lensrunner_page.js";
import { language, say } from "./words.js";

document.documentElement.lang = language;
// What is heard: the last that was said of it, and what makes it once it has begun.
const sound = { last: undefined, program: undefined, context: undefined, node: undefined, beginning: false };
const at = (name) => document.getElementById(name);
at("upright").textContent = say.upright;

// Nothing ends without a sentence: neither the page's own scripts nor the program, which an empty memory ends where it is.
// An event without an error is a warning of the browser's own.
window.addEventListener("error", ({ error }) => error && refuse(memory(error) ? say.memory : say.failed, String(error)));

class Refusal extends Error {}

function refuse(sentence, cause) {
  at("word").textContent = sentence;
  at("cause").textContent = cause ?? "";
  at("bar").hidden = true;
  at("loading").hidden = false;
  sound.context?.suspend();
}

const memory = (error) => error instanceof RangeError || /memory/i.test(String(error));

// All files of the game, with one bar for what has come of them.
function files(sizes) {
  const whole = Object.values(sizes).reduce((sum, size) => sum + size, 0);
  let come = 0;
  return async (name) => {
    const answer = await fetch(name).catch(() => undefined);
    if (!answer?.ok) throw new Refusal(say.missing);
    const follow = new TransformStream({
      transform(piece, out) {
        come += piece.length;
        at("bar").value = Math.min(come / whole, 1);
        out.enqueue(piece);
      },
    });
    // Whatever the host calls it.
    const type = name.endsWith(".wasm") ? "application/wasm" : "application/octet-stream";
    return new Response(answer.body.pipeThrough(follow), { headers: { "content-type": type } });
  };
}

// A device that is lost is said, whoever asked for it.
function watchDevices() {
  const request = GPUAdapter.prototype.requestDevice;
  GPUAdapter.prototype.requestDevice = async function (...descriptor) {
    const device = await request.apply(this, descriptor);
    device.lost.then(({ message }) => refuse(say.lost, message));
    globalThis.lensrunnerDevice = device;
    return device;
  };
}

async function load() {
  if (!navigator.gpu) throw new Refusal(say.noWebGpu);
  watchDevices();
  at("word").textContent = say.loading;
  const [adapter, list] = await Promise.all([navigator.gpu.requestAdapter(), fetch("files.json").catch(() => undefined)]);
  if (!adapter) throw new Refusal(say.noAdapter);
  if (!list?.ok) throw new Refusal(say.missing);
  const { loaded } = await list.json();
  const file = files(loaded);
  const arrived = (error) => {
    throw error instanceof Refusal || memory(error) ? error : new Refusal(say.missing);
  };
  const [, table, shaders] = await Promise.all([
    begin({ module_or_path: file("lensrunner_page_bg.wasm") }),
    file("table.bin").then((answer) => answer.arrayBuffer()),
    file("shaders.json").then((answer) => answer.text()),
  ]).catch(arrived);
  at("word").textContent = say.starting;
  at("bar").removeAttribute("value");
  // The words are painted before the game takes the page's thread.
  await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
  await play(new Uint8Array(table), shaders, location.hash);
}

// The sound's own thread, begun by a gesture of the player, as browsers want it; until it runs each gesture tries again.
async function beginSound() {
  const context = new AudioContext({ latencyHint: "interactive" });
  try {
    sound.program ??= fetch("lensrunner_sound_bg.wasm").then((answer) => answer.arrayBuffer());
    const [program] = await Promise.all([sound.program, context.audioWorklet.addModule("sound.js")]);
    const node = new AudioWorkletNode(context, "sound", { numberOfInputs: 0, outputChannelCount: [2], processorOptions: { program } });
    node.connect(context.destination);
    if (sound.last) node.port.postMessage(sound.last);
    Object.assign(sound, { context, node });
  } catch (error) {
    sound.program = undefined;
    context.close();
    throw error;
  }
}

async function wakeSound() {
  if (sound.beginning || sound.context?.state === "running" || document.hidden) return;
  sound.beginning = true;
  try {
    if (!sound.context) await beginSound();
    // It waits for a gesture that counts: the next one tries again meanwhile.
    sound.context.resume();
  } catch (error) {
    console.warn(`There is no sound: ${error}`);
  }
  sound.beginning = false;
}
for (const kind of ["pointerup", "keydown"]) window.addEventListener(kind, wakeSound, { capture: true });
document.addEventListener("visibilitychange", () => (document.hidden ? sound.context?.suspend() : sound.context?.resume()));

// Keys are the game's, but for the browser's own: those with Ctrl, Alt or Meta, and F5 and F12, which the game does not hear.
const browsers = ({ code, ctrlKey, altKey, metaKey }) => ctrlKey || altKey || metaKey || code === "F5" || code === "F12";
const game = at("game");
for (const kind of ["keydown", "keyup"]) {
  window.addEventListener(kind, (event) => {
    if (event.target !== game) return;
    if (!browsers(event)) event.preventDefault();
    else if (kind === "keydown" && !/^(Control|Alt|Meta)/.test(event.key)) event.stopImmediatePropagation();
  }, { capture: true });
}
at("egui_text_agent").addEventListener("blur", () => game.focus());
for (const kind of ["contextmenu", "wheel"]) game.addEventListener(kind, (event) => event.preventDefault(), { passive: false });

// The mouse belongs to the game as long as the game wants it. A browser refuses it for a moment after Esc, and without a gesture: then the
// next click asks again. Esc gives the mouse back, and many browsers do not tell the page: that is a pause.
const without = () => undefined;
const mouse = {
  wanted: false,
  // Tablets have no such thing.
  lock: game.requestPointerLock?.bind(game) ?? without,
  unlock: document.exitPointerLock?.bind(document) ?? without,
};
game.requestPointerLock = (options) => {
  mouse.wanted = true;
  Promise.resolve(mouse.lock(options)).catch(without);
};
document.exitPointerLock = () => {
  mouse.wanted = false;
  mouse.unlock();
};
game.addEventListener("pointerdown", ({ pointerType }) => {
  if (mouse.wanted && pointerType === "mouse" && !document.pointerLockElement) game.requestPointerLock();
});
function pause() {
  if (document.body.dataset.screen !== "playing" || document.pointerLockElement) return;
  const key = (kind) => new KeyboardEvent(kind, { code: "Escape", key: "Escape", bubbles: true });
  for (const kind of ["keydown", "keyup"]) game.dispatchEvent(key(kind));
}
document.addEventListener("pointerlockchange", () => {
  // Long enough for the game to hear of Esc by itself.
  if (mouse.wanted && !document.pointerLockElement) setTimeout(pause, 500);
});

// What is kept for the game, of all that this address keeps.
const own = (name) => name.startsWith("lensrunner/");

function download(name, bytes) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

async function bring(file) {
  const texts = await file.text().then(JSON.parse).then(Object.entries).catch(() => []);
  const ours = texts.filter(([name, text]) => own(name) && typeof text === "string");
  if (ours.length === 0) return alert(say.noneOfOurs);
  if (!confirm(say.replace)) return;
  const before = Object.entries(localStorage).filter(([name]) => own(name));
  try {
    ours.forEach(([name, text]) => localStorage.setItem(name, text));
    location.reload();
  } catch {
    ours.forEach(([name]) => localStorage.removeItem(name));
    before.forEach(([name, text]) => localStorage.setItem(name, text));
    alert(say.full);
  }
}

// A flight whose link is put into the page's address is shown.
window.addEventListener("hashchange", () => location.hash.startsWith("#flight=") && location.reload());

// What fails here must not end the game.
const safely = (act) => (...values) => {
  try {
    act(...values);
  } catch (error) {
    alert(`${error.message ?? error}`);
  }
};

// What the game asks the page for (`src/page.rs`).
globalThis.lensrunner = {
  breath: () => new Promise((resolve) => setTimeout(resolve)),
  sound(numbers) {
    sound.last = Float64Array.from(numbers);
    sound.node?.port.postMessage(sound.last);
  },
  download: safely(download),
  save_all: safely(() => {
    const kept = Object.entries(localStorage).filter(([name]) => own(name));
    download("lensrunner.json", JSON.stringify(Object.fromEntries(kept), undefined, 1));
  }),
  bring_all: safely(() => {
    const chooser = Object.assign(document.createElement("input"), { type: "file", accept: ".json" });
    chooser.onchange = () => bring(chooser.files[0]);
    chooser.click();
  }),
  share: safely((link) => {
    const address = location.origin + location.pathname + link;
    // Where the clipboard is forbidden the player copies it.
    const shown = () => prompt(say.copy, address);
    navigator.clipboard ? navigator.clipboard.writeText(address).catch(shown) : shown();
  }),
  begun() {
    at("loading").hidden = true;
    // A flight that was opened is opened once.
    history.replaceState(null, "", location.pathname + location.search);
    game.focus();
    // Kept for the next time only now: it loads the same files.
    navigator.serviceWorker?.register("keep.js").catch((error) => console.warn(`The page is not kept: ${error}`));
  },
  by_finger: () => matchMedia("(pointer: coarse)").matches,
  hands(name) {
    document.body.dataset.hands = name;
  },
  drawn() {
    document.body.dataset.drawn = performance.now();
  },
  screen(name, won, watched) {
    Object.assign(document.body.dataset, { screen: name, won, watched });
  },
  ended(cause) {
    refuse(say.failed, cause);
  },
};
globalThis.lensrunnerSound = sound;

load().catch((error) => {
  if (error instanceof Refusal) refuse(error.message);
  else refuse(memory(error) ? say.memory : say.failed, String(error));
});
