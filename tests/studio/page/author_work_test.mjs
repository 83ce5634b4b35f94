// An author at work on one scene: dragging, undoing, the keyboard alone, closing and killing: author_work_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { copyFileSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before } from "node:test";
import { authorOf } from "./author_page.mjs";
import { ctpm, ctpmBeside, isWhole, leave, makeFolder, moveMouse, openStudio, outOfReach, paths, picture, pixelsOf, rareStep, reading, seriousFindings, step, takeUp } from "./browser.mjs";

let folder, studio, page;
const kScene = "kidney.json";
const { onDisk, text, scene, button, handle, settled, write, centreOf, drag, untilSaved, save, taken } = authorOf(() => page, () => folder, kScene);

before(async () => {
  folder = makeFolder(kScene);
  studio = await openStudio(folder);
  page = studio.page;
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await openScene();
});

after(() => leave(studio, folder));

async function openScene() {
  await page.click("header nav button:has-text('Author')");
  await page.locator(".scenes button", { has: page.locator('span:text-is("kidney")') }).click();
  await settled();
}
const undoAll = async () => {
  while (await button("Undo").isEnabled()) await page.keyboard.press("Control+z");
};

/** How many pixels of the picture have about the hue of each colour (red, green, blue), as strong as paint is. */
async function hues(colours) {
  const { x, y, width, height } = await page.locator(".view > canvas").boundingBox();
  const bytes = await page.screenshot({ clip: { x, y: y + 50, width, height: height - 50 } });
  const hueOf = (r, g, b) => {
    const most = Math.max(r, g, b), spread = most - Math.min(r, g, b);
    if (spread < 40) return null; // grey
    return (60 * (most === r ? (g - b) / spread : most === g ? 2 + (b - r) / spread : 4 + (r - g) / spread) + 360) % 360;
  };
  const { data } = pixelsOf(bytes), wanted = colours.map((colour) => hueOf(...colour)), counts = colours.map(() => 0);
  for (let i = 0; i < data.length; i += 4) {
    const hue = hueOf(data[i], data[i + 1], data[i + 2]);
    wanted.forEach((w, k) => hue !== null && Math.abs(((hue - w + 540) % 360) - 180) < 8 && ++counts[k]);
  }
  return counts;
}

step("the slider is dragged with the mouse: one step, its numbers are told, and less is lost of the shape", async () => {
  await page.click("#tab-filling");
  const before = await text(), fill = async () => (await scene()).organs[0].fill;
  const within = async () => Number(/95 % within ([\d.]+) mm/.exec(await page.locator("#panel .shape").textContent())[1]);
  const coarse = await within(), spheres = await reading(page, "spheres");
  // What the page says while it works.
  await page.evaluate(() => {
    globalThis.said = new Set();
    const look = () => {
      for (const place of document.querySelectorAll(".busy, #panel .readings dd")) globalThis.said.add(place.textContent);
    };
    globalThis.watching = new MutationObserver(look);
    globalThis.watching.observe(document.querySelector(".author"), { subtree: true, childList: true, characterData: true });
  });
  const slider = page.locator("#panel .slider input").first(), { x, y, width, height } = await slider.boundingBox();
  const share = (await slider.inputValue()) / 200, thumb = x + 8 + share * (width - 16);
  const isFilling = (line) => /^filling [1-9]\d* %$/.test(line), said = () => page.evaluate(() => [...globalThis.said]);
  // Where pictures come rarely, a filling may be over before there is one of it: then it is filled once more.
  for (let i = 0; i < 5; ++i) {
    await drag({ x: thumb, y: y + height / 2 }, { x: x + 0.26 * width - thumb, y: 0 });
    await settled();
    if ((await said()).some(isFilling)) break;
    await page.keyboard.press("Control+z");
    await settled();
  }
  assert.ok((await said()).some(isFilling), (await said()).join("; "));
  const dragged = await fill();
  assert.ok(dragged.radius_mm < 2 && dragged.radius_mm > 0.8, `${dragged.radius_mm} mm`);
  assert.equal(dragged.gap_mm, dragged.radius_mm);
  await page.waitForFunction(() => [...globalThis.said].some((line) => /^measuring, \d+ of at most \d+ ticks$/.test(line)));
  await page.evaluate(() => globalThis.watching.disconnect());
  assert.ok(!(await said()).some((line) => line.includes("…")), "nothing works without a number");
  await settled();
  await picture(page, "author-slider");
  assert.ok((await reading(page, "spheres")) > 8 * spheres);
  assert.ok((await within()) < 0.5 * coarse, `${coarse} mm before, ${await within()} mm`);
  await page.keyboard.press("Control+z");
  assert.equal(await text(), before);
  await settled();
});

step("a change that is taken back while the time of a step is measured leaves nothing unmeasured", async () => {
  const before = await text(), time = () => page.waitForFunction(() => / ms it has$/.test([...document.querySelectorAll("#panel .readings div")].find((d) => d.textContent.startsWith("a step takes"))?.lastChild.textContent ?? ""));
  await time();
  // As soon as it is measured, a tool is added and taken back at once.
  await page.evaluate(() => {
    globalThis.said = [];
    globalThis.watching = new MutationObserver(() => {
      const cost = [...document.querySelectorAll("#panel .readings div")].find((d) => d.textContent.startsWith("a step takes"))?.lastChild.textContent ?? "";
      if (!cost.startsWith("measuring")) return;
      globalThis.watching.disconnect();
      globalThis.said.push(cost);
      for (const name of ["+ scalpel", "Undo"]) [...document.querySelectorAll(".author button")].find((button) => button.textContent === name).click();
    });
    globalThis.watching.observe(document.querySelector("#panel"), { subtree: true, childList: true, characterData: true });
  });
  await page.locator("#panel .slider input").first().focus();
  for (let i = 0; i < 4; ++i) await page.keyboard.press("ArrowLeft");
  const changed = await text();
  await page.waitForFunction(() => globalThis.said.length > 0);
  await settled();
  assert.equal(await text(), changed, "the tool was taken back");
  await page.click("#tab-filling");
  await time();
  await page.keyboard.press("Control+z");
  assert.equal(await text(), before);
  await settled();
});

step("spheres are drawn in the colours of their layers, and those that never move in blue", async () => {
  await button("spheres").click();
  await page.waitForTimeout(300);
  const dots = await page.locator("#panel .layers i").evaluateAll((list) => list.map((dot) => getComputedStyle(dot).backgroundColor.match(/\d+/g).map(Number)));
  const kBlue = [127, 184, 255];
  assert.deepEqual([dots.length, dots[2]], [3, kBlue]);
  assert.equal(await page.locator("#panel .layers li").last().innerText(), "never moves");
  const [outer, inner, anchored] = await hues(dots);
  await picture(page, "author-layers");
  await button("surface").click();
  await page.waitForTimeout(300);
  const [, none, neither] = await hues(dots); // of handles and rings
  assert.ok(outer > 3000 && inner - none > 100 && anchored - neither > 300, `pixels of layer 1, layer 2 and anchored: ${outer}, ${inner} - ${none}, ${anchored} - ${neither}`);
  assert.ok(outer > 3 * (inner - none), "the inner layer is behind the outer one");
});

rareStep("the scatter in full is that of the command", async () => {
  await write((await text()).replace('"radius_mm": 4, "gap_mm": 4', '"radius_mm": 6, "gap_mm": 6'));
  await save();
  await settled();
  // What is too thin for so large spheres is said as `plan` says it.
  const thin = /\d+ of \d+ spheres lie in tissue thinner than .*? mm(?= \(a smaller)/.exec(ctpm(folder, "plan", kScene, "--quick").err)[0];
  assert.ok((await page.locator("#panel .fine-enough.warning").textContent()).includes(thin), thin);
  await picture(page, "author-too-coarse");
  const command = ctpmBeside(folder, "fidelity", kScene, "-o", "fidelity");
  await button("In full", "#panel").click();
  await page.waitForSelector("#panel .scatter");
  const cells = (await page.locator("#panel .scatter td").allInnerTexts()).filter((cell) => cell.endsWith("%")).map(Number.parseFloat);
  assert.ok((await command).code < 2);
  const figures = JSON.parse(readFileSync(join(folder, "fidelity", "results.json"), "utf8")).figures.filter((f) => f.figure.startsWith("scatter"));
  assert.deepEqual([...cells].sort(), figures.map((f) => Number.parseFloat(f.measured.toFixed(1))).sort());
  await undoAll();
  await save();
  await settled();
});

step("changes of one value within half a second are one step", async () => {
  const before = await text(), place = async () => (await scene()).probes[0].at_mm;
  await button("+ probe", ".objects").click();
  const from = await place(), added = await text(), way = async () => Math.hypot(...(await place()).map((x, i) => x - from[i]));
  await handle("probe").focus();
  for (let i = 0; i < 20; ++i) await page.keyboard.press("ArrowLeft");
  const moved = await text();
  assert.ok(Math.abs((await way()) - 20) < 0.3, `${await way()} mm`);
  await page.waitForTimeout(600);
  for (let i = 0; i < 3; ++i) await page.keyboard.press("ArrowLeft");
  // Another value is another step at once, and so is the first one after it.
  const number = page.locator("#panel .vector input").nth(2);
  await number.fill("77");
  await number.press("Tab");
  await handle("probe").focus();
  const numbered = await text();
  await page.locator("#panel label:has-text('name') input").fill("tip");
  await page.keyboard.press("Tab");
  const steps = [];
  while ((await text()) !== before) {
    await page.keyboard.press("Control+z");
    steps.push(await text());
  }
  assert.equal(steps[0], numbered);
  assert.ok(steps.includes(moved) && steps.includes(added));
  assert.equal(steps.at(-2), added, "20 keys are one step");
  // What is undone is not joined by the next change.
  for (let i = 0; i < steps.length; ++i) await page.keyboard.press("Control+Shift+z");
  await page.keyboard.press("Control+z");
  await handle("probe").focus();
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("Control+z");
  assert.equal(await text(), numbered);
  await undoAll();
  assert.equal(await text(), before);
});

// Ten steps in each round: 200 as is promised, or enough of each kind.
const kRounds = isWhole ? 20 : 3;

step(`${10 * kRounds} steps of all kinds are undone and done again, each as it was, also after the page was loaded anew`, async () => {
  await page.setViewportSize({ width: 1000, height: 560 }); // fewer pixels are drawn for each
  await page.click("#tab-place");
  const before = await text(), steps = [before];
  const did = async (what) => {
    const now = await text();
    assert.notEqual(now, steps.at(-1), `step ${steps.length}, ${what}`);
    steps.push(now);
  };
  const row = (name) => page.locator(".objects li button", { has: page.locator(`span:text-is("${name}")`) });
  const name = async (value) => {
    await page.locator("#panel label:has-text('name') input").fill(value);
    await page.keyboard.press("Tab");
  };
  for (let round = 0; round < kRounds; ++round) {
    await button("+ probe", ".objects").click();
    await did("add a probe");
    const { x, y } = await centreOf(handle("probe"));
    await drag({ x, y }, { x: 20 + round, y: 5 }, 3);
    await did("drag it");
    await name(`tip ${round}`);
    await did("its name");
    await handle(`tip ${round}`).focus();
    await page.keyboard.press("ArrowUp");
    await did("nudge it");
    await button("+ this view", ".objects").click();
    await did("a camera");
    await page.locator("#panel label:has-text('field of view') input").fill(String(41 + round));
    await page.keyboard.press("Tab");
    await did("its angle");
    await page.locator("#panel .vector input").first().fill(String(100 + round));
    await page.keyboard.press("Tab");
    await did("a number of its place");
    await name(`view ${round}`);
    await did("its name");
    await page.locator(".remove").click();
    await did("remove it");
    await row(`tip ${round}`).click();
    await page.waitForSelector(`#panel h2:has-text('probe: tip ${round}')`);
    await page.keyboard.press("Delete");
    await did("remove the probe by key");
  }
  const count = 10 * kRounds, half = count / 2;
  assert.equal(steps.length, count + 1);
  const undo = async (to) => {
    await page.keyboard.press("Control+z");
    assert.equal(await text(), steps[to], `undone to step ${to}`);
  };
  for (let i = count - 1; i >= half; --i) await undo(i);
  // The page is loaded anew in the middle of them: what leads on is there, and so is what led here.
  await page.reload(); // which shows the scene again
  await page.waitForSelector(".earlier-visit");
  await settled();
  assert.equal(await text(), steps[half]);
  for (let i = half + 1; i <= count; ++i) {
    await page.keyboard.press("Control+Shift+z");
    assert.equal(await text(), steps[i], `done again to step ${i}`);
  }
  assert.ok(!(await button("Redo").isEnabled()));
  for (let i = count - 1; i >= 0; --i) await undo(i);
  await page.setViewportSize({ width: 1280, height: 720 });
});

/** Goes to a control by the tabulator alone. */
async function tabTo(locator, key = "Tab") {
  for (let i = 0; i < 150; ++i) {
    if (await locator.evaluate((control) => control === document.activeElement)) return;
    await page.keyboard.press(key);
  }
  assert.fail("the tabulator does not come there");
}

step("import, filling, tools and anchors are worked by the keyboard alone", async () => {
  await page.locator("header nav button:has-text('Author')").focus();
  // A mesh is chosen, named and imported.
  const elsewhere = mkdtempSync(join(tmpdir(), "ctpm-mesh-")), mesh = join(elsewhere, "typed.obj");
  copyFileSync(join(paths.source, "scenes", "organs", "kidney.obj"), mesh);
  await tabTo(page.locator(".pick input"));
  const chooser = page.waitForEvent("filechooser");
  await page.waitForTimeout(300); // until it is listened for
  await page.keyboard.press("Enter");
  await (await chooser).setFiles(mesh);
  await page.waitForSelector("aside .field:has-text('tissue')");
  assert.deepEqual(await outOfReach(page), []);
  await tabTo(page.locator("aside .field:has-text('tissue') select"));
  await page.keyboard.type("live");
  assert.equal(await page.locator("aside .field:has-text('tissue') select").inputValue(), "liver");
  await tabTo(page.locator("aside .field:has-text('radius') input"));
  await page.keyboard.type("6");
  await tabTo(page.locator("aside .field:has-text('scene to write') input"));
  await page.keyboard.press("Control+a");
  await page.keyboard.type("typed-scene.json");
  await tabTo(button("Import", "aside"));
  await page.keyboard.press("Enter");
  await page.waitForSelector("aside .good:has-text('typed-scene.json')");
  await settled();
  rmSync(elsewhere, { recursive: true });
  // The filling.
  const typed = async () => JSON.parse(await text("typed-scene.json"));
  await tabTo(page.locator("#tab-filling"));
  await page.keyboard.press("Enter");
  assert.deepEqual(await outOfReach(page), []);
  await tabTo(page.locator("#panel .slider input"));
  for (let i = 0; i < 5; ++i) await page.keyboard.press("ArrowRight");
  assert.ok((await typed()).organs[0].fill.radius_mm > 6);
  await settled();
  await tabTo(button("Measure, short form", "#panel"));
  await page.keyboard.press("Enter");
  await page.waitForSelector("#panel .scatter");
  // A tool is added, moved by its handle and its numbers, and removed.
  await tabTo(page.locator(".objects button:has-text('+ scalpel')"), "Shift+Tab");
  await page.keyboard.press("Enter");
  await page.waitForSelector("#panel h2:has-text('tool: scalpel')");
  const name = await page.locator("#panel label:has-text('name') input").inputValue();
  const toolOf = async () => (await typed()).tools.find((tool) => tool.name === name), put = await toolOf();
  assert.deepEqual(await outOfReach(page), []);
  await tabTo(page.locator(`.handle:has(span:text-is("${name}"))`));
  await page.keyboard.press("ArrowUp");
  assert.notDeepEqual((await toolOf()).at_mm, put.at_mm);
  await tabTo(page.locator("#panel label:has-text('length of the blade') input"));
  await page.keyboard.press("ArrowUp");
  assert.equal((await toolOf()).blade_length_mm, put.blade_length_mm + 1);
  await tabTo(page.locator("#panel .vector:has-text('pointing') input").first());
  await page.keyboard.press("ArrowUp");
  const turned = (await toolOf()).pointing[0] - put.pointing[0];
  assert.ok(turned > 0 && turned < 0.101, `${put.pointing} to ${(await toolOf()).pointing}`);
  // Anchors are painted: the arrows move the brush, Space paints and, with Shift, erases.
  const anchors = async () => (await typed()).organs[0].anchors, had = (await anchors()).length;
  await tabTo(button("paint", ".objects"), "Shift+Tab");
  await page.keyboard.press("Enter");
  assert.match(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), /^Painting anchors: arrow keys/);
  await page.keyboard.press("Space");
  const once = await anchors();
  assert.equal(once.length, had + 1);
  assert.equal(await page.locator(".brush-says").count(), 0);
  await page.keyboard.press("Space");
  await page.waitForSelector(".brush-says:has-text('an anchor already')");
  assert.deepEqual(await anchors(), once, "a place is not painted twice");
  await picture(page, "author-painted-twice");
  await page.keyboard.press("ArrowRight");
  await page.waitForSelector(".brush-says", { state: "detached" });
  for (let i = 0; i < 7; ++i) await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Space");
  const painted = (await anchors()).slice(had).map((anchor) => anchor.sphere.centre_mm);
  assert.ok(painted.length >= 2, JSON.stringify(painted));
  assert.ok(Math.hypot(...painted.at(-1).map((x, i) => x - painted[0][i])) > 5, JSON.stringify(painted));
  await settled();
  await picture(page, "author-painted-by-keys");
  assert.deepEqual(await seriousFindings(page), []);
  await page.locator(".view > canvas").focus();
  await page.keyboard.press("Shift+Space");
  const left = await anchors();
  assert.ok(left.length < had + painted.length);
  // Where nothing is painted nothing is erased, and a brush that holds no sphere paints none: both are said.
  await page.keyboard.press("Shift+Space");
  await page.waitForSelector(".brush-says:has-text('There is no painted anchor here')");
  assert.deepEqual(await anchors(), left);
  const size = page.locator(".brush input"), least = Number(await size.getAttribute("min"));
  await tabTo(size, "Shift+Tab");
  await page.keyboard.press("Home");
  assert.ok(Math.abs((await size.inputValue()) - least) < 1e-9);
  await page.locator(".view > canvas").focus();
  for (let i = 0, before = null; i < 30 && JSON.stringify(before) !== JSON.stringify(await anchors()); ++i) {
    before = await anchors();
    await page.keyboard.press("ArrowUp");
    await page.keyboard.press("Space");
  }
  await page.waitForSelector(".brush-says:has-text('The brush holds no sphere here')");
  await picture(page, "author-brush-says");
  await page.keyboard.press("Escape");
  assert.equal(await button("paint", ".objects").getAttribute("aria-pressed"), "false");
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => localStorage.getItem("ctpm.draft:typed-scene.json") === null);
  const checked = ctpm(folder, "check", "typed-scene.json");
  assert.equal(checked.code, 0, checked.err);
  await openScene();
});

step("a mesh that is not there is told where the text names it, as by check", async () => {
  await openScene();
  const bad = onDisk().replace("organs/kidney.obj", "organs/nowhere.obj");
  await write(bad);
  await page.waitForSelector("aside .jumps button.error:has-text('nowhere.obj')");
  const [line] = await page.locator("aside .jumps button.error").allInnerTexts();
  const [, place, message] = /^(\d+:\d+)\s*(.*)$/s.exec(line);
  writeFileSync(join(folder, "bad.json"), bad);
  const printed = ctpm(folder, "check", "bad.json").err;
  assert.ok(printed.includes(`bad.json:${place}: error: ${message.trim()}`), `${line}\n---\n${printed}`);
  rmSync(join(folder, "bad.json"));
  await page.locator("aside .jumps button.error").first().click();
  assert.ok((await page.locator(".cm-lintRange-error").allInnerTexts()).some((part) => part.includes("nowhere.obj")));
  await undoAll();
  await settled();
});

step("a blade cuts when a scene is tried, and nothing is kept", async () => {
  const files = readdirSync(folder).sort();
  const started = Date.now();
  await button("Try it").click();
  await page.waitForSelector(".view.running .force-bar");
  console.log(`author: from "Try it" to the hand ${Date.now() - started} ms`);
  const middle = await takeUp(page);
  await page.keyboard.press("2");
  await moveMouse(page, middle, { x: -20, y: 240 }, 30);
  await moveMouse(page, { x: middle.x - 20, y: middle.y + 240 }, { x: 180, y: 0 }, 36);
  await page.waitForFunction(() => [...document.querySelectorAll(".readings div")].some((d) => /severed[1-9]/.test(d.textContent)));
  await picture(page, "author-try-cut");
  assert.equal(await page.locator(".recorded").textContent(), "not recorded");
  await page.keyboard.press("Escape");
  await page.waitForSelector("button:has-text('Train again')");
  assert.ok((await reading(page, "severed")) > 0);
  assert.deepEqual(readdirSync(folder).sort(), files);
  await page.click("button:has-text('Back to Author')");
  await settled();
});

step("a draft is there after its tab was closed, until the file says the same", async () => {
  const saved = onDisk(), changed = saved.replace('"name": "kidney"', '"name": "not saved"');
  await write(changed);
  assert.equal(await text(), changed);
  const other = await page.context().newPage();
  await page.close();
  page = other;
  await page.goto(studio.address);
  await page.click("header nav button:has-text('Author')");
  const marked = page.locator(".scenes li button[aria-describedby]");
  assert.equal(await marked.locator("span").innerText(), "kidney");
  assert.equal(await page.locator(`#${await marked.getAttribute("aria-describedby")}`).innerText(), "unsaved changes");
  await openScene();
  assert.equal(await text(), changed);
  assert.match(await page.locator(".verdict").textContent(), /not saved$/);
  const told = page.locator(".earlier-visit[role=status]:has-text('unsaved changes of an earlier visit: Undo takes them back')");
  await told.waitFor();
  assert.deepEqual(await seriousFindings(page), []);
  await picture(page, "author-earlier-visit");
  await page.keyboard.press("Control+z");
  assert.equal(await text(), saved);
  await told.waitFor({ state: "detached" });
  assert.equal(await marked.count(), 0);
  await page.keyboard.press("Control+Shift+z");
  assert.equal(onDisk(), saved);
  // One that another tab wrote: the history is none of it, and one step leads back to the file.
  const others = changed.replace("not saved", "of another tab");
  await page.waitForFunction(([key, text]) => JSON.parse(localStorage.getItem(key)).doc === text, [`ctpm.history:${kScene}`, changed]);
  await page.evaluate(([key, text]) => localStorage.setItem(key, text), [`ctpm.draft:${kScene}`, others]);
  await page.reload();
  await openScene();
  assert.equal(await text(), others);
  assert.ok(!(await button("Redo").isEnabled()));
  await page.keyboard.press("Control+z");
  assert.equal(await text(), saved);
  assert.ok(!(await button("Undo").isEnabled()));
  await page.keyboard.press("Control+Shift+z");
  // Somebody writes into the file what is here, with other ends of lines: it is saved, and nobody is asked.
  writeFileSync(join(folder, kScene), others.replaceAll("\n", "\r\n"));
  await page.waitForSelector(".verdict:has-text(', saved')");
  assert.equal(await page.locator(".conflict").count(), 0);
  assert.equal(await marked.count(), 0);
  await page.keyboard.press("Control+z");
  await save();
  assert.equal(onDisk(), saved);
  // The same while the scene is not open: its mark goes when its author comes back to the window.
  await page.keyboard.press("Control+Shift+z");
  await page.evaluate(() => sessionStorage.clear()); // as another tab begins
  await page.reload();
  await page.waitForFunction(() => document.querySelector(".scenes li button[aria-describedby]"));
  writeFileSync(join(folder, kScene), others);
  await page.evaluate(() => dispatchEvent(new Event("focus")));
  await marked.waitFor({ state: "detached" });
  assert.equal(await page.evaluate((key) => localStorage.getItem(key), `ctpm.draft:${kScene}`), null);
  await openScene();
  await page.waitForSelector(".verdict:has-text(', saved')");
  await page.keyboard.press("Control+z");
  await save();
  assert.equal(onDisk(), saved);
});


step("a program that is killed while it writes leaves the scene whole, and nothing is lost", async () => {
  const saved = onDisk(), longer = `${await text()}\n${" ".repeat(300_000)}\n`;
  await write(longer);
  studio.limitFiles(100_000); // a longer write ends the program, in the middle of it
  await page.keyboard.press("Control+s");
  await studio.ended();
  await page.waitForSelector(".empty:has-text('The studio has ended')");
  assert.equal(onDisk(), saved, "the file is the old one, whole");
  const half = readdirSync(folder).filter((name) => name.startsWith(`${kScene}.part-`));
  assert.equal(half.length, 1, "it was in the middle of writing");
  const address = await studio.startAgain();
  const other = await page.context().newPage();
  await other.goto(address);
  await page.waitForSelector(".author .editor-frame");
  await other.close(); // a page behind another one is not drawn
  await settled();
  assert.equal(await text(), longer);
  await page.keyboard.press("Control+s");
  await untilSaved();
  assert.equal(onDisk(), longer);
  assert.deepEqual(readdirSync(folder).filter((name) => name.includes(".part-")), []);
});

step("every scene that was saved is one that the program takes", taken);
