// What leaving a room would end, and the question whether to.
import { useEffect, useRef, useState } from "preact/hooks";

/** A training that is being recorded. */
export interface Recording {
  name: string; // of its session
  end(): Promise<void>; // and it is saved
  resume(): void; // to whoever stays: the focus is on the picture
}

/** Asks whether a recording ends here; the picture and the tool stay as they are meanwhile. */
export function LeaveQuestion({ recording, onLeave, onStay }: { recording: Recording; onLeave: () => void; onStay: () => void }) {
  const box = useRef<HTMLDialogElement>(null);
  const [isEnding, setEnding] = useState(false);
  useEffect(() => {
    box.current?.showModal();
    return () => void setTimeout(() => recording.resume());
  }, []);
  const leave = async () => {
    setEnding(true);
    await recording.end().catch(() => {}); // the program has ended, and the recording with it
    onLeave();
  };
  return (
    <dialog ref={box} aria-labelledby="leave-title" onCancel={(e) => (e.preventDefault(), isEnding || onStay())}>
      <h2 id="leave-title">The training is being recorded</h2>
      <p>Leaving this room ends the recording here. It is kept as <b>{recording.name}</b>, and can be verified and compared when you come back.</p>
      <div class="buttons">
        <button type="button" class="main" disabled={isEnding} onClick={onStay}>Go on training</button>
        <button type="button" disabled={isEnding} onClick={() => void leave()}>End the recording and leave</button>
      </div>
    </dialog>
  );
}
