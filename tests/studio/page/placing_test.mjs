// An author who places things in a scene with the mouse: placing_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { authorOf } from "./author_page.mjs";
import { ctpm, leave, makeFolder, openStudio, outOfReach, picture, step, until } from "./browser.mjs";

let folder, studio, page;
const kScene = "kidney.json";
const { onDisk, text, scene, button, handle, settled, write, centreOf, drag, untilSaved, save, taken } = authorOf(() => page, () => folder, kScene);

before(async () => {
  folder = makeFolder(kScene);
  studio = await openStudio(folder);
  page = studio.page;
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.click("header nav button:has-text('Author')");
  await page.click(".scenes button:has-text('kidney')");
  await settled();
});

after(() => leave(studio, folder));

/** Distance of a place from the nearest vertex of the mesh [mm]. */
function fromMesh(place) {
  const vertices = readFileSync(join(folder, "organs/kidney.obj"), "utf8").split("\n").filter((line) => line.startsWith("v "));
  return Math.min(...vertices.map((line) => Math.hypot(...line.split(/\s+/).slice(1, 4).map((x, i) => Number(x) - place[i]))));
}

step("a tool without a place goes where its handle is dragged, and no name covers another", async () => {
  assert.ok(JSON.parse(onDisk()).tools.every((tool) => tool.at_mm === undefined));
  const before = await centreOf(handle("ball"));
  await drag(before, { x: 30, y: -20 });
  await settled();
  const ball = await centreOf(handle("ball"));
  assert.ok(Math.hypot(ball.x - before.x - 30, ball.y - before.y + 20) < 3, JSON.stringify([before, ball]));
  // Beside each other on one line, the scalpel's name would be on the ball and its name.
  const names = async () => {
    const boxes = await page.locator(".handle span:visible").evaluateAll((spans) => spans.map((span) => span.getBoundingClientRect().toJSON()));
    const dots = await page.locator(".handle:visible").evaluateAll((handles) => handles.map((h) => h.getBoundingClientRect().toJSON()));
    return { boxes, dots };
  };
  const meet = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
  for (const [x, y] of [[-14, 4], [0, 0], [-30, 0], [40, 3]]) {
    const from = await centreOf(handle("scalpel")), to = await centreOf(handle("ball"));
    await drag(from, { x: to.x + x - from.x, y: to.y + y - from.y });
    await settled();
    const { boxes, dots } = await names();
    assert.equal(boxes.length, 2);
    assert.ok(!meet(boxes[0], boxes[1]), `${x}, ${y}: ${JSON.stringify(boxes)}`);
    for (const box of boxes) assert.ok(!dots.some((dot) => meet(box, dot)), `${x}, ${y}: ${JSON.stringify([box, dots])}`);
    if (x === -14) await picture(page, "author-names-apart");
  }
});

step("a probe is dragged over the surface", async () => {
  await button("+ probe", ".objects").click();
  const added = (await scene()).probes[0];
  assert.equal(added.name, "probe");
  assert.ok(fromMesh(added.at_mm) < 4, `${added.at_mm}`);
  await drag(await centreOf(handle("probe")), { x: -70, y: 20 });
  const moved = (await scene()).probes[0].at_mm;
  assert.ok(Math.hypot(...moved.map((x, i) => x - added.at_mm[i])) > 8, `${added.at_mm} to ${moved}`);
  assert.ok(fromMesh(moved) < 4, `${moved}`);
  const numbers = await page.locator("#panel .vector input").evaluateAll((inputs) => inputs.map((input) => Number(input.value)));
  assert.deepEqual(numbers, moved);
  await picture(page, "author-probe");
  // Its number moves it, and so does an arrow key.
  await page.locator("#panel .vector input").first().fill("3.5");
  await page.locator("#panel .vector input").first().press("Tab");
  assert.equal((await scene()).probes[0].at_mm[0], 3.5);
  await handle("probe").focus();
  await page.keyboard.press("ArrowUp");
  assert.notDeepEqual((await scene()).probes[0].at_mm, [3.5, moved[1], moved[2]]);
  assert.equal((await save()).probes.length, 1);
  assert.deepEqual(await outOfReach(page), []);
});

step("a tool stands where it was dragged to, and is taken up there", async () => {
  await page.click(".objects button:has-text('scalpel')");
  await drag(await centreOf(handle("scalpel")), { x: 10, y: 130 });
  const { at_mm: at, pointing } = (await save()).tools.find((tool) => tool.name === "scalpel");
  assert.ok(fromMesh(at) < 6, `${at}`);
  assert.ok(Math.abs(Math.hypot(...pointing) - 1) < 1e-3);
  await settled();
  await picture(page, "author-tool");
  await button("turn").click();
  const before = (await scene()).tools.find((tool) => tool.name === "scalpel"), middle = await centreOf(handle("scalpel"));
  await drag({ x: middle.x + 18, y: middle.y - 14 }, { x: 50, y: 30 });
  const turned = (await scene()).tools.find((tool) => tool.name === "scalpel");
  await picture(page, "author-turn");
  assert.deepEqual(turned.at_mm, before.at_mm);
  const angle = (Math.acos(Math.min(1, before.pointing.reduce((sum, x, i) => sum + x * turned.pointing[i], 0))) * 180) / Math.PI;
  const facing = (Math.acos(Math.min(1, before.facing.reduce((sum, x, i) => sum + x * turned.facing[i], 0))) * 180) / Math.PI;
  assert.ok(Math.max(angle, facing) > 5, `turned by ${angle} and ${facing} degrees`);
  assert.ok(Math.abs(turned.pointing.reduce((sum, x, i) => sum + x * turned.facing[i], 0)) < 1e-3, "pointing and facing stay square");
  await page.keyboard.press("Control+z");
  assert.deepEqual((await scene()).tools.find((tool) => tool.name === "scalpel"), before);
  await settled();
  // It is tried as its author sees it: the tool is where its handle was in the picture.
  await page.locator(".view canvas").focus();
  for (const key of ["d", "d", "d", "d", "w", "-"]) await page.keyboard.press(key);
  await page.waitForTimeout(200);
  const fromMiddle = async (locator) => {
    const at = await centreOf(locator), box = await page.locator(".view canvas").boundingBox();
    return [at.x - box.x - box.width / 2, at.y - box.y - box.height / 2].map((x) => x / box.width);
  };
  const first = await fromMiddle(handle("ball"));
  await button("Try it").click();
  await page.waitForSelector(".view.running .force-bar");
  await page.mouse.move(2, 700);
  await page.waitForSelector(".take-up");
  const tried = await fromMiddle(page.locator(".take-up"));
  assert.ok(Math.hypot(tried[0] - first[0], tried[1] - first[1]) < 0.005, `${first} and ${tried}, in widths of the picture`);
  assert.equal(await page.locator(".recorded").textContent(), "not recorded");
  await page.keyboard.press("Escape");
  await page.waitForSelector("button:has-text('Train again')");
  await page.click("button:has-text('Back to Author')"); // to the same scene
  await page.waitForSelector(`.scenes button[aria-current=true]:has-text('kidney')`);
  await settled();
});

step("a box anchor gets another size by its cubes", async () => {
  await page.locator(".objects section:has(h2:text-is(\"Anchors\")) button:text-is(\"+ box\")").click();
  await settled();
  const before = (await scene()).organs[0].anchors.at(-1).box;
  await button("size").click();
  // Its cube to the right is dragged with the mouse: the box grows along x alone, about its middle.
  const middle = await centreOf(handle(await page.locator(".handle[aria-pressed=true] span").textContent()));
  await drag({ x: middle.x + 64, y: middle.y + 2 }, { x: 30, y: 1 });
  const wide = (await scene()).organs[0].anchors.at(-1).box;
  await picture(page, "author-box");
  const sizeOf = (box) => box.max_mm.map((most, i) => most - box.min_mm[i]), [was, is] = [sizeOf(before), sizeOf(wide)];
  assert.ok(is[0] > 1.2 * was[0], `${was} and ${is}`);
  assert.ok(Math.abs(is[1] - was[1]) < 0.02 && Math.abs(is[2] - was[2]) < 0.02, `${was} and ${is}`);
  for (let i = 0; i < 3; ++i) assert.ok(Math.abs(wide.max_mm[i] + wide.min_mm[i] - before.max_mm[i] - before.min_mm[i]) < 0.05);
  await page.locator("#panel .vector").nth(1).locator("input").first().fill("60");
  await page.keyboard.press("Tab");
  const after = (await scene()).organs[0].anchors.at(-1).box;
  assert.equal(after.max_mm[0], 60);
  assert.deepEqual(after.min_mm, wide.min_mm);
  await page.locator(".remove").click();
  assert.equal((await save()).organs[0].anchors.some((anchor) => anchor.box), false);
});

step("a click on an organ's surface chooses the organ; a drag from there turns the view and chooses nothing", async () => {
  const view = await page.locator(".view canvas").boundingBox(), chosen = () => page.locator("#panel h2").first().innerText();
  const at = (x, y) => ({ x: view.x + x * view.width, y: view.y + y * view.height }), middle = at(0.5, 0.5), nothing = at(0.97, 0.95);
  const surface = { x: middle.x + 140, y: middle.y - 15 }; // beside the arrows around the probe
  await page.click(".objects button:has-text('probe')");
  await page.waitForSelector("#panel h2:has-text('probe: probe')");
  await page.mouse.click(nothing.x, nothing.y);
  await page.mouse.move(surface.x, surface.y);
  await page.mouse.down();
  for (const x of [20, 40, 20, 0]) await page.mouse.move(surface.x + x, surface.y);
  await page.mouse.up();
  await settled();
  assert.match(await chosen(), /probe: probe/i);
  // Arrow keys in the picture move what is chosen, as is said beside it.
  const hint = await page.locator("#panel .hint").first().innerText();
  assert.match(hint, /drag turns the view, and the wheel zooms\. Where its handle has the focus, arrow keys move it by 1 mm, with Shift by 0\.1 mm\./);
  const place = async () => (await scene()).probes[0].at_mm, before = await text(), was = await place();
  for (const [key, way] of [["ArrowUp", 1], ["Shift+ArrowUp", 1.1]]) {
    await page.keyboard.press(key);
    const moved = Math.hypot(...(await place()).map((x, i) => x - was[i]));
    assert.ok(Math.abs(moved - way) < 0.02, `${key}: ${moved} mm`);
  }
  while ((await text()) !== before) await page.keyboard.press("Control+z");
  await page.mouse.click(surface.x, surface.y);
  await page.waitForSelector("#panel h2:has-text('organ: kidney')");
  await picture(page, "author-clicked-organ");
  assert.equal(await text(), before);
});

step("anchors are painted by the brush; a stroke is one step", async () => {
  const before = await text(), anchors = (await scene()).organs[0].anchors.length;
  await page.click(".objects button:has-text('paint')");
  const view = await page.locator(".view canvas").boundingBox();
  await drag({ x: view.x + 0.5 * view.width, y: view.y + 0.5 * view.height }, { x: 90, y: 10 }, 20);
  const painted = (await scene()).organs[0].anchors;
  assert.ok(painted.length > anchors + 1, `${painted.length}`);
  for (const anchor of painted.slice(anchors)) assert.ok(fromMesh(anchor.sphere.centre_mm) < 4);
  await settled();
  await picture(page, "author-brush");
  // A press on a ball's handle is the brush's too: it erases the ball, and nothing is chosen or unfolds in the list.
  const ball = await centreOf(handle(`ball ${painted.length - 1}`));
  await page.keyboard.down("Shift");
  await drag(ball, { x: 0, y: 0 }, 1);
  await page.keyboard.up("Shift");
  const erased = (await scene()).organs[0].anchors;
  assert.ok(erased.length < painted.length && erased.length > anchors, `${erased.length} of ${painted.length}`);
  assert.equal(await page.locator(".handle[aria-pressed=true], .objects li button[aria-current=true], .objects .stroke details[open]").count(), 0);
  await page.keyboard.press("Control+z");
  const beside = await centreOf(handle(`ball ${painted.length}`));
  await drag(beside, { x: 0, y: -40 }, 8);
  const more = (await scene()).organs[0].anchors;
  assert.ok(more.length > painted.length, "it paints from there");
  assert.deepEqual(more.slice(0, painted.length), painted, "and moves no ball");
  await page.keyboard.press("Control+z");
  assert.deepEqual((await scene()).organs[0].anchors, painted);
  await settled();
  await page.keyboard.press("Escape");
  // One row of the list, which opens: each of its balls can be chosen, and all of them removed.
  const row = page.locator(".objects .stroke"), balls = painted.length - anchors;
  assert.match(await row.locator("summary").innerText(), new RegExp(`^${balls} balls of [\\d.]+ mm$`));
  assert.equal(await row.locator("li button:visible").count(), 0);
  await row.locator("summary").click();
  assert.equal(await row.locator("li button:visible").count(), balls);
  assert.deepEqual(await outOfReach(page), []);
  assert.equal(await row.locator("li button[tabindex='0']").count(), 1);
  await row.locator("li button[tabindex='0']").focus();
  await page.keyboard.press("ArrowDown");
  assert.ok(await row.locator("li button").nth(1).evaluate((control) => control === document.activeElement && control.tabIndex === 0));
  // Their handles are one stop of the tabulator. Arrow keys go from one to the next, until one is chosen: then they move it.
  await row.locator("li button").nth(1).click();
  await page.waitForSelector("#panel h2:has-text('anchor: ball')");
  await picture(page, "author-stroke");
  const chosen = page.locator(".handle[aria-pressed=true]");
  await chosen.focus();
  await page.keyboard.press("Escape");
  assert.equal(await chosen.count(), 0);
  const stops = page.locator(".handle.anchor[tabindex='0']:visible");
  assert.equal(await stops.count(), 1);
  await stops.focus();
  const focused = () => page.evaluate(() => document.activeElement.textContent);
  await page.keyboard.press("End");
  assert.equal(await focused(), `ball ${painted.length}`);
  await page.keyboard.press("ArrowLeft");
  assert.equal(await focused(), `ball ${painted.length - 1}`);
  assert.match(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), new RegExp(`one of ${painted.length - anchors}; arrow keys go to the others`));
  assert.deepEqual((await scene()).organs[0].anchors, painted, "no ball moved");
  await page.keyboard.press("Enter");
  await page.waitForSelector(`#panel h2:has-text('ball ${painted.length - 1}')`);
  await page.keyboard.press("ArrowUp");
  const nudged = (await scene()).organs[0].anchors;
  assert.notDeepEqual(nudged.at(-2), painted.at(-2));
  assert.deepEqual(nudged.toSpliced(-2, 1), painted.toSpliced(-2, 1));
  await page.keyboard.press("Control+z");
  await page.keyboard.press("Escape");
  await page.keyboard.press("Home");
  assert.equal(await focused(), `ball ${anchors + 1}`);
  assert.deepEqual((await scene()).organs[0].anchors, painted);
  await row.locator("button:has-text('remove them all')").click();
  assert.equal((await scene()).organs[0].anchors?.length ?? 0, anchors);
  await page.keyboard.press("Control+z");
  assert.deepEqual((await scene()).organs[0].anchors, painted);
  await page.keyboard.press("Control+z");
  assert.equal(await text(), before);
  await page.keyboard.press("Control+Shift+z");
  assert.deepEqual((await save()).organs[0].anchors, painted);
});

step("the view turns about what is up, and calmly where it looks straight down", async () => {
  const view = await page.locator(".view canvas").boundingBox(), before = await text(), kDegree = Math.PI / 180;
  const at = { x: view.x + 0.96 * view.width, y: view.y + 0.12 * view.height };
  /** Where it is seen from: around what is up, and above the horizon [degrees]. */
  const seen = async () => {
    await button("+ this view", ".objects").click();
    const { eye_mm, target_mm, up } = (await scene()).cameras.at(-1), [x, y, z] = eye_mm.map((e, i) => e - target_mm[i]);
    await page.keyboard.press("Control+z");
    assert.deepEqual(up, [0, 0, 1]);
    return { around: Math.atan2(y, x) / kDegree, above: Math.asin(z / Math.hypot(x, y, z)) / kDegree };
  };
  const apart = (a, b) => Math.abs(((a - b + 540) % 360) - 180), turn = (pixels) => (360 * pixels) / view.height;
  await page.locator(".objects button", { has: page.locator('span:text-is("front")') }).click();
  await button("Look through it", "#panel").click();
  const first = await seen();
  await drag(at, { x: 0, y: 40 });
  const higher = await seen();
  assert.ok(apart(higher.around, first.around) < 0.5 && Math.abs(higher.above - first.above - turn(40)) < 1, JSON.stringify([first, higher]));
  // Far beyond straight down: it stops there, and what was in front stays in front.
  await drag(at, { x: 0, y: 0.6 * view.height }, 30);
  const above = await seen();
  assert.ok(above.above > 89 && apart(above.around, first.around) < 1, JSON.stringify([first, above]));
  await picture(page, "author-straight-down");
  await drag(at, { x: -40, y: 3 });
  const beside = await seen();
  assert.ok(beside.above > 89 && Math.abs(apart(beside.around, above.around) - turn(40)) < 1, JSON.stringify([above, beside]));
  // By keys too.
  await page.locator(".view canvas").focus();
  for (const key of ["w", "w", "d"]) await page.keyboard.press(key);
  const byKeys = await seen();
  assert.ok(byKeys.above > 89 && Math.abs(apart(byKeys.around, beside.around) - 0.1 / kDegree) < 1, JSON.stringify([beside, byKeys]));
  await page.locator(".objects button", { has: page.locator('span:text-is("front")') }).click();
  await button("Look through it", "#panel").click();
  assert.equal(await text(), before);
});

step("a camera is the view that was orbited to", async () => {
  const view = await page.locator(".view canvas").boundingBox();
  await drag({ x: view.x + 0.9 * view.width, y: view.y + 0.8 * view.height }, { x: -160, y: -40 }, 10);
  await page.waitForTimeout(200);
  await button("+ this view", ".objects").click();
  const cameras = (await save()).cameras, made = cameras.at(-1);
  assert.equal(made.name, "camera");
  assert.notDeepEqual(made.eye_mm, cameras[0].eye_mm);
  await drag({ x: view.x + 0.9 * view.width, y: view.y + 0.8 * view.height }, { x: 120, y: 0 }, 10);
  await page.waitForTimeout(200);
  await page.locator(".view canvas").focus();
  for (let i = 0; i < 8; ++i) await page.keyboard.press("-"); // until it is in the picture
  await page.waitForTimeout(200);
  // Its own handle moves its eye, and what it looks at stays.
  await drag(await centreOf(handle("camera")), { x: -24, y: -18 });
  const dragged = (await scene()).cameras.at(-1);
  assert.ok(Math.hypot(...dragged.eye_mm.map((x, i) => x - made.eye_mm[i])) > 5, `${made.eye_mm} to ${dragged.eye_mm}`);
  assert.deepEqual({ ...dragged, eye_mm: 0 }, { ...made, eye_mm: 0 });
  await picture(page, "author-camera");
  const turned = await scene();
  await page.locator(".view canvas").focus();
  for (let i = 0; i < 4; ++i) await page.keyboard.press("d");
  assert.deepEqual(await scene(), turned, "keys turn the view, and nothing of the scene");
  await button("Use this view", "#panel").click();
  const again = (await save()).cameras.at(-1);
  assert.notDeepEqual(again.eye_mm, made.eye_mm);
  const drawn = ctpm(folder, "preview", kScene, "-o", "camera.png", "--camera", "camera");
  assert.equal(drawn.code, 0, drawn.err);
});

step("an organ stands on a table or a block that is added, and a forbidden zone is where it is dragged", async () => {
  const before = await text(), section = (title) => page.locator(`.objects section:has(h2:text-is("${title}"))`);
  const lowest = Math.min(...readFileSync(join(folder, "organs/kidney.obj"), "utf8").split("\n").filter((line) => line.startsWith("v ")).map((line) => Number(line.split(/\s+/)[3])));
  await section("Obstacles").locator("button:text-is('+ table')").click();
  await settled();
  const [table] = (await scene()).obstacles;
  assert.deepEqual([table.name, table.plane.normal], ["table", [0, 0, 1]]);
  assert.ok(Math.abs(table.plane.point_mm[2] - lowest) < 1, `${table.plane.point_mm} below ${lowest}`);
  await picture(page, "author-table");
  // A plane is turned by its rings, and by its numbers.
  await button("turn").click();
  const [right, up] = [page.locator("#panel .vector:has-text('normal') input").first(), page.locator("#panel .vector:has-text('normal') input").nth(2)];
  await right.fill("");
  await right.pressSequentially("0,5"); // as a decimal point is written in many countries
  await right.press("Tab");
  assert.deepEqual((await scene()).obstacles[0].plane.normal, [0.5, 0, 1]);
  assert.equal(await up.inputValue(), "1");
  await page.locator(".remove").click();
  assert.ok(!((await scene()).obstacles?.length > 0));
  await section("Obstacles").locator("button:text-is('+ block')").click();
  await settled();
  const { box } = (await scene()).obstacles[0];
  assert.ok(Math.abs(box.max_mm[2] - lowest) < 1 && box.max_mm[2] - box.min_mm[2] === 20, JSON.stringify(box));
  assert.ok(box.max_mm[0] - box.min_mm[0] > 100, "wider than the kidney");
  await picture(page, "author-block");
  // Another one stands beside what is there.
  await section("Obstacles").locator("button:text-is('+ block')").click();
  await settled();
  const beside = (await scene()).obstacles[1].box;
  assert.ok(Math.abs(beside.min_mm[2] - lowest) < 1 && beside.min_mm[0] > 40, JSON.stringify(beside));
  await picture(page, "author-blocks");
  await page.locator(".remove").click();
  await section("Forbidden zones").locator("button:text-is('+ ball')").click();
  const [zone] = (await scene()).forbidden;
  assert.ok(fromMesh(zone.sphere.centre_mm) < 4, JSON.stringify(zone));
  await drag(await centreOf(handle("zone")), { x: 60, y: 10 });
  const [moved] = (await scene()).forbidden;
  assert.ok(fromMesh(moved.sphere.centre_mm) < 4 && moved.sphere.centre_mm[0] !== zone.sphere.centre_mm[0], JSON.stringify(moved));
  await settled();
  await picture(page, "author-zone");
  assert.deepEqual(await outOfReach(page), []);
  await save();
  // An organ that nothing holds is told of, once it has been seen to fall.
  const loose = JSON.parse(before);
  delete loose.organs[0].anchors;
  await write(JSON.stringify(loose));
  await page.waitForSelector(".problem-list:has-text('nothing holds the organ, so that it falls')");
  await page.waitForSelector(".verdict:has-text('1 warning')");
  await write(before);
  await save();
});

step("what an organ and its layers are made of is chosen", async () => {
  const before = await text(), tissues = page.locator('#panel section:has(h2:text-is("kidney: its tissue")) select'), depths = page.locator("#panel .layer label:has-text('down to') input");
  const organ = async () => (await scene()).organs[0], old = (await organ()).layers;
  assert.equal(old.length, 1);
  await page.click("#tab-filling");
  const names = (await studio.call("scene.presets", {})).map(({ name }) => name);
  assert.deepEqual(await until(() => tissues.first().locator("option").allInnerTexts(), ({ length }) => length === names.length), names);
  assert.deepEqual(await tissues.evaluateAll((all) => all.map(({ value }) => value)), ["kidney", "kidney"]);
  assert.ok((await organ()).material.stiffness_scale > 0);
  await tissues.first().selectOption("liver");
  assert.deepEqual((await organ()).material, { preset: "liver", prestrain: -0.018 }, "a fit of another tissue is none of this one; how tense it lies stays");
  await page.waitForSelector("#panel .hint:has-text('is not fitted')");
  await tissues.nth(1).selectOption("spleen");
  assert.deepEqual((await organ()).layers[0], { to_depth_mm: 12, material: { preset: "spleen", prestrain: 0.002 } });
  await depths.first().fill("3");
  await depths.first().press("Tab");
  await button("+ layer of tissue", "#panel").click();
  await tissues.nth(2).selectOption("skin");
  await depths.nth(1).fill("10.5");
  await depths.nth(1).press("Tab");
  assert.deepEqual((await organ()).layers.map((layer) => [layer.to_depth_mm, layer.material.preset]), [[3, "spleen"], [10.5, "skin"]]);
  await settled();
  await depths.nth(1).fill("60");
  await page.waitForSelector(".verdict.bad");
  assert.match(await page.locator(".author .side").innerText(), /deeper than the organ/);
  await depths.nth(1).fill("10.5");
  await page.waitForSelector(".verdict.good");
  await settled();
  // Spheres are told and coloured by tissue.
  const kinds = page.locator("#panel ul[aria-label='Spheres by tissue'] li"), counts = (await kinds.locator(".number").allInnerTexts()).map(Number);
  assert.deepEqual((await kinds.allInnerTexts()).map((text) => text.replace(/\s*\d+$/, "")), ["spleen down to 3 mm", "skin down to 10.5 mm", "liver below", "never moves"]);
  assert.equal(counts.reduce((sum, count) => sum + count), Number(/spheres\s+(\d+)/.exec(await page.locator("#panel .numbers").first().innerText())[1]));
  await button("spheres", ".view-bar").click();
  await picture(page, "author-tissue");
  await button("surface", ".view-bar").click();
  await save();
  for (let i = 0; i < 2; ++i) await page.locator("#panel .layer .remove").first().click();
  assert.equal((await organ()).layers, undefined);
  await write(before);
  await save();
  await page.click("#tab-place");
});

step("comments stay where they are when things are dragged, added and removed", async () => {
  const before = await text();
  const commented = before.replace('"tools": [', '"tools": [ // what a hand takes up').replace('"cameras": [', '/* views */ "cameras": [ // from outside');
  assert.equal((commented.match(/\/\/|\/\*/g) ?? []).length, 3);
  await write(commented);
  await settled();
  await button("+ probe", ".objects").click();
  await drag(await centreOf(handle("probe-2")), { x: 30, y: 10 });
  await page.click(".objects button:has-text('scalpel')");
  await handle("scalpel").focus();
  await page.keyboard.press("ArrowUp");
  await page.click(".objects button:has-text('camera')");
  await page.locator(".remove").click();
  const now = await text();
  for (const comment of ["// what a hand takes up", "/* views */", "// from outside"]) assert.ok(now.includes(comment), now);
  assert.match(now, /"probe-2"/);
  assert.doesNotMatch(now, /"name": "camera"/);
  await page.keyboard.press("Control+s");
  await untilSaved();
  const checked = ctpm(folder, "check", kScene);
  assert.equal(checked.code, 0, checked.err);
  await write(before);
  await save();
});

step("every scene that was saved is one that the program takes", taken);

step("nothing was complained about", () => assert.deepEqual(studio.complaints, []));
