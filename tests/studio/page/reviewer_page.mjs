// What a reviewer's hands do in the page, for the tests of the Review room.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { picture, seriousFindings } from "./browser.mjs";

/** Changes the only note of a session that is noted beside its expert's, on a page that can keep messages back. */
export async function changeNotes(studio, folder, path, note) {
  const { page } = studio;
  // Other words for one, and none: deleted, it can be had back.
  const words = () => page.locator("#panel .jumps li button:first-child").evaluateAll((all) => all.map((button) => button.lastChild.textContent));
  const written = () => JSON.parse(readFileSync(join(folder, path.replace(/ctpm$/, "notes.json")), "utf8")).notes;
  const button = (text) => page.locator(`#panel section button:text-is("${text}")`), editor = page.locator("#panel .note-editor textarea");
  await button("edit").click();
  assert.ok(await editor.evaluate((field) => field === document.activeElement));
  await editor.fill("  ");
  assert.ok(await button("Save").isDisabled(), "a note has words, as one that is added");
  await page.keyboard.press("Escape");
  await editor.waitFor({ state: "detached" });
  await page.waitForFunction(() => document.activeElement.textContent === "edit");
  await page.keyboard.press("Enter");
  await editor.fill("hurried, and too deep");
  await picture(page, "review-note-edited");
  await page.keyboard.press("Control+Enter");
  await editor.waitFor({ state: "detached" });
  assert.deepEqual(written(), [{ ...note, text: "hurried, and too deep" }]);
  await page.click("#panel button[aria-label^='Delete']");
  await button("Undo").waitFor();
  assert.deepEqual(written(), []);
  await button("Undo").click();
  await button("Undo").waitFor({ state: "detached" });
  assert.deepEqual(written(), [{ ...note, text: "hurried, and too deep" }]);
  // Somebody else writes meanwhile: that is said and shown, and neither their words nor those that are being written are lost.
  const byOthers = async (change) => {
    const { revision, notes: now } = await studio.call("notes.read", { path });
    await studio.call("notes.write", { path, revision, notes: change(now) });
  };
  await button("edit").click();
  await editor.fill("mine");
  await byOthers((now) => [...now, { time_s: 0.5, text: "theirs" }]);
  await button("Save").click();
  await page.waitForSelector("#panel .problems:has-text('changed by somebody else; nothing was written')");
  assert.deepEqual((await words()).sort(), ["hurried, and too deep", "theirs"]);
  assert.equal(await editor.inputValue(), "mine");
  await byOthers((now) => now.filter(({ text }) => text === "theirs"));
  await button("Save").click();
  await page.waitForSelector("#panel .note-editor .warning:has-text('Somebody else changed or deleted this note')");
  await picture(page, "review-note-conflict");
  assert.deepEqual(await seriousFindings(page), []);
  await button("Save").click();
  await editor.waitFor({ state: "detached" });
  assert.deepEqual(written().map(({ text }) => text).sort(), ["mine", "theirs"]);
  // What was read before a note was written, and comes after it, hides none.
  await page.click("#tab-moment");
  await page.evaluate(() => (globalThis.holds = (data) => typeof data === "string" && data.includes('"revision"') && globalThis.keptCount() < 2));
  await page.click("#tab-notes");
  await page.waitForFunction(() => globalThis.keptCount() === 2); // one list of each session
  await page.fill("#panel textarea", "hurried");
  await button("Add note").click();
  await page.waitForSelector("#panel .jumps button:has-text('hurried')");
  await page.evaluate(() => globalThis.letGo());
  await studio.quiet();
  assert.equal(await page.locator("#panel .jumps button:has-text('hurried')").count(), 1);
}
