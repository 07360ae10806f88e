// What the page says before the game can, in the language that the player chose, else in the browser's.
const words = {
  en: {
    loading: "Loading the game …",
    starting: "Starting …",
    noWebGpu: "This browser has no WebGPU, which the game draws with: Chrome and Edge from 121, Safari from 26 and Firefox from 141 have it.",
    noAdapter: "The browser finds no graphics device that it may use: switch graphics acceleration on in its settings, and load the page again.",
    missing: "A file of the game did not arrive: load the page again.",
    memory: "The browser has not enough memory for the game: close other pages, and load this one again.",
    lost: "The graphics device was lost: load the page again. What you have won is kept.",
    copy: "The link of the flight, to copy:",
    replace: "What is kept here is replaced by what is in the file. Go on?",
    full: "The browser has no room for it; what was kept is as it was.",
    failed: "The game had to end: load the page again, and it begins anew. What you have won is kept.",
    noneOfOurs: "This file holds nothing that this page has saved.",
    upright: "Turn the screen: the game is wider than high.",
  },
  ja: {
    loading: "ゲームを読み込んでいます…",
    starting: "始めています…",
    noWebGpu: "このブラウザにはゲームの描画に必要な WebGPU がありません。Chrome と Edge は 121、Safari は 26、Firefox は 141 から使えます。",
    noAdapter: "ブラウザが使えるグラフィックス装置が見つかりません。設定でグラフィックスの高速化を有効にして、ページをもう一度読み込んでください。",
    missing: "ゲームのファイルが届きませんでした。ページをもう一度読み込んでください。",
    memory: "ブラウザのメモリがゲームに足りません。ほかのページを閉じて、もう一度読み込んでください。",
    lost: "グラフィックス装置が失われました。ページをもう一度読み込んでください。これまでの成績は残っています。",
    copy: "飛行のリンクです。コピーしてください：",
    replace: "ここにある記録をファイルの記録で置き換えます。よろしいですか？",
    full: "ブラウザに空きがありません。記録は元のままです。",
    failed: "ゲームを続けられなくなりました。ページをもう一度読み込むと始められます。これまでの成績は残っています。",
    noneOfOurs: "このページが保存したファイルではありません。",
    upright: "画面を横向きにしてください。ゲームは横長です。",
  },
};
function chosen() {
  try {
    return localStorage.getItem("lensrunner/settings.toml")?.match(/^language *= *"(en|ja)"/m)?.[1];
  } catch {
    // A storage that is forbidden.
    return undefined;
  }
}
export const language = chosen() ?? (navigator.language.startsWith("ja") ? "ja" : "en");
export const say = words[language];
