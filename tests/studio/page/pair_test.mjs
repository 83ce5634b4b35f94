// A reviewer of two sessions in a browser: pair_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { ctpm, ctpmBeside, keepBack, leave, makeFolder, openStudio, outOfReach, picture, pixelsOf, rareStep, seenFirst, seriousFindings, step, wordsOf } from "./browser.mjs";
import { changeNotes } from "./reviewer_page.mjs";

const kExpert = "kidney-cut-expert.ctpm", kClumsy = "kidney-cut-clumsy.ctpm", kOther = "liver-press-expert.ctpm";
let folder, studio, page, expert, clumsy;
let path, command; // moments of both along the path, and the command that compares

/** When an event of that kind first happened [s]. */
function firstOf(info, kind) {
  return info.events.find((event) => event.kind === kind).tick * info.tick_s;
}

before(async () => {
  folder = makeFolder(kExpert, kClumsy, kOther);
  [expert, clumsy] = [kExpert, kClumsy].map((name) => JSON.parse(ctpm(folder, "info", name, "--json").out));
  studio = await openStudio(folder);
  page = studio.page;
  await keepBack(page);
  await page.reload();
  await page.click("header nav button:has-text('Review')");
});

after(() => leave(studio, folder));

const clock = async () => Number.parseFloat(await page.locator(".clock").innerText());
const ahead = async () => Number(await page.locator("#panel input[type=number]").inputValue());
const offsetAt = (kind) => Number((firstOf(clumsy, kind) - firstOf(expert, kind)).toFixed(3));

/** Waits until the trainee's session is shown at a time that is told to 10 ms. */
const untilTrainee = (time) => page.waitForFunction((time) => Math.abs(Number(/([-\d.]+) s$/.exec(document.querySelector(".captions .second").textContent)?.[1]) - time) < 6e-3, time);

step("of sessions of two scenes it is said at once that they cannot be compared", async () => {
  await page.click(".list button:has-text('kidney-cut-expert')");
  await page.waitForSelector(".uplot");
  await page.click("#tab-compare");
  await page.locator("#panel select").selectOption(kOther);
  const notice = page.locator(".other-scene"), difference = page.locator(".plots div[data-title='difference of force [N]']");
  const compare = page.locator("#panel button:text-is('Compare')"), path = page.locator("#panel button:text-is('path')");
  await notice.waitFor();
  assert.match(await notice.innerText(), /cannot be compared.*liver-press-expert\.ctpm is of another scene.*liver instead of kidney/s);
  await page.waitForFunction(() => document.querySelector(".plots div[data-title='force [N]']")?.dataset.at.includes(" · ")); // both have curves
  assert.equal(await difference.count(), 0);
  assert.ok((await compare.isDisabled()) && (await path.isDisabled()));
  assert.deepEqual(await seriousFindings(page), []);
  await studio.quiet(1000);
  await picture(page, "review-other-scene");
  // Both organs are in the picture, although one is larger: none of its edges has tissue.
  const count = async () => {
    const { width, height, data } = pixelsOf(await page.locator(".view > canvas").screenshot());
    let all = 0, edges = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (data[i] < 60 || data[i] < 1.8 * data[i + 1] || data[i] < 1.8 * data[i + 2]) continue;
      const x = (i / 4) % width, y = Math.floor(i / 4 / width), middle = Math.abs(x - width / 2);
      ++all, edges += x < 5 || x > width - 6 || y > height - 6 || middle < 3;
    }
    return [all, edges];
  };
  let [inAll, atEdges] = await count();
  for (const began = Date.now(); atEdges > 0 && Date.now() < began + 20_000; ) [inAll, atEdges] = await count(); // a loaded machine draws late
  assert.ok(inAll > 3000 && atEdges === 0, `${atEdges} of ${inAll} pixels of tissue are at an edge`);
  await page.locator("#panel select").selectOption(kClumsy);
  await difference.waitFor();
  assert.equal(await notice.count(), 0);
  assert.ok((await compare.isEnabled()) && (await path.isEnabled()));
  await page.locator("#panel select").selectOption("");
});

step("from a pair of sessions to a video of its worst moment", async () => {
  await page.click(".list button:has-text('kidney-cut-expert')");
  await page.waitForSelector(".uplot");
  const began = Date.now();
  await page.click("#tab-compare");
  await page.locator("#panel select").selectOption(kClumsy);
  await page.waitForSelector(".captions .second");
  await page.click("#panel button.main");
  for (const tab of ["moment", "compare"]) await page.click(`#tab-${tab}`);
  assert.ok(await page.locator("#panel .working, #panel table").count(), "it goes on while another tab is looked at");
  await page.waitForSelector("#panel table");
  await page.waitForFunction(() => document.querySelector("#panel").scrollTop === 0);
  const seen = await seenFirst(page, "#panel");
  console.log(`of the comparison is seen without scrolling: ${JSON.stringify(seen)}`);
  assert.ok(seen.advice && seen.moments >= Math.min(3, seen.of) && seen.measuresAfter, JSON.stringify(seen));
  await picture(page, "review-compared");
  const worst = page.locator("#panel .jumps button").first(), when = Number.parseFloat(await worst.innerText());
  const fault = (await worst.innerText()).replace(/^[\d.]+ s /, "");
  await worst.click();
  await untilTrainee(when);
  const [shown, there] = (await page.locator(".captions b").allInnerTexts()).map((text) => / ([-\d.]+) s$/.exec(text)[1]);
  await page.click("#tab-export");
  // Nothing chosen, the video has both beside each other as they are here.
  assert.equal(Number(/--align (\S+)/.exec(await page.locator("#panel .command code").innerText())[1]).toFixed(3), (Number(there) - Number(shown)).toFixed(3));
  await page.locator('#panel .field:has-text("file in the folder") input').fill("worst.avi");
  await page.locator('#panel .field:has-text("pictures a second") input').fill("10");
  await page.locator('#panel .field:has-text("size") select').selectOption("854x480");
  await page.click("#panel button:has-text('1 s before')");
  // The film says what is wrong, in the words of the page.
  const caption = page.locator('#panel .field:has-text("caption") input');
  assert.equal(await caption.inputValue(), fault);
  assert.equal(wordsOf(await page.locator("#panel .command code").innerText()).at(-3), fault); // before the camera
  await page.click("#panel button.main");
  await page.waitForSelector("#panel .good:has-text('worst.avi')");
  console.log(`a video of the worst moment ${((Date.now() - began) / 1e3).toFixed(1)} s after the comparison was opened`);
  const [from, to] = await Promise.all(["from [s]", "to [s]"].map(async (label) => Number(await page.locator(`#panel .field:has-text("${label}") input`).inputValue())));
  assert.ok(from <= Number(shown) + 0.01 && Number(shown) - 0.01 <= to && to - from > 0.4, `${shown} s, and a video from ${from} to ${to} s`);
  assert.ok(readFileSync(join(folder, "worst.avi")).length > 1e4);
  // The next one is not to be where that one is: its name has the moment, and none that is taken is exported to.
  const name = page.locator('#panel .field:has-text("file in the folder") input'), of = `${kClumsy}-beside-${kExpert}`.replaceAll(".ctpm", "");
  await page.waitForFunction((name) => document.querySelector("#panel .field input").value === name, `${of}-${Number(there).toFixed(2)}s.mp4`);
  await name.fill("worst.avi");
  await page.waitForSelector("#panel .warning:has-text('worst.avi exists already; worst-2.avi does not')");
  assert.ok(await page.locator("#panel button.main").isDisabled());
  const film = JSON.parse(readFileSync(join(folder, "worst.avi.json"), "utf8")).sessions[1];
  assert.ok(film.first_tick * clumsy.tick_s <= when && film.last_tick * clumsy.tick_s >= when, `${when} s in ${JSON.stringify(film)}`);
  await page.click("#tab-compare");
  // The command that is shown compares too, while the page goes on: without the replay and the pictures of its report, which change none
  // of its words (Compare and Reviewing of the program's tests hold that).
  const words = (await page.locator("#panel .command code").first().innerText()).split(" ").slice(1);
  command = ctpmBeside(folder, ...words.filter((word) => word !== "-o" && word !== "report"), "--no-verify");
});

step("two sessions beside each other, compared", async () => {
  await page.click("#panel button:text-is('first contact')");
  assert.equal(await ahead(), offsetAt("contact begins"));
  await page.click("#panel button:has-text('first cut')");
  const offset = offsetAt("cut");
  assert.equal(await ahead(), offset);
  const moments = await page.locator("#panel .jumps button").allInnerTexts(), late = moments.findIndex((moment) => Number.parseFloat(moment) - offset > expert.duration_s);
  const limits = moments.filter((moment) => moment.includes("limit"));
  for (const moment of limits) assert.match(moment, / (\S+), limit [\d.]+ \1$/, "a limit has the unit of what goes beyond it");
  assert.ok(limits.length > 0);
  // One that is after the first session's end: both are shown at the same place of the path.
  assert.ok(late >= 0);
  await page.locator("#panel .jumps button").nth(late).click();
  await untilTrainee(Number.parseFloat(moments[late]));
  assert.ok((await clock()) <= expert.duration_s);
  // Others are seen as they were before it, and it again as it was.
  const own = await ahead(), early = moments.findIndex((moment) => Number.parseFloat(moment) > offset && Number.parseFloat(moment) - offset < expert.duration_s);
  assert.notEqual(own, offset);
  assert.ok(early >= 0);
  for (const [moment, seen] of [[early, offset], [late, own]]) {
    await page.locator("#panel .jumps button").nth(moment).click();
    await untilTrainee(Number.parseFloat(moments[moment]));
    assert.equal(await ahead(), seen, moments[moment]);
  }
  // The command prints the same, and the program answers the same advice again.
  const printed = (await command).out;
  const { comparison: { advice }, path_s } = await studio.call("session.compare", { expert: kExpert, trainee: kClumsy });
  path = path_s;
  assert.deepEqual(await page.locator("#panel .advice li").allInnerTexts(), advice);
  for (const line of advice) assert.ok(printed.includes(line), `${line} is not in: ${printed}`);
  // Without their units, which the page writes smaller.
  const names = await page.locator("#panel tbody th").evaluateAll((cells) => cells.map((cell) => cell.firstChild.textContent.trim()));
  for (const name of names) assert.ok(printed.includes(name.split(" ").slice(0, 2).join(" ")), name);
  assert.ok(printed.includes(moments[0].replace(/^[\d.]+ s\s*/, "").split(":")[0]));
  assert.deepEqual(await seriousFindings(page), []);
  await picture(page, "review-compare");
});

step("the expert's cut is on the trainee's organ, and what was cut elsewhere is marked", async () => {
  const legend = page.locator(".expert-legend li"), chosen = page.locator('.look-bar label:has-text("expert\'s line") input');
  /** Pixels of each half, without what is written over it: of the line, and of the marks. */
  const count = async () => {
    const { width, height, data } = pixelsOf(await page.locator(".view > canvas").screenshot());
    const halves = [{ line: 0, strays: 0 }, { line: 0, strays: 0 }];
    for (let i = 0; i < data.length; i += 4) {
      const y = Math.floor(i / 4 / width), half = halves[Number((i / 4) % width >= width / 2)];
      if (y < 60 || y > height - 60) continue;
      half.line += data[i + 2] > data[i] + 50;
      half.strays += data[i] > 200 && data[i + 1] > 140 && data[i + 1] < 200 && data[i + 2] < 140;
    }
    return halves;
  };
  const until = async (isSo) => {
    let halves = await count();
    for (const began = Date.now(); !isSo(halves) && Date.now() < began + 20_000; ) halves = await count(); // a loaded machine draws late
    assert.ok(isSo(halves), JSON.stringify(halves));
    return halves;
  };
  await page.locator("#panel .jumps button:has-text('cut where the expert did not')").last().click();
  await page.waitForFunction(() => document.querySelectorAll(".expert-legend li").length === 2);
  assert.deepEqual(await legend.allInnerTexts(), ["the expert's cut", "cut where the expert did not"]);
  const [, there] = await until(([expert, trainee]) => expert.line === 0 && trainee.line > 40 && trainee.strays > 10);
  await picture(page, "review-expert-line");
  assert.deepEqual(await seriousFindings(page), []);
  // Drawn by the program it is there too.
  const view = page.locator(".look-bar label:has-text('view') select");
  await view.selectOption("both");
  await page.waitForSelector(".drawings canvas:not([hidden]) + canvas:not([hidden])");
  await until(([expert, trainee]) => expert.line === 0 && trainee.line > 40);
  await view.selectOption("surface");
  // Before the trainee cuts, nothing is cut elsewhere.
  await page.locator(".view > canvas").focus();
  await page.keyboard.press("Home");
  await page.waitForFunction(() => document.querySelectorAll(".expert-legend li").length === 1);
  assert.deepEqual(await legend.allInnerTexts(), ["the expert's cut"]);
  await until(([, { line, strays }]) => line > 40 && strays < there.strays);
  await chosen.uncheck();
  await page.waitForFunction(() => !document.querySelector(".expert-legend"));
  await until(([, { line }]) => line === 0);
  await chosen.check();
  await page.waitForSelector(".expert-legend");
  await until(([, { line }]) => line > 40);
});

step("what chooses a panel stays while it is scrolled", async () => {
  const tabs = page.locator(".tabs"), before = await tabs.boundingBox();
  const far = await page.locator("#panel").evaluate((panel) => {
    panel.scrollTop = panel.scrollHeight;
    return panel.scrollTop;
  });
  assert.ok(far > 200, `it is scrolled by ${far} px`);
  assert.deepEqual(await tabs.boundingBox(), before);
  assert.ok(await page.locator("#tab-moment").evaluate((tab) => {
    const { x, y, width, height } = tab.getBoundingClientRect();
    return document.elementFromPoint(x + width / 2, y + height / 2) === tab;
  }), "nothing covers them");
  await page.locator("#panel").evaluate((panel) => void (panel.scrollTop = 0));
});

step("what happened in each session is marked at its place, and listed", async () => {
  await page.click("#tab-moment");
  const marks = (which) => page.locator(".marks").evaluateAll((all, which) => all.map((row) => [...row.querySelectorAll(which)].map(({ title }) => title)), which);
  const rows = await marks(".mark:not(.worst-moment)"), worst = await marks(".mark.worst-moment");
  const lists = await page.locator("#panel section:has(h2:has-text('Events'))").evaluateAll((all) => all.map((list) => [...list.querySelectorAll("li")].map(({ textContent }) => textContent)));
  const told = [expert, clumsy].map(({ events, tick_s }) => events.filter(({ kind }) => kind !== "late tick").map(({ tick, text }) => `${(tick * tick_s).toFixed(3)} s ${text}`));
  assert.ok(told.every((each) => each.length > 2));
  assert.deepEqual(lists, told);
  assert.deepEqual(rows, told);
  // The worst moments are the trainee's.
  await page.click("#tab-compare");
  const found = (await page.locator("#panel .of-trainee button").allInnerTexts()).map((text) => text.replace(/^[\d.]+ s /, ""));
  assert.deepEqual(worst.map((row) => row.map((title) => title.replace(/^[\d.]+ s /, ""))), [[], found]);
  // What each mark means is said, of the kinds that are there, beside marks that look like those.
  const looks = await page.evaluate(() => {
    const look = (mark) => {
      const { backgroundColor, borderTopWidth, borderTopColor, borderRadius, clipPath, transform } = getComputedStyle(mark);
      return [backgroundColor, borderTopWidth === "0px" ? "" : borderTopColor, borderRadius, clipPath, transform].join();
    };
    const of = (marks) => [...new Set([...marks].map(look))].sort();
    return [...document.querySelectorAll(".mark-legend li")].map((item) => {
      const kind = item.textContent;
      return { kind, there: of(document.querySelectorAll(`.marks .mark.${kind.replaceAll(" ", "-")}`)), here: of(item.querySelectorAll(".mark")) };
    });
  });
  assert.deepEqual(new Set(looks.map(({ kind }) => kind)), new Set(["worst moment", ...[expert, clumsy].flatMap(({ events }) => events.map(({ kind }) => kind)).filter((kind) => kind !== "late tick")]));
  for (const { kind, there, here } of looks) assert.ok(there.length > 0 && String(there) === String(here), `${kind}: ${here}, and on the timeline ${there}`);
  await page.click("#tab-moment");
  // A press on the trainee's goes to its own moment.
  await page.locator("#panel section:has(h2:has-text('trainee')) li button").last().click();
  await page.waitForFunction((time) => document.querySelector(".clock-beside").textContent.startsWith(time), told[1].at(-1).split(" ")[0]);
  await page.click("#tab-compare");
});

step("each session has its own clock and its own axis, below each other where they belong together", async () => {
  const axis = (whose) => page.locator(`.axis.of-${whose} .times span`).evaluateAll((all) => all.map((mark) => [Number.parseFloat(mark.textContent), Number(mark.style.getPropertyValue("--at"))]));
  const clocks = () => page.locator(".clock, .clock-beside").allInnerTexts();
  const heights = new Set(), keepHeight = async () => heights.add(await page.locator(".view > canvas").evaluate((canvas) => canvas.clientHeight));
  for (const [button, kind] of [["first contact", "contact begins"], ["first cut", "cut"]]) {
    await page.click(`#panel button:text-is('${button}')`);
    const offset = offsetAt(kind), [from, to] = [Math.min(0, -offset), Math.max(expert.duration_s, clumsy.duration_s - offset)];
    assert.equal(await page.locator(".aligned").innerText(), `aligned at the ${button}`);
    for (const [whose, duration, ahead] of [["first", expert.duration_s, 0], ["second", clumsy.duration_s, offset]]) {
      const marks = await axis(whose);
      assert.ok(marks.length >= 3, `${marks}`);
      for (const [time, at] of marks) {
        assert.ok(time >= 0 && time <= duration, `${time} s of ${duration} s`);
        assert.ok(Math.abs(at - (time - ahead - from) / (to - from)) < 1e-3, `${whose}: ${time} s at ${at}`);
      }
    }
    // Where the span begins one of them has not begun yet, and its clock says so.
    await page.locator(".view > canvas").focus();
    await page.keyboard.press("Home");
    await page.waitForFunction((from) => Math.abs(Number(document.querySelector(".scrub").value) - from) < 2e-3, from);
    const begins = [from, from + offset].map((time) => (time < -2e-3 ? "not begun" : `${Math.abs(time).toFixed(3)} s of`));
    await page.waitForFunction((begins) => [...document.querySelectorAll(".clock, .clock-beside")].every((clock, i) => clock.textContent.trim().startsWith(begins[i])), begins);
    await keepHeight();
    const captions = await page.locator(".captions b").allInnerTexts();
    for (const [i, begin] of begins.entries()) assert.ok(captions[i].endsWith(` ${begin.replace(/ of$/, "")}`), `${captions[i]}: ${begin}`);
    // Around a moment that its clock does not have there is no film.
    await page.click("#tab-export");
    assert.equal(await page.locator("#panel button:has-text('1 s before')").isDisabled(), begins[0] === "not begun");
    await page.click("#tab-compare");
    await page.locator(".view > canvas").focus();
    await page.keyboard.press("End");
    const [ownEnd, otherEnd] = await page.waitForFunction((to) => {
      const texts = [...document.querySelectorAll(".clock, .clock-beside")].map((clock) => clock.innerText);
      return Math.abs(Number.parseFloat(texts[0]) - to) < 2e-3 && texts;
    }, to).then((handle) => handle.jsonValue());
    assert.match(to > expert.duration_s + 2e-3 ? ownEnd : otherEnd, /has ended|of \d/);
    if (to > expert.duration_s + 2e-3) assert.match(ownEnd, /has ended/);
    await keepHeight();
  }
  // Nor is anything moved by what is said of a playback that this machine does not keep up with.
  await page.keyboard.press("Home");
  await page.evaluate(() => {
    globalThis.busy = setInterval(() => {
      for (const began = performance.now(); performance.now() < began + 300; );
    }, 10);
  });
  await page.keyboard.press("Space");
  await page.waitForSelector(".pace");
  await picture(page, "review-pace");
  await keepHeight();
  await page.evaluate(() => clearInterval(globalThis.busy));
  await page.click(".transport button:text-is('Pause')");
  assert.equal(heights.size, 1, `the picture stays as high, whatever the clocks say: ${[...heights]}`);
  await picture(page, "review-clocks");
});

step("along the path both tools are at the same place of it, and by hand as far apart in time as one says", async () => {
  const scrubTo = async (time) => {
    await page.locator(".scrub").evaluate((slider, value) => {
      slider.value = String(value);
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    }, time);
    await page.waitForFunction((shown) => document.querySelector(".clock").textContent.startsWith(shown), time.toFixed(3));
    return (await page.locator(".captions b").allInnerTexts()).map((text) => Number(/([-\d.]+) s$/.exec(text)[1]));
  };
  await page.waitForSelector(".plots div[data-title='difference of force [N]']"); // curves come after the picture
  const motions = await Promise.all([kExpert, kClumsy].map((path) => studio.call("session.motion", { path, rate_hz: 200 })));
  const placeAt = (i, time) => motions[i].poses[Math.round(time / motions[i].interval_s)].slice(1, 4);
  const apart = (here, there) => Math.hypot(...placeAt(0, here).map((x, axis) => x - placeAt(1, there)[axis]));
  const moments = [0.3, 0.5, 0.7].map((share) => path[Math.floor(share * path.length)][0]);
  const mean = async () => {
    let sum = 0;
    for (const moment of moments) sum += apart(...(await scrubTo(moment))) / moments.length;
    return sum;
  };
  await page.click("#panel button:text-is('first contact')");
  const atContact = await mean();
  await page.click("#panel button:text-is('path')");
  await page.waitForSelector("#panel button[aria-pressed=true]:text-is('path')");
  const alongPath = await mean();
  console.log(`aligned by first contact the tools are ${(1e3 * atContact).toFixed(1)} mm apart, along the path ${(1e3 * alongPath).toFixed(1)} mm`);
  assert.ok(alongPath < 0.9 * atContact, `${alongPath} and ${atContact}`);
  for (const moment of moments) {
    const belong = path.filter(([here]) => here === moment).map(([, there]) => there), [here, there] = await scrubTo(moment);
    assert.ok(here === Number(moment.toFixed(3)) && there >= Math.min(...belong) - 1e-3 && there <= Math.max(...belong) + 1e-3, `${here}, ${there}: ${belong}`);
  }
  await picture(page, "review-along-path");
  const byHand = async (ahead) => {
    await page.locator("#panel input[type=number]").fill(String(ahead));
    await page.keyboard.press("Tab");
  };
  await byHand(0.25);
  assert.deepEqual(await scrubTo(2), [2, 2.25]);
  assert.equal(await page.locator("#panel [aria-label='Align at'] button[aria-pressed=true]").count(), 0);
  // What is being typed stays while pictures come.
  await page.locator("#panel input[type=number]").fill("0.3");
  await scrubTo(2.1);
  assert.equal(await page.locator("#panel input[type=number]").inputValue(), "0.3");
  // Not so far that nothing of both is left beside each other.
  for (const [asked, limit, word] of [[9999, clumsy.duration_s - 0.1, "more"], [-9999, 0.1 - expert.duration_s, "less"]]) {
    await byHand(asked);
    await page.waitForFunction((limit) => document.querySelector("#panel input[type=number]").value === limit, String(Number(limit.toFixed(3))));
    assert.equal(await page.locator(".aligned").innerText(), `the trainee's clock shows ${Number(Math.abs(limit).toFixed(3))} s ${word}, the most with which both overlap`);
  }
  await byHand(0.25);
  await scrubTo(2);
  assert.deepEqual(await outOfReach(page), []);
});

step("it is said whose session is whose, and they can be swapped at the same moment of both", async () => {
  const whose = async () => (await page.locator(".captions b").allInnerTexts()).map((text) => text.replace(/ [-\d.]+ s$/, ""));
  assert.deepEqual(await whose(), [`expert: ${kExpert}`, `trainee: ${kClumsy}`]);
  await page.click("#panel button:has-text('first cut')");
  const times = async () => (await page.locator(".captions b").allInnerTexts()).map((text) => Number(/([-\d.]+) s$/.exec(text)[1]));
  const before = await times();
  const swapped = async (first, second) => {
    await page.click("#panel button:has-text('Swap')");
    await page.waitForFunction((text) => document.querySelector(".captions .first")?.textContent.includes(text) && document.querySelector(".captions .second"), first);
    await page.waitForSelector("#panel button[aria-pressed=true]:text-is('first cut')");
    assert.deepEqual(await whose(), [`expert: ${first}`, `trainee: ${second}`]);
    assert.equal(await page.locator("#panel .command code").first().innerText(), `ctpm compare ${first} ${second} -o report`);
  };
  await swapped(kClumsy, kExpert);
  assert.deepEqual(await times(), [before[1], before[0]]);
  await swapped(kExpert, kClumsy);
  assert.deepEqual(await times(), before);
});

rareStep("a link keeps how the pair is seen: view, colours, cutaway, camera, the timeline's zoom and what brings both together", async () => {
  const choose = (label, value) => page.locator(`.look-bar label:has-text("${label}") select`).selectOption(value);
  const looks = () => page.locator(".look-bar select").evaluateAll((all) => all.map((select) => select.selectedOptions[0].textContent));
  const drawn = () => page.evaluate(() => [...document.querySelectorAll(".drawings canvas")].map((canvas) => (canvas.hidden ? "" : canvas.toDataURL())));
  const opened = async (link) => {
    await page.goto("about:blank");
    await page.goto(link);
    await page.waitForSelector(".captions .second");
  };
  const copied = async () => {
    await page.click("#tab-notes");
    await page.click("#panel button:has-text('Copy the link')");
    return page.locator("#panel .hint code").innerText();
  };
  await page.click("#panel button:has-text('first cut')");
  await choose("view", "elements force");
  await choose("cutaway", "y");
  await page.locator(".view > canvas").focus();
  for (let i = 0; i < 3; ++i) await page.keyboard.press("d");
  await page.waitForFunction(() => [...document.querySelectorAll(".drawings canvas")].every((canvas) => !canvas.hidden));
  // A part of the timeline, in which the moment of the link is not.
  for (const key of [".", ".", "."]) await page.keyboard.press(key);
  await page.hover(".plots");
  await page.keyboard.down("Shift");
  for (let i = 0; i < 12; ++i) await page.mouse.wheel(0, 100);
  await page.keyboard.up("Shift");
  await page.waitForSelector(".playhead[hidden]", { state: "attached" });
  const zoom = () => page.locator(".zoom output").innerText();
  await studio.quiet(1000);
  const before = { looks: await looks(), drawn: await drawn(), times: await page.locator(".captions").innerText(), zoom: await zoom() };
  assert.deepEqual(before.looks, ["elements by force", "across y", "as turned"]);
  const link = await copied();
  await picture(page, "review-link-before");
  await opened(link);
  assert.deepEqual(await looks(), before.looks);
  await page.waitForFunction((drawn) => [...document.querySelectorAll(".drawings canvas")].every((canvas, i) => !canvas.hidden && canvas.toDataURL() === drawn[i]), before.drawn);
  assert.equal(await page.locator(".captions").innerText(), before.times);
  assert.equal(await zoom(), before.zoom);
  await picture(page, "review-link-after");
  await page.locator(".view > canvas").focus();
  await page.keyboard.press("0");
  await page.waitForSelector(".zoom output", { state: "detached" });
  await page.click("#tab-compare");
  await page.waitForSelector("#panel button[aria-pressed=true]:text-is('first cut')");
  assert.equal(await ahead(), offsetAt("cut"));
  // Along the path, for which both are compared again.
  await page.click("#panel button:text-is('path')");
  await page.waitForSelector("#panel button[aria-pressed=true]:text-is('path')");
  await page.locator(".scrub").evaluate((slider) => {
    slider.value = "2.4";
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  });
  await page.waitForFunction(() => document.querySelector(".clock").textContent.startsWith("2.400"));
  const along = await page.locator(".captions").innerText();
  await opened(await copied());
  await page.waitForSelector("#panel button[aria-pressed=true]:text-is('path')");
  assert.equal(await page.locator(".captions").innerText(), along);
  await choose("view", "surface");
  await choose("cutaway", "");
  await choose("camera", "");
  await page.waitForFunction(() => [...document.querySelectorAll(".drawings canvas")].every((canvas) => canvas.hidden));
});

step("notes stay, and a link leads to the moment", async () => {
  const session = readFileSync(join(folder, kExpert));
  await page.click("#panel button:has-text('first contact')");
  await page.click("#tab-notes");
  assert.equal(await page.locator("#panel select").inputValue(), "1", "what is reviewed is the trainee's");
  await page.locator("#panel select").selectOption(kExpert);
  await page.locator(".view > canvas").focus();
  await page.keyboard.press("Home");
  for (let i = 0; i < 20; ++i) await page.keyboard.press("Shift+ArrowRight");
  await page.fill("#panel textarea", "<b>too steep</b> here");
  // What is not added yet is there after a look elsewhere.
  await page.locator("#panel select").selectOption(kClumsy);
  assert.equal(await page.locator("#panel textarea").inputValue(), "");
  await page.locator("#panel select").selectOption(kExpert);
  assert.equal(await page.locator("#panel textarea").inputValue(), "<b>too steep</b> here");
  await page.click("#panel button.main");
  await page.waitForSelector("#panel .jumps button:has-text('<b>too steep</b>')");
  const time = await clock(); // of the first session; the one beside may begin earlier
  const notes = JSON.parse(readFileSync(join(folder, "kidney-cut-expert.notes.json"), "utf8"));
  assert.deepEqual(notes.notes, [{ time_s: time, text: "<b>too steep</b> here" }]);
  assert.ok(readFileSync(join(folder, kExpert)).equals(session));
  await page.click("#panel button:has-text('Copy the link')");
  const link = await page.locator("#panel .hint code").innerText();
  assert.ok(!link.includes("token"));
  const both = await page.locator(".captions").innerText();
  assert.match(both, new RegExp(`${kExpert}.*${kClumsy}`, "s"));
  await picture(page, "review-notes");
  await page.goto("about:blank");
  await page.goto(link);
  await page.waitForFunction((shown) => document.querySelector(".clock")?.textContent.startsWith(shown), time.toFixed(3));
  await page.waitForFunction((shown) => document.querySelector(".captions").innerText === shown, both);
  // A note of the session beside lies beside that one, at its own time.
  await page.click("#tab-notes");
  await page.locator("#panel select").selectOption(kClumsy);
  await page.fill("#panel textarea", "hurried");
  await page.click("#panel button.main");
  await page.waitForSelector("#panel .jumps button:has-text('hurried')");
  const beside = JSON.parse(readFileSync(join(folder, "kidney-cut-clumsy.notes.json"), "utf8")).notes;
  assert.ok(both.includes(beside[0].time_s.toFixed(3)) && beside[0].time_s !== time, `${both} and ${beside[0].time_s}`);
  await changeNotes(studio, folder, kClumsy, beside[0]);
  // Those of both are marked at once when they are opened again.
  await page.click("#tab-compare");
  await page.reload();
  for (const text of ["too steep", "hurried"]) await page.waitForSelector(`.mark.note[title*='${text}']`);
  assert.equal(await page.locator("#tab-notes[aria-selected=true]").count(), 0);
  // Whichever of them was read first, the expert's is told of first.
  await page.click("#tab-moment");
  assert.deepEqual(await page.locator("#panel h2:has-text('Events')").allTextContents(), ["Events, expert", "Events, trainee"]);
});

step("an export is the one that the shown command makes, and can be cancelled", async () => {
  const field = (label) => page.locator(`#panel .field:has-text("${label}") input`);
  const choose = (label, value) => page.locator(`#panel .field:has-text("${label}") select`).selectOption(value);
  const makesWhatItShows = async (name, options) => {
    await studio.quiet(); // the camera that the program chose has come: what is shown is what will be exported
    const shown = await page.locator("#panel .command code").innerText();
    for (const option of options) assert.ok(shown.includes(option), shown);
    const command = ctpmBeside(folder, ...wordsOf(shown).slice(1).map((word) => (word === `${name}.avi` ? `${name}-command.avi` : word)));
    await page.click("#panel button.main");
    await page.waitForSelector(`#panel .good:has-text("${name}.avi")`);
    assert.equal((await command).code, 0);
    assert.ok(readFileSync(join(folder, `${name}.avi`)).equals(readFileSync(join(folder, `${name}-command.avi`))));
  };
  // Two sessions beside each other; the command says no more than what was chosen.
  await page.click("#tab-compare");
  await page.click("#panel button:text-is('first contact')");
  await page.waitForSelector("#panel button[aria-pressed=true]:text-is('first contact')");
  await page.click("#tab-export");
  const align = async () => Number(/--align (\S+)/.exec(await page.locator("#panel .command code").innerText())[1]).toFixed(3);
  assert.equal(await align(), offsetAt("contact begins").toFixed(3));
  // The video's own choices are not those of the page, which says of them that they slow one half down; the first follows the page.
  const together = page.locator('#panel .field:has-text("bring both together") option');
  assert.deepEqual(await together.allInnerTexts(), ["as seen here: aligned at the first contact", "path of the tool, slowing one down",
    "first contact, slowing one down", "first cut, slowing one down", "both clocks, as they were recorded"]);
  await page.click("#tab-compare");
  await page.click("#panel button:text-is('first cut')");
  await page.click("#tab-export");
  assert.equal(await align(), offsetAt("cut").toFixed(3));
  assert.equal(await field("file in the folder").inputValue(), `${kClumsy.replace(".ctpm", "")}-beside-${kExpert.replace(".ctpm", "")}.mp4`);
  const press = await page.locator("#panel button.main").boundingBox();
  assert.ok(press.y + press.height <= page.viewportSize().height, `what exports is seen without scrolling: ${JSON.stringify(press)}`);
  // Where it is around a moment that no limit is exceeded at, it says what both forces are there, until it is around another time.
  const [own, theirs] = (await page.locator(".plots div[data-title='force [N]']").getAttribute("data-at")).split(" · ");
  await page.click("#panel button:has-text('1 s before')");
  assert.equal(await field("caption").inputValue(), `force ${theirs} N, expert ${own} N`);
  await field("from [s]").fill("0");
  await field("to [s]").fill("");
  assert.equal(await field("caption").inputValue(), "");
  // It is seen as it is here, unless the command is to choose.
  assert.match(await page.locator("#panel .command code").innerText(), / --camera [-\d.]+,[-\d.]+,[-\d.]+:[-\d.]+,[-\d.]+,[-\d.]+(:| |$)/);
  await choose("camera", "");
  assert.doesNotMatch(await page.locator("#panel .command code").innerText(), /--camera/);
  await choose("camera", "seen");
  assert.doesNotMatch(await page.locator("#panel .command code").innerText(), /--(overlay|slow-at|fps|size|speed|from-s|to-s)/);
  await choose("size", "854x480"); // which is drawn sooner
  // Aligned by hand, it says by how much.
  await page.click("#tab-compare");
  await page.locator("#panel input[type=number]").fill("-0.4");
  await page.keyboard.press("Tab");
  await page.click("#tab-export");
  assert.match(await page.locator("#panel .command code").innerText(), /--align -0\.4( |$)/);
  await field("file in the folder").fill("hand.avi");
  await field("from [s]").fill("2.2");
  await field("to [s]").fill("2.3");
  await makesWhatItShows("hand", ["--align -0.4"]);
  await field("file in the folder").fill("both.avi");
  await field("from [s]").fill("2.2");
  await field("to [s]").fill("2.5");
  await field("pictures a second").fill("10");
  await choose("bring both together", "cut");
  await choose("overlay", "small");
  await field("caption").fill("too steep");
  await makesWhatItShows("both", ["--align cut", "--overlay small", "--fps 10", "--caption 'too steep'", `--beside ${kClumsy}`]);
  await picture(page, "review-export");
  // The expert's tool in the trainee's session, in the words of the command, whose times are by the trainee's clock.
  const ghost = page.locator(`#panel label:has-text("ghost: ${kExpert}")`), said = (await ghost.innerText()).replace(/^.*?, /, "");
  assert.ok(ctpm(folder, "export", "--help").out.replace(/\s+/g, " ").includes(said), said);
  await field("caption").fill("");
  await ghost.click();
  const ghostName = `${kClumsy.replace(".ctpm", "")}-ghost-${kExpert.replace(".ctpm", "")}.mp4`;
  await page.waitForFunction((name) => document.querySelector("#panel .field input").value === name, ghostName);
  assert.ok(await page.locator("#panel .hint:has-text(\"by the trainee's clock\")").count());
  await page.locator('.look-bar label:has-text("expert\'s line") input').uncheck();
  await field("file in the folder").fill("ghost.avi");
  await field("from [s]").fill("2.2");
  await field("to [s]").fill("2.4");
  await makesWhatItShows("ghost", [`export ${kClumsy} -o ghost.avi --ghost ${kExpert} --align cut --no-expert-line`]);
  await picture(page, "review-export-ghost");
  await ghost.click();
  await page.locator('.look-bar label:has-text("expert\'s line") input').check();
  // A picture of both at this moment.
  await page.click("#panel button:has-text('Save a picture of')");
  const still = /^(.*-beside-.*s\.png) is written$/.exec(await page.locator("#panel .good", { hasText: "is written" }).innerText())?.[1];
  const stillCommand = await page.locator("#panel .command code").first().innerText();
  assert.match(stillCommand, new RegExp(`--at-s [\\d.]+ --beside ${kClumsy} --align -0\\.4`));
  assert.equal(ctpm(folder, ...stillCommand.replace(still, "still.png").split(" ").slice(1)).code, 0);
  assert.ok(readFileSync(join(folder, still)).equals(readFileSync(join(folder, "still.png"))));
  // One of them.
  await page.click("#tab-compare");
  await page.locator("#panel select").selectOption("");
  await page.click("#tab-export");
  await field("file in the folder").fill("one.avi");
  await field("from [s]").fill("0.6");
  await field("to [s]").fill("0.9");
  await field("pictures a second").fill("10");
  for (const moment of ["damage", "cuts"]) await page.click(`#panel fieldset label:has-text("${moment}")`);
  await makesWhatItShows("one", ["--slow-at cut,damage", "--fps 10", "--size 854x480"]);
  // The film is a press away.
  const [film] = await Promise.all([page.waitForEvent("download"), page.click("#panel button:text-is('Download one.avi')")]);
  assert.equal(film.suggestedFilename(), "one.avi");
  assert.ok(readFileSync(await film.path()).equals(readFileSync(join(folder, "one.avi"))));
  await picture(page, "review-export-one");
  await field("file in the folder").fill("long.avi");
  await field("from [s]").fill("0");
  await field("to [s]").fill("");
  await page.click("#panel button.main");
  await page.waitForFunction(() => /exporting [1-9]\d* %/.test(document.querySelector("#panel .working")?.textContent ?? ""));
  // It goes on while another tab is looked at.
  await page.click("#tab-moment");
  await page.click("#tab-export");
  assert.equal(await field("file in the folder").inputValue(), "long.avi");
  // And while another room is.
  await page.click("header nav button:has-text('Author')");
  await page.click("header nav button:has-text('Review')");
  await page.click("#tab-export");
  await page.waitForFunction(() => /exporting [1-9]\d* %/.test(document.querySelector("#panel .working")?.textContent ?? ""));
  await page.click("#panel .working button");
  await page.waitForSelector("#panel .hint:has-text('Stopped; nothing was written')");
  assert.ok(!existsSync(join(folder, "long.avi")));
});

step("nothing was complained about", () => assert.deepEqual(studio.complaints, []));
