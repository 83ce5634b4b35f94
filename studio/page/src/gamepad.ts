// A gamepad of the standard layout, as a hand.

export interface Steering {
  right: number; // shares of full speed, in [-1, 1]
  deep: number;
  up: number;
  turnUp: number;
  turnRight: number;
  nextTool: number; // -1, 0, 1; not 0 once a press
}

const kDead = 0.12; // of a stick that rests

function beyondDead(value: number | undefined): number {
  const size = Math.abs(value ?? 0);
  return size < kDead ? 0 : (Math.sign(value!) * (size - kDead)) / (1 - kDead);
}

let shoulders = 0; // pressed at the last look

/** What the first connected gamepad asks for: left stick moves, triggers press and lift, right stick turns, shoulders choose the tool. Null: there is none. */
export function readGamepad(): Steering | null {
  const pad = navigator.getGamepads?.().find((candidate) => candidate?.connected && candidate.mapping === "standard");
  if (!pad) return null;
  const pressed = (button: number) => pad.buttons[button]?.value ?? 0;
  const now = (pressed(4) > 0.5 ? 1 : 0) | (pressed(5) > 0.5 ? 2 : 0), fresh = now & ~shoulders;
  shoulders = now;
  return {
    right: beyondDead(pad.axes[0]), deep: -beyondDead(pad.axes[1]), up: pressed(6) - pressed(7),
    turnRight: beyondDead(pad.axes[2]), turnUp: -beyondDead(pad.axes[3]), nextTool: fresh & 2 ? 1 : fresh & 1 ? -1 : 0,
  };
}
