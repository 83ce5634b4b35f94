import { useEffect, useRef, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { Problems, Readings, Section, ShownCommand, Working } from "./parts";
import type { Player, Track } from "./player";
import type { SessionEvent } from "./protocol";
import { behind, command, millimetres, newtons, seconds, tickRows } from "./text";

const kNoticed = 0.25; // a device that is away for less interrupts nobody [s]

/** What happened in a session; late ticks are counted elsewhere. */
export function shownEvents({ events, tick_s }: { events: SessionEvent[]; tick_s: number }): SessionEvent[] {
  const hidden = new Set<SessionEvent>();
  let lost: SessionEvent | null = null;
  for (const event of events) {
    if (event.kind === "late tick") hidden.add(event);
    if (event.kind === "device back" && lost && (event.tick - lost.tick) * tick_s < kNoticed) hidden.add(lost).add(event);
    if (event.kind.startsWith("device ")) lost = event.kind === "device lost" ? event : null;
  }
  return events.filter((event) => !hidden.has(event));
}

export type ShownFrame = { force: number[]; depth: number; contacts: number; severed: number; isSame: boolean; isGlimpse: boolean; missed: number; tick: number; tool: number; second: { force: number[]; depth: number; tool: number } | null } | null;

/** What happened in a session, each at a press. */
function Events({ player, track: { stage, session: { info } } }: { player: Player; track: Track }) {
  return (
    <Section title={player.tracks.size < 2 ? "Events" : stage === 0 ? "Events, expert" : "Events, trainee"}>
      <ul class="jumps">
        {shownEvents(info).map((event, i) => {
          const time = event.tick * info.tick_s;
          return (
            <li key={i}>
              <button type="button" onClick={() => player.move(stage === 0 ? time : player.firstAt(time))}>
                <span class="number">{seconds(time)}</span> {event.text}
              </button>
            </li>
          );
        })}
      </ul>
      {info.events.length === 0 && <p class="hint">Nothing was touched in this session.</p>}
    </Section>
  );
}

/** The moment that is shown, in numbers, and the session that it is of. */
export function Moment({ connection, player, frame, other }: { connection: Connection; player: Player; frame: ShownFrame; other: ShownFrame }) {
  const [verdict, setVerdict] = useState<{ same: boolean; text: string } | null>(null);
  const [progress, setProgress] = useState<[number, number] | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const running = useRef<AbortController | null>(null);
  const { path, info } = player.tracks.get(0)!.session;
  useEffect(() => setVerdict(null), [path]);

  const verify = async () => {
    setError(null);
    setProgress([0, 1]);
    running.current = new AbortController();
    try {
      setVerdict(await connection.call("session.verify", { path },
        { progress: (done, total) => setProgress([done, total]), signal: running.current.signal }));
    } catch (failure) {
      setError(failure as Error);
    }
    setProgress(null);
  };
  const depthOf = (stage: number, { tool, depth }: { tool: number; depth: number }, isGlimpse: boolean) =>
    isGlimpse && player.tracks.get(stage)?.session.view.tools[tool]?.kind === "scalpel" ? "–" : millimetres(depth, 2); // a glimpse does not know that of a blade
  const rows = (shown: ShownFrame, stage: number): [string, string][] => shown ? [
    ["force", newtons(Math.hypot(...shown.force))],
    ["depth", depthOf(stage, shown, shown.isGlimpse)],
    ...(shown.second
      ? ([["force, left", newtons(Math.hypot(...shown.second.force))], ["depth, left", depthOf(stage, shown.second, shown.isGlimpse)]] as [string, string][])
      : []),
    ["touched", `${shown.contacts} points`],
    ["severed", `${shown.severed} elements`],
    ["replay", shown.isGlimpse ? "is computed…" : shown.isSame ? "as recorded" : "DIFFERS"],
  ] : [];
  return (
    <>
      <Section title={other ? "This moment, expert" : "This moment"}>
        <Readings rows={[["step", String(frame?.tick ?? 0)], ...rows(frame, 0),
          ["picture after", player.pictureAfter === null ? "…" : `${player.pictureAfter.toFixed(0)} ms`],
          ["replayed after", player.replayedAfter === null ? "…" : `${player.replayedAfter.toFixed(0)} ms`]]} />
      </Section>
      {other && <Section title="Trainee"><Readings rows={rows(other, 1)} /></Section>}
      {[...player.tracks.values()].sort((a, b) => a.stage - b.stage).map((track) => <Events key={track.stage} player={player} track={track} />)}
      <Section title="Session">
        <Readings rows={[
          ["recorded", info.created_utc.replace("T", " ").replace("Z", " UTC") || "its time of day was taken out"],
          ["tissue", `${info.spheres} spheres`],
          ["largest force", newtons(info.max_force_n)],
          ["deepest press", info.max_depth_m ? millimetres(info.max_depth_m, 2) : "–"],
          ...tickRows(info.tick_time_p50_s, info.tick_time_p99_s, info.tick_s),
          // Only a session that was recorded in real time knows how long it waited.
          ...("waited_for_processor_s" in info.values || info.late_ticks > 0
            ? [["late steps", String(info.late_ticks)], ["behind the clock", behind(info.slip_s, info.slip_max_s)]] as [string, string][]
            : [["late steps", "not known"]] as [string, string][]),
        ]} />
        {!info.ended_cleanly && <p class="warning">It has no clean end: its recording was interrupted, or still goes on.</p>}
        {[info.physics_remark, ...info.remarks].filter(Boolean).map((remark) => <p key={remark} class="warning">{remark}</p>)}
        {progress ? <Working what="verifying" done={progress[0]} total={progress[1]} onCancel={() => running.current?.abort()} />
          : <button type="button" onClick={() => void verify()}>Verify the replay</button>}
        {verdict && <p class={verdict.same ? "good" : "warning"} role="status">{verdict.text}</p>}
        <Problems error={error} />
        <ShownCommand text={command("verify", path)} />
      </Section>
    </>
  );
}
