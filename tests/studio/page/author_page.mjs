// What an author's hands do in the page, for the tests of the Author room.
import assert from "node:assert/strict";
import { cpSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { ctpmBeside } from "./browser.mjs";

/** Tools for the scene `own` of a folder. `page` and `folder` are asked for when they are needed: both may change. */
export function authorOf(page, folder, own) {
  const onDisk = (scene = own) => readFileSync(join(folder(), scene), "utf8");
  /** The text as its author has it: a draft until it is saved. */
  const text = async (scene = own) => (await page().evaluate((key) => localStorage.getItem(key), `ctpm.draft:${scene}`)) ?? onDisk(scene);
  const scene = async () => JSON.parse(await text());
  const button = (name, within = ".author") => page().locator(`${within} button:text-is("${name}")`);
  const handle = (name) => page().locator(`.handle:has(span:text-is("${name}"))`);
  const drawn = () => page().evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  /** Waits until the scene is shown as its text says, and its errors are known. */
  async function settled() {
    await drawn();
    await page().waitForFunction(() => document.querySelector(".verdict[aria-busy=false]") && !document.querySelector(".view .empty"));
    await drawn();
  }
  /** Puts a text into the editor, as pasted. */
  async function write(content) {
    await page().locator(".cm-content").click();
    await page().keyboard.press("Control+a");
    await page().evaluate((pasted) => navigator.clipboard.writeText(pasted), content);
    await page().keyboard.press("Control+v");
  }
  const centreOf = async (locator) => {
    const box = await locator.boundingBox();
    return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
  };
  /** Drags with the mouse, as a hand does: in steps. */
  async function drag(from, by, steps = 12) {
    await page().mouse.move(from.x, from.y);
    await drawn(); // what is taken hold of is there
    await page().mouse.down();
    for (let i = 1; i <= steps; ++i) await page().mouse.move(from.x + (by.x * i) / steps, from.y + (by.y * i) / steps);
    await page().mouse.up();
  }
  const untilSaved = () => page().waitForFunction((key) => localStorage.getItem(key) === null, `ctpm.draft:${own}`);
  /** Saves by key. Returns the scene. That the program takes it is checked beside the page, until `taken`. */
  async function save() {
    await page().keyboard.press("Control+s");
    await untilSaved();
    check();
    return JSON.parse(onDisk());
  }
  const checks = [];
  let elsewhere = null; // copies of what was saved, with their meshes
  function check() {
    elsewhere ??= mkdtempSync(join(tmpdir(), "ctpm-saved-"));
    const copy = `${checks.length}.json`;
    cpSync(join(folder(), own), join(elsewhere, copy));
    for (const { mesh } of JSON.parse(onDisk()).organs) cpSync(join(folder(), mesh), join(elsewhere, mesh), { force: false });
    checks.push((checks.at(-1) ?? Promise.resolve()).then(() => ctpmBeside(elsewhere, "check", copy)));
  }
  /** Every scene that was saved is one that the program takes. */
  async function taken() {
    for (const { code, err } of await Promise.all(checks)) assert.equal(code, 0, err);
    assert.ok(checks.length > 0);
    rmSync(elsewhere, { recursive: true });
  }
  return { onDisk, text, scene, button, handle, settled, write, centreOf, drag, untilSaved, save, taken };
}
