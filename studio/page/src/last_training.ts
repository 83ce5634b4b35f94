// The training that a trainee ended last, for whoever comes back to its room or loads the page again: kept with this tab of the browser.
import type { Connection } from "./connection";
import type { DeviceChoice } from "./device_choice";
import type { EndedTraining, OpenedSession } from "./protocol";

export interface LastTraining {
  folder: string; // of the studio
  scene: string;
  output: string; // the session that was recorded; empty: none
  sceneKey: string;
  chosenName: string | null; // the form's choices, as the room has them
  chosenExpert: string | null;
  device: DeviceChoice;
  ended: EndedTraining | null; // null: the page was left while it ran
}

const kKept = "ctpm.training";

export function keepTraining(training: LastTraining): void {
  sessionStorage.setItem(kKept, JSON.stringify(training));
}

export function forgetTraining(): void {
  sessionStorage.removeItem(kKept);
}

/** The one that was kept, of which something can be said; null: there is none in this folder. */
export function lastTraining(folder: string): LastTraining | null {
  try {
    const kept = JSON.parse(sessionStorage.getItem(kKept) ?? "null") as LastTraining | null;
    return kept && kept.folder === folder && (kept.output || kept.ended) ? kept : null;
  } catch {
    return null;
  }
}

const kLookAgain = 200, kPatience = 25; // whether it is saved [ms], and how often

/** How it ended, which its session tells once it is saved. Rejects if that is not there any more. */
export async function endOf(connection: Connection, { output, ended }: LastTraining): Promise<EndedTraining> {
  if (ended && (!ended.path || ended.errors.length > 0)) return ended; // nothing was kept
  for (let look = 1; ; ++look) {
    const { info } = await connection.call<OpenedSession>("session.open", { path: output });
    if (ended) return ended;
    if (!info.ended_cleanly && look < kPatience) {
      await new Promise((resolve) => setTimeout(resolve, kLookAgain));
      continue;
    }
    const fault = info.ended_cleanly ? "" : `${output} has no clean end: the program was ended while it recorded, and it is there up to its last whole second.`;
    const { device_pose_wait_p50_s, device_pose_wait_p99_s, device_poses_within_5ms } = info.values;
    return { path: output, errors: [], ...info, fault, pose_wait_p50_s: device_pose_wait_p50_s, pose_wait_p99_s: device_pose_wait_p99_s, poses_within_5ms: device_poses_within_5ms };
  }
}
