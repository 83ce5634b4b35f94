// What a page asks for when a review opens: opening_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { rmSync } from "node:fs";
import { after, before, test } from "node:test";
import { makeFolder, openStudio, picture, reading } from "./browser.mjs";

const kExpert = "kidney-cut-expert.ctpm", kClumsy = "kidney-cut-clumsy.ctpm", kPress = "liver-press-expert.ctpm";
let folder, studio, page;

before(async () => {
  folder = makeFolder(kExpert, kClumsy, kPress);
  studio = await openStudio(folder);
  page = studio.page;
  // Keeps what the page asks for, and which opens and closes of a stage it has not been answered yet.
  await page.addInitScript(() => {
    Object.assign(globalThis, { shown: [], opened: [], together: 0 });
    const unanswered = new Map(); // stage of each call
    globalThis.WebSocket = class extends WebSocket {
      constructor(...of) {
        super(...of);
        this.addEventListener("message", ({ data }) => typeof data === "string" && unanswered.delete(JSON.parse(data).id));
      }
      send(data) {
        const { show, id, call, params } = JSON.parse(data);
        if (show) globalThis.shown.push(show);
        if (call === "session.open" && params.stage !== undefined || call === "session.close") {
          globalThis.together += [...unanswered.values()].includes(params.stage);
          unanswered.set(id, params.stage);
          globalThis.opened.push(params);
        }
        super.send(data);
      }
    };
  });
});

after(async () => {
  assert.deepEqual(studio.complaints, []);
  assert.equal(await studio.close(), 0);
  rmSync(folder, { recursive: true });
});

const replayed = (count) => page.waitForFunction((count) => {
  const shown = [...document.querySelectorAll(".readings div")].filter((row) => row.querySelector("dt").textContent === "replay");
  return shown.length === count && shown.every((row) => row.querySelector("dd").textContent === "as recorded")
    && /\d+ ms/.test([...document.querySelectorAll(".readings div")].find((row) => row.textContent.includes("replayed after"))?.textContent ?? "");
}, count);

test("a link to a moment of two sessions opens both at it, and no other picture is made", async () => {
  await page.goto("about:blank");
  await page.goto(`${new URL(studio.address).origin}/#${new URLSearchParams({ room: "review", session: kExpert, beside: kClumsy, ahead: "0.75", t: "1.5" })}`);
  await replayed(2);
  await page.waitForFunction(() => document.querySelectorAll(".uplot").length === 3); // the curves come too
  const shown = await page.evaluate(() => globalThis.shown.map(({ stage, tick }) => `${stage}: ${tick}`));
  assert.deepEqual([...new Set(shown)].sort(), ["0: 1500", "1: 2250"]);
  assert.deepEqual(await page.locator(".captions b").allInnerTexts(), [`expert: ${kExpert} 1.500 s`, `trainee: ${kClumsy} 2.250 s`]);
  await picture(page, "opening-pair");
});

test("whoever chooses sessions faster than they open gets the last one", async () => {
  await page.evaluate((names) => {
    const buttons = names.map((name) => [...document.querySelectorAll(".list button")].find((button) => button.title === name));
    for (let i = 0; i < 4; ++i) for (const button of buttons) button.click();
  }, [kExpert, kClumsy, kPress]);
  await page.waitForSelector(".captions:has-text('liver-press-expert')");
  await replayed(1);
  assert.equal(await page.evaluate(() => globalThis.together), 0, "opens and closes of a stage that the program could run in any order");
  const opened = await page.evaluate(() => globalThis.opened);
  assert.equal(opened.filter(({ stage, path }) => stage === 0 && path).at(-1).path, kPress);
  assert.ok(opened.filter(({ path }) => path).length < 7, "those in between are not opened");
  assert.equal(await page.locator(".captions .second").count(), 0);
  // What is seen is that session: its ball presses, and no tissue is cut.
  await page.locator(".view > canvas").focus();
  await page.keyboard.press("End");
  await replayed(1);
  assert.equal(await reading(page, "severed"), 0);
});
