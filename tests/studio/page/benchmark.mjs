// What a training costs the browser, and how long a pose waits for its tick:
//   run.sh benchmark.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES [ROUNDS]
// The mouse leads the ball over the shipped kidney, and over an egg of 20,000 triangles. Of each round: pictures a second;
// processor time of the page's main thread for each of them; poses as the program measured them.
import { rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { ctpm, makeFolder, openStudio } from "./browser.mjs";
import { largeMesh } from "./large_mesh.mjs";

const kSeconds = 8, rounds = Number(process.argv[7] ?? 3);
const folder = makeFolder("kidney.json");
writeFileSync(join(folder, "scan.obj"), largeMesh(20000));
const imported = ctpm(folder, "import", "scan.obj", "-o", "egg.json", "--radius-mm", "7", "--organ", "liver");
if (imported.code !== 0) throw new Error(imported.err);
const studio = await openStudio(folder), { page } = studio;
const browser = await page.context().newCDPSession(page);
await browser.send("Performance.enable", { timeDomain: "threadTicks" });
const busy = async () => (await browser.send("Performance.getMetrics")).metrics.find(({ name }) => name === "TaskDuration").value;
await page.evaluate(() => {
  globalThis.pictures = 0; // each ends with a fence
  const fence = WebGL2RenderingContext.prototype.fenceSync;
  WebGL2RenderingContext.prototype.fenceSync = function (...of) {
    ++globalThis.pictures;
    return fence.apply(this, of);
  };
});

async function lead(scene) {
  await page.click("header nav button:has-text('Train')");
  await page.locator("aside input").first().fill("");
  await page.click(`.list button:has-text('${scene}')`);
  await page.waitForSelector(".view.running .force-bar");
  const { x, y, width, height } = await page.locator(".view canvas").boundingBox();
  const began = Date.now(), before = [await page.evaluate(() => globalThis.pictures), await busy()];
  for (let t = 0; t < kSeconds; t = (Date.now() - began) / 1e3)
    await Promise.all([page.mouse.move(x + width * (0.5 + 0.06 * Math.sin(3 * t)), y + height * (0.1 + 0.15 * (1 - Math.cos(2 * t)))), page.waitForTimeout(8)]);
  const pictures = (await page.evaluate(() => globalThis.pictures)) - before[0], time = (await busy()) - before[1];
  await page.keyboard.press("Escape");
  await page.waitForSelector("button:has-text('Train again')");
  const row = (name) => page.locator(`.readings div:has(dt:text-is("${name}")) dd`).innerText();
  console.log(`${scene}: ${(pictures / kSeconds).toFixed(1)} pictures a second, ${((1e3 * time) / pictures).toFixed(2)} ms of the main thread each; `
    + `pose to tick p50, p99 ${await row("hand to tick p50, p99")}, ${await row("within 5 ms")} within 5 ms; ${await row("late ticks")} late ticks`);
  await page.click("button:has-text('Train again')");
}

for (let round = 0; round < rounds; ++round) for (const scene of ["kidney", "egg"]) await lead(scene);
await studio.close();
rmSync(folder, { recursive: true });
