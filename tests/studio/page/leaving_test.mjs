// A trainee whose machine is too slow, and who leaves while a session is recorded: leaving_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { rmSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { ctpm, leave, makeFolder, openStudio, picture, reading, seriousFindings, step } from "./browser.mjs";
import { begin, end, takeUpByKeys } from "./trainee_page.mjs";

const kOther = "liver-press-expert.ctpm";
let folder, studio, page;

before(async () => {
  folder = makeFolder("kidney.json", kOther);
  studio = await openStudio(folder);
  page = studio.page;
  await page.click("header nav button:has-text('Train')");
});

after(() => leave(studio, folder));

step("a session that falls behind the clock says so in the picture, and what helps, until it keeps up", async () => {
  await begin(page, "kidney");
  await takeUpByKeys(page);
  await page.waitForFunction(() => Number.parseFloat(document.querySelector(".clock").textContent) > 0.2);
  assert.match(await page.locator(".of-machine summary").innerText(), /^The machine: /);
  const said = page.locator(".view .slow-motion");
  await studio.starve(3000);
  await said.waitFor();
  assert.match(await said.innerText(), /^This machine is too slow for what happens here: [1-9]\d* s behind the clock\s+The tissue moves at \d+ % of its pace.*close other programs/s);
  await picture(page, "train-slow-motion");
  assert.deepEqual(await seriousFindings(page), []);
  await said.waitFor({ state: "detached" });
  assert.ok((await reading(page, "behind the clock")) > 2, "what was lost stays lost");
  await end(page);
  await page.click("button:has-text('Choose a scene')");
});

step("leaving the room, or the page, asks before it ends a recording, which is there when somebody comes back", async () => {
  const question = page.locator("dialog"), room = () => page.evaluate(() => new URLSearchParams(location.hash.slice(1)).get("room"));
  const goOnRecording = async () => {
    await takeUpByKeys(page);
    await page.waitForFunction(() => Number.parseFloat(document.querySelector(".clock").textContent) > 0.3);
  };
  await begin(page, "kidney", "left.ctpm");
  await page.locator("aside .field:has-text('expert') select").selectOption(kOther);
  await page.click("header nav button:has-text('Review')"); // nothing is recorded yet
  await page.waitForSelector(".room.review");
  await page.click("header nav button:has-text('Train')");
  await page.waitForSelector(".view .empty:has-text('Choose a scene to train in')");
  await begin(page, "kidney", "left.ctpm");
  await page.locator("aside .field:has-text('expert') select").selectOption(kOther);
  await goOnRecording();
  await page.click("header nav button:has-text('Review')");
  await question.waitFor();
  assert.match(await question.innerText(), /Leaving this room ends the recording here\. It is kept as left\.ctpm/);
  assert.deepEqual(await seriousFindings(page), []);
  await picture(page, "train-leaving");
  const before = await page.locator(".clock").innerText();
  await page.click("dialog button:has-text('Go on training')");
  await question.waitFor({ state: "detached" });
  await page.waitForFunction((before) => document.querySelector(".clock").textContent !== before, before);
  // The browser's way back asks too.
  await page.evaluate(() => history.back());
  await question.waitFor();
  assert.equal(await room(), "train");
  await page.click("dialog button:has-text('End the recording and leave')");
  await page.waitForSelector(".room.review");
  assert.equal(await room(), "review");
  const info = () => JSON.parse(ctpm(folder, "info", "left.ctpm", "--json").out);
  assert.ok(info().ended_cleanly && info().duration_s > 0.3);
  await page.click("header nav button:has-text('Train')");
  const ended = async (session) => {
    await page.waitForSelector("aside .readings dt:text-is('recorded as')");
    assert.equal(await page.locator(".readings div:has(dt:text-is('recorded as')) dd").innerText(), session);
    assert.match(await page.locator("aside button.main").innerText(), /^Verify/);
    assert.equal(await page.locator("aside .field:has-text('expert') select").inputValue(), kOther);
  };
  await ended("left.ctpm");
  await picture(page, "train-come-back");
  await page.click("button:has-text('Train again')");
  await page.waitForSelector(".view.running");
  assert.equal((await page.locator(".recorded").textContent()).trim(), "records left-2.ctpm");
  await goOnRecording();
  const asked = new Promise((resolve) => page.once("dialog", (dialog) => (resolve(dialog.type()), void dialog.accept())));
  await page.reload();
  assert.equal(await asked, "beforeunload");
  await ended("left-2.ctpm");
  assert.ok((await reading(page, "duration")) > 0.2);
  await page.click("button.main:has-text('Verify')");
  assert.match(await page.locator("aside .good").first().innerText(), /^The recording, replayed: same/);
  await page.click("button:has-text('Choose a scene')");
  // Who has chosen another scene does not come back to it, nor is a page asked that records nothing.
  await page.reload();
  await page.waitForSelector(".view .empty:has-text('Choose a scene to train in')");
  for (const name of ["left.ctpm", "left-2.ctpm"]) rmSync(join(folder, name));
});

step("nothing was complained about", () => assert.deepEqual(studio.complaints, []));
