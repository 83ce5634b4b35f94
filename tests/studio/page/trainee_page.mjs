// What a trainee's hands do in the page, for the tests of the Train room.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { paths } from "./browser.mjs";

/** Axes of the hand in the scene `kidney`: to the right in the picture, up, and away from the viewer of its first camera. */
export function handAxes() {
  const [camera] = JSON.parse(readFileSync(join(paths.source, "scenes", "kidney.json"), "utf8")).cameras;
  const x = camera.target_mm[0] - camera.eye_mm[0], y = camera.target_mm[1] - camera.eye_mm[1], far = Math.hypot(x, y);
  return { eye: camera.eye_mm.map((c) => c / 1e3), right: [y / far, -x / far, 0], up: [0, 0, 1], deep: [x / far, y / far, 0] };
}

/** Begins a training of a scene from the list; what is recorded becomes `session`, or nothing is. */
export async function begin(page, scene, session = "") {
  await page.locator("aside input").first().fill(session);
  await page.click(`.list button:has(span:text-is("${scene}"))`);
  await page.waitForSelector(".view.running");
}

/** Takes the tool up by keys, which leave it where it was: from then on the session runs. */
export async function takeUpByKeys(page) {
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("ArrowDown");
}

/** Ends it by key. */
export async function end(page) {
  await page.keyboard.press("Escape");
  await page.waitForSelector("button:has-text('Train again')");
}

/** Waits until the tissue resists. */
export function untilFelt(page) {
  return page.waitForFunction(() => Number.parseFloat(document.querySelector(".force-bar output").textContent) > 0.1);
}
