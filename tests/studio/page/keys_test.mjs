// A trainee and a reviewer who have a keyboard alone: keys_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { existsSync, readFileSync, rmSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { ctpm, ctpmBeside, makeFolder, openStudio, picture, reading, step, until } from "./browser.mjs";

const kExpert = "kidney-cut-expert.ctpm", kEvil = "<img src=x onerror=alert(1)>.ctpm", kEvilScene = "<b onclick=alert(2)>.json";
let folder, studio, page, verdict;

before(async () => {
  folder = makeFolder("kidney.json", kExpert);
  studio = await openStudio(folder);
  page = studio.page;
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
});

after(async () => {
  assert.equal(await studio.close(), 0);
  rmSync(folder, { recursive: true });
});

const press = (key) => page.keyboard.press(key);

/** Presses the tabulator until what is focused is that; fails after one round. */
async function tabTo(what, selector, key = "Tab") {
  for (let i = 0; i < 120; ++i) {
    await press(key);
    if (await page.evaluate((selector) => document.activeElement?.matches(selector), selector)) return;
    const own = await page.evaluate(() => document.activeElement?.textContent ?? "");
    if (typeof what === "string" && what && own.trim() === what) return;
  }
  assert.fail(`the tabulator does not come to ${what || selector}`);
}
const toButton = (text) => tabTo(text, "no-such-element");
/** To the field with that label; `tag` as a selector. */
async function toField(label, tag) {
  await page.evaluate(([label, tag]) => {
    for (const each of document.querySelectorAll("[data-goal]")) delete each.dataset.goal;
    const field = [...document.querySelectorAll(".field")].find((each) => each.textContent.includes(label));
    field.querySelector(tag).dataset.goal = "";
  }, [label, tag]);
  await tabTo("", "[data-goal]");
}
async function write(text) {
  await press("Control+A");
  await page.keyboard.type(text);
}
/** Chooses in the list that is focused, by arrows. */
async function choose(value) {
  const chosen = () => page.evaluate(() => document.activeElement.value);
  for (let i = 0; i < 30 && (await chosen()) !== value; ++i) await press("ArrowDown");
  for (let i = 0; i < 30 && (await chosen()) !== value; ++i) await press("ArrowUp");
  assert.equal(await chosen(), value);
}

step("by keys a trainee starts, presses, records, ends, verifies and compares", async () => {
  await toButton("Train");
  await press("Enter");
  await page.waitForSelector(".room.train");
  await toField("record as", "input");
  await write("keys.ctpm");
  await toField("the expert's session", "select");
  await choose(kExpert);
  await toButton("kidney");
  await press("Enter");
  await page.waitForSelector(".view.running .force-bar");
  assert.equal(await page.evaluate(() => document.activeElement.tagName), "CANVAS", "the tool's keys work at once");
  // 46 keys take less than a tenth of a second here: the tool begins where they have led it, unless a tick was done before.
  await press("ArrowUp");
  await until(() => reading(page, "newest step"), (ms) => ms > 0);
  for (let i = 0; i < 46; ++i) await press("ArrowDown");
  await page.waitForFunction(() => Number.parseFloat(document.querySelector(".force-bar output").textContent) > 0.1);
  // Another room asks first, and Escape is an answer: to stay.
  await toButton("Review");
  await press("Enter");
  await page.waitForSelector("dialog");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Go on training");
  await press("ArrowDown");
  await press("Escape");
  await page.waitForSelector("dialog", { state: "detached" });
  assert.ok(await page.locator(".view.running").count(), "it goes on");
  await press("ArrowUp");
  await press("2");
  await page.waitForSelector(".transport button[aria-pressed=true]:has-text('scalpel')");
  await press("Escape");
  await page.waitForSelector("button:has-text('Train again')");
  await toButton("Verify and compare");
  await press("Enter");
  await page.waitForSelector("aside table");
  assert.match(await page.locator("aside .good").first().innerText(), /no difference/);
  await picture(page, "keys-train");
  const info = JSON.parse(ctpm(folder, "info", "keys.ctpm", "--json").out);
  assert.ok(info.max_force_n > 0.1, `${info.max_force_n} N`);
  verdict = ctpmBeside(folder, "verify", "keys.ctpm");
});

step("by keys a reviewer opens, scrubs, plays, writes a note, copies a moment's link and exports", async () => {
  await toButton("Review");
  await press("Enter");
  await page.waitForSelector(".room.review");
  await page.evaluate((name) => {
    [...document.querySelectorAll(".list button")].find((each) => each.title === name).dataset.goal = "";
  }, kExpert);
  await tabTo("", "[data-goal]");
  await press("Enter");
  await page.waitForSelector(".uplot");
  const clock = async () => Number.parseFloat(await page.locator(".clock").innerText());
  await tabTo("", ".scrub");
  await press("Home");
  for (let i = 0; i < 12; ++i) await press("Shift+ArrowRight");
  for (let i = 0; i < 3; ++i) await press("ArrowRight");
  await page.waitForFunction(() => document.querySelector(".clock").textContent.startsWith("1.230"));
  await press("Space");
  await page.waitForFunction(() => Number.parseFloat(document.querySelector(".clock").textContent) > 1.3);
  await press("Space");
  const time = await clock();
  await press("n");
  await page.waitForSelector("#panel textarea");
  await tabTo("", "#panel textarea");
  await page.keyboard.type("look here");
  await press("Control+Enter");
  await page.waitForSelector("#panel .jumps button:has-text('look here')");
  const { notes } = JSON.parse(readFileSync(join(folder, kExpert.replace(".ctpm", ".notes.json")), "utf8"));
  assert.deepEqual(notes.map(({ text }) => text), ["look here"]);
  assert.ok(Math.abs(notes[0].time_s - time) <= 5e-4 + 1e-9, `${notes[0].time_s} s, where the clock said ${time}`);
  await toButton("Copy the link");
  await press("Enter");
  await page.waitForSelector("#panel .hint code");
  const link = await page.evaluate(() => navigator.clipboard.readText());
  assert.equal(link, await page.locator("#panel .hint code").innerText());
  assert.ok(link.includes(encodeURIComponent(kExpert)) && !link.includes("token"), link);
  await toButton("export");
  await press("Enter");
  for (const [label, value] of [["file in the folder", "keys.avi"], ["from [s]", "1"], ["to [s]", "1.1"]]) {
    await toField(label, "input");
    await write(value);
  }
  await toButton("Export");
  await press("Enter");
  await page.waitForSelector("#panel .good:has-text('keys.avi')");
  assert.ok(existsSync(join(folder, "keys.avi")));
  assert.equal((await verdict).code, 0, "what the trainee recorded");
  await picture(page, "keys-review");
});

step("names of files and notes are text, in all rooms", async () => {
  const { copyFileSync } = await import("node:fs");
  copyFileSync(join(folder, kExpert), join(folder, kEvil));
  copyFileSync(join(folder, "kidney.json"), join(folder, kEvilScene));
  const nothingCame = async (where) => assert.equal(await page.locator("main img, main b[onclick], aside b[onclick]").count(), 0, where);
  await page.click("header nav button:has-text('Author')");
  await page.click(`.scenes button:has-text('<b onclick=alert(2)>')`);
  await page.waitForSelector(".handle", { state: "attached" });
  await nothingCame("Author");
  await page.click("header nav button:has-text('Train')");
  await page.click(`.list button:has-text('<b onclick=alert(2)>')`);
  await page.waitForSelector(".view.running");
  await press("Escape");
  await page.waitForSelector("button:has-text('Train again')");
  await nothingCame("Train");
  await page.click("header nav button:has-text('Review')");
  await page.click(`.list button:has-text('<img src=x')`);
  await page.waitForSelector(".uplot");
  assert.match(await page.locator(".captions").innerText(), /<img src=x onerror=alert\(1\)>\.ctpm/);
  await page.click("#tab-notes");
  await page.fill("#panel textarea", "<img src=y onerror=alert(3)>");
  await page.click("#panel button.main");
  await page.waitForSelector("#panel .jumps button:has-text('<img src=y')");
  assert.equal(await page.locator(".marks .mark.note").count(), 1);
  await page.click("#panel button:has-text('Copy the link')");
  await page.click("#tab-export");
  assert.match(await page.locator("#panel .command code").innerText(), /'<img src=x onerror=alert\(1\)>\.ctpm'/);
  await page.click("#tab-compare");
  await page.locator("#panel select").selectOption(kExpert);
  await page.waitForSelector(".captions .second");
  await page.click("#panel button.main");
  await page.waitForSelector("#panel table");
  await nothingCame("Review");
});

step("nothing was complained about", () => assert.deepEqual(studio.complaints, []));
