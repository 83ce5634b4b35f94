// What leads the hands of a trainee: mouse, keys, gamepad, device, fingers, and an expert's ghost: hands_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { openDevice } from "./igtl.mjs";
import { chooseDevice, ctpm, ctpmBeside, leave, makeFolder, moveMouse, openStudio, outOfReach, picture, pixelsOf, reading, seriousFindings, step, takeUp, until } from "./browser.mjs";
import { begin, end, handAxes, takeUpByKeys, untilFelt } from "./trainee_page.mjs";
import { dot, minus, scaled } from "./vectors.mjs";

const kExpert = "kidney-cut-expert.ctpm";
let folder, studio, page;
const verdicts = []; // of what was recorded, while the page goes on

before(async () => {
  folder = makeFolder("kidney.json", kExpert);
  const two = JSON.parse(readFileSync(join(folder, "kidney.json"), "utf8"));
  two.name = "two hands", two.hands = 2;
  writeFileSync(join(folder, "two.json"), JSON.stringify(two));
  studio = await openStudio(folder);
  page = studio.page;
  await page.click("header nav button:has-text('Train')");
});

after(() => leave(studio, folder));

step("the mouse leads one of two hands, and the other one stays", async () => {
  await begin(page, "two", "two.ctpm");
  const pressed = (name) => page.locator(`.transport button:has-text('${name}')`).getAttribute("aria-pressed");
  assert.equal(await pressed("right hand"), "true");
  assert.equal(await pressed("ball"), "true");
  assert.ok(await page.locator(".transport button:has-text('scalpel')").isDisabled(), "it is in the other hand");
  // Each waits on its side of the picture, whatever was seen before, and the ring shows which one is led.
  await page.waitForSelector(".take-up");
  const ring = async () => (await page.locator(".take-up").boundingBox()).x, ofRight = await ring();
  await page.keyboard.press("x");
  assert.ok((await until(ring, (x) => x < ofRight - 20)) < ofRight - 20, `the right hand waits at ${ofRight} px`);
  await page.keyboard.press("x");
  assert.ok(Math.abs((await until(ring, (x) => Math.abs(x - ofRight) < 2)) - ofRight) < 2);
  const middle = await takeUp(page);
  await moveMouse(page, middle, { x: 0, y: 150 }, 40);
  await page.waitForFunction(() => [...document.querySelectorAll(".readings div")].some((d) => /force, right0?\.?0*[1-9]/.test(d.textContent)));
  await page.keyboard.press("x");
  await page.waitForFunction(() => document.querySelector(".transport button[aria-pressed=true]").textContent.includes("left hand"));
  assert.equal(await pressed("scalpel"), "true");
  // The picture says which one it is, at its tool.
  const label = page.locator(".tool-label"), left = (element) => element.getBoundingClientRect().left;
  assert.match(await until(() => label.textContent(), (text) => /^left hand/.test(text)), /^left hand\n[\d.]+ mm above$/);
  const ofLeft = await label.evaluate(left);
  await picture(page, "train-left-hand");
  await page.keyboard.press("x");
  assert.equal(await until(() => label.textContent(), (text) => text === "right hand"), "right hand"); // it touches
  assert.ok(Math.abs((await label.evaluate(left)) - ofLeft) > 20, "it went to the other tool");
  await page.keyboard.press("x");
  const held = await reading(page, "force, right");
  await moveMouse(page, { x: middle.x, y: middle.y + 150 }, { x: -30, y: 80 }, 20);
  assert.ok((await reading(page, "force, right")) > 0.3 * held, "the ball still presses");
  await picture(page, "train-two-hands");
  assert.deepEqual(await seriousFindings(page), []);
  await end(page);
  verdicts.push(ctpmBeside(folder, "verify", "two.ctpm"));
  await page.click("button:has-text('Choose a scene')");
});

step("the expert's ghost is ahead, or at the same place of its path", async () => {
  const { right, up, deep } = handAxes();
  await page.locator("aside input").first().fill("");
  await page.locator("aside .field:has-text('expert') select").selectOption(kExpert);
  await page.click(".list button:has-text('kidney')");
  await page.waitForSelector(".view.running");
  await takeUpByKeys(page);
  const { poses, interval_s } = await studio.call("session.motion", { path: kExpert, rate_hz: 60 });
  const canvas = page.locator(".view canvas"), box = await canvas.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + 60);
  // By keys to the first pose of the expert, and beside its way down.
  const goTo = async (place) => {
    const way = minus(place, await studio.handAtRest());
    for (const [axis, more, less] of [[right, "ArrowRight", "ArrowLeft"], [up, "ArrowUp", "ArrowDown"], [deep, "PageUp", "PageDown"]])
      for (let mm = Math.round(1e3 * dot(way, axis)); mm !== 0; mm -= Math.sign(mm)) await page.keyboard.press(mm > 0 ? more : less);
    return studio.handAtRest();
  };
  const first = poses.findIndex(([tool]) => tool >= 0), placeOf = (pose) => pose.slice(1, 4);
  const begin = placeOf(poses[first]);
  await goTo(begin);
  const hand = await goTo([begin[0], begin[1], begin[2] - 0.008]);
  const far = poses.map((pose) => (pose[0] < 0 ? Infinity : Math.hypot(...minus(placeOf(pose), hand))));
  const here = far.indexOf(Math.min(...far)), ahead = here + Math.round(0.25 / interval_s);
  assert.ok(here > first && far[here] < 1e-3 && far[ahead] > 5e-3, `${here}: ${far[here]}, ${ahead}: ${far[ahead]}`);
  // Where two pictures differ by a ghost, which is blue: edges differ, too, where one of them is drawn finer.
  const between = (...pictures) => {
    const [one, other] = pictures.map(pixelsOf);
    const columns = Array.from({ length: one.width }, () => []); // the rows of such pixels
    for (let i = 0; i < one.data.length; i += 4) {
      const red = one.data[i] - other.data[i], blue = one.data[i + 2] - other.data[i + 2];
      if (Math.abs(blue) > 15 && Math.sign(blue) * (blue - red) > 25) columns[(i / 4) % one.width].push(Math.floor(i / 4 / one.width));
    }
    // A ghost is tall: an edge has a few pixels of a column, and lies below it.
    const tall = columns.filter((rows) => rows.length >= 20);
    return { lowest: Math.max(-1, ...tall.map((rows) => rows[Math.floor(0.9 * rows.length)])), count: tall.flat().length };
  };
  /** Until pictures that were begun before are on the screen, however slowly it draws. */
  const shown = () => page.evaluate(async () => {
    for (let frame = 0; frame < 6; ++frame) await new Promise(requestAnimationFrame);
  });
  /** The picture when what it shows rests: three in a row are the same. */
  const atRest = async () => {
    await shown();
    let rests = await canvas.screenshot();
    for (let alike = 0; alike < 2; ) {
      await page.waitForTimeout(200);
      await shown();
      const next = await canvas.screenshot();
      alike = between(rests, next).count < 20 ? alike + 1 : 0, rests = next;
    }
    return rests;
  };
  /** The next picture in which the ghost is elsewhere, or gone. */
  const drawnAfter = async (before) => {
    await until(async () => between(await canvas.screenshot(), before).count, (count) => count > 200);
    return atRest(); // one that moves may be drawn coarser
  };
  const choose = async (label, far) => {
    await page.locator("aside .field:has-text('the ghost is') select").selectOption({ label });
    const isNear = (mm) => Math.abs(mm - 1e3 * far) < 1.2; // of a pose or two later: the ghost never goes back
    const away = await until(() => reading(page, "away from your tool"), isNear);
    assert.ok(isNear(away), `${label}: ${away} mm, ${1e3 * far}`);
  };
  const rests = await atRest();
  await choose("where you are on its path", far[here]);
  const same = await drawnAfter(rests);
  await choose("a little ahead", far[ahead]);
  const later = await drawnAfter(same);
  await picture(page, "train-ghost");
  await page.locator("aside .field:has-text('expert') select").selectOption("");
  const none = await drawnAfter(later);
  // What the ghost changes in the picture is where the expert's tool was: lower, by what the way between the poses is in pixels.
  const [atSame, atLater] = [between(same, none), between(later, none)];
  console.log(`the ghost is ${atSame.count} and ${atLater.count} pixels`);
  assert.ok(atSame.count > 200 && atLater.count > 200, `${atSame.count} and ${atLater.count} pixels`);
  assert.ok(atLater.lowest > atSame.lowest + 5, `${atSame.lowest} and ${atLater.lowest}`);
  await end(page);
  await page.click("button:has-text('Choose a scene')");
});

step("a gamepad leads the tool: the trigger presses, the shoulder changes it", async () => {
  // No gamepad is plugged into a test's machine; the page sees one as the browser would show it.
  await page.evaluate(() => {
    const buttons = Array.from({ length: 17 }, () => ({ pressed: false, touched: false, value: 0 }));
    globalThis.pad = { connected: true, mapping: "standard", axes: [0, 0, 0, 0], buttons };
    navigator.getGamepads = () => [globalThis.pad];
  });
  await page.click("header nav button:has-text('Train')");
  await page.locator("aside input").first().fill("");
  await page.click(".list button:has-text('kidney')");
  await page.waitForSelector(".transport .hint:has-text('gamepad')");
  await page.waitForTimeout(100);
  assert.match(await page.locator(".clock").innerText(), /^not begun/, "a gamepad that rests takes nothing up");
  await page.evaluate(() => (globalThis.pad.axes[0] = 1));
  await page.waitForFunction(() => /^\d/.test(document.querySelector(".clock").textContent));
  await page.evaluate(() => (globalThis.pad.axes[0] = 0));
  // Sticks: sideways, deep and turns about two axes; a stick that rests a little off its middle does nothing.
  const { right, up, deep } = handAxes(), start = await studio.handAtRest();
  const hold = async (axis, value, time = 200) => {
    await page.evaluate(([axis, value]) => (globalThis.pad.axes[axis] = value), [axis, value]);
    await page.waitForTimeout(time);
    await page.evaluate((axis) => (globalThis.pad.axes[axis] = 0), axis);
    return studio.handAtRest();
  };
  assert.ok(Math.hypot(...minus(await hold(0, 0.1), start)) < 1e-9, "a stick at rest");
  for (const [axis, way, others] of [[0, right, [up, deep]], [1, scaled(deep, -1), [right, up]]]) {
    const from = await studio.handAtRest(), by = minus(await hold(axis, 1), from);
    assert.ok(dot(by, way) > 4e-3 && others.every((other) => Math.abs(dot(by, other)) < 1e-5), `stick ${axis}: ${by}`);
    await hold(axis, -1);
  }
  for (const [axis, part] of [[2, 2], [3, 1]]) {
    const [w, ...from] = studio.hand().orientation;
    await hold(axis, axis === 2 ? 1 : -1);
    const [W, ...to] = studio.hand().orientation, cross = [from[1] * to[2] - from[2] * to[1], from[2] * to[0] - from[0] * to[2], from[0] * to[1] - from[1] * to[0]];
    const turn = to.map((x, i) => w * x - W * from[i] - cross[i]); // about the axes of the tool
    assert.ok(turn[part - 1] > 0.05 && turn.every((x, i) => i === part - 1 || Math.abs(x) < 1e-6), `stick ${axis}: ${turn}`);
    await hold(axis, axis === 2 ? -1 : 1);
  }
  await page.evaluate(() => (globalThis.pad.buttons[7].value = 1));
  await untilFelt(page);
  await page.evaluate(() => (globalThis.pad.buttons[7].value = 0, globalThis.pad.buttons[6].value = 1));
  await page.waitForFunction(() => Number.parseFloat(document.querySelector(".force-bar output").textContent) === 0);
  await page.evaluate(() => (globalThis.pad.buttons[6].value = 0, globalThis.pad.buttons[5].value = 1));
  await page.waitForSelector(".transport button[aria-pressed=true]:has-text('scalpel')");
  await page.evaluate(() => (navigator.getGamepads = () => []));
  await end(page);
});

step("a device leads, and the page looks on", async () => {
  await page.click("button:has-text('Choose a scene')");
  const field = await chooseDevice(page, "device.ctpm");
  await field("tool in the hand").locator("input").fill("saw");
  assert.match(await page.locator("aside .command code").innerText(), /-o device\.ctpm --igtl-listen 0 --device-offset-mm 0 0 75 --device-tool saw$/);
  await picture(page, "train-device-form");
  assert.deepEqual(await outOfReach(page), []);
  assert.deepEqual(await seriousFindings(page), []);
  await page.click(".list button:has-text('kidney')");
  await page.waitForSelector(".problems:has-text('saw')"); // no tool of the scene
  await field("tool in the hand").locator("input").fill("");
  await page.click(".list button:has-text('kidney')");
  await page.waitForSelector(".view.running .empty:has-text('aiting for a device on 127.0.0.1:')");
  await picture(page, "train-device-awaited");
  const device = await openDevice(Number((await page.locator(".empty h2").innerText()).match(/:(\d+)/)[1]));
  let at = 0;
  const sway = () => 1 - Math.cos(at++ / 40), metres = setInterval(() => device.move([0, 0, -0.2 * sway()]), 10);
  await page.waitForSelector("aside .warning:has-text('a device that sends metres needs a scale of 1000')");
  clearInterval(metres);
  const hand = setInterval(() => device.move([0, 0, -20 * sway()]), 10);
  await untilFelt(page);
  assert.equal(await page.locator(".view .empty").count(), 0);
  // The mouse looks around.
  const box = await page.locator(".view canvas").boundingBox(), drawn = await page.locator(".view canvas").screenshot();
  await page.mouse.move(box.x + 100, box.y + 100);
  await page.mouse.down();
  await moveMouse(page, { x: box.x + 100, y: box.y + 100 }, { x: 120, y: 0 }, 8);
  await page.mouse.up();
  assert.ok(!drawn.equals(await page.locator(".view canvas").screenshot()));
  await picture(page, "train-device");
  await end(page);
  clearInterval(hand), device.close();
  assert.ok(device.felt() > 0.02, `the device felt ${device.felt()} N`);
  verdicts.push(ctpmBeside(folder, "verify", "device.ctpm"));
  // The next time the page leads again, unless it is chosen anew.
  await page.click("button:has-text('Choose a scene')");
  await field("in the hand").locator("select").selectOption("");
  await page.click(".list button:has-text('kidney')");
  await page.waitForSelector(".view.running");
  await end(page);
});

step("a recording is there up to the moment when the program was killed", async () => {
  await page.click("button:has-text('Choose a scene')");
  await begin(page, "kidney", "killed.ctpm");
  const middle = await takeUp(page);
  await moveMouse(page, middle, { x: 0, y: 150 }, 60);
  await page.waitForFunction(() => Number.parseFloat(document.querySelector(".clock").textContent) > 2.5);
  const complaints = studio.complaints.length;
  await studio.kill();
  await page.waitForSelector(".empty:has-text('The studio has ended')");
  await picture(page, "train-killed");
  const other = await page.context().newPage();
  await other.goto(await studio.startAgain());
  await page.waitForSelector(".list button:has-text('kidney')"); // the page goes on
  await other.close();
  await page.waitForSelector("aside .warning:has-text('killed.ctpm has no clean end')");
  studio.complaints.splice(complaints); // that nothing answered
  const recovered = ctpm(folder, "recover", "killed.ctpm", "-o", "recovered.ctpm");
  assert.equal(recovered.code, 3, recovered.out + recovered.err); // the end was lost
  assert.match(recovered.out + recovered.err, /cut off.*no difference/s); // it simulates again what it saved
  const info = JSON.parse(ctpm(folder, "info", "recovered.ctpm", "--json").out);
  assert.ok(info.duration_s > 1 && info.max_force_n > 0.1, JSON.stringify(info));
});

step("on a tablet one finger moves the tool, two look around, and buttons do what keys do", async () => {
  await page.click("button:has-text('Choose a scene')");
  await page.setViewportSize({ width: 820, height: 1180 });
  const input = await page.context().newCDPSession(page);
  await input.send("Emulation.setTouchEmulationEnabled", { enabled: true, maxTouchPoints: 5 });
  const touch = (type, ...points) => input.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(({ x, y }, id) => ({ x, y, id })) });
  const tap = async (selector) => {
    const box = await page.locator(selector).first().boundingBox();
    await touch("touchStart", { x: box.x + box.width / 2, y: box.y + box.height / 2 });
    await touch("touchEnd");
  };
  await page.locator("aside input").first().fill("");
  await tap(".list button:has-text('kidney')");
  await page.waitForSelector(".view.running .force-bar");
  const { right, up, deep } = handAxes(), box = await page.locator(".view canvas").boundingBox();
  await tap("button:text-is('turn left')"); // a session begins with the first that leads the tool
  const start = await studio.handAtRest(), began = { x: box.x + box.width / 2, y: box.y + 60 };
  const slide = async (by, ...fingers) => {
    await touch("touchStart", ...fingers);
    for (let i = 1; i <= 10; ++i) await touch("touchMove", ...fingers.map(({ x, y }) => ({ x: x + (by.x * i) / 10, y: y + (by.y * i) / 10 })));
    await touch("touchEnd");
    return minus(await studio.handAtRest(), start);
  };
  const moved = await slide({ x: 60, y: 0 }, began);
  assert.ok(dot(moved, right) > 5e-3 && Math.abs(dot(moved, up)) < 1e-5 && Math.abs(dot(moved, deep)) < 1e-5, `${moved}`);
  assert.ok(Math.hypot(...(await slide({ x: -60, y: 0 }, began))) < 1e-3, "the view was not turned on the way");
  await tap("button:text-is('farther')");
  const away = minus(await studio.handAtRest(), start);
  assert.ok(dot(away, deep) > 0.5e-3 && Math.abs(dot(away, right)) < 1e-3, `${away}`);
  // Two fingers turn the view, and the hand stays.
  const picture0 = await page.locator(".view > canvas").screenshot(), before = await studio.handAtRest();
  await slide({ x: 80, y: 0 }, { x: began.x - 60, y: began.y + 200 }, { x: began.x + 60, y: began.y + 200 });
  assert.ok(Math.hypot(...minus(await studio.handAtRest(), before)) < 1e-6);
  assert.ok(!picture0.equals(await page.locator(".view > canvas").screenshot()));
  await picture(page, "train-tablet");
  await tap("button:text-is('End')");
  await page.waitForSelector("button:has-text('Train again')");
  await tap("button:has-text('Choose a scene')");
  await input.send("Emulation.setTouchEmulationEnabled", { enabled: false });
});

step("what was recorded verifies to the bit", async () => {
  for (const { code, out, err } of await Promise.all(verdicts)) assert.equal(code, 0, out + err);
  assert.equal(verdicts.length, 2);
});

step("nothing was complained about", () => assert.deepEqual(studio.complaints, []));
