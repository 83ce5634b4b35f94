import { useRef, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { Problems, Readings, Section, ShownCommand, Working } from "./parts";
import { firstOf, type Player } from "./player";
import type { ComparisonResult, Listing, MeasureRow } from "./protocol";
import { command, seconds, short } from "./text";

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
  const running = useRef<AbortController | null>(null), shown = useRef<HTMLDivElement>(null);
  const first = player.tracks.get(0)!.session, second = player.tracks.get(1)?.session;

  const align = (kind: string) => {
    const time = player.alignAt(kind);
    if (time !== null) player.move(time);
  };
  const choose = async (path: string) => {
    await onBeside(path || undefined);
    align("contact begins");
  };
  const compare = async () => {
    setError(null);
    setProgress([0, 1]);
    running.current = new AbortController();
    try {
      const result = await connection.call<ComparisonResult>("session.compare", { expert: first.path, trainee: second!.path },
        { progress: (done, total) => setProgress([done, total]), signal: running.current.signal });
      onComparison(result);
      // What was asked for may be below the panel's end, or the window's.
      requestAnimationFrame(() => requestAnimationFrame(() => shown.current?.querySelector(".jumps")?.scrollIntoView({ block: "nearest" })));
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
  const can = (kind: string) => !!second && firstOf(first.info, kind) !== null && firstOf(second.info, kind) !== null;

  return (
    <>
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
              <button type="button" aria-pressed={player.aligned === "contact begins"} disabled={!can("contact begins")} onClick={() => align("contact begins")}>first contact</button>
              <button type="button" aria-pressed={player.aligned === "cut"} disabled={!can("cut")} onClick={() => align("cut")}>first cut</button>
              <button type="button" aria-pressed={player.aligned === "path"} disabled={progress !== null} onClick={() => void alignAlong()}>path</button>
            </div>
            <label class="field">
              <span>by hand: the trainee is ahead by [s]</span>
              <input type="number" step="0.01" value={player.path ? "" : Number(player.offset.toFixed(3))}
                onChange={(e) => player.setOffset(Number(e.currentTarget.value) || 0)} />
            </label>
            {progress ? <Working what="comparing" done={progress[0]} total={progress[1]} onCancel={() => running.current?.abort()} />
              : <button type="button" class="main" onClick={() => void compare()}>Compare</button>}
            <ShownCommand text={command("compare", first.path, second.path, "-o", "report")} />
          </>
        )}
        <Problems error={error} />
      </Section>
      {second && comparison && <div ref={shown}><Result comparison={comparison} onMoment={(time) => player.moveBeside(time, comparison)} /></div>}
    </>
  );
}

const hasNone = (row: MeasureRow) => row.trainee_is.startsWith("no value");

/** The worst moments and the measures; `onMoment` gets a time of the trainee's session. */
export function Result({ comparison, onMoment }: { comparison: ComparisonResult; onMoment: (time: number) => void }) {
  const { moments, measures, advice, less_done } = comparison.comparison;
  const reasons = new Map<string, string[]>(); // why measures have no value
  for (const row of measures)
    if (hasNone(row)) reasons.set(row.trainee_is, [...(reasons.get(row.trainee_is) ?? []), row.measure]);
  return (
    <>
      {comparison.remarks.map((remark) => <p key={remark} class="warning">{remark}</p>)}
      <Section title="Worst moments">
        {moments.length === 0 && <p class="good">No moment goes beyond a limit.</p>}
        <ul class="jumps">
          {moments.map((moment, i) => (
            <li key={i}>
              <button type="button" onClick={() => onMoment(moment.worst_s)}>
                <span class="number">{seconds(moment.worst_s, 2)}</span> {moment.what}: {short(moment.value, 3)} {moment.unit}
                {moment.limit != null && `, limit ${short(moment.limit, 3)} ${moment.unit}`}
              </button>
            </li>
          ))}
        </ul>
      </Section>
      <Section title="What to do better">
        {less_done && <p class="hint">{less_done}</p>}
        <ul class="advice">{advice.map((sentence) => <li key={sentence}>{sentence}</li>)}</ul>
      </Section>
      <Section title="Measures">
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
    </>
  );
}
