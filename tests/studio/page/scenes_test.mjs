// An author who renames scenes, removes them and brings them back, and how they look: scenes_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { cpSync, existsSync, readdirSync, readFileSync, renameSync, unlinkSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { authorOf } from "./author_page.mjs";
import { ctpm, leave, makeFolder, openStudio, outOfReach, overflow, picture, pixelsOf, seriousFindings, step, until } from "./browser.mjs";

const kExpert = "kidney-cut-expert.ctpm", kCourse = '{"format": "ctpm-course", "tasks": [{"name": "cut", "scene": "kidney.json"}]} // mine';
let folder, studio, page;
const { onDisk, text, button, settled, write } = authorOf(() => page, () => folder, "kidney.json");
const read = (name) => readFileSync(join(folder, name), "utf8");
const has = (name) => existsSync(join(folder, name));
const listed = () => page.locator(".scenes li > button:first-child").allInnerTexts();
const more = (name) => page.locator(`.scenes button[aria-label="Rename or remove ${name}"]`);
const form = () => page.locator(".scene-form").first();
const open = async (name) => (await page.click(`.scenes button:has(span:text-is("${name}"))`), await settled());

before(async () => {
  folder = makeFolder("kidney.json", "skin.json", kExpert);
  writeFileSync(join(folder, "course.json"), kCourse);
  cpSync(join(folder, "skin.json"), join(folder, "skin-2.json"));
  studio = await openStudio(folder);
  page = studio.page;
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.click("header nav button:has-text('Author')");
  await open("kidney");
});

after(() => leave(studio, folder));

step("a scene that is renamed keeps its text, what is not saved, its history and who names it", async () => {
  const before = onDisk(), changed = before.replace('"name": "kidney"', '"name": "mine"');
  await write(changed);
  await settled();
  await more("kidney").click();
  await form().locator("input").fill("skin");
  await button("Rename", ".scene-form").click();
  await page.waitForSelector(".scene-form .problems:has-text('exists already')");
  await form().locator("input").fill("../kidney");
  assert.ok(await button("Rename", ".scene-form").isDisabled());
  await form().locator("input").fill("left kidney");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".scene-form:has-text('so it is named in course.json')");
  await picture(page, "author-renamed");
  await button("Close", ".scene-form").click();
  assert.equal(read("course.json"), kCourse.replace("kidney.json", "left kidney.json"));
  assert.ok(!has("kidney.json") && read("left kidney.json") === before);
  assert.deepEqual(await until(listed, (names) => names.includes("left kidney")), ["left kidney", "skin-2", "skin"]);
  await settled();
  assert.equal(await page.locator(".scenes button[aria-current=true]").innerText(), "left kidney");
  assert.equal(await text("left kidney.json"), changed);
  assert.match(await page.locator(".verdict").innerText(), /not saved/);
  await page.waitForTimeout(2500); // the file is looked for
  assert.equal(await page.locator(".conflict").count(), 0);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector(".verdict").textContent.endsWith(", saved"));
  assert.equal(read("left kidney.json"), changed);
  await page.locator(".view > canvas").focus();
  await page.keyboard.press("Control+z");
  await page.keyboard.press("Control+s");
  assert.equal(await until(() => read("left kidney.json"), (now) => now === before), before);
  // One that is not open has a draft, too, and goes on being another scene.
  await open("skin");
  await more("left kidney").click();
  await form().locator("input").fill("kidney");
  await page.keyboard.press("Enter");
  await button("Close", ".scene-form").click();
  assert.deepEqual(await until(listed, (names) => names.includes("kidney")), ["kidney", "skin-2", "skin"]);
  assert.equal(await page.locator(".scenes button[aria-current=true]").innerText(), "skin");
});

step("who removes a scene hears what goes and what stays, and gets it back at once", async () => {
  await open("kidney");
  const before = onDisk(), session = read(kExpert), changed = before.replace('"ball", "kind"', '"bead", "kind"');
  await write(changed);
  await settled();
  await more("kidney").click();
  await button("Remove…", ".scene-form").click();
  await page.waitForSelector(".scene-form:has-text('Remove kidney?')");
  const said = await until(() => form().innerText(), (text) => text.includes("1 session of a scene named kidney"));
  for (const words of ["kidney.json", "organs/kidney.obj", "course.json stays: it names the scene", "What is not saved of it goes too"]) assert.ok(said.includes(words), said);
  assert.deepEqual(await seriousFindings(page), []);
  await picture(page, "author-remove");
  for (const [width, height] of [[1920, 1080], [820, 1180]]) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(300);
    assert.ok((await overflow(page)) <= 0, `${width}x${height}`);
    await picture(page, `author-remove-${width}x${height}`);
  }
  await page.setViewportSize({ width: 1280, height: 720 });
  // Back changes nothing.
  await page.keyboard.press("Escape");
  assert.equal(await page.locator(".scene-form").count(), 0);
  await more("kidney").click();
  await button("Remove…", ".scene-form").click();
  await button("Remove", ".scene-form").click();
  await page.waitForSelector(".scene-form:has-text('kidney was removed')");
  assert.ok(!has("kidney.json") && !has("organs/kidney.obj") && has(".ctpm-removed/1/organs/kidney.obj"));
  assert.equal(read(kExpert), session);
  assert.deepEqual(await listed(), ["skin-2", "skin"]);
  await page.waitForSelector(".view .empty:has-text('Drop a mesh')");
  assert.equal(await page.evaluate(() => localStorage.getItem("ctpm.draft:kidney.json")), null);
  await picture(page, "author-removed");
  assert.deepEqual(await seriousFindings(page), []);
  // Its session replays without it.
  const verdict = ctpm(folder, "verify", kExpert);
  assert.equal(verdict.code, 0, verdict.err);
  // It is still there when the author has been in another room; back comes what was not saved, and the history.
  await page.click("header nav button:has-text('Review')");
  await page.click("header nav button:has-text('Author')");
  await button("Undo", ".scene-form").click();
  await page.waitForSelector(".scenes button[aria-current=true]:has-text('kidney')");
  await settled();
  assert.ok(onDisk() === before && has("organs/kidney.obj") && !has(".ctpm-removed/1"));
  assert.equal(await text(), changed);
  await page.locator(".view > canvas").focus();
  await page.keyboard.press("Control+z");
  assert.equal(await text(), before);
});

step("two tabs of a browser have one text of a scene, whoever of them changes, undoes or saves it", async () => {
  const before = onDisk(), name = (text) => before.replace('"name": "kidney"', `"name": "${text}"`);
  const top = (text) => text.slice(0, 80); // what the editor draws of it
  const other = await page.context().newPage();
  await other.goto(studio.address);
  await other.click("header nav button:has-text('Author')");
  await other.click(".scenes button:has(span:text-is('kidney'))");
  const there = authorOf(() => other, () => folder, "kidney.json");
  const shows = (tab, text) => tab.waitForFunction((wanted) => document.querySelector(".editor").shadowRoot.querySelector(".cm-content").innerText.startsWith(wanted), top(text));
  const says = (tab, verdict) => tab.waitForFunction((ending) => document.querySelector(".verdict").textContent.endsWith(ending), verdict);
  await there.settled();
  await there.write(name("theirs"));
  await shows(page, name("theirs"));
  await says(page, ", not saved");
  // Who trains meanwhile trains in the file.
  await other.click("header nav button:has-text('Train')");
  await other.waitForSelector(".room.train .draft:has-text('without its unsaved changes')");
  await other.click("header nav button:has-text('Author')");
  await there.settled();
  await page.bringToFront();
  await write(name("mine"));
  await shows(other, name("mine"));
  // What the other tab did is a step of the history here.
  for (const text of [name("theirs"), before]) {
    await page.click(".author button:text-is('Undo')");
    await shows(page, text);
    await shows(other, text);
  }
  await says(other, ", saved");
  await write(name("saved"));
  await shows(other, name("saved"));
  await page.keyboard.press("Control+s");
  for (const tab of [page, other]) await says(tab, ", saved");
  assert.equal(onDisk(), name("saved"));
  await other.close();
  await page.click(".author button:text-is('Undo')");
  await page.keyboard.press("Control+s");
  await says(page, ", saved");
  assert.equal(onDisk(), before);
});

step("a place that is taken, and a scene that is open elsewhere, stay as they are, and it is said", async () => {
  await more("skin-2").click();
  await button("Remove…", ".scene-form").click();
  assert.match(await until(() => form().innerText(), (text) => text.includes("stays:")), /organs\/skin\.obj stays: skin\.json uses it/);
  // What goes has changed since it was said.
  writeFileSync(join(folder, "skin-2.script.json"), '{"format": "ctpm-script"}');
  await button("Remove", ".scene-form").click();
  await page.waitForSelector(".scene-form .problems:has-text('other files than these')");
  assert.ok(has("skin-2.json"));
  renameSync(join(folder, "skin-2.script.json"), join(folder, "else.json"));
  await button("Remove", ".scene-form").click();
  await page.waitForSelector(".scene-form:has-text('skin-2 was removed')");
  writeFileSync(join(folder, "skin-2.json"), "somebody else's");
  await button("Undo", ".scene-form").click();
  await page.waitForSelector(".scene-form .problems:has-text('exists already')");
  assert.equal(read("skin-2.json"), "somebody else's");
  await button("Close", ".scene-form").click();
  // In another tab it is shown.
  const other = await page.context().newPage();
  await other.goto(studio.address);
  await other.click("header nav button:has-text('Author')");
  await other.click(".scenes button:has(span:text-is('skin'))");
  await other.waitForSelector(".verdict[aria-busy=false]");
  await page.bringToFront(); // a page in the back draws once a second
  await more("skin").click();
  await form().locator("input").fill("hide");
  await button("Rename", ".scene-form").click();
  await page.waitForSelector(".scene-form .problems:has-text('open in another page')");
  await button("Remove…", ".scene-form").click();
  await page.waitForSelector(".scene-form .problems:has-text('open in another page')");
  await picture(page, "author-open-elsewhere");
  // Who leaves the room gives it free, unless something is not saved; a draft in the browser keeps nothing.
  const refusedNow = async () => (await button("Remove…", ".scene-form").click(), until(() => form().innerText(), (text) => /Remove skin\?|not saved/.test(text)));
  await other.click("header nav button:has-text('Review')");
  await page.waitForTimeout(300);
  await button("Remove…", ".scene-form").click();
  await page.waitForSelector(".scene-form:has-text('Remove skin?')");
  await button("Back", ".scene-form").click();
  await more("skin").click();
  await other.click("header nav button:has-text('Author')");
  await other.waitForSelector(".verdict[aria-busy=false]");
  await other.locator(".cm-content").click();
  await other.keyboard.press("Control+End");
  await other.keyboard.type(" ");
  await other.waitForSelector(".verdict:has-text('not saved')");
  await other.click("header nav button:has-text('Review')");
  await page.waitForTimeout(300);
  assert.match(await refusedNow(), /changes in another page that are not saved/);
  await form().locator("input").fill("hide");
  await other.close();
  assert.ok(has("skin.json") && !has("hide.json"));
  await until(async () => (await button("Rename", ".scene-form").click({ timeout: 500 }).catch(() => {}), has("hide.json")), (done) => done);
  assert.ok(has("hide.json"));
  // The page moves the draft when it hears of it.
  const drafts = () => page.evaluate(() => ["skin", "hide"].map((name) => localStorage.getItem(`ctpm.draft:${name}.json`) !== null));
  assert.deepEqual(await until(drafts, ([skin]) => !skin), [false, true]);
  await page.evaluate(() => localStorage.removeItem("ctpm.draft:hide.json"));
});

step("by keyboard too", async () => {
  assert.deepEqual(await outOfReach(page), []);
  await more("hide").focus();
  await page.keyboard.press("Enter");
  await page.waitForSelector(".scene-form input:focus");
  await page.keyboard.type("skin"); // over the old name, which is selected
  await page.keyboard.press("Enter");
  assert.deepEqual(await until(listed, (names) => names.includes("skin")), ["kidney", "skin"]);
  await more("skin").focus();
  await page.keyboard.press("Enter");
  await page.waitForSelector(".scene-form input:focus");
  for (const key of ["Tab", "Enter"]) await page.keyboard.press(key);
  await page.waitForSelector(".scene-form button:focus:text-is('Remove')");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".scene-form:has-text('skin was removed')");
  await button("Undo", ".scene-form").focus();
  await page.keyboard.press("Enter");
  assert.deepEqual(await until(listed, (names) => names.includes("skin")), ["kidney", "skin"]);
});

step("files that a command has made meanwhile are listed as soon as somebody looks, in each room", async () => {
  const come = () => page.evaluate(() => dispatchEvent(new Event("focus"))), room = (name) => page.click(`header nav button:has-text('${name}')`);
  cpSync(join(folder, "skin.json"), join(folder, "late.json"));
  await page.locator("header nav button").first().focus();
  assert.ok(!(await listed()).includes("late"));
  await more("skin").focus(); // into the list
  assert.ok((await until(listed, (names) => names.includes("late"))).includes("late"));
  unlinkSync(join(folder, "late.json"));
  await come();
  assert.deepEqual(await until(listed, (names) => !names.includes("late")), ["kidney", "skin"]);
  const late = page.locator(".list button:has-text('late')");
  for (const [name, from, to] of [["Review", kExpert, "late.ctpm"], ["Train", "skin.json", "late.json"]]) {
    await room(name);
    await page.waitForSelector(".list button");
    cpSync(join(folder, from), join(folder, to));
    await come();
    await late.waitFor();
    unlinkSync(join(folder, to));
    await come();
    await late.waitFor({ state: "detached" });
  }
  await room("Author");
  await page.waitForSelector(".scenes button");
});

step("what was removed stands at the end of the list, until it is brought back or deleted for good", async () => {
  const gone = page.locator("details.removed-scenes"), heading = gone.locator("summary"), one = (name) => gone.locator(`li:has(> span:text-is("${name}"))`);
  await open("kidney");
  const before = onDisk(), changed = before.replace('"ball", "kind"', '"bead", "kind"');
  await write(changed);
  await settled();
  await more("kidney").click();
  await button("Remove…", ".scene-form").click();
  await button("Remove", ".scene-form").click();
  await page.waitForSelector(".scene-form:has-text('kidney was removed')");
  // Nothing is kept in the page itself; beside it stands what was removed above, whose place is taken by now.
  await page.reload();
  await page.click("header nav button:has-text('Author')");
  assert.match(await heading.innerText(), /^Removed scenes\s+2$/);
  assert.equal(await gone.getAttribute("open"), null);
  await picture(page, "author-removed-closed");
  await heading.focus();
  await page.keyboard.press("Enter");
  assert.match(await one("kidney").innerText(), /20\d\d.*, \d+ kB/);
  assert.deepEqual(await outOfReach(page), []);
  await gone.locator("button[aria-label='Delete kidney for good']").focus();
  await page.keyboard.press("Enter");
  const asked = gone.locator("[role=group][aria-label='Delete kidney for good']");
  await page.waitForFunction(() => document.activeElement.textContent === "Back"); // a key pressed twice deletes nothing
  const said = await asked.innerText();
  for (const words of [/Delete kidney for good\? Nothing brings these \d+ kB back/, /kidney\.json\s+\d/, /organs\/kidney\.obj\s+\d/, /What is not saved of it goes too/]) assert.match(said, words);
  assert.deepEqual(await seriousFindings(page), []);
  for (const [width, height] of [[1280, 720], [820, 1180]]) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(300);
    assert.ok((await overflow(page)) <= 0, `${width}x${height}`);
    await asked.scrollIntoViewIfNeeded();
    await picture(page, `author-delete-${width}x${height}`);
  }
  await page.setViewportSize({ width: 1280, height: 720 });
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => document.activeElement.textContent === "Delete…");
  assert.ok(has(".ctpm-removed/1/kidney.json") || has(".ctpm-removed/2/kidney.json"));
  // Back comes what was not saved, too.
  await gone.locator("button[aria-label='Bring back kidney']").click();
  assert.ok((await until(listed, (names) => names.includes("kidney"))).includes("kidney"));
  await until(() => heading.innerText(), (text) => /1$/.test(text));
  assert.ok(onDisk() === before && has("organs/kidney.obj"));
  assert.equal(await text(), changed);
  await gone.locator("button[aria-label='Bring back skin-2']").click();
  await gone.locator(".problems:has-text('exists already')").waitFor();
  await gone.locator("button[aria-label='Delete skin-2 for good']").click();
  await button("Delete", "details.removed-scenes .scene-form").click();
  await gone.waitFor({ state: "detached" });
  assert.deepEqual(readdirSync(join(folder, ".ctpm-removed")), []);
  assert.equal(read("skin-2.json"), "somebody else's");
  await page.evaluate(() => localStorage.removeItem("ctpm.draft:kidney.json"));
  await page.reload();
  await page.click("header nav button:has-text('Author')");
  await page.waitForSelector(".scenes li");
  assert.equal(await gone.count(), 0);
});

/** A picture of the open scene, shown in one of the ways that its buttons name. */
async function shownAs(how) {
  await button(how, ".view-bar").click();
  await page.waitForTimeout(1200); // the fine picture
  const { x, y, width, height } = await page.locator(".view > canvas").boundingBox();
  return page.screenshot({ clip: { x, y: y + 44, width, height: height - 44 } });
}
/** In how many pixels two pictures differ. */
function apart(a, b) {
  const [p, q] = [a, b].map((png) => pixelsOf(png).data);
  let count = 0;
  for (let i = 0; i < p.length; i += 4) count += Math.abs(p[i] - q[i]) + Math.abs(p[i + 1] - q[i + 1]) + Math.abs(p[i + 2] - q[i + 2]) > 30;
  return count;
}

step("where both are shown, the surface is seen around its spheres, on a dark organ and on a bright one", async () => {
  for (const name of ["kidney", "skin"]) {
    await open(name);
    const surface = await shownAs("surface"), both = await shownAs("both");
    await picture(page, `author-both-${name}`);
    const spheres = await shownAs("spheres");
    // What of the organ's picture is neither as its spheres nor as its surface alone: both are seen there.
    const ofSurface = apart(both, spheres), ofSpheres = apart(both, surface);
    console.log(`author: ${name} shown as both differs from its spheres in ${ofSurface} pixels, from its surface in ${ofSpheres}`);
    assert.ok(ofSurface > 25000 && ofSpheres > 25000, `${ofSurface}, ${ofSpheres}`);
    await button("surface", ".view-bar").click();
  }
});

step("nothing was complained about", () => assert.deepEqual(studio.complaints, []));
