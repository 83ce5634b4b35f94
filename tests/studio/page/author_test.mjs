// An author in a browser: author_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { cpSync, existsSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { authorOf } from "./author_page.mjs";
import { largeMesh } from "./large_mesh.mjs";
import { ctpm, ctpmBeside, isWhole, leave, makeFolder, openStudio, overflow, paths, picture, reading, seriousFindings, step, until } from "./browser.mjs";

let folder, studio, page;

before(async () => {
  folder = makeFolder("kidney.json");
  studio = await openStudio(folder);
  page = studio.page;
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.click("header nav button:has-text('Author')");
});

after(() => leave(studio, folder));

const kScene = "my-kidney-scene.json";
const { onDisk, text, scene, button, handle, settled, write, centreOf, drag, untilSaved, save, taken } = authorOf(() => page, () => folder, kScene);
/** What is dragged: files of these names and contents. */
const dragged = (...files) => page.evaluateHandle((files) => {
  const data = new DataTransfer();
  for (const [name, text] of files) data.items.add(new File([text], name));
  return data;
}, files);
/** Drops a file onto the page. Returns when. */
async function drop(name, bytes) {
  const dropped = await dragged([name, bytes.toString()]);
  const at = Date.now();
  await page.dispatchEvent(".view canvas", "drop", { dataTransfer: dropped });
  return at;
}

step("an empty room says what to do", async () => {
  assert.match(await page.locator(".view .empty").innerText(), /Drop a mesh/);
  assert.deepEqual(await seriousFindings(page), []);
  await picture(page, "author-empty");
});

const kTriangles = isWhole ? 100_000 : 20_000;
step(`a mesh of ${kTriangles} triangles is imported, and an import that is stopped leaves what another try needs until its author goes back`, async () => {
  // It is dropped onto the page, uneven as a scanner's surface is.
  const started = Date.now();
  await drop("large.obj", largeMesh(kTriangles, 0.6));
  await page.locator("aside label:has-text('tissue') select").selectOption("liver");
  await button("Import", "aside").click();
  await page.waitForFunction(() => /importing [1-9]/.test(document.querySelector("aside .working")?.textContent ?? ""));
  await button("cancel", "aside").click();
  await page.waitForSelector("aside .hint:has-text('Stopped')");
  console.log(`author: an import of ${kTriangles} triangles was stopped ${Date.now() - started} ms after it was dropped`);
  // What was uploaded is there for another try, until its author goes back.
  const left = () => readdirSync(folder).filter((name) => name.startsWith("large"));
  assert.deepEqual(left(), ["large.obj"]);
  await button("Back", "aside").click();
  assert.deepEqual(await until(left, (names) => names.length === 0), []);
  const again = await drop("large.obj", largeMesh(kTriangles, 0.6));
  await page.locator("aside label:has-text('tissue') select").selectOption("liver");
  await button("Import", "aside").click();
  await page.waitForSelector("aside .good:has-text('large-scene.json')");
  assert.ok(!left().includes("large.obj"), "the scene has its own mesh");
  await page.waitForFunction(() => !document.querySelector(".busy") && !document.querySelector(".view .empty"));
  console.log(`author: ${kTriangles} triangles uploaded, imported, filled and drawn ${((Date.now() - again) / 1e3).toFixed(1)} s after they were dropped`);
  await settled();
  await picture(page, "author-large");
});

step("the next import of that mesh is proposed a name that nothing has", async () => {
  await drop("large.obj", "");
  const name = page.locator("aside label:has-text('scene to write') input");
  assert.equal(await until(() => name.inputValue(), (proposed) => proposed !== ""), "large-scene-2.json");
  await button("Back", "aside").click();
});

step("a hole that is too wide is told, and closed when its author says so", async () => {
  const lines = readFileSync(join(paths.source, "scenes", "organs", "kidney.obj"), "utf8").trimEnd().split("\n");
  const x = lines.filter((line) => line.startsWith("v ")).map((line) => Number(line.split(/\s+/)[1])), least = Math.min(...x), most = Math.max(...x);
  const mesh = Buffer.from(lines.filter((line) => !line.startsWith("f ") || x[Number.parseInt(line.split(/\s+/)[1]) - 1] < most - 0.15 * (most - least)).join("\n") + "\n");
  const uploads = [], listen = (request) => request.method() === "PUT" && uploads.push(request.url());
  page.on("request", listen);
  await drop("holed.obj", mesh);
  await page.locator("aside label:has-text('radius') input").fill("5");
  await button("Import", "aside").click();
  await page.waitForSelector("aside .problems:has-text('wider than')");
  const told = await page.locator("aside .problems").innerText();
  assert.match(told, /^holed\.obj: /);
  assert.equal(uploads.length, 1);
  await picture(page, "author-holed");
  // What would close it is offered where it was refused.
  const width = /largest_hole_mm (\d+)/.exec(told)[1];
  await button(`Close holes up to ${width} mm and import`, "aside").click();
  assert.equal(await page.locator("aside label:has-text('largest hole') input").inputValue(), width);
  assert.ok((await page.locator("aside .command code").innerText()).includes(`--largest-hole-mm ${width}`));
  await page.waitForSelector("aside .good:has-text('holed-scene.json')");
  assert.equal(uploads.length, 1, "it was not uploaded anew");
  assert.ok(!existsSync(join(folder, "holed.obj")));
  page.off("request", listen);
  await settled();
});

step("a mesh becomes a scene, as by the command, and what was repaired is listed", async () => {
  // One triangle is missing, and one is there twice.
  const lines = readFileSync(join(paths.source, "scenes", "organs", "kidney.obj"), "utf8").trimEnd().split("\n");
  const mesh = Buffer.from([...lines.slice(0, -1), lines.at(-2)].join("\n") + "\n");
  await page.setInputFiles(".pick input", { name: "my-kidney.obj", mimeType: "model/obj", buffer: mesh });
  // The usual radius is what holds 1 kHz while it is measured.
  await page.locator("aside label:has-text('radius') input").fill("4");
  // What a tissue is, in the program's words, follows the choice.
  const about = () => page.locator("#tissue-source").textContent();
  assert.match(await until(about, (text) => text.includes("Its values")), /Bao & Wu/);
  await page.locator("aside label:has-text('tissue') select").selectOption("lung");
  assert.match(await about(), /Mariappan/);
  await page.locator("aside label:has-text('tissue') select").selectOption("kidney");
  await picture(page, "author-import");
  const shown = await page.locator("aside .command code").innerText();
  // The command that it shows writes the same scene elsewhere, and reports the same repairs.
  const other = makeFolder();
  writeFileSync(join(other, "my-kidney.obj"), mesh);
  const command = ctpmBeside(other, ...shown.split(" ").slice(1));
  await button("Import", "aside").click();
  await page.waitForSelector("aside .good");
  await page.waitForSelector("aside .findings");
  await settled();
  assert.deepEqual(await seriousFindings(page), []);
  await picture(page, "author-imported");
  assert.ok(!existsSync(join(folder, "my-kidney.obj")), "the scene has its own mesh");
  const outcome = await command;
  assert.equal(outcome.code, 0, outcome.err);
  assert.equal(onDisk(), readFileSync(join(other, kScene), "utf8"));
  const repairs = await page.locator("aside section:has-text('Imported') .findings li span:first-child").allInnerTexts();
  assert.ok(repairs.some((line) => /hole|open/.test(line)), repairs.join("\n"));
  for (const repair of repairs) assert.ok((outcome.out + outcome.err).includes(repair), `${repair}\n---\n${outcome.out}`);
  rmSync(other, { recursive: true });
});

step("errors in the text are those of check, at their places", async () => {
  const good = onDisk();
  const bad = good.replace(/"radius_mm": [\d.]+/, '"radius_mm": -4').replace('"damage', '"dammage');
  await write(bad);
  await page.waitForSelector("aside .jumps button.error");
  await page.waitForSelector(".cm-lintRange-error");
  await settled();
  const shown = await page.locator("aside .jumps button.error").allInnerTexts();
  writeFileSync(join(folder, "bad.json"), bad);
  const printed = ctpm(folder, "check", "bad.json").err;
  assert.equal(shown.length, (printed.match(/: error: /g) ?? []).length, printed);
  for (const line of shown) {
    const [, place, message] = /^(\d+:\d+)\s*(.*)$/s.exec(line);
    assert.ok(printed.includes(`bad.json:${place}: error: ${message.trim()}`), `${line}\n---\n${printed}`);
  }
  await page.locator("aside .jumps button.error").first().click();
  assert.ok((await page.locator(".cm-lintRange-error").allInnerTexts()).includes("-4"));
  await picture(page, "author-errors");
  assert.deepEqual(await seriousFindings(page), []);
  // Nothing was written, and a draft outlives the page.
  assert.equal(onDisk(), good);
  assert.ok(await page.locator(".view > canvas").isVisible() && !(await page.locator(".view .empty").count()), "what was valid last is still shown");
  await page.reload();
  await page.click(`.scenes button:has-text('my-kidney-scene')`);
  await page.waitForSelector("aside .jumps button.error");
  assert.equal(await text(), bad);
  await button("Undo").click();
  await page.waitForFunction(() => !document.querySelector("aside .jumps button.error"));
  assert.equal(await text(), good);
});

step("a text that is no JSON for a while stops nothing, and what fields refuse does not stay in them", async () => {
  const good = onDisk(), mistake = () => page.waitForSelector("aside .jumps button.error");
  await page.click("#tab-filling");
  await write(good.replace('"version"', '"version'));
  await mistake();
  for (const tab of ["scene", "place", "filling"]) {
    await page.click(`#tab-${tab}`);
    await page.waitForSelector(`#tab-${tab}[aria-selected=true]`);
  }
  // Opened with the mistake in it, it says so, and waits for nothing.
  await page.reload();
  await page.locator(".scenes button", { has: page.locator(`span:text-is("${kScene.replace(".json", "")}")`) }).click();
  await mistake();
  await page.waitForSelector(".view .empty:has-text('cannot be shown')");
  assert.equal(await page.locator(".view .empty:has-text('Loading')").count(), 0);
  await page.click("#tab-filling");
  await button("Undo").click();
  await settled();
  assert.equal(await text(), good);
  await page.click("#tab-place");
  await page.locator("#tab-place[aria-selected=true]").waitFor();
  await page.locator(".objects li button", { has: page.locator(`span:text-is("${JSON.parse(good).organs[0].name}")`) }).click();
  const scale = page.getByLabel("scale of the mesh", { exact: false });
  const was = await scale.inputValue();
  for (const refused of ["-1", ""]) {
    await scale.fill(refused);
    await page.keyboard.press("Tab");
    await page.waitForFunction(([field, value]) => field.value === value, [await scale.elementHandle(), was]);
  }
  assert.equal(await text(), good);
});

step("the schema completes keys and values", async () => {
  const good = onDisk();
  const loads = page.locator(".cm-tooltip-autocomplete li:has-text('loads')");
  await settled();
  // By keys: a click within the frame that scrolled to the top, as no hand makes it, goes where the editor was scrolled to before.
  await page.locator(".cm-content").focus();
  await page.keyboard.press("Control+Home");
  for (const key of ["ArrowDown", "ArrowDown", "End", "Enter"]) await page.keyboard.press(key); // behind the version
  await page.keyboard.type('"loa', { delay: 30 });
  // It comes by itself, but on a busy machine another change may close it: then it is asked for.
  for (let i = 0; i < 6 && !(await loads.isVisible()); ++i) await loads.waitFor({ timeout: 5000 }).catch(() => page.keyboard.press("Control+Space"));
  assert.ok(await loads.isVisible(), await text());
  await picture(page, "author-completion");
  await page.waitForTimeout(100);
  await page.keyboard.press("Enter");
  await page.keyboard.type(",");
  assert.deepEqual((await scene()).loads, []);
  // Values: those that the schema lists, in place of the one that stands there.
  const schema = await studio.call("scene.schema", {});
  const { integrator } = schema.$defs[schema.properties.solver.$ref.split("/").at(-1)].properties;
  await page.keyboard.press("Control+End"); // only lines near what is seen are there
  await page.locator(".cm-line:has-text('\"integrator\"')").click();
  await page.keyboard.press("End");
  const behind = /"integrator": "(\w+)(".*)$/m.exec(await text());
  for (let i = 0; i < behind[2].length; ++i) await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("Control+Space");
  await page.waitForSelector(".cm-tooltip-autocomplete li");
  const offered = await page.locator(".cm-tooltip-autocomplete li .cm-completionLabel").allInnerTexts();
  await picture(page, "author-completion-value");
  assert.ok(offered.length > 0 && offered.every((value) => integrator.enum.includes(value)), `${offered}`);
  for (let i = 0; i < behind[1].length; ++i) await page.keyboard.press("Backspace");
  await page.keyboard.type("leap", { delay: 30 });
  await page.waitForSelector(".cm-tooltip-autocomplete li:has-text('leapfrog')");
  await page.waitForTimeout(100);
  await page.keyboard.press("Enter");
  assert.equal((await scene()).solver.integrator, "leapfrog");
  assert.equal(await button("Undo").getAttribute("title"), "Undo solver integrator (Ctrl+Z)");
  while (await button("Undo").isEnabled()) await button("Undo").click();
  assert.equal(await text(), good);
});

step("saving is by key, and never over somebody else's change", async () => {
  const changed = onDisk().replace(/"name": "[^"]*"/, '"name": "mine"');
  await write(changed);
  await page.keyboard.press("Control+s");
  await untilSaved();
  assert.equal(onDisk(), changed);
  await settled();
  assert.equal(await page.locator(".verdict").textContent(), "good, saved");
  // Somebody else's change is noticed before anything is saved, while the page is only looked at.
  writeFileSync(join(folder, kScene), changed + "\n");
  await page.waitForSelector(".conflict:has-text('was changed on the disk')");
  await picture(page, "author-changed-on-disk");
  assert.equal(await page.locator(".verdict").textContent(), "good", "not that it is saved");
  await button("Load it").click();
  await page.waitForSelector(".conflict", { state: "detached" });
  assert.equal(await text(), changed + "\n");
  await page.keyboard.press("Control+z");
  assert.equal(await text(), changed, "undo brings the author's own text back");
  // Who saves before it was noticed is refused, and may keep what is here.
  const mine = changed.replace("mine", "again");
  await write(mine);
  writeFileSync(join(folder, kScene), changed + "\n\n");
  await page.keyboard.press("Control+s");
  await page.waitForSelector(".conflict:has-text('was changed on the disk')");
  assert.equal(onDisk(), changed + "\n\n");
  // It is known after the page was loaded again, too: the draft is of what the file said before.
  await page.reload();
  await page.click(`.scenes button:has-text('${kScene.replace(".json", "")}')`);
  await page.waitForSelector(".conflict:has-text('was changed on the disk')");
  await settled();
  assert.equal(await text(), mine);
  await page.keyboard.press("Control+s");
  await page.waitForTimeout(500);
  assert.equal(onDisk(), changed + "\n\n");
  await button("Keep mine").click();
  await page.waitForSelector(".conflict", { state: "detached" });
  assert.equal(await page.locator(".earlier-visit").count(), 0, "undo does not lead to the file that is there now");
  assert.equal(onDisk(), changed + "\n\n");
  assert.equal(await text(), mine);
  await save();
  assert.equal(onDisk(), mine);
  // A file that is gone is written again when its author wants that.
  rmSync(join(folder, kScene));
  await page.waitForSelector(".conflict:has-text('no longer there')");
  await button("Keep mine").click();
  await page.waitForSelector(".conflict", { state: "detached" });
  await page.keyboard.press("Control+s");
  await untilSaved();
  assert.equal(onDisk(), mine);
  await settled();
});

step("the slider fills again: spheres, time per tick, scatter", async () => {
  await page.click("#tab-filling");
  const slider = page.locator("#panel .slider input").first();
  const before = await reading(page, "spheres");
  await slider.focus();
  for (let i = 0; i < 12; ++i) await page.keyboard.press("ArrowLeft");
  await page.waitForSelector("#panel .numbers[aria-busy=true]:has-text('a step takes')"); // numbers of the filling before
  await settled();
  assert.equal(await page.locator("#panel .numbers[aria-busy=true]").count(), 0);
  await button("spheres").click();
  await page.waitForFunction(() => / ms it has$/.test([...document.querySelectorAll("#panel .readings div")].find((d) => d.textContent.startsWith("a step takes"))?.lastChild.textContent ?? ""));
  const spheres = await reading(page, "spheres"), time = await reading(page, "a step takes");
  assert.ok(spheres > before, `${before} to ${spheres}`);
  assert.ok(time > 0);
  const layers = await page.locator("#panel .layers .number").allInnerTexts();
  assert.equal(layers.map(Number).reduce((a, b) => a + b), spheres);
  await picture(page, "author-filling");
  await save();
  assert.equal(Number(/(\d+) spheres/.exec(ctpm(folder, "check", kScene).out)[1]), spheres);
  console.log(`author: ${spheres} spheres, ${time} ms a tick at rest`);
  const shape = await page.locator("#panel .shape").first().textContent(), { out: plan, err: warned } = ctpm(folder, "plan", kScene, "--quick");
  const { radius_mm, gap_mm } = (await scene()).organs[0].fill;
  assert.doesNotMatch(warned, /tissue thinner/);
  assert.equal(await page.locator("#panel .fine-enough").textContent(), `Fine enough: the organ is nowhere thinner than two spacings (${Number((4 * radius_mm + 2 * gap_mm).toPrecision(4))} mm).`);
  assert.match(shape, /95 % within [\d.]+ mm, all within [\d.]+ mm/);
  assert.ok(plan.includes(`shape of kidney, ${shape}\n`), `${shape}\n---\n${plan}`);
  const started = Date.now();
  const command = ctpmBeside(folder, "fidelity", kScene, "-o", "fidelity", "--quick");
  await button("Measure, short form", "#panel").click();
  await page.waitForSelector("#panel .scatter");
  console.log(`author: scatter, short form, in ${((Date.now() - started) / 1e3).toFixed(1)} s`);
  const cells = (await page.locator("#panel .scatter td").allInnerTexts()).filter((cell) => cell.endsWith("%")).map(Number.parseFloat);
  assert.ok((await command).code < 2);
  const figures = JSON.parse(readFileSync(join(folder, "fidelity", "results.json"), "utf8")).figures.filter((f) => f.figure.startsWith("scatter"));
  assert.deepEqual([...cells].sort(), figures.map((f) => Number.parseFloat(f.measured.toFixed(1))).sort());
  await page.locator("#panel .scatter").scrollIntoViewIfNeeded();
  await picture(page, "author-scatter");
  assert.deepEqual(await seriousFindings(page), []);
  await button("surface").click();
});

step("the stiffness is fitted for other spheres, as by the command, in one step", async () => {
  const before = await text(), other = makeFolder(), warned = page.locator("#panel .warning:has-text('fitted with spheres of 4 mm')");
  await warned.waitFor();
  for (const file of [kScene, ...JSON.parse(before).organs.map(({ mesh }) => mesh)]) cpSync(join(folder, file), join(other, file));
  const shown = await page.locator("#panel .command code:has-text('ctpm fit')").innerText(), command = ctpmBeside(other, ...shown.split(" ").slice(1));
  // One that is stopped changes nothing.
  await page.evaluate(async () => {
    const press = (name) => [...document.querySelectorAll("#panel button")].find((button) => button.textContent === name).click();
    press("Fit the stiffness");
    for (let i = 0; i < 2; ++i) await new Promise((resolve) => requestAnimationFrame(resolve));
    press("cancel");
  });
  await button("Fit the stiffness", "#panel").waitFor();
  assert.equal(await text(), before);
  assert.equal(await page.locator("#panel .problems, #panel .fitted").count(), 0);
  await button("Fit the stiffness", "#panel").click();
  await page.waitForSelector("#panel .working:has-text('fitting')");
  await picture(page, "author-fitting");
  await page.waitForSelector("#panel .fitted");
  const { code, out, err } = await command;
  assert.equal(code, 0, err);
  assert.deepEqual(await scene(), JSON.parse(readFileSync(join(other, kScene), "utf8")));
  assert.equal(await warned.count(), 0);
  const rows = await page.locator("#panel .fitted tbody tr").evaluateAll((list) => list.map((row) => [...row.cells].map((cell) => Number.parseFloat(cell.textContent))));
  const printed = out.split("\n").map((line) => line.trim().split(/\s+/).map(Number)).filter((row) => row.length === 5 && row.every(Number.isFinite));
  assert.equal(rows.length, 6);
  for (const [i, row] of rows.entries()) for (const [k, number] of row.entries()) assert.ok(Math.abs(number - printed[i][k]) < 0.0051, `${row} and ${printed[i]}`);
  await page.locator("#panel .fitted").scrollIntoViewIfNeeded();
  await picture(page, "author-fitted");
  assert.deepEqual(await seriousFindings(page), []);
  await page.keyboard.press("Control+z");
  assert.equal(await text(), before);
  // Who changes the organ meanwhile is told, and keeps the change.
  await page.evaluate(() => {
    [...document.querySelectorAll("#panel button")].find((button) => button.textContent === "Fit the stiffness").click();
    const slider = document.querySelector("#panel .slider input");
    slider.value = String(Number(slider.value) + 20);
    for (const event of ["input", "change"]) slider.dispatchEvent(new Event(event, { bubbles: true }));
  });
  await page.waitForSelector("#panel .problems:has-text('was changed while it was fitted')");
  const { fill, material } = (await scene()).organs[0], was = JSON.parse(before).organs[0];
  assert.ok(fill.radius_mm > was.fill.radius_mm);
  assert.deepEqual(material, was.material);
  await page.keyboard.press("Control+z");
  assert.equal(await text(), before);
  await settled();
  rmSync(other, { recursive: true });
});

step("nothing is lost when the program is killed while a scene is edited", async () => {
  await page.click("header nav button:has-text('Author')");
  await settled(); // the scene that was open is open again
  const changed = (await text()).replace(/"name": "[^"]*"/, '"name": "not saved yet"');
  await write(changed);
  const complaints = studio.complaints.length;
  await studio.kill();
  await page.waitForSelector(".empty:has-text('The studio has ended')");
  assert.deepEqual(await seriousFindings(page), []);
  await picture(page, "author-ended");
  const other = await page.context().newPage();
  await other.goto(await studio.startAgain());
  await page.waitForSelector(".author .editor-frame");
  await other.close(); // a page behind another one is not drawn
  await settled();
  assert.equal(await text(), changed);
  await page.keyboard.press("Control+z");
  assert.notEqual(await text(), changed);
  await page.keyboard.press("Control+Shift+z");
  await page.keyboard.press("Control+s");
  await untilSaved();
  assert.equal(onDisk(), changed);
  studio.complaints.splice(complaints); // that nothing answered
});

step("it fits other windows", async () => {
  await page.click("header nav button:has-text('Author')");
  for (const [width, height] of [[1280, 720], [1920, 1080], [820, 1180]]) {
    await page.setViewportSize({ width, height });
    await page.click(`.scenes button:has-text('my-kidney-scene')`);
    await settled();
    assert.ok((await overflow(page)) <= 0);
    await picture(page, `author-${width}x${height}`);
  }
});

step("every scene that was saved is one that the program takes", taken);

step("a place to drop is seen while files are dragged, and which of several is not taken is said", async () => {
  await page.setViewportSize({ width: 1280, height: 720 });
  const target = page.locator(".drop-target"), files = await dragged(["organs.mtl", "newmtl red"], ["first.obj", "v 0 0 0"], ["second.NII.GZ", "map"]);
  const hold = (event, relatedTarget = null) => page.dispatchEvent(".view > canvas", event, { dataTransfer: files, relatedTarget });
  assert.equal(await target.count(), 0);
  await hold("dragover");
  await target.waitFor();
  await picture(page, "author-drag");
  await hold("dragleave");
  await target.waitFor({ state: "detached" });
  await hold("dragover");
  await hold("drop");
  await target.waitFor({ state: "detached" });
  assert.equal(await page.locator("aside .readings dd").first().innerText(), "first.obj"); // the first that is read
  assert.match(await page.locator("aside .warning").innerText(), /organs\.mtl, second\.NII\.GZ were left out/);
  await picture(page, "author-left-out");
  await button("Back", "aside").click();
  // The chooser offers what the program reads.
  const offered = await page.locator(".pick input").getAttribute("accept");
  assert.deepEqual(offered.split(","), await studio.call("scene.formats", {}));
  for (const ending of [".msh", ".vtu", ".nrrd", ".stl"]) assert.ok(offered.split(",").includes(ending), offered);
});

step("each label that is chosen of a segmentation becomes an organ, also of a scene that is open", async () => {
  const before = await text();
  await page.setInputFiles(".pick input", join(paths.source, "tests", "importers", "maps", "names.seg.nrrd"));
  await page.click("aside label:has-text('an organ of')");
  const radius = page.locator("aside .field:has-text('radius') input");
  await radius.fill("0");
  await page.waitForSelector("aside .warning:has-text('The radius: from 0.01 to 100 mm')");
  assert.ok(await button("Import", "aside").isDisabled());
  await radius.fill("");
  await radius.pressSequentially("4,0"); // as a decimal point is written in many countries
  assert.equal(await radius.inputValue(), "4.0");
  await button("Import", "aside").click();
  await page.waitForSelector("aside .problems:has-text('choose one of left_kidney, stone')");
  assert.ok(existsSync(join(folder, "names.seg.nrrd")), "for another try");
  await page.locator("aside .field:has-text('labels') input").fill("left_kidney, stone");
  assert.match(await page.locator("aside .command code").innerText(), /--label left_kidney --label stone .* --into my-kidney-scene\.json --beside$/);
  await button("Import", "aside").click();
  await page.waitForSelector("aside .good:has-text('names-seg.json')");
  assert.ok(!existsSync(join(folder, "names.seg.nrrd")));
  await settled();
  const organs = (await scene()).organs, known = JSON.parse(before).organs.length;
  assert.equal(organs.length, known + 2);
  assert.deepEqual(organs[known].at_mm, organs[known + 1].at_mm); // as they lie to each other in the file
  await picture(page, "author-labels");
  await page.keyboard.press("Control+z");
  assert.equal(await text(), before);
});

step("an upload goes with its page, also before the program was asked to import it", async () => {
  await page.evaluate(() => {
    const send = WebSocket.prototype.send;
    WebSocket.prototype.send = function (message) {
      if (!String(message).includes('"scene.import"')) send.call(this, message);
    };
  });
  await drop("gone.obj", largeMesh(2000, 0.1));
  await button("Import", "aside").click();
  const left = () => readdirSync(folder).filter((name) => name.startsWith("gone"));
  assert.deepEqual(await until(left, (names) => names.includes("gone.obj")), ["gone.obj"]);
  await page.goto("about:blank");
  assert.deepEqual(await until(left, (names) => names.length === 0), []);
});

step("nothing was complained about", () => assert.deepEqual(studio.complaints, []));
