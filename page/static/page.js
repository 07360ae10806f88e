// Loads the game with a bar, and says in one sentence what keeps it from beginning.
import begin, { play } from "./lensrunner_page.js";

const words = {
  en: {
    loading: "Loading the game …",
    starting: "Starting …",
    noWebGpu: "This browser has no WebGPU, which the game draws with. Please try a newer Chrome, Edge, Firefox or Safari.",
    noAdapter: "The browser finds no graphics device that it may use. Please switch graphics acceleration on in its settings.",
    missing: "A file of the game did not arrive. Please load the page again.",
    failed: "The game could not begin: ",
  },
  ja: {
    loading: "ゲームを読み込んでいます…",
    starting: "始めています…",
    noWebGpu: "このブラウザにはゲームの描画に必要な WebGPU がありません。新しい Chrome、Edge、Firefox、Safari でお試しください。",
    noAdapter: "ブラウザが使えるグラフィックス装置が見つかりません。設定でグラフィックスの高速化を有効にしてください。",
    missing: "ゲームのファイルが届きませんでした。ページをもう一度読み込んでください。",
    failed: "ゲームを始められませんでした：",
  },
};
const language = navigator.language.startsWith("ja") ? "ja" : "en";
const say = words[language];
document.documentElement.lang = language;

const loading = document.getElementById("loading");
const word = document.getElementById("word");
const bar = document.getElementById("bar");

class Refusal extends Error {}

function refuse(sentence) {
  word.textContent = sentence;
  bar.hidden = true;
  loading.hidden = false;
}

// The answer's body as it comes, so that the bar can follow.
function followed(answer, length) {
  let come = 0;
  const follow = new TransformStream({
    transform(piece, out) {
      come += piece.length;
      bar.value = Math.min(come / length, 1);
      out.enqueue(piece);
    },
  });
  return new Response(answer.body.pipeThrough(follow), { headers: { "content-type": "application/wasm" } });
}

async function load() {
  if (!navigator.gpu) throw new Refusal(say.noWebGpu);
  if (!(await navigator.gpu.requestAdapter())) throw new Refusal(say.noAdapter);
  word.textContent = say.loading;
  const [sizes, answer] = await Promise.all([fetch("sizes.json"), fetch("lensrunner_page_bg.wasm")]).catch(() => {
    throw new Refusal(say.missing);
  });
  if (!sizes.ok || !answer.ok) throw new Refusal(say.missing);
  const length = (await sizes.json())["lensrunner_page_bg.wasm"];
  await begin({ module_or_path: followed(answer, length) });
  word.textContent = say.starting;
  bar.removeAttribute("value");
  // The words are painted before the game takes the page's thread.
  await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
  play();
  loading.hidden = true;
  document.getElementById("game").focus();
}

load().catch((error) => refuse(error instanceof Refusal ? error.message : say.failed + error));
