// Numbers and commands as people read them.

export function millimetres(metres: number, digits = 1): string {
  return `${(1e3 * metres).toFixed(digits)} mm`;
}

export function newtons(force: number, digits = 2): string {
  return `${force.toFixed(digits)} N`;
}

export function seconds(time: number, digits = 3): string {
  return `${time.toFixed(digits)} s`;
}

/** "1 error", "3 errors". */
export function counted(count: number, noun: string): string {
  return `${count} ${noun}${count === 1 ? "" : "s"}`;
}

export function underMs(time: number, digits: number): string {
  return `under ${(1e3 * time).toFixed(digits)} ms`;
}

/** What `check` says of a scene with so many errors and warnings. */
export function verdictOf(errors: number, warnings: number): string {
  return errors ? counted(errors, "error") : warnings ? `good, ${counted(warnings, "warning")}` : "good";
}

/** Whether a file can have that name: it is not blank, and names no folder. */
export function isFileName(name: string): boolean {
  return /^[^/\\]+$/.test(name) && name.trim() === name && !/^\.+$/.test(name);
}

/** That path, or with the next number, so that it is none of those that are taken. */
export function freePath(taken: string[], path: string): string {
  const [, stem, ending = ""] = /^(.*?)(?:-\d+)?(\.[^./]+)?$/.exec(path)!;
  for (let i = 1, free = path; ; free = `${stem}-${++i}${ending}`) if (!taken.includes(free)) return free;
}

/** Why a number that was typed is none that its field takes; empty: it is one, or the field is empty. */
export function whyNot(name: string, typed: string, least: number, most: number, unit = ""): string {
  const number = Number(typed), limits = most === Infinity ? `at least ${least}` : `from ${least} to ${most}`;
  return typed === "" || (least <= number && number <= most) ? "" : `${name}: ${limits} ${unit}`.trimEnd();
}

/** How far a session fell behind real time. */
export function behind(atEnd: number, atMost: number): string {
  return atMost > 0 ? `${seconds(atEnd)} at the end, ${seconds(atMost)} at most` : "never";
}

export function short(value: number | null | undefined, significant = 4): string {
  return value === null || value === undefined ? "–" : String(Number(value.toPrecision(significant)));
}

/** A scene by its path, without the ending that all of them have. */
export function sceneName(path: string): string {
  return path.replace(/\.json$/, "");
}

export function bytes(count: number): string {
  if (count < 1e3) return `${count} B`;
  return count < 1e6 ? `${(count / 1e3).toFixed(0)} kB` : `${(count / 1e6).toFixed(1)} MB`;
}

/** By how much the clock of the session beside differs; a trainee who is slower comes to the same place later, and this clock shows more. */
export function clockText(ahead: number): string {
  return `the trainee's clock shows ${Math.abs(ahead)} s ${ahead < 0 ? "less" : "more"}`;
}

/** How long a step of the simulation, a tick, took or takes, and how long it may. */
export function ofStep(time: number, tick: number): string {
  return `${(1e3 * time).toFixed(2)} ms of the ${Number((1e3 * tick).toPrecision(3))} ms it has`;
}

/** How long ticks took: what a session's p50 and p99 say. */
export function tickRows(p50: number, p99: number, tick: number): [string, string][] {
  return [
    ["half of the steps took", underMs(p50, 2)], ["99 of 100 steps took", underMs(p99, 2)],
    ["a step has", `${Number((1e3 * tick).toPrecision(3))} ms`],
  ];
}

/** A word of a shell command, quoted where the shell needs it. */
export function word(text: string): string {
  return /^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}

/** `ctpm NAME WORDS...`; undefined words are left out. */
export function command(name: string, ...words: (string | undefined)[]): string {
  return ["ctpm", name, ...words.filter((w) => w !== undefined).map((w) => word(w))].join(" ");
}
