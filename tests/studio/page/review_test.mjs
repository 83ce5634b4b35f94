// A reviewer in a browser: review_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { ctpm, ctpmBeside, keepBack, leave, makeFolder, openStudio, overflow, paths, picture, pixelsOf, rareStep, reading, seriousFindings, step, until } from "./browser.mjs";

const kExpert = "kidney-cut-expert.ctpm";
let folder, studio, page, expert;

before(async () => {
  folder = makeFolder(kExpert, "liver-press-expert.ctpm");
  expert = JSON.parse(ctpm(folder, "info", kExpert, "--json").out);
  studio = await openStudio(folder);
  page = studio.page;
  // Keeps what the program sends, for the test that spoils it.
  await page.addInitScript(() => {
    globalThis.came = {};
    globalThis.WebSocket = class extends WebSocket {
      constructor(...of) {
        super(...of);
        globalThis.socket = this;
        this.addEventListener("message", ({ data }) => data instanceof ArrayBuffer && data.byteLength >= 4 && (globalThis.came[new Uint32Array(data, 0, 1)[0]] ??= data.slice(0)));
      }
    };
  });
  await keepBack(page);
  await page.reload();
  await page.click("header nav button:has-text('Review')");
});

after(() => leave(studio, folder));

const clock = async () => Number.parseFloat(await page.locator(".clock").innerText());
const drawn = () => page.locator(".view > canvas").screenshot();
const quiet = () => page.waitForFunction(() => /\d+ ms/.test([...document.querySelectorAll(".readings div")].find((d) => d.textContent.includes("picture after"))?.textContent ?? ""));

const replayedQuiet = () => page.waitForFunction(() => /\d+ ms/.test([...document.querySelectorAll(".readings div")].find((d) => d.textContent.includes("replayed after"))?.textContent ?? ""));

step("the token leaves the address bar, and an empty page says what to do", async () => {
  assert.ok(!page.url().includes("token"));
  assert.match(await page.locator(".view .empty").innerText(), /Choose a session/);
  assert.deepEqual(await seriousFindings(page), []);
  await picture(page, "review-empty");
});

step("a session opens, and any moment of it is a press away", async () => {
  const command = ctpmBeside(folder, "replay", kExpert, "--csv", "replay.csv");
  await page.click(".list button:has-text('kidney-cut-expert')");
  await page.waitForSelector(".uplot");
  await quiet();
  const start = await drawn();
  const plots = await page.locator(".plots").boundingBox();
  await page.mouse.click(plots.x + 64 + 0.55 * (plots.width - 78), plots.y + 20);
  await replayedQuiet();
  assert.ok(Math.abs((await clock()) - 0.55 * expert.duration_s) < 0.05);
  assert.ok((await reading(page, "severed")) > 20);
  assert.ok(!start.equals(await drawn()));
  // The numbers of this moment are those of the command.
  const tick = await reading(page, "step");
  assert.equal((await command).code, 0);
  const row = readFileSync(join(folder, "replay.csv"), "utf8").split("\n")[tick].split(",");
  assert.equal(row[0], String(tick - 1));
  assert.equal((await reading(page, "force")).toFixed(2), Number(row[14]).toFixed(2));
  assert.deepEqual(await seriousFindings(page), []);
  await picture(page, "review-moment");
});

step("what happened is marked on the timeline, at its time", async () => {
  const marks = await page.locator(".marks .mark").evaluateAll((all) => all.map((mark) => [mark.title, Number(mark.style.getPropertyValue("--at"))]));
  const events = expert.events.filter(({ kind }) => kind !== "late tick"); // of the machine, not of the hand
  assert.ok(events.some(({ kind }) => kind === "cut") && events.some(({ kind }) => kind === "contact begins"));
  assert.deepEqual(marks.map(([title]) => title), events.map(({ tick, text }) => `${(tick * expert.tick_s).toFixed(3)} s ${text}`));
  assert.deepEqual(await page.locator(".mark-legend li").allInnerTexts(), [...new Set(events.map(({ kind }) => kind))]);
  for (const [i, { tick }] of events.entries()) assert.ok(Math.abs(marks[i][1] - (tick * expert.tick_s) / expert.duration_s) < 1e-6, marks[i][0]);
});

step("where the browser draws with the processor, what faces away is left out, wherever it is seen from", async () => {
  await page.evaluate(() => {
    globalThis.largest = 0; // triangles of one draw: those of the organ
    const draw = WebGL2RenderingContext.prototype.drawElements;
    WebGL2RenderingContext.prototype.drawElements = function (mode, count, ...of) {
      globalThis.largest = Math.max(globalThis.largest, count / 3);
      return draw.call(this, mode, count, ...of);
    };
  });
  // Before anything is cut.
  await page.locator(".scrub").evaluate((slider) => {
    slider.value = "0";
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  });
  await replayedQuiet();
  await page.waitForTimeout(600); // the picture that stands still
  const obj = readFileSync(join(paths.source, "scenes", "organs", "kidney.obj"), "utf8"), all = obj.split("\n").filter((line) => line.startsWith("f ")).length;
  await page.locator(".view > canvas").focus();
  const shares = [];
  for (let turn = 0; turn < 4; ++turn) {
    await page.evaluate(() => (globalThis.largest = 0));
    for (let i = 0; i < 8; ++i) await page.keyboard.press("d");
    await page.waitForFunction(() => globalThis.largest > 0);
    shares.push((await page.evaluate(() => globalThis.largest)) / all);
  }
  console.log(`of ${all} triangles are drawn, from four sides: ${shares.map((share) => `${(100 * share).toFixed(0)} %`).join(", ")}`);
  for (const share of shares) assert.ok(share > 0.3 && share < 0.7, `${shares}`);
  for (let i = 0; i < 32; ++i) await page.keyboard.press("a");
});

step("full stop and comma zoom the timeline, + and - the view alone", async () => {
  await page.locator(".view > canvas").focus();
  await page.keyboard.press("+");
  await page.keyboard.press("-");
  assert.equal(await page.locator(".zoom output").count(), 0);
  await page.keyboard.press(".");
  await page.waitForSelector(".zoom output");
  await page.keyboard.press(",");
  await page.waitForSelector(".zoom output", { state: "detached" });
});

step("keys move and play it", async () => {
  const before = await clock();
  await page.locator(".view > canvas").focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Shift+ArrowRight");
  await page.waitForFunction((t) => Math.abs(Number.parseFloat(document.querySelector(".clock").textContent) - t - 0.11) < 0.002, before);
  await page.keyboard.press("Home");
  await page.keyboard.press("Space");
  await page.waitForFunction(() => Number.parseFloat(document.querySelector(".clock").textContent) > 0.5);
  await page.keyboard.press("Space");
  const paused = await clock();
  await page.waitForTimeout(300);
  assert.equal(await clock(), paused);
  // At a tenth of the speed, and four times as fast: as far as time has gone, or less where the machine is slow.
  const place = () => page.locator(".transport button.main").evaluate((button) => button.getBoundingClientRect().y), rests = await place();
  const rateAt = async (speed) => {
    await page.locator(".transport select").selectOption(String(speed));
    await page.keyboard.press("Home");
    await page.click(".transport button.main");
    const [began, from] = [Date.now(), await clock()];
    await page.waitForTimeout(800);
    await page.waitForFunction((from) => Number.parseFloat(document.querySelector(".clock").textContent) > from, from); // the picture before may take long
    const [went, far] = [(Date.now() - began) / 1e3, (await clock()) - from];
    assert.equal(await place(), rests, `where Pause is, ${await page.locator(".pace").count() ? "and that it plays slower is said" : "playing"}`);
    await page.click(".transport button.main");
    assert.ok(far > 0 && far <= speed * (went + 0.1), `${speed} x: ${far} s in ${went} s`);
    return far / went;
  };
  const [slow, fast] = [await rateAt(0.1), await rateAt(4)];
  assert.ok(fast > 3 * slow, `${fast} and ${slow}`);
  await page.locator(".transport select").selectOption("1");
  await page.locator(".view > canvas").focus();
  await page.keyboard.press("End");
  await page.waitForFunction((seconds) => Math.abs(Number.parseFloat(document.querySelector(".clock").textContent) - seconds) < 1e-3, expert.duration_s);
});

step("scrubbing", async () => {
  const times = [], replayed = [];
  await page.evaluate(() => {
    globalThis.compiled = 0;
    const link = WebGL2RenderingContext.prototype.linkProgram;
    WebGL2RenderingContext.prototype.linkProgram = function (...of) {
      ++globalThis.compiled;
      return link.apply(this, of);
    };
  });
  for (let i = 0; i < 13; ++i) {
    const time = ((i * 7919) % 5000) / 1000;
    await page.locator(".scrub").evaluate((slider, value) => {
      slider.value = String(value);
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    }, time);
    await quiet();
    await replayedQuiet();
    times.push(await reading(page, "picture after"));
    replayed.push(await reading(page, "replayed after"));
  }
  const of = (list) => list.sort((a, b) => a - b);
  console.log(`scrubbing: half within ${of(times)[6]} ms, all within ${times[12]} ms from release to picture, ${of(replayed)[6]} ms and ${replayed[12]} ms to the replayed one (286 spheres, software WebGL)`);
  assert.ok(times.every((time, i) => time <= replayed[i])); // both in the order of their lengths
  // A cut has new triangles, and the materials that the whole organ has.
  assert.ok((await page.evaluate(() => globalThis.compiled)) <= 2, "materials are not compiled again for each cut");
});

/** How far the picture that the shown command makes of 2.6 s is from the page's drawing: at most, and the share of colours that differ by
    more than can be told, of which less than `share` is alike enough. */
async function filmAndPage(shown, still, share = 0) {
  const size = await page.evaluate(() => [document.querySelector(".drawings canvas").width, document.querySelector(".drawings canvas").height]);
  const made = await ctpmBeside(folder, ...(await shown()).split(" ").slice(1).map((word) => (word.endsWith(".mp4") ? still : word)),
    "--from-s", "2.599", "--to-s", "2.6", "--overlay", "none", "--size", size.join("x"));
  assert.equal(made.code, 0, made.err);
  const last = readdirSync(join(folder, still)).filter((name) => name.endsWith(".png")).sort().at(-1);
  const film = pixelsOf(readFileSync(join(folder, still, last))).data;
  const apart = async () => {
    const drawn = await page.evaluate(() => document.querySelector(".drawings canvas").toDataURL());
    const differences = pixelsOf(Buffer.from(drawn.split(",")[1], "base64")).data.map((x, i) => Math.abs(x - film[i]));
    return { most: differences.reduce((most, x) => Math.max(most, x), 0), share: differences.filter((x) => x > 24).length / differences.length };
  };
  const isAlike = (now) => now.most === 0 || now.share < share;
  return { ...(await until(apart, isAlike, 5)), size }; // the page's newest drawing may still be on its way
}

step("a view that is turned faster than the program answers stays where it was turned to", async () => {
  await page.click("#tab-export");
  await page.locator(".view > canvas").focus();
  await page.evaluate(async () => {
    for (let i = 0; i < 24; ++i) {
      document.activeElement.dispatchEvent(new KeyboardEvent("keydown", { key: i < 18 ? "d" : "a", bubbles: true }));
      await new Promise((resolve) => setTimeout(resolve, 12));
    }
  });
  await studio.quiet(1000);
  // What is seen is told once no camera is chosen any more, until the program has chosen one.
  const [turned, seen] = await page.evaluate(async () => {
    const camera = () => /--camera (\S+)/.exec(document.querySelector("#panel .command code").textContent)[1].split(/[,:]/).map(Number), before = camera();
    const select = [...document.querySelectorAll(".look-bar label")].find((label) => label.textContent.startsWith("camera")).querySelector("select");
    select.value = "";
    select.dispatchEvent(new Event("change", { bubbles: true }));
    await Promise.resolve();
    return [before, camera()];
  });
  assert.ok(turned.every((mm, i) => Math.abs(mm - seen[i]) < 0.05), `turned to ${turned}, seen from ${seen}`);
  await page.keyboard.press("d");
});

step("views, cutaway and cameras are those of export", async () => {
  const choose = (label, value) => page.locator(`.look-bar label:has-text("${label}") select`).selectOption(value);
  const drawing = () => page.waitForSelector(".drawings canvas:not([hidden])");
  const pixels = () => page.evaluate(() => document.querySelector(".drawings canvas").toDataURL());
  await page.locator(".scrub").evaluate((slider) => {
    slider.value = "2.6";
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  });
  await page.click("#tab-export");
  const camera = async () => /--camera (\S+)/.exec(await page.locator("#panel .command code").innerText())[1];
  const turnedCamera = await camera(); // by keys
  const isApart = (seen) => seen.split(/[,:]/).some((mm, i) => Math.abs(mm - turnedCamera.split(/[,:]/)[i]) > 1);
  await choose("camera", "");
  const firstCamera = await until(camera, isApart, 60);
  assert.ok(isApart(firstCamera), `${firstCamera} from ${turnedCamera}`);
  // Until the program has drawn it, it is said that it does.
  const notice = page.locator(".view .drawing"), isKept = () => page.evaluate(() => void (globalThis.holds = () => true));
  const comes = async () => {
    await page.evaluate(() => globalThis.letGo());
    await drawing();
    await notice.waitFor({ state: "detached" });
  };
  await isKept();
  await choose("view", "spheres");
  await notice.waitFor();
  assert.equal(await notice.innerText(), "drawing: spheres …");
  assert.equal(await page.locator(".drawings canvas:not([hidden])").count(), 0, "the picture before is still there");
  await picture(page, "review-drawing");
  await comes();
  const seen = new Set([await pixels()]);
  await isKept();
  await page.locator(".scrub").evaluate((slider) => {
    for (const at of ["2.5", "2.6"]) {
      slider.value = at;
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    }
  });
  await notice.waitFor();
  await comes();
  await picture(page, "review-spheres");
  for (const [label, value] of [["view", "elements tilt"], ["view", "surface"], ["cutaway", "y"], ["camera", "follow"]]) {
    await choose(label, value);
    if (value === "surface") {
      await page.waitForSelector(".drawings canvas[hidden]", { state: "attached" });
      continue;
    }
    await page.waitForFunction((known) => {
      const canvas = document.querySelector(".drawings canvas");
      return !canvas.hidden && !known.includes(canvas.toDataURL());
    }, [...seen]);
    seen.add(await pixels());
    if (value.startsWith("elements")) assert.match(await page.locator(".legend").innerText(), /tilt/);
    await picture(page, `review-${value.replace(" ", "-")}`);
  }
  assert.deepEqual(await seriousFindings(page), []);
  // The export has the same words.
  await page.click("#tab-export");
  const shown = () => page.locator("#panel .command code").innerText();
  assert.match(await shown(), /--camera follow --cutaway y/);
  // The cutaway's place, the mouse, the wheel, keys and the other side each make another picture.
  const changed = async (what) => {
    await page.waitForFunction((known) => {
      const canvas = document.querySelector(".drawings canvas");
      return !canvas.hidden && !known.includes(canvas.toDataURL());
    }, [...seen], { timeout: 20000 }).catch(() => assert.fail(`nothing changed: ${what}`));
    await studio.quiet(); // until the last picture of a turn
    seen.add(await pixels());
  };
  await choose("camera", "");
  await page.locator(".look-bar .plane input").evaluate((slider) => {
    slider.value = "-8";
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  });
  await changed("place of the cutaway");
  assert.match(await shown(), /--camera [-\d.]+,.* --cutaway y=-8$/);
  // The camera that the program chose for the page is the film's too.
  const kAlike = 2e-3, apart = await filmAndPage(shown, "chosen/", kAlike);
  assert.ok(apart.share < kAlike, `the program's camera: ${JSON.stringify(apart)}`);
  const view = await page.locator(".view > canvas").boundingBox();
  await page.mouse.move(view.x + 200, view.y + 150);
  await page.mouse.down();
  await page.mouse.move(view.x + 320, view.y + 170, { steps: 6 });
  await page.mouse.up();
  await changed("mouse");
  const turned = await shown();
  assert.match(turned, /--camera [-\d.]+,[-\d.]+,[-\d.]+:/);
  await page.mouse.wheel(0, -200);
  await changed("wheel");
  await page.locator(".view > canvas").focus();
  await page.keyboard.press("d");
  await changed("key that turns");
  await page.keyboard.press("-");
  await changed("key that moves away");
  await page.click(".look-bar .plane button");
  await changed("other side");
  await choose("view", "elements force");
  await changed("elements");
  await picture(page, "review-turned");
  // The command that it shows sees the same.
  const same = await filmAndPage(shown, "still/"), { size } = same;
  assert.equal(same.most, 0, "the film's picture is the page's");
  // Its size is that of its place.
  await page.setViewportSize({ width: 1500, height: 900 });
  await page.waitForFunction((before) => {
    const canvas = document.querySelector(".drawings canvas"), place = document.querySelector(".view > canvas");
    return canvas.width !== before && Math.abs(canvas.width - place.clientWidth) <= 1 && Math.abs(canvas.height - place.clientHeight) <= 1;
  }, size[0]);
  await page.setViewportSize({ width: 1280, height: 720 });
  // Back to how it was seen at first, chosen faster than it is drawn: the program's camera, and the page's own picture.
  await choose("view", "surface");
  await choose("camera", "");
  await choose("cutaway", "");
  await page.waitForFunction((first) => document.querySelector("#panel .command code").textContent.includes(`--camera ${first}`), firstCamera, { timeout: 60000 }).catch(async () => {
    const looks = await page.locator(".look-bar select").evaluateAll((all) => all.map((select) => select.value));
    assert.fail(`${await shown()} is not from ${firstCamera}; chosen: ${looks}; said: ${await page.locator(".problems").allInnerTexts()}`);
  });
  await page.waitForSelector(".drawings canvas[hidden]", { state: "attached" });
  await page.click("#tab-moment");
});

step("a picture of the moment is the command's that is shown", async () => {
  await page.click("#tab-export");
  await page.click("button:has-text('Save a picture of')");
  const said = await page.locator("#panel .good").first().innerText(), name = /^(kidney-cut-expert-[\d.]+s\.png) is written$/.exec(said)?.[1];
  assert.ok(name, said);
  const shown = await page.locator("#panel .command code").first().innerText();
  assert.ok(shown.includes(`-o ${name} --at-s`), shown);
  const again = ctpm(folder, ...shown.replace(name, "again.png").split(" ").slice(1));
  assert.equal(again.code, 0, again.err);
  assert.ok(readFileSync(join(folder, name)).equals(readFileSync(join(folder, "again.png"))));
  const fetched = page.waitForEvent("download");
  await page.click(`button:has-text('Download ${name}')`);
  assert.equal((await fetched).suggestedFilename(), name);
  await picture(page, "review-still");
  assert.deepEqual(await seriousFindings(page), []);
});

step("it fits a desk, a large screen and a tablet", async () => {
  await page.click("#tab-export"); // the longest panel
  for (const [width, height] of [[1280, 720], [1920, 1080], [820, 1180]]) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(400);
    assert.ok((await overflow(page)) <= 0, `${width}x${height}`);
    await picture(page, `review-${width}x${height}`);
  }
  // On a tablet what is below the picture is scrolled, and the picture stays.
  const top = await page.locator("main").evaluate((main) => {
    main.scrollTop = main.scrollHeight;
    return main.scrollTop > 0 ? main.getBoundingClientRect().top : null;
  });
  assert.ok(top !== null, "there is something to scroll");
  const view = await page.locator(".view").boundingBox(), tabs = await page.locator(".tabs").boundingBox();
  assert.equal(view.y, top);
  assert.ok(Math.abs(tabs.y - view.y - view.height) < 2, `what chooses a panel stays below the picture: ${tabs.y} and ${view.y + view.height}`);
  await picture(page, "review-820x1180-scrolled");
  await page.locator("main").evaluate((main) => void (main.scrollTop = 0));
  assert.deepEqual(await seriousFindings(page), []);
});

step("what cannot be read is left out and said, and the page goes on", async () => {
  await page.setViewportSize({ width: 1280, height: 720 });
  await page.click(".list button:has-text('kidney-cut-expert')");
  await page.waitForSelector(".uplot");
  await page.click("#tab-moment");
  await quiet();
  // Each: the kind of message, and what the page is given in its place.
  const spoilt = {
    "empty": [2, () => new ArrayBuffer(0)],
    "of an unknown kind": [2, (bytes, u32) => (u32[0] = 9)],
    "cut off": [2, (bytes) => bytes.slice(0, bytes.byteLength - 8)],
    "longer than it says": [2, (bytes) => Uint8Array.from([...new Uint8Array(bytes), 0, 0, 0, 0]).buffer],
    "of more organs than follow": [2, (bytes, u32) => (u32[31] = 4e9)],
    "of more vertices than follow": [2, (bytes, u32) => (u32[32] = 4e9)],
    "of a triangle without vertices": [1, (bytes, u32) => (u32[8] = u32[4])],
    "of more triangles than follow": [1, (bytes, u32) => (u32[6] = 4e9)],
    "of a tool's vertices that do not follow": [3, (bytes, u32) => (u32[3] = 4e9)],
    "of more of an expert's line than follows": [2, () => Uint32Array.of(6, 0, 1, 2, 0, 0, 0, 0, 0, 0, 0).buffer],
  };
  const comes = (kind, spoil) => page.evaluate(`(() => {
    const bytes = globalThis.came[${kind}].slice(0), made = (${spoil})(bytes, new Uint32Array(bytes));
    globalThis.socket.dispatchEvent(new MessageEvent("message", { data: made instanceof ArrayBuffer ? made : bytes }));
    return bytes.byteLength;
  })()`);
  const alert = page.locator(".unreadable");
  const severedAt = async (share) => {
    const plots = await page.locator(".plots").boundingBox();
    await page.mouse.click(plots.x + 64 + share * (plots.width - 78), plots.y + 20);
    await replayedQuiet();
    return reading(page, "severed");
  };
  assert.ok((await severedAt(0.2)) < (await severedAt(0.8)));
  for (const [how, [kind, spoil]] of Object.entries(spoilt)) {
    assert.ok((await comes(kind, spoil)) > 100, how);
    await alert.waitFor();
    assert.match(await alert.innerText(), /cannot read/, how);
    if (kind === 3) await picture(page, "review-unreadable");
    await alert.locator("button.quiet").click();
    await alert.waitFor({ state: "detached" });
  }
  // A frame of other triangles than those that are here: nothing to say, as the right ones follow.
  await page.evaluate(() => {
    const data = globalThis.came[2].slice(0);
    new Uint32Array(data)[2] = 4e9;
    globalThis.socket.dispatchEvent(new MessageEvent("message", { data }));
    globalThis.socket.dispatchEvent(new MessageEvent("message", { data: "no JSON" }));
  });
  await alert.waitFor();
  assert.deepEqual(await seriousFindings(page), []);
  await alert.locator("button.quiet").click();
  const early = await severedAt(0.2);
  assert.ok(early < (await severedAt(0.8)), "it still shows any moment");
});

step("a picture that stands still is finer than one that moves", async () => {
  await page.evaluate(() => {
    const { viewport, drawElements } = WebGL2RenderingContext.prototype;
    let right = 0;
    Object.assign(WebGL2RenderingContext.prototype, {
      viewport(x, y, width, height) {
        right = x + width; // that of the last session is at the edge
        viewport.call(this, x, y, width, height);
      },
      drawElements(...what) {
        globalThis.drawnWidth = right;
        drawElements.call(this, ...what);
      },
    });
  });
  // Pixels that are drawn for one of the page; the browser of these tests draws with the processor.
  const finer = (is) => page.waitForFunction((is) => is === (globalThis.drawnWidth / document.querySelector(".view > canvas").clientWidth > 1.9), is);
  const canvas = page.locator(".view > canvas");
  await canvas.focus();
  await page.keyboard.press("a");
  await finer(true);
  const before = await canvas.screenshot();
  await page.evaluate(() => {
    const canvas = document.querySelector(".view > canvas");
    globalThis.turning = setInterval(() => canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "d", bubbles: true })), 40);
  });
  await finer(false);
  await page.evaluate(() => clearInterval(globalThis.turning));
  await finer(true);
  assert.notDeepEqual(await canvas.screenshot(), before, "the finer picture is the newest one");
});

step("who looks into another room finds the session as it was, at its moment", async () => {
  const placed = () => (({ searchParams }) => [searchParams.get("session"), searchParams.get("t")])(new URL(page.url().replace("#", "?")));
  const before = await until(placed, ([session, time]) => session === kExpert && time > 0);
  await page.click("header nav button:has-text('Author')");
  await page.waitForSelector(".author");
  await page.click("header nav button:has-text('Review')");
  await page.waitForFunction((time) => document.querySelector(".review .clock")?.textContent.startsWith(Number(time).toFixed(3)), before[1]);
  assert.deepEqual(await until(placed, ([, time]) => time === before[1]), before);
  // The browser's own Back and Forward go through the rooms, too.
  await page.goBack();
  await page.waitForSelector(".author");
  await page.goBack();
  await page.waitForFunction((time) => document.querySelector(".review .clock")?.textContent.startsWith(Number(time).toFixed(3)), before[1]);
  await page.goForward();
  await page.waitForSelector(".author");
  await page.goForward();
  await page.waitForSelector(".review .clock");
});

rareStep("of a session that cannot be read the reason stays until another one is chosen, and nothing of the one before", async () => {
  writeFileSync(join(folder, "no-session.ctpm"), "a letter");
  for (const room of ["Author", "Review"]) await page.click(`header nav button:has-text('${room}')`);
  const choose = (name) => page.click(`.list button:has-text('${name}')`), problem = page.locator(".view .problems"), canvas = ".drawings canvas";
  await choose("kidney-cut-expert");
  await page.locator('.look-bar label:has-text("cutaway") select').selectOption("y");
  await page.waitForSelector(`${canvas}:not([hidden])`);
  await page.waitForFunction(() => location.hash.includes("kidney-cut-expert"));
  await choose("no-session");
  await page.waitForSelector(`${canvas}[hidden]`, { state: "attached" });
  const told = async () => {
    await page.waitForFunction(() => document.querySelector(".view .empty")?.textContent.includes("no-session.ctpm cannot be shown"));
    await page.waitForTimeout(1000); // what was asked of the session before is answered by now
    assert.match(await problem.innerText(), /no-session\.ctpm: is not a session/);
    assert.equal(new URL(page.url()).hash, "#room=review");
  };
  await told();
  await picture(page, "review-unopened");
  // Chosen while the one before is still being looked at.
  await choose("kidney-cut-expert");
  await page.waitForSelector(".captions");
  await choose("no-session");
  await told();
  assert.equal(await page.locator(`${canvas}:not([hidden])`).count(), 0);
  // Beside another one it is said too, until that is put away.
  await choose("kidney-cut-expert");
  await page.click("#tab-compare");
  assert.equal(await problem.count(), 0);
  await page.locator("#panel select").selectOption("no-session.ctpm");
  await problem.waitFor();
  await page.waitForTimeout(1000);
  assert.match(await problem.innerText(), /no-session\.ctpm: is not a session/);
  await problem.locator("button").click();
  await problem.waitFor({ state: "detached" });
});

step("nothing was complained about", () => assert.deepEqual(studio.complaints, []));
