// Sessions of many minutes, for what is measured in them.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { ctpmBeside, paths } from "./browser.mjs";

const kRows = 4; // of places that are pressed

/** Steps of a ball that presses at places near `x` for about so many seconds. */
function presses(seconds, x) {
  const steps = [{ take: { tool: "ball", at_mm: [x, 5, 75] } }];
  for (let i = 0; i < seconds / 8.5; ++i)
    steps.push({ move: { to_mm: [x + 4 * (i % 3), 5 + 3 * (i % kRows), 60], speed_mm_per_s: 20 } }, { press: { distance_mm: 22, speed_mm_per_s: 6 } },
      { wait_s: 1.5 }, { release: { distance_mm: 25, speed_mm_per_s: 20 } });
  return [...steps, { put_away: true }];
}

/** The cuts of a shipped script of the kidney, and presses of so many seconds before and after each of them. */
function longScript(name, pressed) {
  const shipped = JSON.parse(readFileSync(join(paths.source, "scenes", "scripts", `${name}.json`), "utf8"));
  const paths_mm = shipped.steps.filter((step) => step.cut).map((step) => step.cut.path_mm);
  const each = pressed / (paths_mm.length + 1);
  return { ...shipped, steps: [...presses(each, -12), ...paths_mm.flatMap((path, i) => [
    { take: { tool: "scalpel", at_mm: [path[0][0], path[0][1], Math.max(60, path[0][2])], facing: [1, 0, 0] } },
    { cut: { path_mm: path, speed_mm_per_s: 12 } },
    { move: { to_mm: [path.at(-1)[0], path.at(-1)[1], 70], speed_mm_per_s: 40 } },
    { put_away: true },
    ...presses(each, -12 + 10 * i),
  ])] };
}

/** Records NAME.ctpm in the folder of kidney.json. */
export async function recordLong(folder, name, shipped, pressed) {
  writeFileSync(join(folder, `${name}.json`), JSON.stringify(longScript(shipped, pressed)));
  const made = await ctpmBeside(folder, "record", "kidney.json", "--script", `${name}.json`, "-o", `${name}.ctpm`, "--fast");
  if (made.code !== 0) throw new Error(made.err);
}
