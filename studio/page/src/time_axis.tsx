import { useMemo } from "preact/hooks";
import type { Player } from "./player";
import { clockText, seconds } from "./text";

const kSteps = [1, 2, 5]; // of numbers on an axis, times powers of ten
const kNumbers = 8; // about as many as there is room for
const kApart = 0.05; // of two numbers at least, in widths of the axis

const kWhose = ["expert", "trainee"];

/** Of two sessions, whose it is. */
export function Whose({ stage }: { stage: number }) {
  return <span class={`whose ${stage === 0 ? "first" : "second"}`}>{kWhose[stage]}</span>;
}

/** The step of an axis that is so long [s]. */
export function stepOf(length: number): number {
  const rough = length / kNumbers, power = 10 ** Math.floor(Math.log10(rough));
  return power * (kSteps.find((step) => step * power >= rough) ?? 10);
}

/** The times of a session on its axis, each with its place there, 0 to 1: those that are shown and in which it runs. */
export function timesOf(player: Player, stage: number, from: number, to: number): { time: number; at: number }[] {
  const track = player.tracks.get(stage);
  if (!track || to <= from) return [];
  const own = (time: number) => (stage === 0 ? time : player.besideAt(time)), there = (time: number) => (stage === 0 ? time : player.firstAt(time));
  const least = Math.max(0, own(from)), most = Math.min(track.session.info.duration_s, own(to));
  if (most <= least) return [];
  const step = stepOf(to - from), times: { time: number; at: number }[] = [];
  for (let i = Math.ceil(least / step - 1e-6); i * step <= most + 1e-6 * step; ++i) {
    const at = (there(i * step) - from) / (to - from), last = times.at(-1);
    if (at >= -1e-6 && at <= 1 + 1e-6 && (!last || at - last.at >= kApart)) times.push({ time: i * step, at });
  }
  return times;
}

/** Below the curves, the time of each session on its own clock, where it runs. */
export function TimeAxes({ player, from, to }: { player: Player; from: number; to: number }) {
  // They do not change with the moment.
  return useMemo(() => axesOf(player, from, to), [player, from, to, player.besideAt(from), player.besideAt(to), player.aligned, player.tracks.get(0), player.tracks.get(1)]);
}

function axesOf(player: Player, from: number, to: number) {
  const isPair = player.tracks.has(1), digits = Math.max(0, -Math.floor(Math.log10(stepOf(to - from)) + 1e-9));
  const shareOf = (time: number) => Math.min(Math.max((time - from) / (to - from), 0), 1);
  if (to <= from) return null;
  return (
    <div class="axes" aria-hidden="true">
      {[...player.tracks.keys()].sort().map((stage) => {
        const { duration_s } = player.tracks.get(stage)!.session.info;
        const ends = stage === 0 ? [0, duration_s] : [player.firstAt(0), player.firstAt(duration_s)];
        return (
          <div key={stage} class={`axis ${stage === 0 ? "of-first" : "of-second"}`}>
            <span class="whose">{isPair ? kWhose[stage] : "time"}</span>
            <div class="times">
              <i style={{ "--from": String(shareOf(ends[0])), "--to": String(shareOf(ends[1])) }} />
              {timesOf(player, stage, from, to).map(({ time, at }) => (
                <span key={time} style={{ "--at": String(at) }}>{time.toFixed(digits)} s</span>
              ))}
            </div>
          </div>
        );
      })}
    </div>
  );
}

const hasNotBegun = (player: Player, stage: number) => player.timeOf(stage) < -5e-4;

/** The moment on a session's own clock. */
export function ownTime(player: Player, stage: number): string {
  return hasNotBegun(player, stage) ? "not begun" : seconds(player.timeOf(stage));
}

/** The moment on a session's own clock, and how long it is: always as wide, or the picture above would change its height. */
function OwnTime({ player, stage, name }: { player: Player; stage: number; name: string }) {
  const time = player.timeOf(stage), { duration_s } = player.tracks.get(stage)!.session.info;
  const isEarly = hasNotBegun(player, stage), where = isEarly ? "not begun" : time > duration_s + 5e-4 ? "has ended" : `of ${seconds(duration_s, duration_s < 100 ? 1 : 0)}`;
  return (
    <output class={name}>
      <span style={{ "--characters": String(seconds(duration_s).length + 1) }}>{!isEarly && seconds(time)}</span> <small>{where}</small>
    </output>
  );
}

/** The clock of the session, or those of both. */
export function Clocks({ player }: { player: Player }) {
  if (!player.tracks.has(1)) return <OwnTime player={player} stage={0} name="clock" />;
  return (
    <div class="clocks">
      <span><b class="first">expert</b> <OwnTime player={player} stage={0} name="clock" /></span>
      <span><b class="second">trainee</b> <OwnTime player={player} stage={1} name="clock-beside" /></span>
    </div>
  );
}

/** How both sessions were brought together. */
export function alignedText(player: Player): string {
  if (player.aligned === "path") return "aligned along the path";
  if (player.aligned) return `aligned at the first ${player.aligned}`;
  const ahead = Number(player.offset.toFixed(3)), { least, most } = player.offsets;
  if (ahead === 0) return "both clocks begin together";
  const isLimit = player.offset === least || player.offset === most;
  return `${clockText(ahead)}${isLimit ? ", the most with which both overlap" : ""}`;
}
