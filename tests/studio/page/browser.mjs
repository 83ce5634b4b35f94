// A studio and a browser that shows it.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, readdirSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { text } from "node:stream/consumers";
import { test } from "node:test";
import { inflateSync } from "node:zlib";

const [program, source, packages, sessions, pictures] = process.argv.slice(2, 7).map((path) => resolve(path));
export const paths = { program, source, packages, sessions, pictures };
const require = createRequire(join(packages, "package.json"));
const { chromium } = require("playwright-core");
const axe = require.resolve("axe-core/axe.min.js");

export const kFlags = [
  "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
  // As on a machine without a GPU: the processor draws the page, and WebGL where a page asks for it.
  "--disable-gpu", "--enable-unsafe-swiftshader",
];

let broken = "";
/** A test of a file in which each goes on where the one before left the page. After one that fails the others are not tried: they would
    wait for what cannot come. */
export function step(name, run) {
  test(name, async (t) => {
    if (broken) return t.skip(`"${broken}" failed before it`);
    try {
      await run(t);
    } catch (error) {
      broken = name;
      throw error;
    }
  });
}

/** Whether all of a test is run, as under the label slow, or what fits beside all others. */
export const isWhole = process.env.CTPM_WHOLE === "1";

/** A step that is taken only where all of a test is run: what comes after it finds the page as it was before. */
export function rareStep(name, run) {
  if (isWhole) step(name, run);
}

/** A folder with the shipped scenes and the sessions that are named. */
export function makeFolder(...names) {
  const folder = mkdtempSync(join(tmpdir(), "ctpm-page-"));
  mkdirSync(join(folder, "organs"));
  for (const file of readdirSync(join(source, "scenes", "organs"))) cpSync(join(source, "scenes", "organs", file), join(folder, "organs", file));
  for (const name of names) cpSync(name.endsWith(".json") ? join(source, "scenes", name) : join(sessions, name), join(folder, name));
  return folder;
}

const nowhere = mkdtempSync(join(tmpdir(), "ctpm-no-programs-"));
process.on("exit", () => rmSync(nowhere, { recursive: true, force: true }));
const { DISPLAY, WAYLAND_DISPLAY, ...others } = process.env;
/** What the program gets: no display, and neither npm nor node nor any other program. */
const kBare = { ...others, PATH: nowhere };

/** Runs the program in a folder. */
export function ctpm(folder, ...words) {
  const done = spawnSync(program, words, { cwd: folder, encoding: "utf8", maxBuffer: 64 << 20 });
  return { code: done.status, out: done.stdout, err: done.stderr };
}

/** The same while the page works: a promise of what ctpm() returns. */
export async function ctpmBeside(folder, ...words) {
  const running = spawn(program, words, { cwd: folder, stdio: ["ignore", "pipe", "pipe"] });
  const [out, err, code] = await Promise.all([text(running.stdout), text(running.stderr), ended(running)]);
  return { code, out, err };
}

/** Serves `folder`; returns the process and the address that it prints. */
export async function serve(folder, port, more = []) {
  const server = spawn(program, ["studio", folder, "--no-open", "--port", String(port), ...more], { env: kBare, stdio: ["ignore", "pipe", "ignore"] });
  return { server, address: await new Promise((resolve) => server.stdout.once("data", (data) => resolve(String(data).trim()))) };
}

function ended(server) {
  return new Promise((resolve) => server.once("exit", resolve));
}

/** Ends it as a user does; its exit code. */
export function stop(server) {
  const end = ended(server);
  server.kill("SIGINT");
  return end;
}

/** Opens a browser with an empty page; what goes wrong in it is added to `complaints`. */
export async function openBrowser(options = {}) {
  const profile = mkdtempSync(join(tmpdir(), "ctpm-profile-"));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: "/usr/bin/chromium", headless: true, viewport: { width: 1280, height: 720 }, args: kFlags, ...options,
  });
  context.setDefaultTimeout(Number(process.env.CTPM_WAIT ?? 150000));
  const page = context.pages()[0];
  const complaints = [];
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error") complaints.push(message.text());
  });
  const close = async () => {
    await context.close();
    rmSync(profile, { recursive: true, force: true });
  };
  return { page, complaints, close };
}

/** Closes a studio, which found nothing wrong, and removes its folder. */
export async function leave(studio, folder) {
  assert.equal(await studio.close(), 0);
  rmSync(folder, { recursive: true });
}

/** Serves `folder` and opens its page. */
export async function openStudio(folder, port = 0, ...more) {
  let { server, address } = await serve(folder, port, more);
  const { page, complaints, close: closeBrowser } = await openBrowser({
    ignoreHTTPSErrors: more.includes("--behind"), // a certificate of the test's own
  });
  page.on("dialog", (dialog) => dialog.type() !== "beforeunload" && complaints.push(`dialog: ${dialog.message()}`));
  let cameAt = Date.now(); // the newest message of the program
  const live = { ready: 0, frames: 0 }; // of a training: how often the page asked for a picture, and how many came
  let sent = null, count = 0, rested = 0; // the hand that the page sent last, of how many, and how many of them were where it is
  const apart = (a, b) => ["position", "orientation"].some((of) => a[of].some((x, i) => Math.abs(x - b[of][i]) > 1e-9));
  page.on("websocket", (socket) => socket.on("framesent", ({ payload }) => {
    live.ready += Number(String(payload).startsWith('{"ready"'));
    if (!String(payload).startsWith('{"hand"')) return;
    const { hand } = JSON.parse(String(payload));
    ++count;
    rested = sent && !apart(hand, sent) ? rested + 1 : 0;
    sent = hand;
  }));
  page.on("websocket", (socket) => socket.on("framereceived", ({ payload }) => {
    cameAt = Date.now();
    live.frames += Number(typeof payload !== "string" && payload.readUInt32LE(0) === 2 && (payload.readUInt32LE(20) & 2) !== 0);
  }));
  /** Waits until the program has sent nothing for that time. */
  const quiet = async (ms = 300) => {
    for (const began = Date.now(); Date.now() < Math.max(cameAt, began) + ms; ) await new Promise((resolve) => setTimeout(resolve, 20));
  };
  /** Where the hand is when it has followed what leads it: it was sent eight times more, and did not move. */
  const handAtRest = async () => {
    for (const from = count, began = Date.now(); count < from + 8 || rested < 8; ) {
      if (Date.now() - began > 60_000) throw new Error(`the hand does not come to rest: ${count - from} sent, ${rested} the same`);
      await new Promise((resolve) => setTimeout(resolve, 10));
    }
    return sent.position;
  };
  await page.goto(address);
  await page.waitForSelector("header nav button");
  const close = async () => {
    await closeBrowser();
    return stop(server);
  };
  /** Kills the server as a crash would. */
  const kill = async () => {
    const end = ended(server);
    server.kill("SIGKILL");
    await end;
  };
  /** It gets no processor for that time, as on a machine that has none left. */
  const starve = async (ms) => {
    server.kill("SIGSTOP");
    await new Promise((resolve) => setTimeout(resolve, ms));
    server.kill("SIGCONT");
  };
  /** From now on a file that it writes may not be longer: a longer write ends it there. */
  const limitFiles = (bytes) => {
    const { status, error } = spawnSync("prlimit", ["--pid", String(server.pid), `--fsize=${bytes}`]);
    if (status !== 0) throw error ?? new Error(`prlimit: ${status}`);
  };
  /** Starts it again where it was; returns its new address. */
  const startAgain = async () => {
    ({ server, address } = await serve(folder, new URL(address).port));
    return address;
  };
  /** Calls the program beside the page, as a script would. */
  const call = async (name, params) => {
    const { origin, hash } = new URL(address);
    const answer = await fetch(`${origin}/call`, {
      method: "POST", body: JSON.stringify({ id: 1, call: name, params }),
      headers: { "Content-Type": "application/json", Authorization: `Bearer ${new URLSearchParams(hash.slice(1)).get("token")}` },
    });
    return (await answer.json()).result;
  };
  return { page, address, complaints, close, kill, starve, limitFiles, ended: () => (server.exitCode ?? server.signalCode ?? ended(server)), startAgain, call, hand: () => sent, handsSent: () => count, live, handAtRest, quiet };
}

/** Lets a test keep back what the program sends, as a loaded machine would: from the next load on the page's global `holds`, while it is
    there, says of a message whether it is kept, and `letGo()` lets the page have what was kept, in order. */
export async function keepBack(page) {
  await page.addInitScript(() => {
    const kept = [];
    globalThis.WebSocket = class extends WebSocket {
      constructor(...of) {
        super(...of);
        this.addEventListener("message", (event) => {
          if (!globalThis.holds?.(event.data)) return;
          event.stopImmediatePropagation();
          kept.push(() => this.dispatchEvent(new MessageEvent("message", { data: event.data })));
        });
      }
    };
    globalThis.letGo = () => {
      globalThis.holds = undefined;
      for (const give of kept.splice(0)) give();
    };
    globalThis.keptCount = () => kept.length;
  });
}

/** The words of a command as a shell reads them. */
export function wordsOf(command) {
  return [...command.matchAll(/(?:'[^']*'|[^\s'])+/g)].map(([word]) => word.replaceAll("'", ""));
}

/** Reads until what was read is as it should be; the last that was read. */
export async function until(read, isRight, seconds = 20) {
  for (const began = Date.now(); ; await new Promise((resolve) => setTimeout(resolve, 50))) {
    const value = await read();
    if (isRight(value) || Date.now() - began > 1e3 * seconds) return value;
  }
}

/** Moves the mouse by steps of some pixels, as a hand does: 60 to 80 of them a second. */
export async function moveMouse(page, from, by, steps) {
  for (let i = 0; i <= steps; ++i) {
    await page.mouse.move(from.x + (by.x * i) / steps, from.y + (by.y * i) / steps);
    await page.waitForTimeout(12);
  }
}

/** The place of the ring around a tool that can be taken up, once it is there [px]. */
export async function ringOf(page) {
  const ring = await page.waitForSelector(".take-up");
  return ring.evaluate((element) => (({ x, y, width, height }) => ({ x: x + width / 2, y: y + height / 2 }))(element.getBoundingClientRect()));
}

/** Brings the pointer to the tool of a training, which is taken up there; returns that place [px]. */
export async function takeUp(page) {
  const box = await page.locator(".view > canvas").boundingBox();
  await page.mouse.move(box.x + 4, box.y + box.height - 4);
  const at = await ringOf(page);
  await page.mouse.move(at.x, at.y);
  await page.waitForSelector(".view.held");
  return at;
}

/** Puts a device, which comes to any free port, in the hand of a training that becomes `session`. Returns how a field of
    its form is found. */
export async function chooseDevice(page, session) {
  const field = (label) => page.locator(`aside .field:has-text("${label}")`);
  await page.locator("aside input").first().fill(session);
  await field("in the hand").locator("select").selectOption("listen");
  await field("port of this machine").locator("input").fill("0");
  await page.click("aside summary");
  await field("its origin").locator("input").fill("0 0 75");
  return field;
}

/** What axe-core finds that is serious. */
export async function seriousFindings(page) {
  await page.evaluate((await import("node:fs")).readFileSync(axe, "utf8") + ";0");
  const { violations } = await page.evaluate(() => globalThis.axe.run({ resultTypes: ["violations"], selectors: false }));
  return violations.filter((v) => v.impact === "serious" || v.impact === "critical")
    .map((v) => `${v.id}: ${v.nodes.map((n) => n.html).join(" | ")}`);
}

/** Controls that can be seen and used, but that the tabulator does not come to, nor to one of their row, which arrow keys go along. */
export async function outOfReach(page) {
  await page.evaluate(() => {
    globalThis.reached = new Set();
    globalThis.looks = (control) => `${control.tagName} ${control.getAttribute("aria-label")} ${control.textContent}`; // it may be made anew
  });
  // Round once, over the end of the page.
  const goesOn = () => page.evaluate(() => {
    let at = document.activeElement;
    while (at?.shadowRoot?.activeElement) at = at.shadowRoot.activeElement;
    const isNew = at === document.body || !globalThis.reached.has(at);
    globalThis.reached.add(at).add(globalThis.looks(at));
    return isNew;
  });
  do await page.keyboard.press("Tab");
  while (await goesOn());
  return page.evaluate(() => {
    const isReached = (control) => globalThis.reached.has(control) || globalThis.reached.has(globalThis.looks(control));
    const isInRow = (control) => control.tabIndex === -1 && [...control.closest("ul, .handles")?.querySelectorAll("button[tabindex='0']") ?? []].some(isReached);
    return [...document.querySelectorAll("button, input:not([type=radio]), select, textarea, summary, a[href], [tabindex]")]
      .filter((control) => !control.disabled && control.checkVisibility({ visibilityProperty: true }) && !control.closest("[aria-hidden=true]") && !isReached(control) && !isInRow(control))
      .map((control) => control.outerHTML.slice(0, 120));
  });
}

/** A picture of the page, to be looked at by people: it takes most of a second, and so is taken where it is asked for. */
export async function picture(page, name) {
  if (!isWhole && process.env.CTPM_PICTURES !== "1") return;
  mkdirSync(pictures, { recursive: true });
  await page.screenshot({ path: join(pictures, `${name}.png`) });
}

/** The pixels of a PNG, as a browser and the program write them, row by row: red, green, blue and opacity in `data`. */
export function pixelsOf(png) {
  const width = png.readUInt32BE(16), height = png.readUInt32BE(20), channels = { 2: 3, 6: 4 }[png[25]];
  assert.ok(png[24] === 8 && channels && png[28] === 0, "8 bits of red, green, blue and perhaps opacity, not interlaced");
  const parts = [];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at))
    if (png.toString("latin1", at + 4, at + 8) === "IDAT") parts.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
  // Each row begins with how its bytes are foretold by those on the left, above, and above that (PNG, section 9).
  const packed = inflateSync(Buffer.concat(parts)), stride = width * channels, data = new Uint8ClampedArray(4 * width * height).fill(255);
  let above = new Uint8Array(stride);
  for (let y = 0; y < height; ++y) {
    const how = packed[y * (stride + 1)], row = packed.subarray(y * (stride + 1) + 1, (y + 1) * (stride + 1));
    for (let i = 0; i < stride; ++i) {
      const a = i < channels ? 0 : row[i - channels], b = above[i], c = i < channels ? 0 : above[i - channels];
      if (how === 1) row[i] += a;
      else if (how === 2) row[i] += b;
      else if (how === 3) row[i] += (a + b) >> 1;
      else if (how === 4) {
        const pa = Math.abs(b - c), pb = Math.abs(a - c), pc = Math.abs(a + b - 2 * c);
        row[i] += pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
      }
    }
    for (let i = 0, to = 4 * y * width; i < stride; ++i, to += channels === 3 && i % 3 === 0 ? 2 : 1) data[to] = row[i];
    above = row;
  }
  return { width, height, data };
}

/** What of a comparison is seen in a panel that nobody has scrolled: the first advice, so many worst moments, and whether measures follow. */
export function seenFirst(page, panel) {
  return page.locator(panel).evaluate((holder) => {
    const box = holder.getBoundingClientRect();
    const isSeen = (element) => {
      const { top, bottom } = element.getBoundingClientRect();
      return top >= box.top - 1 && bottom <= Math.min(box.bottom, innerHeight) + 1;
    };
    const moments = [...holder.querySelectorAll(".jumps button")];
    return {
      scrolled: holder.scrollTop, advice: isSeen(holder.querySelector(".advice li")), moments: moments.filter(isSeen).length, of: moments.length,
      measuresAfter: holder.querySelector("table").getBoundingClientRect().top >= moments.at(-1).getBoundingClientRect().bottom,
    };
  });
}

/** How far the page is wider than its window [px]. */
export function overflow(page) {
  return page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
}

/** The number in the reading of that name, which may be folded. */
export async function reading(page, name) {
  const text = await page.locator(`.readings div:has(dt:text-is("${name}")) dd`).first().textContent();
  return Number.parseFloat(text);
}
