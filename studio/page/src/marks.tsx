// What happened in sessions, was noted or found, as marks above their curves.
import { faultText } from "./compare";
import { shownEvents } from "./moment";
import type { ReadNotes } from "./notes";
import type { Player } from "./player";
import type { ComparisonResult } from "./protocol";
import { seconds } from "./text";

export interface Mark {
  stage: number;
  time: number; // of stage 0 [s]
  kind: string;
  title: string; // with the time of its own session
  onPress?: () => void; // in place of going to its time
}

/** Those of all sessions that are shown. The worst moments are the trainee's. */
export function marksOf(player: Player, notes: ReadNotes, comparison: ComparisonResult | null): Mark[] {
  return [...player.tracks.values()].flatMap(({ stage, session: { path, info } }) => {
    const of = (own: number, kind: string, text: string): Mark =>
      ({ stage, time: stage === 0 ? own : player.firstAt(own), kind, title: `${seconds(own)} ${text}` });
    const read = notes[path];
    return [
      ...shownEvents(info).map((e) => of(e.tick * info.tick_s, e.kind, e.text)),
      ...(stage === 1 && comparison ? comparison.comparison.moments : []).map((moment) =>
        ({ ...of(moment.worst_s, "worst moment", faultText(moment)), onPress: () => player.moveBeside(moment.worst_s, comparison!) })),
      ...(!read || read instanceof Error ? [] : read.notes).map((note) => of(note.time_s, "note", note.text)),
    ];
  });
}

/** How a mark looks; a contact has the colour of its session. */
export function classOf({ kind, stage }: Pick<Mark, "kind" | "stage">): string {
  return `mark ${kind.replaceAll(" ", "-")}${stage === 1 ? " of-second" : ""}`;
}

/** What the marks mean, of the kinds that are there. */
export function MarkLegend({ marks }: { marks: Mark[] }) {
  const kinds = new Map<string, Set<string>>(); // and how they look
  for (const { kind, stage } of marks) kinds.set(kind, (kinds.get(kind) ?? new Set()).add(classOf({ kind, stage: kind.startsWith("contact") ? stage : 0 })));
  if (kinds.size === 0) return null;
  return (
    <ul class="mark-legend" aria-label="Marks on the timeline">
      {[...kinds].map(([kind, looks]) => <li key={kind}>{[...looks].sort().map((look) => <i key={look} class={look} />)}{kind}</li>)}
    </ul>
  );
}
