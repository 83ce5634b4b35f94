// What the page shows, held against what the commands say: shown_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { networkInterfaces } from "node:os";
import { after, before } from "node:test";
import { openDevice } from "./igtl.mjs";
import { chooseDevice, ctpm, ctpmBeside, makeFolder, openStudio, paths, picture, pixelsOf, rareStep, step, takeUp } from "./browser.mjs";
import { cross, dot, length, minus, scaled, unit } from "./vectors.mjs";

const kExpert = "kidney-cut-expert.ctpm", kClumsy = "kidney-cut-clumsy.ctpm", kSame = "kidney-same.ctpm";
let folder, studio, page;
let shown = null; // newest frame of a training

before(async () => {
  folder = makeFolder("kidney.json", kExpert, kClumsy);
  copyFileSync(join(folder, kExpert), join(folder, kSame));
  studio = await openStudio(folder);
  page = studio.page;
  page.on("websocket", (socket) => socket.on("framereceived", ({ payload }) => {
    if (typeof payload !== "string" && payload.readUInt32LE(0) === 2 && payload.readUInt32LE(4) === 2) shown = payload;
  }));
  await page.reload();
  await page.waitForSelector("header nav button");
});

after(async () => {
  assert.equal(await studio.close(), 0);
  rmSync(folder, { recursive: true });
});

step("there is no network, no display, and no program that the studio could call", (t) => {
  if (!process.env.CTPM_HAS_NO_NETWORK) return t.skip("this machine does not let its user take the network away");
  assert.deepEqual(Object.keys(networkInterfaces()), ["lo"]);
});

/** Places in a picture whose red, green and blue are as asked. `endsOfRows`: the first and the last one of each row. */
function placesOf(png, isSuch, endsOfRows = false) {
  const { data, width } = pixelsOf(png), places = [];
  for (let i = 0; i < data.length; i += 4) if (isSuch(data[i], data[i + 1], data[i + 2])) places.push([(i / 4) % width, Math.floor(i / 4 / width)]);
  return endsOfRows ? places.filter(([, y], i) => places[i - 1]?.[1] !== y || places[i + 1]?.[1] !== y) : places;
}

/** What `replay` writes of each tick, up to one of them. */
async function table(session, to = Infinity) {
  const until = to < Infinity ? ["--to-s", String(to / 1e3)] : [];
  assert.equal((await ctpmBeside(folder, "replay", session, "--csv", `${session}.csv`, ...until)).code, 0);
  return readFileSync(join(folder, `${session}.csv`), "utf8").trim().split("\n").slice(1).map((row) => row.split(","))
    .map((row) => ({ place: row.slice(3, 6).map(Number), force: Number(row[14]), depth: Number(row[15]) }));
}

const quiet = () => page.waitForFunction(() => /\d+ ms/.test([...document.querySelectorAll(".readings div")].find((d) => d.textContent.includes("replayed after"))?.textContent ?? ""));

async function scrubTo(time) {
  await page.locator(".scrub").evaluate((slider, value) => {
    slider.value = String(value);
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  }, time);
  await page.waitForFunction((text) => document.querySelector(".clock").textContent.startsWith(text), time.toFixed(3));
}

step("the numbers beside the curves are the table's: force, speed, and the difference", async () => {
  const contact = (name) => JSON.parse(ctpm(folder, "info", name, "--json").out).events.find(({ kind }) => kind === "contact begins").tick;
  const ahead = contact(kClumsy) - contact(kExpert); // [ticks]
  const kTicks = [1200, 2200, 2600, 3100, 3700], kNear = 20; // in the middle of ticks that are that far, speeds are measured
  const last = kTicks.at(-1) + kNear, tables = Promise.all([table(kExpert, last), table(kClumsy, last + ahead)]);
  await page.click("header nav button:has-text('Review')");
  await page.click(".list button:has-text('kidney-cut-expert')");
  await page.waitForSelector(".uplot");
  await page.click("#tab-compare");
  await page.locator("#panel select").selectOption(kClumsy);
  await page.waitForSelector(".plots div[data-title='difference of force [N]']");
  const [expert, clumsy] = await tables;
  const beside = (title) => page.locator(`.plots div[data-title='${title}']`).getAttribute("data-at");
  const speedAt = (rows, tick) => (1e3 * length(minus(rows[tick + 10].place, rows[tick - 10].place))) / 20; // [mm/s]
  let fastest = 0;
  for (const tick of kTicks) {
    await scrubTo(tick / 1e3);
    await page.waitForTimeout(120); // they are written 25 times a second
    const [own, other] = (await beside("force [N]")).split(" · ").map(Number), [fast] = (await beside("speed [mm/s]")).split(" · ").map(Number);
    assert.equal(own.toFixed(2), expert[tick - 1].force.toFixed(2), `force at ${tick}`);
    const there = tick + ahead - 1, near = [-2, -1, 0, 1, 2].map((by) => clumsy[there + by].force); // parts of its curve are two ticks long
    assert.ok(other >= Math.min(...near) - 0.006 && other <= Math.max(...near) + 0.006, `${other} at ${there}: ${near}`);
    assert.ok(Math.abs(Number(await beside("difference of force [N]")) - (other - own)) < 0.011, `${await beside("difference of force [N]")}: ${other} - ${own}`);
    const speed = speedAt(expert, tick - 1);
    assert.ok(Math.abs(fast - speed) < 2 + 0.15 * speed, `${fast} mm/s at ${tick}, by the table ${speed}`);
    fastest = Math.max(fastest, speed);
  }
  assert.ok(fastest > 20, "something moved");
  await picture(page, "shown-curves");
  await page.locator("#panel select").selectOption("");
  await page.click("#tab-moment");
});

rareStep("compare and verify say how far they are, in numbers, and can be cancelled", async () => {
  await page.evaluate(() => {
    globalThis.said = new Set();
    new MutationObserver(() => globalThis.said.add(document.querySelector(".working")?.textContent ?? "")).observe(document.body, { subtree: true, childList: true, characterData: true });
  });
  const saidOf = async (what) => (await page.evaluate(() => [...globalThis.said])).map((text) => new RegExp(`${what} (\\d+) %`).exec(text)?.[1]).filter((share) => share > 0 && share < 100);
  // A short one with itself.
  await page.click("#tab-compare");
  await page.locator("#panel select").selectOption(kSame);
  await page.waitForSelector(`.captions .second:has-text("${kSame}")`);
  await page.click("#panel button:text-is('path')"); // which is known once they are compared
  await page.waitForSelector("#panel table");
  await page.waitForSelector("#panel button[aria-pressed=true]:text-is('path')");
  assert.ok((await saidOf("comparing")).length > 0, "comparing N %");
  await page.locator("#panel select").selectOption("");
  await page.click("#tab-moment");
  await page.click("#panel button:has-text('Verify the replay')");
  await page.waitForSelector("#panel .good:has-text('no difference')");
  assert.ok((await saidOf("verifying")).length > 0, "verifying N %");
  // The longer one of both, so that there is time to cancel.
  await page.click(".list button:has-text('kidney-cut-clumsy')");
  await page.waitForSelector(".captions:has-text('clumsy')");
  await page.click("#panel button:has-text('Verify the replay')");
  await page.click("#panel .working button:has-text('cancel')");
  await page.waitForSelector("#panel .problems:has-text('stopped')");
  await page.click(".list button:has-text('kidney-cut-expert')");
  await page.waitForSelector(".captions:has-text('expert')");
});

step("playing at 1 x is real time", async () => {
  await page.locator(".view > canvas").focus();
  // By a clock that goes slower: what the machine cannot do in time, it can do in some times that.
  const rateBy = async (slower) => {
    await page.keyboard.press("Home");
    await page.waitForFunction(() => Number.parseFloat(document.querySelector(".clock").textContent) === 0);
    await quiet();
    await page.evaluate((slower) => {
      const real = performance.now.bind(performance), began = real();
      performance.now = () => began + (real() - began) / slower;
      globalThis.seen = [];
      const read = () => globalThis.seen.push([performance.now() / 1e3, Number.parseFloat(document.querySelector(".clock").textContent)]);
      globalThis.reading = setInterval(read, 5 * slower);
    }, slower);
    await page.keyboard.press("Space");
    await page.waitForFunction(() => Number.parseFloat(document.querySelector(".clock").textContent) > 0.9);
    await page.keyboard.press("Space");
    const seen = await page.evaluate(() => (clearInterval(globalThis.reading), delete performance.now, globalThis.seen));
    const [from, to] = [seen.find(([, at]) => at > 0.2), seen.findLast(([, at]) => at < 0.8)];
    return (to[1] - from[1]) / (to[0] - from[0]);
  };
  let rate = 0;
  for (const slower of [4, 16]) {
    rate = await rateBy(slower);
    console.log(`playing at 1 x goes ${rate.toFixed(3)} s in a second, by a clock that goes ${slower} times slower`);
    if (Math.abs(rate - 1) < 0.06) break;
  }
  assert.ok(Math.abs(rate - 1) < 0.06, `${rate}`);
});

step("the surface that the page draws covers what the exported picture of the same moment shows", async () => {
  await scrubTo(2.6);
  await quiet();
  await page.waitForTimeout(900); // the finer picture that stands still
  const { width, height } = await page.locator(".view > canvas").boundingBox(), size = [width, height].map((n) => 2 * Math.floor(n / 2));
  const own = await page.locator(".view > canvas").screenshot();
  await page.click("#tab-export");
  const words = (await page.locator("#panel .command code").innerText()).split(" ").slice(1).map((word) => (word.endsWith(".mp4") ? "still/" : word));
  const made = await ctpmBeside(folder, ...words, "--from-s", "2.599", "--to-s", "2.6", "--overlay", "none", "--size", size.join("x"));
  assert.equal(made.code, 0, made.err);
  const film = readFileSync(join(folder, "still", readdirSync(join(folder, "still")).filter((name) => name.endsWith(".png")).sort().at(-1)));
  mkdirSync(paths.pictures, { recursive: true });
  writeFileSync(join(paths.pictures, "shown-surface-page.png"), own);
  writeFileSync(join(paths.pictures, "shown-surface-film.png"), film);
  // What lies between the first and the last tissue of a row: what shines on it, and the arrow, count as tissue.
  const silhouette = (bytes) => {
    const rows = new Map();
    for (const [x, y] of placesOf(bytes, (r, g, b) => r > 45 && r > 1.5 * g && r > 1.5 * b, true)) {
      const [from, to] = rows.get(y) ?? [x, x];
      rows.set(y, [Math.min(from, x), Math.max(to, x)]);
    }
    return rows;
  };
  const [here, there] = [silhouette(own), silhouette(film)];
  let either = 0, both = 0;
  for (let y = 0; y < height; ++y) {
    const [from, to] = here.get(y) ?? [0, -1], [first, last] = there.get(y) ?? [0, -1];
    const shared = Math.max(0, Math.min(to, last) - Math.max(from, first) + 1);
    both += shared, either += to - from + 1 + last - first + 1 - shared;
  }
  const overlap = both / either;
  console.log(`of the tissue in either picture, ${(100 * overlap).toFixed(1)} % is in both (${either} pixels)`);
  assert.ok(either > 0.1 * width * height, "there is an organ");
  // The film's picture is up to two rows lower, and a pixel around the organ is 1 %. Another place of it by a fiftieth of the
  // picture's width, or a size that differs by as much, is more than 4 %.
  assert.ok(overlap > 0.96, `${overlap}`);
});

step("the arrow is as long as the force, and points as it does", async () => {
  await page.click("header nav button:has-text('Train')");
  await page.locator("aside input").first().fill("arrow.ctpm");
  await page.click(".list button:has-text('kidney'):not(:has-text('cut'))");
  await page.waitForSelector(".view.running");
  const at = await takeUp(page);
  for (let y = 0; y < 300 && Number.parseFloat(await page.locator(".force-bar output").innerText()) < 3; y += 6) {
    await page.mouse.move(at.x + y / 4, at.y + y);
    await page.waitForTimeout(40);
  }
  await page.waitForTimeout(1200); // it holds still
  const canvas = page.locator(".view > canvas"), { width, height } = await canvas.boundingBox();
  const places = placesOf(await canvas.screenshot(), (r, g, b) => r > 238 && g > 180 && g < 218 && b > 55 && b < 120)
    .filter(([x]) => x < width - 80);
  const f32 = (at, count) => Array.from({ length: count }, (_, i) => shown.readFloatLE(at + 4 * i));
  const position = f32(44, 3), force = f32(72, 3), newtons = length(force);
  assert.ok(newtons > 2 && places.length > 100, `${newtons} N, ${places.length} pixels`);
  // The scene's first camera, upright.
  const [camera] = JSON.parse(readFileSync(join(folder, "kidney.json"), "utf8")).cameras, eye = scaled(camera.eye_mm, 1e-3);
  const into = unit(minus(scaled(camera.target_mm, 1e-3), eye)), right = unit(cross(into, [0, 0, 1])), up = cross(right, into);
  const half = Math.max(1, 16 / 9 / (width / height)) * Math.tan((((camera.fov_deg ?? 32) / 2) * Math.PI) / 180);
  const pixel = (place) => {
    const way = minus(place, eye), far = dot(way, into), unitPixel = height / 2 / half / far;
    return [width / 2 + dot(way, right) * unitPixel, height / 2 - dot(way, up) * unitPixel];
  };
  const kPerNewton = 0.007; // [m]
  const tail = pixel(position), tip = pixel(position.map((x, i) => x + Math.min(kPerNewton * newtons, 0.06) * (force[i] / newtons)));
  const way = [tip[0] - tail[0], tip[1] - tail[1]], expected = Math.hypot(...way), along = way.map((x) => x / expected);
  // How far its pixels go along that way, and their main direction.
  const far = places.map(([x, y]) => (x + 0.5 - tail[0]) * along[0] + (y + 0.5 - tail[1]) * along[1]);
  const [least, most] = far.reduce(([a, b], x) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]);
  const middle = [0, 1].map((axis) => places.reduce((sum, place) => sum + place[axis], 0) / places.length);
  const [xx, xy, yy] = places.reduce(([a, b, c], [x, y]) => [a + (x - middle[0]) ** 2, b + (x - middle[0]) * (y - middle[1]), c + (y - middle[1]) ** 2], [0, 0, 0]);
  const turn = 0.5 * Math.atan2(2 * xy, xx - yy), off = Math.abs(Math.cos(turn) * along[1] - Math.sin(turn) * along[0]);
  console.log(`an arrow of ${newtons.toFixed(2)} N from ${least.toFixed(1)} to ${most.toFixed(1)} px of ${expected.toFixed(1)}, ${((Math.asin(off) * 180) / Math.PI).toFixed(1)} degrees off`);
  await picture(page, "shown-arrow");
  assert.ok(Math.abs(least) < 4 && Math.abs(most - expected) < 0.1 * expected + 2, `${least} to ${most}, expected ${expected}`);
  assert.ok(off < Math.sin((8 * Math.PI) / 180), `${(Math.asin(off) * 180) / Math.PI} degrees`);
});

rareStep("the shown commands verify and record do what the buttons did", async () => {
  await page.keyboard.press("Escape");
  await page.waitForSelector("button:has-text('Train again')");
  const commands = () => page.locator("aside .command code").allInnerTexts();
  await page.locator("aside .field:has-text('to compare with') select").selectOption(""); // the one that is proposed
  const words = (text) => text.split(" ").slice(1);
  const [verify, ...others] = await commands();
  assert.deepEqual(others, []);
  await page.click("aside button.main:text-is('Verify')");
  const verdict = (await page.locator("aside .good").innerText()).replace(/^The recording, replayed: /, ""), printed = ctpm(folder, ...words(verify));
  assert.equal(printed.code, 0);
  assert.ok(printed.out.includes(verdict), `${printed.out}: ${verdict}`);
  // With an expert both are done, and both are shown.
  await page.locator("aside .field:has-text('to compare with') select").selectOption(kExpert);
  assert.deepEqual(await commands(), [verify, `ctpm compare ${kExpert} arrow.ctpm -o report`]);

  await page.click("button:has-text('Choose a scene')");
  const field = await chooseDevice(page, "device.ctpm");
  await page.click(".list button:has-text('kidney'):not(:has-text('cut'))");
  await page.waitForSelector(".view.running .empty:has-text('aiting for a device on 127.0.0.1:')");
  const press = async (port) => {
    const device = await openDevice(port), began = Date.now();
    for (let t = 0; t < 1.5; t = (Date.now() - began) / 1e3) {
      device.move([0, 0, -15 * (1 - Math.cos(Math.PI * Math.min(t, 1)))]);
      await new Promise((resolve) => setTimeout(resolve, 8));
    }
    return device;
  };
  const ofPage = await press(Number((await page.locator(".empty h2").innerText()).match(/:(\d+)/)[1]));
  await page.keyboard.press("Escape");
  await page.waitForSelector("button:has-text('Train again')");
  ofPage.close();
  await page.click("button:has-text('Choose a scene')");
  await page.locator("aside input").first().fill("command.ctpm");
  const [record] = await commands();
  assert.match(record, /^ctpm record kidney\.json -o command\.ctpm /);
  const running = spawn(paths.program, words(record), { cwd: folder, stdio: ["ignore", "ignore", "pipe"] });
  let said = "";
  const port = await new Promise((resolve) => running.stderr.on("data", (data) => {
    said += data;
    const found = /127\.0\.0\.1:(\d+)/.exec(said);
    if (found) resolve(Number(found[1]));
  }));
  const ofCommand = await press(port), end = new Promise((resolve) => running.once("exit", resolve));
  running.kill("SIGINT");
  assert.equal(await end, 0, said);
  ofCommand.close();
  const infos = ["device.ctpm", "command.ctpm"].map((name) => JSON.parse(ctpm(folder, "info", name, "--json").out));
  for (const { metadata, values } of infos) assert.ok(metadata.source === "igtl-listen" && values.device_samples > 50, JSON.stringify(values));
  // Where it was held at the end; on the way down both depend on when its poses came.
  const [button, command] = (await Promise.all(["device.ctpm", "command.ctpm"].map((name) => table(name)))).map((rows) => rows.at(-1).force);
  console.log(`a device holds ${button} N by the button, ${command} N by its command`);
  assert.ok(button > 0.2 && Math.abs(command / button - 1) < 0.02, `${button} and ${command} N`);
  assert.equal(ctpm(folder, "verify", "command.ctpm").code, 0);
  await field("in the hand").locator("select").selectOption("");
});

step("nothing was complained about", () => assert.deepEqual(studio.complaints, []));
