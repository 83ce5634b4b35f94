// How long a reviewer waits for a moment of a ten-minute session, and of a pair of them:
//   run.sh scrub_benchmark.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES [RELEASES [FOLDER]]
// FOLDER keeps the two sessions for the next run. A release is a press on the timeline at a random place; the next one follows
// a while after everything that it asked for was shown. Times are from the release, in the browser: to the picture (a glimpse
// or not) that the browser has drawn, and to the replayed one. Before that a session is chosen in the list, each time in a page
// that begins anew, and one and both are opened by a link, which has the browser begin the page first.
import { cpSync, existsSync, mkdirSync, rmSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as rest } from "node:timers/promises";
import { openBareBrowser } from "./bare_browser.mjs";
import { makeFolder, serve, stop } from "./browser.mjs";
import { recordLong } from "./long_session.mjs";

const kPressed = 560; // of a session, beside its cuts [s]
const kOpenings = 9;
const kPause = 900; // before the next release [ms]: the picture that stands still is drawn by then
const releases = Number(process.argv[7] ?? 60), kept = process.argv[8];
const kPair = { "long-expert": "kidney-cut-expert", "long-clumsy": "kidney-cut-clumsy" };

const folder = makeFolder("kidney.json"), served = kept ?? folder;
mkdirSync(served, { recursive: true });
for (const [name, shipped] of Object.entries(kPair)) {
  if (existsSync(join(served, `${name}.ctpm`))) continue;
  await recordLong(folder, name, shipped, kPressed);
  if (kept) cpSync(join(folder, `${name}.ctpm`), join(kept, `${name}.ctpm`));
}
// Follows each release through the page: asked for, arrived, drawn (the fence was set), done (the fence was passed).
const { server, address } = await serve(served, 0), page = await openBareBrowser(() => {
  const now = () => performance.now();
  const release = globalThis.release = { at: 0, asked: new Map(), first: new Map(), exact: new Map(), marks: {} };
  addEventListener("pointerdown", (event) => Object.assign(release, { at: event.timeStamp, asked: new Map(), first: new Map(), exact: new Map(), marks: {} }), true);
  globalThis.WebSocket = class extends WebSocket {
    constructor(...of) {
      super(...of);
      this.addEventListener("message", ({ data }) => {
        if (!(data instanceof ArrayBuffer)) return;
        const [kind, stage, , , request, flags] = new Uint32Array(data, 0, 6);
        if (kind !== 2 || release.asked.get(stage) !== request) return;
        if (!release.first.has(stage)) release.first.set(stage, now());
        if (!(flags & 4)) release.exact.set(stage, now());
        for (const of of ["first", "exact"]) if (release[of].size === release.asked.size) release.marks[of] ??= { came: now() };
      });
    }
    send(data) {
      const show = typeof data === "string" && data.startsWith('{"show"') && JSON.parse(data).show;
      if (show) release.asked.set(show.stage, show.request), release.marks.sent = now();
      super.send(data);
    }
  };
  const { fenceSync, clientWaitSync } = WebGL2RenderingContext.prototype, of = new Map();
  WebGL2RenderingContext.prototype.fenceSync = function (...args) {
    const sync = fenceSync.apply(this, args);
    for (const mark of [release.marks.first, release.marks.exact]) if (mark && !mark.drawn) mark.drawn = now(), of.set(sync, [...(of.get(sync) ?? []), mark]);
    return sync;
  };
  WebGL2RenderingContext.prototype.clientWaitSync = function (sync, ...args) {
    const result = clientWaitSync.call(this, sync, ...args);
    if (result !== this.TIMEOUT_EXPIRED) for (const mark of of.get(sync) ?? []) mark.done = now();
    return result;
  };
});
await page.go(address);
await page.find("header nav button");

const { origin } = new URL(address);

/** When the browser is done with a picture of `count` stages, on the clock of this machine [ms]. */
const until = (count, mark) => page.until((count, mark) => {
  const { asked, marks } = globalThis.release;
  return asked.size === count && marks[mark]?.done && performance.timeOrigin + marks[mark].done;
}, count, mark);

/** Chooses a session in the list of a page that has not shown one: how long it takes from the press to its picture, which is replayed [ms]. */
async function choose(path) {
  await page.go("about:blank");
  await page.go(`${origin}/#room=review`);
  const entry = await page.find(".list button", path.replace(".ctpm", ""));
  await rest(2 * kPause);
  await page.clickAt(entry);
  return (await until(1, "exact")) - (await page.evaluate(() => performance.timeOrigin + globalThis.release.at));
}

/** Opens one or both by a link, in a page that begins; says how long that took until the replayed picture. */
async function open(...paths) {
  const hash = new URLSearchParams({ room: "review", session: paths[0], t: "300", ...(paths[1] && { beside: paths[1] }) });
  await page.go("about:blank");
  const began = Date.now();
  await page.go(`${origin}/#${hash}`);
  const first = await until(paths.length, "first"), exact = await until(paths.length, "exact");
  console.log(`${paths.join(" and ")}: at 300 s ${(first - began).toFixed(0)} ms after the browser was given its link, replayed after ${(exact - began).toFixed(0)} ms`);
  await page.find(".uplot");
}

const percentile = (list, share) => [...list].sort((a, b) => a - b)[Math.min(list.length - 1, Math.floor(share * list.length))];
const told = (name, list) => `${name} ${percentile(list, 0.5).toFixed(0)}, ${percentile(list, 0.95).toFixed(0)} ms`;

async function scrub(title) {
  const all = [];
  for (let i = 0; i < releases; ++i) {
    const { left, top, width } = await page.find(".plots");
    await page.clickAt({ x: left + 64 + ((0.5 + i * 0.6180339887) % 1) * (width - 78), y: top + 20 });
    await page.until(() => globalThis.release.marks.first?.done && globalThis.release.marks.exact?.done);
    all.push(await page.evaluate(() => ({ at: globalThis.release.at, ...globalThis.release.marks })));
    await rest(kPause);
  }
  const from = (mark, stage) => all.map((one) => one[mark][stage] - one.at);
  const between = (mark, before, after) => all.map((one) => one[mark][after] - (before === "sent" ? one.sent : one[mark][before]));
  console.log(`${title}, ${releases} releases, p50, p95: ${told("picture", from("first", "done"))}; ${told("replayed", from("exact", "done"))}`);
  for (const mark of ["first", "exact"])
    console.log(`  ${mark === "first" ? "picture" : "replayed"}: ${told("asked", all.map((one) => one.sent - one.at))}; ${told("program and way", between(mark, "sent", "came"))}; `
      + `${told("until drawn", between(mark, "came", "drawn"))}; ${told("drawing", between(mark, "drawn", "done"))}`);
}

const [expert, clumsy] = Object.keys(kPair).map((name) => `${name}.ctpm`);
const opened = [];
for (let i = 0; i < kOpenings; ++i) opened.push(await choose(i % 2 ? clumsy : expert));
console.log(`chosen in the list, ${kOpenings} times, from the press to the picture, median ${percentile(opened, 0.5).toFixed(0)}, longest ${Math.max(...opened).toFixed(0)} ms`);
await open(expert);
await scrub("one session, just opened");
await scrub("one session, later");
await open(expert, clumsy);
await scrub("two sessions, just opened");
await scrub("two sessions, later");
await page.close();
await stop(server);
rmSync(folder, { recursive: true });
