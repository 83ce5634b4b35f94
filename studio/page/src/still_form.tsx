import { useState } from "preact/hooks";
import type { Connection } from "./connection";
import { download } from "./download";
import { filmName, seenAlign } from "./export_form";
import { asSeen, type Look, lookParameters, lookWords } from "./look";
import { Problems, Section, ShownCommand } from "./parts";
import type { Player } from "./player";
import { command, seconds } from "./text";

/** A picture of the moment that is seen, of a session alone or of a pair side by side. */
export function StillForm({ connection, player, look }: { connection: Connection; player: Player; look: Look }) {
  const { session } = player.tracks.get(0)!;
  const [isBusy, setBusy] = useState(false), [written, setWritten] = useState({ path: "", command: "" });
  const [error, setError] = useState<Error | null>(null);
  const seen = asSeen(look, player.viewer.seen(), session.view.up), time = player.timeOf(0), at = Math.max(0, time).toFixed(3);
  const beside = player.tracks.get(1)?.session.path, align = beside && seenAlign(player, false), own = player.timeOf(beside ? 1 : 0);
  const isThere = !beside || (time > -1e-3 && time < session.info.duration_s + 1e-3); // the command's moment is by its clock
  const isMarked = [...player.tracks.values()].some((track) => !!track.session.info.physics_remark); // with what differs, in the picture
  const wanted = filmName(session.path, beside, "beside", `-${Math.max(0, own).toFixed(2)}s`, "png");
  const save = async () => {
    setBusy(true), setError(null), setWritten({ path: "", command: "" });
    try {
      const { path } = await connection.call<{ path: string }>("session.export_name", { path: wanted });
      await connection.call("session.export_moment", { path: session.path, output: path, at_s: Number(at), allow_diverged: isMarked, beside, align, expert_line: !beside || player.hasExpertLine, ...lookParameters(seen) });
      setWritten({ path, command: command("export", session.path, "-o", path, "--at-s", at, ...(beside ? ["--beside", beside, "--align", align!] : []), ...(!beside || player.hasExpertLine ? [] : ["--no-expert-line"]), ...(isMarked ? ["--allow-diverged"] : []), ...lookWords(seen)) });
    } catch (failure) {
      setError(failure as Error);
    }
    setBusy(false);
  };
  return (
    <Section title="Picture">
      <button type="button" disabled={isBusy || !isThere} onClick={() => void save()}>Save a picture of {seconds(own, 2)}{beside && " of the trainee, and the expert beside it"}</button>
      {!isThere && <p class="hint">The expert has not begun at this moment, or has ended. Another alignment brings both together.</p>}
      <Problems error={error} />
      {written.path && (
        <>
          <p class="good" role="status">{written.path} is written</p>
          <ShownCommand text={written.command} />
          <button type="button" onClick={() => download(connection, written.path).catch(setError)}>Download {written.path.replace(/^.*\//, "")}</button>
        </>
      )}
    </Section>
  );
}
