// Pictures of the page into docs/screens: on a desk by keys, on a tablet by fingers, in both languages: node screens.mjs HOST FOLDER
import { fingers, open, screen, serve, watched } from "./browser.mjs";

const [host, folder] = process.argv.slice(2);
const server = await serve(host, folder);

// The bytes of a picture once nothing moves on it any more but stars.
async function picture(page, name) {
  await page.waitForTimeout(4000);
  await page.screenshot({ path: `docs/screens/${name}.jpg`, type: "jpeg", quality: 85 });
}

async function desk(language, locale) {
  const { browser, close } = await open({ locale, viewport: { width: 1280, height: 800 } });
  const { page } = await watched(browser, server.address);
  const at = (name) => `${language}-page-1280x800-${name}`;
  await screen(page, "warning");
  await page.waitForFunction(() => document.body.dataset.drawn);
  await picture(page, at("warning"));
  await page.keyboard.press("Enter");
  await screen(page, "title");
  await picture(page, at("title"));
  await page.keyboard.press("Enter");
  await screen(page, "playing");
  await picture(page, at("flight"));
  await close();
}

async function tablet(language, locale) {
  const { browser, close } = await open({ locale, hasTouch: true, isMobile: true, viewport: { width: 1180, height: 820 } });
  const { page } = await watched(browser, server.address);
  const touch = await fingers(page);
  const at = (name) => `${language}-page-1180x820-${name}`;
  const tap = async (x, y) => {
    await touch.put(1, x, y);
    await page.waitForTimeout(80);
    await touch.lift(1);
  };
  await screen(page, "warning");
  await page.waitForFunction(() => document.body.dataset.drawn);
  await page.keyboard.press("Enter");
  await screen(page, "title");
  // A finger anywhere, and it is a touch screen again.
  await tap(1100, 700);
  await picture(page, at("title"));
  await tap(171, 193);
  await screen(page, "playing");
  await touch.put(1, 90, 430);
  await touch.move(1, 110, 380);
  await picture(page, at("flight"));
  await touch.lift(1);
  await tap(285, 45);
  await screen(page, "paused");
  await picture(page, at("pause"));
  await close();
}

try {
  for (const [language, locale] of [["en", "en-GB"], ["ja", "ja-JP"]]) {
    await desk(language, locale);
    await tablet(language, locale);
  }
} finally {
  server.stop();
}
