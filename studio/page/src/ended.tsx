import { useEffect, useRef, useState } from "preact/hooks";
import { knownComparison, Measures, Outcome } from "./compare";
import type { Connection } from "./connection";
import { ExpertChoice } from "./expert_choice";
import { OfMachine, Problems, Readings, Section, ShownCommand, Working } from "./parts";
import type { Place } from "./place";
import { type Comparable, type ComparisonResult, type EndedTraining, type Listing, problemText, type SceneOfSession } from "./protocol";
import { behind, command, millimetres, newtons, seconds, tickRows, underMs } from "./text";

/** "machine 9, solver 3": what made steps late, the most frequent cause first. */
const causes = (lateBy: { [cause: string]: number }) =>
  Object.entries(lateBy).sort((a, b) => b[1] - a[1]).map(([cause, count]) => `${cause} ${count}`).join(", ");

const kPoseWait = "From the moment when the page sent where the hand is until a tick took it";

/** What became of a session: its numbers, its verdict, and how it compares with the expert's. */
export function Ended({ connection, listing, scenes, sceneKey, ended, expert, onExpert, onReview, onAgain, onChoose, onAuthor }: {
  connection: Connection;
  listing: Listing;
  scenes: SceneOfSession[];
  sceneKey: string;
  ended: EndedTraining;
  expert: string;
  onExpert: (path: string | null) => void;
  onReview: (place: Place) => void;
  onAgain: () => void;
  onChoose: () => void; // of another scene
  onAuthor: (() => void) | null;
}) {
  const [verdict, setVerdict] = useState<{ same: boolean; text: string } | null>(null);
  const [comparison, setComparison] = useState<ComparisonResult | null>(null);
  const [progress, setProgress] = useState<[number, number] | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const running = useRef<AbortController | null>(null);
  const path = ended.errors.length === 0 ? ended.path : ""; // a file of that name may be somebody else's
  const [otherScene, setOtherScene] = useState(""); // why the expert's session cannot be compared with

  useEffect(() => {
    let isWanted = true;
    setOtherScene(""), setComparison(null);
    if (expert && path) {
      connection.call<Comparable>("session.comparable", { expert, trainee: path })
        .then(({ text }) => isWanted && setOtherScene(text), (failure) => isWanted && setError(failure));
      void knownComparison(connection, expert, path).then((known) => isWanted && known && setComparison(known));
    }
    return () => void (isWanted = false);
  }, [expert, path]);
  const isCompared = expert !== "" && otherScene === "";
  const others = listing.sessions.filter((session) => session.path !== path);
  const compare = async () => {
    const progress = (done: number, total: number) => setProgress([done, total]);
    setError(null), setComparison(null), setVerdict(null), progress(0, 1);
    running.current = new AbortController();
    const { signal } = running.current;
    try {
      setVerdict(await connection.call("session.verify", { path }, { progress, signal }));
      progress(0, 1);
      if (isCompared) setComparison(await connection.call<ComparisonResult>("session.compare", { expert, trainee: path }, { progress, signal }));
    } catch (failure) {
      setError(failure as Error);
    }
    setProgress(null);
  };
  return (
    <>
      {ended.errors.map((problem, i) => <p key={i} class="warning" role="alert">{problemText(problem)}</p>)}
      {ended.fault && <p class="warning">{ended.fault}</p>}
      {ended.refused && <p class="warning">The simulation was refused; what came before is saved.</p>}
      {!ended.path && !onAuthor && ended.errors.length === 0 && (
        <p class="hint">Nothing was recorded, so there is nothing to verify or to compare. Give the session a name (record as) before it begins.</p>
      )}
      {path && (
        <Section title="Verify and compare">
          <ExpertChoice listing={others} scenes={scenes} sceneKey={sceneKey} expert={expert} onExpert={onExpert} use="to compare with" />
          {otherScene && <p class="warning" role="alert">{otherScene}. They cannot be compared.</p>}
          {progress ? <Working what={verdict ? "comparing" : "verifying"} done={progress[0]} total={progress[1]} onCancel={() => running.current?.abort()} />
            : <button type="button" class="main" onClick={() => void compare()}>{isCompared ? "Verify and compare" : "Verify"}</button>}
          {verdict && <p class={verdict.same ? "good" : "warning"} role="status">The recording, replayed: {verdict.text}</p>}
          <Problems error={error} />
        </Section>
      )}
      {comparison && <Outcome comparison={comparison} onMoment={(besideTime) => onReview({ session: expert, beside: path, besideTime, comparison })} />}
      <Section title="This session">
        {ended.ticks !== undefined && (
          <>
            <Readings rows={[
              ["recorded as", path || "not recorded"],
              ["duration", seconds(ended.ticks * (ended.tick_s ?? 1e-3), 1)],
              ["largest force", newtons(ended.max_force_n ?? 0)],
              ["deepest press", ended.max_depth_m ? millimetres(ended.max_depth_m, 2) : "–", "Of a ball; how deep a cut is the comparison says"],
              ["severed", `${ended.severed} elements`],
            ]} />
            <OfMachine says={ended.slip_s ? `${seconds(ended.slip_s, 1)} behind the clock` : "kept up"} rows={[
              ["late steps", `${ended.late_ticks}${ended.late_ticks ? ` (${causes(ended.late_by ?? {})})` : ""}`],
              ["behind the clock", behind(ended.slip_s ?? 0, ended.slip_max_s ?? 0)],
              ...tickRows(ended.tick_time_p50_s ?? 0, ended.tick_time_p99_s ?? 0, ended.tick_s ?? 1e-3),
              ["half of the poses", underMs(ended.pose_wait_p50_s ?? 0, 1), kPoseWait],
              ["99 of 100 poses", underMs(ended.pose_wait_p99_s ?? 0, 1), kPoseWait],
              ["within 5 ms", `${(1e2 * (ended.poses_within_5ms ?? 0)).toFixed(1)} %`, kPoseWait],
            ]} />
          </>
        )}
        <button type="button" onClick={onAgain}>Train again</button>
        <button type="button" onClick={onChoose}>Choose a scene</button>
        {onAuthor && <button type="button" onClick={onAuthor}>Back to Author</button>}
        {path && <button type="button" onClick={() => onReview({ session: path, time: 0 })}>Open in Review</button>}
      </Section>
      {comparison && <Measures comparison={comparison} />}
      {path && (
        <Section title="The same in a terminal">
          <ShownCommand text={command("verify", path)} />
          {isCompared && <ShownCommand text={command("compare", expert, path, "-o", "report")} />}
        </Section>
      )}
    </>
  );
}
