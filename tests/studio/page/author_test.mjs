// An author in a browser: author_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { ctpm, makeFolder, openStudio, overflow, paths, picture, seriousFindings } from "./browser.mjs";

let folder, studio, page;

before(async () => {
  folder = makeFolder("kidney.json");
  studio = await openStudio(folder);
  page = studio.page;
  await page.click("header nav button:has-text('Author')");
});

after(async () => {
  assert.equal(await studio.close(), 0);
  rmSync(folder, { recursive: true });
});

const kScene = "my-kidney-scene.json";
const text = () => page.locator("textarea.code").inputValue();
const checked = () => page.waitForTimeout(1200);

test("an empty room says what to do", async () => {
  assert.match(await page.locator(".view .empty").innerText(), /Drop a mesh/);
  assert.deepEqual(await seriousFindings(page), []);
  await picture(page, "author-empty");
});

test("a mesh becomes a scene, as by the command", async () => {
  const mesh = readFileSync(join(paths.source, "scenes", "organs", "kidney.obj"));
  await page.setInputFiles(".pick input", { name: "my-kidney.obj", mimeType: "model/obj", buffer: mesh });
  await picture(page, "author-import");
  const shown = await page.locator("aside .command code").innerText();
  await page.click("aside button.main");
  await page.waitForSelector("aside .good");
  await page.waitForSelector("aside pre");
  await page.waitForTimeout(1000);
  assert.deepEqual(await seriousFindings(page), []);
  await picture(page, "author-imported");
  assert.ok(readFileSync(join(folder, "my-kidney.obj")).equals(mesh));
  // The command that it showed writes the same scene elsewhere.
  const scene = readFileSync(join(folder, kScene), "utf8");
  const other = makeFolder();
  writeFileSync(join(other, "my-kidney.obj"), mesh);
  const words = shown.split(" ").slice(1);
  const outcome = ctpm(other, ...words);
  assert.equal(outcome.code, 0, outcome.err);
  assert.equal(scene, readFileSync(join(other, kScene), "utf8"));
  const report = await page.locator("aside pre").innerText();
  const printed = outcome.out.split("\n").filter((line) => /spheres|triangles/.test(line));
  assert.ok(printed.length > 0);
  rmSync(other, { recursive: true });
  assert.ok(report.length > 50);
});

test("errors in the text are those of check, at their places", async () => {
  await page.click("#tab-text");
  await page.waitForFunction(() => document.querySelector("textarea.code").value.length > 100);
  const good = await text();
  const bad = good.replace(/"radius_mm": [\d.]+/, '"radius_mm": -4').replace('"gravity', '"gravty');
  await page.fill("textarea.code", bad);
  await checked();
  const shown = await page.locator("#panel .jumps button.error").allInnerTexts();
  writeFileSync(join(folder, "bad.json"), bad);
  const printed = ctpm(folder, "check", "bad.json").err;
  assert.ok(shown.length >= 1);
  for (const line of shown) {
    const [, place, message] = /^(\d+:\d+)\s*(.*)$/s.exec(line);
    assert.ok(printed.includes(`bad.json:${place}: error: ${message.trim()}`), `${line}\n---\n${printed}`);
  }
  await page.locator("#panel .jumps button.error").first().click();
  await picture(page, "author-errors");
  assert.deepEqual(await seriousFindings(page), []);
  // Nothing was written, and a draft outlives the page.
  assert.equal(readFileSync(join(folder, kScene), "utf8"), good);
  await page.reload();
  await page.click(`.list button:has-text('my-kidney-scene')`);
  await page.waitForSelector("aside .readings");
  await page.click("#tab-text");
  await page.waitForFunction((wanted) => document.querySelector("textarea.code")?.value === wanted, bad);
  await page.click("#panel button:has-text('Drop changes')");
  await page.waitForFunction((wanted) => document.querySelector("textarea.code")?.value === wanted, good);
});

test("saving is by key, and never over somebody else's change", async () => {
  const changed = (await text()).replace(/"name": "[^"]*"/, '"name": "mine"');
  await page.fill("textarea.code", changed);
  await page.locator("textarea.code").press("Control+s");
  await page.waitForSelector("#panel button.main:disabled");
  assert.equal(readFileSync(join(folder, kScene), "utf8"), changed);
  writeFileSync(join(folder, kScene), changed + "\n");
  await page.fill("textarea.code", changed.replace("mine", "again"));
  await page.locator("textarea.code").press("Control+s");
  await page.waitForSelector("#panel .problems");
  assert.match(await page.locator("#panel .problems").innerText(), /changed on the disk/);
  assert.equal(readFileSync(join(folder, kScene), "utf8"), changed + "\n");
  await page.click("#panel button:has-text('Drop changes')");
});

test("a scene is tried at once, and nothing is kept", async () => {
  await page.click("#tab-scene");
  const before = readdirSync(folder).sort();
  const started = Date.now();
  await page.click("aside button:has-text('Try it')");
  await page.waitForSelector(".view.running .force-bar");
  console.log(`author: from "Try it" to a scene in the hand ${Date.now() - started} ms`);
  await picture(page, "author-try");
  await page.keyboard.press("Escape");
  await page.waitForSelector("button:has-text('Train again')");
  assert.deepEqual(readdirSync(folder).sort(), before);
});

test("it fits a tablet", async () => {
  await page.click("header nav button:has-text('Author')");
  await page.setViewportSize({ width: 820, height: 1180 });
  await page.click(`.list button:has-text('my-kidney-scene')`);
  await page.waitForSelector("aside .readings");
  assert.ok((await overflow(page)) <= 0);
  await picture(page, "author-820x1180");
});

test("nothing was complained about", () => assert.deepEqual(studio.complaints, []));
