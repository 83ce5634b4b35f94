// How long a reviewer waits for a moment of a ten-minute session, and of a pair of them:
//   run.sh scrub_benchmark.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES [RELEASES [FOLDER]]
// FOLDER keeps the two sessions for the next run. A release is a press on the timeline at a random place; the next one follows
// a while after everything that it asked for was shown. Times are from the release, in the browser: to the picture (a glimpse
// or not) that the browser has drawn, and to the replayed one.
import { cpSync, existsSync, mkdirSync, rmSync } from "node:fs";
import { join } from "node:path";
import { makeFolder, openStudio } from "./browser.mjs";
import { recordLong } from "./long_session.mjs";

const kPressed = 560; // of a session, beside its cuts [s]
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
const studio = await openStudio(served), { page } = studio;
// Follows each release through the page: asked for, arrived, drawn (the fence was set), done (the fence was passed).
await page.addInitScript(() => {
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

/** Opens one or both; how long that took until the replayed picture [ms]. */
async function open(...paths) {
  const hash = new URLSearchParams({ room: "review", session: paths[0], t: "300", ...(paths[1] && { beside: paths[1] }) });
  await page.goto("about:blank");
  const began = Date.now();
  await page.goto(`${new URL(studio.address).origin}/#${hash}`);
  const until = async (mark) => {
    await page.waitForFunction(([count, name]) => globalThis.release?.asked.size === count && globalThis.release.marks[name]?.done, [paths.length, mark], { polling: 5 });
    return page.evaluate((name) => performance.timeOrigin + globalThis.release.marks[name].done, mark);
  };
  const first = await until("first"), exact = await until("exact");
  console.log(`${paths.join(" and ")}: at 300 s ${(first - began).toFixed(0)} ms after its address was opened, replayed after ${(exact - began).toFixed(0)} ms`);
  await page.waitForSelector(".uplot");
}

const percentile = (list, share) => [...list].sort((a, b) => a - b)[Math.min(list.length - 1, Math.floor(share * list.length))];
const told = (name, list) => `${name} ${percentile(list, 0.5).toFixed(0)}, ${percentile(list, 0.95).toFixed(0)} ms`;

async function scrub(title) {
  const all = [];
  for (let i = 0; i < releases; ++i) {
    const { x, y, width } = await page.locator(".plots").boundingBox();
    await page.mouse.click(x + 64 + ((0.5 + i * 0.6180339887) % 1) * (width - 78), y + 20);
    await page.waitForFunction(() => globalThis.release.marks.first?.done && globalThis.release.marks.exact?.done);
    all.push(await page.evaluate(() => ({ at: globalThis.release.at, ...globalThis.release.marks })));
    await page.waitForTimeout(kPause);
  }
  const from = (mark, stage) => all.map((one) => one[mark][stage] - one.at);
  const between = (mark, before, after) => all.map((one) => one[mark][after] - (before === "sent" ? one.sent : one[mark][before]));
  console.log(`${title}, ${releases} releases, p50, p95: ${told("picture", from("first", "done"))}; ${told("replayed", from("exact", "done"))}`);
  for (const mark of ["first", "exact"])
    console.log(`  ${mark === "first" ? "picture" : "replayed"}: ${told("asked", all.map((one) => one.sent - one.at))}; ${told("program and way", between(mark, "sent", "came"))}; `
      + `${told("until drawn", between(mark, "came", "drawn"))}; ${told("drawing", between(mark, "drawn", "done"))}`);
}

const [expert, clumsy] = Object.keys(kPair).map((name) => `${name}.ctpm`);
await open(expert);
await scrub("one session, just opened");
await scrub("one session, later");
await open(expert, clumsy);
await scrub("two sessions, just opened");
await scrub("two sessions, later");
await studio.close();
rmSync(folder, { recursive: true });
