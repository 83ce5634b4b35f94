// An author of a scene of several organs: organs_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { cpSync, existsSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { authorOf } from "./author_page.mjs";
import { ctpm, leave, makeFolder, openStudio, paths, picture, step, takeUp, until } from "./browser.mjs";

let folder, studio, page;
const kScene = "my-kidney-scene.json";
const { onDisk, text, scene, button, handle, settled, write, centreOf, drag, save, taken } = authorOf(() => page, () => folder, kScene);

before(async () => {
  folder = makeFolder();
  cpSync(join(paths.source, "scenes", "organs", "kidney.obj"), join(folder, "my-kidney.obj"));
  const imported = ctpm(folder, "import", "my-kidney.obj", "-o", kScene, "--organ", "kidney", "--radius-mm", "4");
  assert.equal(imported.code, 0, imported.err);
  studio = await openStudio(folder);
  page = studio.page;
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.click("header nav button:has-text('Author')");
  await page.click(".scenes button:has-text('my-kidney-scene')");
  await settled();
});

after(() => leave(studio, folder));

step("a second mesh becomes an organ of the scene, which is moved by its handle", async () => {
  const before = await text();
  const mesh = readFileSync(join(paths.source, "scenes", "organs", "kidney.obj"));
  await page.setInputFiles(".pick input", { name: "other-kidney.obj", mimeType: "model/obj", buffer: mesh });
  await page.click("aside label:has-text('an organ of')");
  await page.waitForSelector("aside .command code:has-text('--organ kidney')");
  const shown = await page.locator("aside .command code").innerText(), other = makeFolder();
  await button("Import", "aside").click();
  await page.waitForSelector("aside .good:has-text('spheres')");
  await settled();
  const { organs, cameras } = await scene();
  // The command that it showed adds the same organ at the same place.
  for (const file of [kScene, ...JSON.parse(before).organs.map(({ mesh }) => mesh)]) cpSync(join(folder, file), join(other, file));
  writeFileSync(join(other, "other-kidney.obj"), mesh);
  writeFileSync(join(other, kScene), before);
  const done = ctpm(other, ...shown.split(" ").slice(1), "--radius-mm", String(organs[1].fill.radius_mm));
  assert.equal(done.code, 0, `${shown}: ${done.err}`);
  const added = JSON.parse(readFileSync(join(other, kScene), "utf8")).organs;
  assert.deepEqual(added.map(({ name }) => name), ["kidney", "kidney-2"]);
  for (const [i, at] of added[1].at_mm.entries()) assert.ok(Math.abs(at - organs[1].at_mm[i]) < 1, `${added[1].at_mm} and ${organs[1].at_mm}`);
  assert.deepEqual({ ...added[1].material, fitted_for: 0 }, { ...organs[1].material, fitted_for: 0 });
  // Where its stiffness was fitted lies in it by now.
  const least = (axis) => Math.min(...mesh.toString().split("\n").filter((line) => line.startsWith("v ")).map((line) => Number(line.split(/\s+/)[1 + axis]))) + organs[1].at_mm[axis];
  assert.ok(organs[1].material.fitted_for.place_mm[0] > least(0), `${organs[1].material.fitted_for.place_mm} beyond ${least(0)}`);
  rmSync(other, { recursive: true });
  assert.deepEqual(organs.map(({ name }) => name), ["kidney", "kidney-2"]); // what they are, not what their files are called
  // The camera that the import left sees both, as a picture of the command does, and so does Author.
  const [was, ...others] = JSON.parse(before).cameras;
  assert.deepEqual(cameras.slice(1), others);
  const far = ({ eye_mm, target_mm }) => Math.hypot(...eye_mm.map((x, i) => x - target_mm[i]));
  assert.ok(far(cameras[0]) > 1.2 * far(was) && cameras[0].target_mm[0] > was.target_mm[0] + 10, JSON.stringify(cameras));
  const canvas = await page.locator(".view > canvas").boundingBox();
  for (const name of ["kidney", "kidney-2"]) {
    await page.locator(".objects button", { has: page.locator(`span:text-is("${name}")`) }).click();
    const { x, y } = await centreOf(handle(name));
    assert.ok(x > canvas.x + 20 && x < canvas.x + canvas.width - 20 && y > canvas.y + 20 && y < canvas.y + canvas.height - 20, `${name}: ${x}, ${y}`);
  }
  await page.click(".objects button:has-text('kidney-2')");
  await page.waitForTimeout(300);
  await picture(page, "author-two-organs");
  // The filling begins with the organ that was chosen; a tool has none, and shows its place.
  await page.click("#tab-filling");
  assert.equal(await page.locator("#panel h2").first().textContent(), "kidney-2: its spheres");
  assert.equal(await page.locator("#panel h2").nth(1).textContent(), "kidney: its spheres");
  await page.click(".objects button:has-text('scalpel')");
  assert.equal(await page.locator("#tab-place").getAttribute("aria-selected"), "true");
  await page.click(".objects button:has-text('kidney-2')");
  await settled();
  await drag(await centreOf(handle("kidney-2")), { x: -20, y: -30 });
  const moved = (await scene()).organs[1].at_mm;
  assert.notDeepEqual(moved, organs[1].at_mm);
  await settled();
  assert.deepEqual((await save()).organs[1].at_mm, moved);
  // Both are in the history: what the mouse did, and the import.
  await page.keyboard.press("Control+z");
  assert.deepEqual((await scene()).organs[1].at_mm, organs[1].at_mm);
  await page.keyboard.press("Control+z");
  assert.equal(await text(), before);
  await page.keyboard.press("Control+Shift+z");
  await page.keyboard.press("Control+Shift+z");
  await settled();
});

step("an organ is turned by its rings and sized by its cubes, and by its text", async () => {
  const before = await text(), organ = async () => (await scene()).organs[1];
  const numbers = (nth) => page.locator("#panel .vector").nth(nth).locator("input").evaluateAll((inputs) => inputs.map((input) => Number(input.value)));
  await page.click(".objects button:has-text('kidney-2')");
  await button("turn").click();
  const middle = await centreOf(handle("kidney-2"));
  await drag({ x: middle.x + 18, y: middle.y - 14 }, { x: 60, y: 30 });
  const turned = await organ(), after = await centreOf(handle("kidney-2"));
  assert.ok(Math.max(...turned.turn_deg.map(Math.abs)) > 10, `${turned.turn_deg}`);
  assert.ok(Math.hypot(after.x - middle.x, after.y - middle.y) < 2, "its middle stays where it is");
  assert.deepEqual(await numbers(1), turned.turn_deg);
  await settled();
  await picture(page, "author-organ-turned");
  await button("size").click();
  const from = await centreOf(handle("kidney-2"));
  await drag({ x: from.x + 45, y: from.y }, { x: 30, y: 0 });
  const sized = await organ();
  assert.ok(sized.scale > 1.2, `${sized.scale}`);
  await settled();
  await picture(page, "author-organ-sized");
  // The same by its text, which the numbers follow; the program takes what was made.
  await write((await text()).replace(`"scale": ${sized.scale}`, '"scale": 1.1'));
  await settled();
  await page.click(".objects button:has-text('kidney-2')");
  await page.waitForFunction(() => [...document.querySelectorAll("#panel label")].some((label) => label.textContent.startsWith("scale of the mesh") && label.lastChild.value === "1.1"));
  assert.deepEqual((await save()).organs[1], { ...sized, scale: 1.1 });
  for (let i = 0; i < 3; ++i) await button("Undo").click();
  assert.equal(await text(), before);
  await settled();
});

step("what belongs to an organ goes with it, unless its author says otherwise", async () => {
  const before = await text(), start = await scene(), organ = start.organs[1];
  // A vertex of each organ, where the file has it; neither is turned or sized.
  const vertexOf = ({ mesh, at_mm = [0, 0, 0] }) => /^v +(\S+) +(\S+) +(\S+)/m.exec(readFileSync(join(folder, mesh), "utf8")).slice(1).map((x, i) => Number(x) + at_mm[i]);
  const [mine, other] = [vertexOf(organ), vertexOf(start.organs[0])];
  const by = (place, way) => place.map((x, i) => Math.round(100 * (x + way[i])) / 100);
  const ball = { centre_mm: by(mine, [0, 0, 0]), radius_mm: 9 }, box = { min_mm: by(mine, [-10, -12, -14]), max_mm: by(mine, [10, 12, 14]) };
  const kept = organ.anchors ?? [];
  const tool = { name: "near", kind: "ball", radius_mm: 5, at_mm: by(mine, [0, 0, 8]), pointing: [1, 0, 0] };
  const made = {
    ...start, organs: [start.organs[0], { ...organ, anchors: [...kept, { sphere: ball }, { box }] }],
    probes: [{ name: "there", at_mm: by(mine, [1, 0, 0]) }, { name: "elsewhere", at_mm: other }], tools: [...start.tools, tool],
  };
  await write(JSON.stringify(made, null, 2));
  await settled();
  const now = async () => {
    const { organs: [, { at_mm, anchors }], probes, tools } = await scene(), [{ sphere }, { box }] = anchors.slice(kept.length);
    return { at: at_mm, sphere, box, probes: probes.map((probe) => probe.at_mm), tool: tools.at(-1), first: tools[0].at_mm };
  };
  const isAt = (place, expected, what) => assert.ok(Math.hypot(...place.map((x, i) => x - expected[i])) < 0.03, `${what}: ${place} for ${expected}`);
  const stand = await now();
  await page.locator(".objects button", { has: page.locator('span:text-is("kidney-2")') }).click();
  await button("move").click();
  await drag(await centreOf(handle("kidney-2")), { x: 30, y: -12 });
  const moved = await now(), way = moved.at.map((x, i) => x - stand.at[i]);
  assert.ok(Math.hypot(...way) > 5, `${way}`);
  for (const [place, from, what] of [
    [moved.sphere.centre_mm, ball.centre_mm, "ball"], [moved.box.min_mm, box.min_mm, "box"], [moved.box.max_mm, box.max_mm, "box"],
    [moved.probes[0], stand.probes[0], "probe"], [moved.tool.at_mm, tool.at_mm, "tool"],
  ]) isAt(place, by(from, way), what);
  assert.deepEqual([moved.probes[1], moved.first], [stand.probes[1], stand.first], "what is nearer to the other organ stays");
  assert.deepEqual(moved.tool.pointing, tool.pointing);
  await settled();
  assert.match(await page.locator(".verdict").textContent(), /^good/);
  await picture(page, "author-taken-along");
  await page.keyboard.press("Control+z");
  assert.deepEqual(await now(), stand, "one step");
  // By numbers too: a quarter turn about z, through the mesh's origin, and twice the size.
  await settled();
  await page.locator("#panel .vector").nth(1).locator("input").nth(2).fill("90");
  await page.keyboard.press("Tab");
  const turned = await now(), quarter = (place) => [stand.at[0] - (place[1] - stand.at[1]), stand.at[1] + place[0] - stand.at[0], place[2]];
  isAt(turned.sphere.centre_mm, quarter(ball.centre_mm), "turned ball");
  isAt(turned.tool.pointing, [0, 1, 0], "turned tool");
  isAt(turned.box.max_mm.map((most, i) => most - turned.box.min_mm[i]), [24, 20, 28], "sides of the turned box");
  assert.equal(turned.sphere.radius_mm, 9);
  await page.keyboard.press("Control+z");
  await settled();
  await page.locator("#panel label:has-text('scale of the mesh') input").fill("2");
  await page.keyboard.press("Tab");
  const sized = await now();
  isAt(sized.sphere.centre_mm, ball.centre_mm.map((x, i) => stand.at[i] + 2 * (x - stand.at[i])), "sized ball");
  assert.equal(sized.sphere.radius_mm, 18);
  await page.keyboard.press("Control+z");
  await settled();
  // Left behind, an anchor holds nothing: its line names it, and leads to it.
  await page.click(".view-bar label:has-text('take along')");
  await drag(await centreOf(handle("kidney-2")), { x: 0, y: -160 });
  assert.deepEqual((await now()).sphere, ball);
  await settled();
  await page.waitForSelector(".problem-list button.error:has-text('holds no sphere')");
  await picture(page, "author-left-behind");
  const thing = page.locator(".problem-list li:has(button.error) button.quiet").first();
  assert.match(await thing.innerText(), /^ball \d of kidney-2$/);
  await thing.click();
  await page.waitForSelector("#panel h2:has-text('anchor: ball')");
  await page.keyboard.press("Control+z");
  await page.locator(".objects button", { has: page.locator('span:text-is("kidney-2")') }).click();
  await page.click(".view-bar label:has-text('take along')");
  await write(before);
  await settled();
});

step("how a scene and its organs behave is chosen without the text", async () => {
  const before = await text(), was = JSON.parse(before);
  await page.click("#tab-scene");
  const down = page.locator("#panel label:has-text('down is') select"), chosen = async () => (await scene()).gravity_m_per_s2;
  assert.equal(await down.inputValue(), "-z");
  await down.selectOption("-y");
  assert.deepEqual(await chosen(), [0, -9.81, 0]);
  await down.selectOption({ label: "nowhere: no gravity" });
  assert.deepEqual(await chosen(), [0, 0, 0]);
  await down.selectOption("+x");
  assert.deepEqual(await chosen(), [9.81, 0, 0], "as strong as on earth again");
  await page.click("#panel label:has-text('two hands')");
  await page.click("#panel label:has-text('sides of a cut')");
  await page.locator("#panel label:has-text('friction') input").fill("0.6");
  await page.keyboard.press("Tab");
  const { hands, lips_meet, contact_friction } = await scene();
  assert.deepEqual([hands, lips_meet, contact_friction], [2, !was.lips_meet, 0.6]);
  await picture(page, "author-behaviour");
  await page.locator(".objects button", { has: page.locator('span:text-is("kidney")') }).click();
  await page.locator("#panel label:has-text('harmed by a force') input").fill("4.5");
  await page.keyboard.press("Tab");
  await page.locator("#panel label:has-text('harmed by a press') input").fill("12");
  await page.keyboard.press("Tab");
  await page.locator("#panel label:has-text('pieces touch each other') input").click();
  await page.locator("#panel label:has-text('colour outside') input").fill("#3366ff");
  const [kidney] = (await scene()).organs;
  assert.deepEqual([kidney.damage_force_n, kidney.damage_depth_mm, kidney.meets_itself, kidney.surface_color], [4.5, 12, true, [0.2, 0.4, 1]]);
  await write(JSON.stringify({ ...await scene(), gravity_m_per_s2: [0, -6, -8] }));
  await settled();
  await page.waitForSelector(".verdict.good");
  await picture(page, "author-organ-behaviour");
  await page.click("#tab-scene");
  assert.equal(await down.inputValue(), "other");
  await down.selectOption("-z");
  assert.deepEqual(await chosen(), [0, 0, -10], "as strong as it was");
  await write(before);
  await settled();
});

step("organs are told to touch each other, removed, and the scene is saved under another name", async () => {
  const before = await text();
  await page.click("#tab-scene");
  const touch = page.locator("#panel label:has-text('organs touch each other') input");
  await touch.click();
  assert.equal((await scene()).organs_meet, true);
  await touch.click();
  assert.equal(await text(), before);
  await page.locator(".objects button", { has: page.locator('span:text-is("kidney-2")') }).click();
  await page.locator("#panel .remove").click();
  assert.deepEqual((await scene()).organs.map(({ name }) => name), ["kidney"]);
  assert.equal(await button("Undo").getAttribute("title"), "Undo kidney-2 (Ctrl+Z)");
  await page.locator(".objects button", { has: page.locator('span:text-is("kidney")') }).click();
  assert.equal(await page.locator("#panel .remove").count(), 0, "the last one stays");
  await button("Save a copy…").click();
  await page.locator(".copy-name input").fill(kScene.replace(".json", ""));
  await button("Save the copy").click();
  await page.waitForSelector(".conflict .problems:has-text('exists already')");
  await page.locator(".copy-name input").fill("one kidney");
  await picture(page, "author-copy");
  await button("Save the copy").click();
  await page.waitForSelector(".scenes button[aria-current=true]:has-text('one kidney')");
  await settled();
  assert.equal(JSON.parse(onDisk("one kidney.json")).organs.length, 1);
  assert.equal(JSON.parse(onDisk("one kidney.json")).name, "one kidney", "recordings tell it from the other one");
  assert.equal(ctpm(folder, "check", "one kidney.json").code, 0);
  assert.equal(JSON.parse(onDisk()).organs.length, 2);
  await page.locator(".scenes button", { has: page.locator(`span:text-is("${kScene.replace(".json", "")}")`) }).click();
  await settled();
  await page.keyboard.press("Control+z");
  assert.equal(await text(), before);
  await settled();
});

step("a scene is tried at once, as it is on the screen, and nothing is kept", async () => {
  await page.click(".objects button:has-text('ball')");
  const files = readdirSync(folder).sort(), organs = (await scene()).organs.length;
  assert.equal(organs, 2);
  // The scene does not say where its ball is taken up; Author shows it where that will be.
  assert.equal((await scene()).tools.find(({ name }) => name === "ball").at_mm, undefined);
  const inPicture = async ({ x, y }) => {
    const box = await page.locator(".view > canvas").boundingBox();
    return [x - box.x - box.width / 2, y - box.y - box.height / 2].map((away) => away / box.width);
  };
  const shown = await inPicture(await centreOf(handle("ball")));
  const started = Date.now();
  await button("Try it").click();
  await page.waitForSelector(".view.running .force-bar");
  const tool = await takeUp(page), tried = await inPicture(tool);
  assert.ok(Math.hypot(tried[0] - shown[0], tried[1] - shown[1]) < 0.005, `${shown} and ${tried}, in widths of the picture`);
  console.log(`author: from "Try it" to a scene of ${organs} organs in the hand ${Date.now() - started} ms`);
  const force = async () => Number.parseFloat(await page.locator(".force-bar output").innerText());
  // As slowly as a hand: the ball follows, and is not far in the organ before its force is seen.
  for (let i = 0; i < 120 && (await force()) < 1; ++i) await page.mouse.move(tool.x, tool.y + 2 * i), await page.waitForTimeout(30);
  assert.ok((await until(force, (newtons) => newtons > 0.1)) > 0.1);
  await picture(page, "author-try");
  await page.keyboard.press("Escape");
  await page.waitForSelector("button:has-text('Train again')");
  assert.deepEqual(readdirSync(folder).sort(), files);
  assert.ok(!existsSync(join(folder, "mine-1.ctpm")));
});

step("every scene that was saved is one that the program takes", taken);

step("nothing was complained about", () => assert.deepEqual(studio.complaints, []));
