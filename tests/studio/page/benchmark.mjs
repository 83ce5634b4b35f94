// What a training costs the browser, and how long a pose waits for its tick:
//   run.sh benchmark.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES [ROUNDS]
// The mouse leads the ball over the shipped kidney, and over an egg of 20,000 triangles. Of each round: pictures a second;
// processor time of the page's main thread for each of them; poses as the program measured them; from the beginning of the tick
// whose State a picture shows until the browser is done with drawing it (what the screen adds is in no number). Both clocks are
// this machine's monotonic one: `began_s` of train_ended, and the page's as Chromium's metrics have it. A tick's beginning is
// known to 1 ms.
import { rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as rest } from "node:timers/promises";
import { openBareBrowser } from "./bare_browser.mjs";
import { ctpm, makeFolder, serve, stop } from "./browser.mjs";
import { largeMesh } from "./large_mesh.mjs";

const kSeconds = 8, rounds = Number(process.argv[7] ?? 3);
const folder = makeFolder("kidney.json");
writeFileSync(join(folder, "scan.obj"), largeMesh(20000));
const imported = ctpm(folder, "import", "scan.obj", "-o", "egg.json", "--radius-mm", "7", "--organ", "liver");
if (imported.code !== 0) throw new Error(imported.err);
const { server, address } = await serve(folder, 0), page = await openBareBrowser(() => {
  globalThis.pictures = 0; // each ends with a fence
  globalThis.shown = []; // of each one that shows a new tick: ticks done, slip [s], when it was drawn [ms]
  globalThis.ended = null;
  let newest = null;
  globalThis.WebSocket = class extends WebSocket {
    constructor(...of) {
      super(...of);
      this.addEventListener("message", ({ data }) => {
        if (typeof data === "string") return data.includes('"train_ended"') && (globalThis.ended = JSON.parse(data).content);
        const view = new DataView(data);
        if (view.getUint32(0, true) === 2) newest = [view.getFloat64(32, true), view.getFloat32(120, true)];
      });
    }
  };
  const { fenceSync, deleteSync } = WebGL2RenderingContext.prototype, of = new Map();
  Object.assign(WebGL2RenderingContext.prototype, {
    fenceSync(...what) {
      const sync = fenceSync.apply(this, what);
      ++globalThis.pictures;
      if (newest) of.set(sync, newest), newest = null;
      return sync;
    },
    deleteSync(sync) {
      if (of.has(sync)) globalThis.shown.push([...of.get(sync), performance.now()]), of.delete(sync);
      return deleteSync.call(this, sync);
    },
  });
});
await page.go(address);
await page.send("Performance.enable", { timeDomain: "threadTicks" });
const busy = async () => (await page.send("Performance.getMetrics")).metrics.find(({ name }) => name === "TaskDuration").value;
/** Of the pictures since the training began, p50 and p95 from their ticks [ms]; the tick is 1 ms long. */
async function fromTicks() {
  const { metrics } = await page.send("Performance.getMetrics"), began = metrics.find(({ name }) => name === "NavigationStart").value;
  const { shown, ended } = await page.evaluate(() => ({ shown: globalThis.shown.splice(0), ended: globalThis.ended }));
  const times = shown.filter(([ticks]) => ticks > 0).map(([ticks, slip, drawn]) => 1e3 * (began - ended.began_s) + drawn - (ticks - 1) - 1e3 * slip);
  times.sort((a, b) => a - b);
  return [0.5, 0.95].map((share) => times[Math.floor(share * (times.length - 1))].toFixed(0));
}

async function lead(scene) {
  await page.click("header nav button", "Train");
  await page.find("aside input");
  await page.evaluate(() => {
    const path = document.querySelector("aside input"); // nothing is recorded
    path.value = "";
    path.dispatchEvent(new Event("input", { bubbles: true }));
  });
  await page.click(".list button", scene);
  await page.find(".view.running .force-bar");
  const { left, top, width, height } = await page.find(".view > canvas");
  await page.move({ x: left + 4, y: top + height - 4 });
  const ring = await page.find(".take-up");
  await page.move(ring);
  await page.find(".view.held");
  await page.evaluate(() => void globalThis.shown.splice(0));
  const began = Date.now(), before = [await page.evaluate(() => globalThis.pictures), await busy()];
  for (let t = 0; t < kSeconds; t = (Date.now() - began) / 1e3)
    await Promise.all([page.move({ x: ring.x + width * 0.06 * Math.sin(3 * t), y: ring.y + height * 0.15 * (1 - Math.cos(2 * t)) }), rest(8)]);
  const pictures = (await page.evaluate(() => globalThis.pictures)) - before[0], time = (await busy()) - before[1];
  await page.press("Escape");
  await page.find("button", "Train again");
  const row = (name) => page.evaluate((name) => [...document.querySelectorAll(".readings div")].find((row) => row.querySelector("dt")?.textContent === name).querySelector("dd").textContent, name);
  console.log(`${scene}: ${(pictures / kSeconds).toFixed(1)} pictures a second, ${((1e3 * time) / pictures).toFixed(2)} ms of the main thread each; `
    + `pose to tick: half ${await row("half of the poses")}, 99 of 100 ${await row("99 of 100 poses")}, ${await row("within 5 ms")} within 5 ms; `
    + `tick to picture p50, p95 ${(await fromTicks()).join(", ")} ms; ${await row("late steps")} late steps`);
  await page.click("button", "Choose a scene");
}

for (let round = 0; round < rounds; ++round) for (const scene of ["kidney", "egg"]) await lead(scene);
await page.close();
await stop(server);
rmSync(folder, { recursive: true });
