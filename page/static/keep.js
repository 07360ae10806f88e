// The service worker: keeps the page's files, so that the game begins without a network too. `VERSION` is that of the files, put in when
// the page is made: other files are another worker, which takes the place of this one.
const kept = "lensrunner-VERSION";

self.addEventListener("install", (event) => {
  const keep = async () => {
    // Not what a host lets the browser keep for long, which may be of the version before.
    const fresh = (name) => new Request(name, { cache: "no-cache" });
    const { files } = await (await fetch(fresh("files.json"))).json();
    await (await caches.open(kept)).addAll(["./", "files.json", ...Object.keys(files)].map(fresh));
    await self.skipWaiting();
  };
  event.waitUntil(keep());
});

self.addEventListener("activate", (event) => {
  const tidy = async () => {
    const names = await caches.keys();
    await Promise.all(names.filter((name) => name.startsWith("lensrunner-") && name !== kept).map((name) => caches.delete(name)));
    await self.clients.claim();
  };
  event.waitUntil(tidy());
});

self.addEventListener("fetch", (event) => {
  const answer = async () => {
    const found = await (await caches.open(kept)).match(event.request, { ignoreSearch: true });
    return found ?? fetch(event.request);
  };
  if (event.request.method === "GET") event.respondWith(answer());
});
