import { HeldButton } from "./parts";
import { seconds } from "./text";
import type { Trainer } from "./trainer";

/** What keys do, for hands that have none. */
const kHeld: [string, string][] = [["farther", "PageUp"], ["closer", "PageDown"], ["turn left", "q"], ["turn right", "e"], ["tip up", "w"], ["tip down", "s"]];

/** What leads the tool, in short. */
function hintOf(trainer: Trainer, isTouch: boolean): string {
  if (trainer.awaited) return "the device leads · mouse and wheel: look around · C: next camera";
  const gamepad = trainer.hasGamepad ? "gamepad: left stick moves, triggers press and lift, right stick turns, shoulders: tool · " : "";
  if (isTouch) return `${gamepad}one finger: move · two: look around`;
  return `${gamepad}mouse, arrows: move · Space: let go of the tool, or take it up · click: hold the mouse · wheel, PgUp, PgDn: away from you, to you · Q E, W S, A D: turn · right button: look · C: next camera${trainer.cameraName && `, now ${trainer.cameraName}`}`;
}

/** Below the picture of a training that runs: its end, its hands and tools, its clock. */
export function TrainBar({ trainer, output, isTouch, redraw }: { trainer: Trainer; output: string; isTouch: boolean; redraw: () => void }) {
  const view = trainer.scene!.view, isLedHere = !trainer.awaited;
  return (
    <div class="transport">
      <button type="button" class="main" onClick={() => void trainer.end()}>{!isTouch && <kbd>Esc</kbd>} End</button>
      {trainer.handCount > 1 && isLedHere && (
        <div class="buttons" role="group" aria-label="Hand">
          {[0, 1].map((hand) => (
            <button key={hand} type="button" aria-pressed={trainer.led === hand} onClick={() => (trainer.lead(hand), redraw())}>
              {trainer.led !== hand && <kbd>X</kbd>} {hand === 0 ? "right hand" : "left hand"}
            </button>
          ))}
        </div>
      )}
      {isLedHere && (
        <div class="buttons" role="group" aria-label="Tool">
          {view.tools.map((tool, i) => (
            <button key={tool.name} type="button" aria-pressed={trainer.tool === i} disabled={trainer.isTaken(i)} onClick={() => (trainer.setTool(i), redraw())}>
              <kbd>{i + 1}</kbd> {tool.name}
            </button>
          ))}
        </div>
      )}
      <span class="recorded">{output ? <><i aria-hidden="true" /> records {output}</> : "not recorded"}</span>
      <output class="clock">{trainer.hasBegun ? seconds(trainer.scene!.frame?.time ?? 0, 1) : "not begun"}</output>
      {isLedHere && isTouch && (
        <div class="buttons held" role="group" aria-label="Depth and turning">
          {kHeld.map(([text, key]) => <HeldButton key={key} text={text} onHeld={() => trainer.press(key, false)} />)}
        </div>
      )}
      <span class="hint">{hintOf(trainer, isTouch)}</span>
    </div>
  );
}
