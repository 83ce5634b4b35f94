import { useEffect, useRef, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { NumberInput } from "./fields";
import { Problems, Readings, Section, ShownCommand, Working } from "./parts";
import { kEventOf } from "./place";
import { firstOf, type Player } from "./player";
import type { ComparisonResult, Listing, MeasureRow, Moment } from "./protocol";
import { command, seconds, short } from "./text";

/** What a comparison of two sessions found that nobody changed since; null: they were not compared, or cannot be. */
export function knownComparison(connection: Connection, expert: string, trainee: string): Promise<ComparisonResult | null> {
  return connection.call<ComparisonResult | null>("session.compare", { expert, trainee, only_known: true }).catch(() => null);
}

/** The session beside: which one, how the two are aligned, and how they differ. */
export function Compare({ connection, player, listing, comparison, onComparison, onBeside, onSwap }: {
  connection: Connection;
  player: Player;
  listing: Listing;
  comparison: ComparisonResult | null;
  onComparison: (result: ComparisonResult | null) => void;
  onBeside: (path: string | undefined) => Promise<void>;
  onSwap: () => void; // the expert's session becomes the trainee's
}) {
  const [error, setError] = useState<Error | null>(null);
  const [progress, setProgress] = useState<[number, number] | null>(null);
  const [typed, setTyped] = useState<string | null>(null); // until it is whole: a picture that comes meanwhile puts no other number in its place
  const running = useRef<AbortController | null>(null), top = useRef<HTMLDivElement>(null);
  const first = player.tracks.get(0)!.session, second = player.tracks.get(1)?.session;

  const align = (event: keyof typeof kEventOf) => {
    const time = player.alignAt(event);
    if (time !== null) player.move(time);
  };
  const choose = async (path: string) => {
    await onBeside(path || undefined);
    align("contact");
  };
  const compare = async () => {
    setError(null);
    setProgress([0, 1]);
    running.current = new AbortController();
    try {
      const result = await connection.call<ComparisonResult>("session.compare", { expert: first.path, trainee: second!.path },
        { progress: (done, total) => setProgress([done, total]), signal: running.current.signal });
      onComparison(result);
      top.current?.scrollIntoView({ block: "nearest" }); // what it found is above what was pressed
      return result;
    } catch (failure) {
      setError(failure as Error);
      return null;
    } finally {
      setProgress(null);
    }
  };
  const alignAlong = async () => {
    const result = comparison ?? (await compare());
    if (!result) return;
    if (result.path_s.length === 0) return setError(new Error("Both paths have no part in common."));
    player.alignAlong(result.path_s);
  };
  useEffect(() => {
    if (!second || !player.isPathWanted) return;
    player.isPathWanted = false;
    void alignAlong();
  }, [second, player.isPathWanted]);
  const can = (event: keyof typeof kEventOf) => !!second && firstOf(first.info, kEventOf[event]) !== null && firstOf(second.info, kEventOf[event]) !== null;
  const isOther = player.otherScene !== "";

  return (
    <>
      <div ref={top} />
      {second && comparison && <Outcome comparison={comparison} onMoment={(time) => player.moveBeside(time, comparison)} />}
      <Section title="Two sessions">
        <Readings rows={[["expert", <b class="first">{first.path}</b>]]} />
        <label class="field">
          <span>trainee, to compare with</span>
          <select value={second?.path ?? ""} onChange={(e) => void choose(e.currentTarget.value)}>
            <option value="">nobody</option>
            {listing.sessions.filter((s) => s.path !== first.path).map((s) => <option key={s.path} value={s.path}>{s.path}</option>)}
          </select>
        </label>
        {!second && <p class="hint">The session that is open counts as the expert's. Choose a trainee's here: they run side by side, and differences are drawn below.</p>}
        {second && (
          <>
            <button type="button" onClick={onSwap}>Swap expert and trainee</button>
            <div class="buttons" role="group" aria-label="Align at">
              <button type="button" aria-pressed={player.aligned === "contact"} disabled={!can("contact")} onClick={() => align("contact")}>first contact</button>
              <button type="button" aria-pressed={player.aligned === "cut"} disabled={!can("cut")} onClick={() => align("cut")}>first cut</button>
              <button type="button" aria-pressed={player.aligned === "path"} disabled={progress !== null || isOther} onClick={() => void alignAlong()}>path</button>
            </div>
            <label class="field">
              <span>by hand: the trainee's clock shows more by [s]</span>
              <NumberInput step="0.01" value={typed ?? (player.path ? "" : Number(player.offset.toFixed(3)))}
                onInput={(e) => setTyped(e.currentTarget.value)} onBlur={() => setTyped(null)}
                onChange={(e) => (player.setOffset(Number(e.currentTarget.value) || 0), setTyped(null))} />
            </label>
            {progress ? <Working what="comparing" done={progress[0]} total={progress[1]} onCancel={() => running.current?.abort()} />
              : <button type="button" class={comparison ? "" : "main"} disabled={isOther} onClick={() => void compare()}>{comparison ? "Compare again" : "Compare"}</button>}
            {isOther ? <p class="warning">They are of different scenes: each has its own force, depth and speed below, but measures, worst moments, the path and the difference of force need one scene.</p>
              : <ShownCommand text={command("compare", first.path, second.path, "-o", "report")} />}
          </>
        )}
        <Problems error={error} />
      </Section>
      {second && comparison && <Measures comparison={comparison} />}
    </>
  );
}

/** What is wrong at a moment, and by how much. */
export function faultText({ what, value, limit, unit }: Moment): string {
  return `${what}: ${short(value, 3)} ${unit}${limit == null ? "" : `, limit ${short(limit, 3)} ${unit}`}`;
}

const kFirstAdvice = 2; // sentences that stand above the worst moments, so that these are seen too

/** What a trainee needs first: what to do better, and the worst moments. `onMoment` gets a time of the trainee's session. */
export function Outcome({ comparison, onMoment }: { comparison: ComparisonResult; onMoment: (time: number) => void }) {
  const { moments, advice } = comparison.comparison, more = advice.slice(kFirstAdvice);
  const [last, setLast] = useState(-1); // moment that was looked at
  useEffect(() => setLast(-1), [comparison]);
  return (
    <>
      <Section title="What to do better">
        <ul class="advice first-advice">{advice.slice(0, kFirstAdvice).map((sentence) => <li key={sentence}>{sentence}</li>)}</ul>
      </Section>
      <Section title="Worst moments">
        {moments.length === 0 && <p class="good">No moment goes beyond a limit.</p>}
        <ul class="jumps of-trainee">
          {moments.map((moment, i) => (
            <li key={i}>
              <button type="button" aria-current={i === last} onClick={() => {
                setLast(i);
                onMoment(moment.worst_s);
              }}>
                <span class="number">{seconds(moment.worst_s, 2)}</span> {faultText(moment)}
              </button>
            </li>
          ))}
        </ul>
      </Section>
      {more.length > 0 && (
        <Section title="More to do better">
          <ul class="advice">{more.map((sentence) => <li key={sentence}>{sentence}</li>)}</ul>
        </Section>
      )}
      {comparison.remarks.map((remark) => <p key={remark} class="warning">{remark}</p>)}
    </>
  );
}

const hasNone = (row: MeasureRow) => row.trainee_is.startsWith("no value");

/** Each measure of both sessions. */
export function Measures({ comparison }: { comparison: ComparisonResult }) {
  const { measures, less_done } = comparison.comparison;
  const reasons = new Map<string, string[]>(); // why measures have no value
  for (const row of measures)
    if (hasNone(row)) reasons.set(row.trainee_is, [...(reasons.get(row.trainee_is) ?? []), row.measure]);
  return (
    <Section title="Measures">
      {less_done && <p class="hint">{less_done}</p>}
      <table>
        <thead><tr><th scope="col">measure</th><th scope="col">expert</th><th scope="col">trainee</th><th scope="col">is</th></tr></thead>
        <tbody>
          {measures.filter((row) => !hasNone(row)).map((row) => (
            <tr key={row.key} title={row.meaning}>
              <th scope="row">{row.measure} {row.unit !== "1" && <small>{row.unit}</small>}</th>
              <td>{short(row.expert, 3)}</td>
              <td>{short(row.trainee, 3)}</td>
              <td class={row.trainee_is}>{row.trainee_is}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {[...reasons].map(([reason, names]) => <p key={reason} class="hint">{names.join(", ")}: {reason}</p>)}
    </Section>
  );
}
