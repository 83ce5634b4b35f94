// A browser as a user has it, for benchmarks. Playwright follows the network of each page: the browser then hands every picture
// of the studio a second time to another process, as text, which on two processors delays poses and pictures by milliseconds.
// Here only what a benchmark asks for goes to the browser: scripts, the mouse, a key.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as rest } from "node:timers/promises";
import { kFlags } from "./browser.mjs";

const kAskAgain = 50; // whether something is so in the page [ms]: to be asked is work for it
const kFrom = 3, kTo = 4; // file descriptors on which Chromium reads and writes messages, each ended by a zero

/** Chromium with one page of 1280 x 720. `script` runs in each of its documents before their own. */
export async function openBareBrowser(script) {
  const profile = mkdtempSync(join(tmpdir(), "ctpm-profile-"));
  const browser = spawn("/usr/bin/chromium", [...kFlags, "--headless", "--hide-scrollbars", `--user-data-dir=${profile}`,
    "--remote-debugging-pipe", "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
  const waiting = new Map();
  let count = 0, session, begun = ""; // a message that is not whole yet
  browser.stdio[kTo].setEncoding("utf8").on("data", (data) => {
    const messages = (begun + data).split("\0");
    begun = messages.pop();
    for (const message of messages.map((text) => JSON.parse(text))) {
      const done = waiting.get(message.id);
      waiting.delete(message.id);
      if (message.error) done?.reject(new Error(message.error.message));
      else done?.resolve(message.result);
    }
  });
  const send = (method, params = {}) => new Promise((resolve, reject) => {
    waiting.set(++count, { resolve, reject });
    browser.stdio[kFrom].write(`${JSON.stringify({ id: count, method, params, ...(session && { sessionId: session }) })}\0`);
  });

  const { targetInfos } = await send("Target.getTargets"), { targetId } = targetInfos.find(({ type }) => type === "page");
  session = (await send("Target.attachToTarget", { targetId, flatten: true })).sessionId;
  await send("Emulation.setDeviceMetricsOverride", { width: 1280, height: 720, deviceScaleFactor: 1, mobile: false });
  await send("Page.enable");
  await send("Page.addScriptToEvaluateOnNewDocument", { source: `(${script})();` });

  /** What a function of the page returns; it knows only its arguments. */
  const evaluate = async (run, ...of) => {
    const { result, exceptionDetails } = await send("Runtime.evaluate",
      { expression: `(${run})(...${JSON.stringify(of)})`, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  };
  /** Waits until a function of the page, asked between two of its tasks, returns something true; returns that. */
  const until = async (is, ...of) => {
    for (;; await rest(kAskAgain)) {
      const value = await evaluate(is, ...of).catch(() => null); // the document may be about to go
      if (value) return value;
    }
  };
  /** The middle, the place, and the size of the element that a selector finds, of those with `text` in them, once it is seen [px]. */
  const find = (selector, text = "") => until((selector, text) => {
    const element = [...document.querySelectorAll(selector)].find((one) => one.textContent.includes(text) && one.checkVisibility());
    if (!element) return null;
    element.scrollIntoView({ block: "nearest" });
    const { x, y, width, height } = element.getBoundingClientRect();
    return { left: x, top: y, width, height, x: x + width / 2, y: y + height / 2 };
  }, selector, text);
  const move = ({ x, y }) => send("Input.dispatchMouseEvent", { type: "mouseMoved", x, y });
  const clickAt = async ({ x, y }) => {
    for (const type of ["mousePressed", "mouseReleased"]) await send("Input.dispatchMouseEvent", { type, x, y, button: "left", clickCount: 1 });
  };
  const press = async (key) => {
    for (const type of ["keyDown", "keyUp"]) await send("Input.dispatchKeyEvent", { type, key });
  };
  const close = async () => {
    const ended = new Promise((resolve) => browser.once("exit", resolve));
    session = undefined;
    send("Browser.close").catch(() => {});
    await ended;
    rmSync(profile, { recursive: true, force: true });
  };
  return {
    send, evaluate, until, find, move, clickAt, press, close, go: (address) => send("Page.navigate", { url: address }),
    click: async (selector, text) => clickAt(await find(selector, text)),
  };
}
