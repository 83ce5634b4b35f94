// The page that a command writes, read in a browser: report_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { readFileSync, rmSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { ctpmBeside, makeFolder, openBrowser, overflow, picture, seriousFindings } from "./browser.mjs";

/** The columns of a CSV file as numbers, by name. */
function columns(path) {
  const [names, ...rows] = readFileSync(path, "utf8").trim().split("\n").map((line) => line.split(","));
  return Object.fromEntries(names.map((name, i) => [name, rows.map((row) => Number(row[i]))]));
}

/** What the cursor of a plot tells at a part of its width. */
async function toldAt(page, plot, part) {
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  await page.mouse.move(box.x + part * box.width, box.y + 0.5 * box.height);
  return plot.evaluate((svg) => [...svg.querySelectorAll(".cursor text")].map((line) => line.textContent));
}

/** The number that a line of the cursor ends with. */
function numberOf(told, name) {
  return Number(told.find((line) => line.startsWith(name))?.split(" ").at(-1));
}

test("a comparison is read at any width, and the cursor of a plot tells what was recorded", async () => {
  const folder = makeFolder("kidney-cut-expert.ctpm", "kidney-cut-clumsy.ctpm");
  const [compared, replayed, { page, complaints, close }] = await Promise.all([
    ctpmBeside(folder, "compare", "kidney-cut-expert.ctpm", "kidney-cut-clumsy.ctpm", "-o", "report"),
    ctpmBeside(folder, "replay", "kidney-cut-clumsy.ctpm", "--csv", "ticks.csv"), openBrowser(),
  ]);
  try {
    assert.equal(compared.code, 0, compared.err);
    assert.equal(replayed.code, 0, replayed.err);
    const recorded = columns(join(folder, "ticks.csv"));
    const asked = [];
    page.on("request", (request) => asked.push(request.url()));
    for (const width of [1280, 420]) {
      await page.setViewportSize({ width, height: 900 });
      await page.goto(pathToFileURL(join(folder, "report", "report.html")).href);
      assert.ok((await overflow(page)) <= 0, `${width} px: wider than the window`);
      assert.deepEqual(await seriousFindings(page), []);
      const plots = await page.$$("svg:has(.cursor)");
      assert.ok(plots.length >= 5);
      for (const plot of plots) assert.notDeepEqual(await toldAt(page, plot, 0.55), [], "a plot without a cursor");
      const force = plots[0];
      await toldAt(page, force, 0.4);
      await picture(page, `report-cursor-${width}`);
      for (const part of [0.3, 0.4, 0.55, 0.8]) {
        const told = await toldAt(page, force, part);
        const time = numberOf(told, "time [s]");
        const near = recorded.force_n.filter((_, i) => Math.abs(recorded.time_s[i] - time) <= 0.03);
        const trainee = numberOf(told, "trainee");
        assert.ok(trainee >= Math.min(...near) - 0.01 && trainee <= Math.max(...near) + 0.01, `${told} at ${time} s: ${Math.min(...near)} to ${Math.max(...near)} N`);
      }
    }
    assert.deepEqual([...new Set(asked.map((url) => new URL(url).protocol))], ["file:"], "a page loads nothing from elsewhere");
    assert.deepEqual(complaints, []);
  } finally {
    await close();
    rmSync(folder, { recursive: true, force: true });
  }
});
