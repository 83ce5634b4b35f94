import { gapText } from "./over_picture";
import { OfMachine, Readings, Section } from "./parts";
import type { Frame, HandFrame } from "./protocol";
import { millimetres, newtons, seconds, underMs } from "./text";
import type { Trainer } from "./trainer";

type Row = [string, string, string?];

/** What a hand does to the tissue; `of`: whose it is, where there are two. */
function handRows(hand: HandFrame, of: string): Row[] {
  return [
    [`force${of}`, newtons(Math.hypot(...hand.force))],
    [`depth${of}`, millimetres(hand.depth, 2), "How far a ball dents the organ, or a blade is in it"],
    [`touched${of}`, `${hand.contacts} points`],
  ];
}

function machineRows(frame: Frame | null): Row[] {
  return [
    ["newest step", `${(1e3 * (frame?.tickTime ?? 0)).toFixed(2)} ms`, "How long the program worked on it"],
    ["99 of 100 steps", frame?.tickP99 ? underMs(frame.tickP99, 2) : "–", "How long the program worked on the newest 500; the longest of each 100 are left out"],
    ["late steps", String(frame?.lateTicks ?? 0)],
    ["behind the clock", seconds(frame?.slip ?? 0, 3)],
    ["frames missed", String(frame?.missed ?? 0)],
  ];
}

/** The numbers of a training that runs: those of the hand, and below them those of the machine. */
export function Now({ trainer, note }: { trainer: Trainer; note: string }) {
  const frame = trainer.scene?.frame ?? null, hands = frame?.second ? [frame, frame.second] : frame ? [frame] : [], { pace } = trainer;
  return (
    <Section title="Now">
      {note && <p class="warning" role="status">Of the device: {note}.</p>}
      <Readings rows={[
        ...hands.flatMap((hand, i) => handRows(hand, hands.length < 2 ? "" : i === 0 ? ", right" : ", left")),
        ["severed", `${frame?.severed ?? 0} elements`],
        ["to the tissue", gapText(trainer) || "touches it", "Straight down from the tool that is led, onto the tissue as it is drawn"],
      ]} />
      <OfMachine says={pace.isSlow ? "too slow" : "keeps up"} rows={machineRows(frame)} />
    </Section>
  );
}

/** What the scene's author wants to see done. */
export function Task({ task }: { task: string }) {
  return task ? <Section title="Task"><p class="task">{task}</p></Section> : null;
}
