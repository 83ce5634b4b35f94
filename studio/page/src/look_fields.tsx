import type { ComponentChildren } from "preact";
import { isFree, kAxes, kViews, type Look, planeOf, viewOf, withView } from "./look";
import type { Legend, SceneView } from "./protocol";

/** View, cutaway and camera, as `export` has them, and what else there is beside them. `onOtherSide`: to look at the cutaway's
    plane from there. */
export function LookFields({ look, onLook, onOtherSide, view, children }: {
  look: Look;
  onLook: (look: Look) => void;
  onOtherSide: () => void;
  view: SceneView;
  children?: ComponentChildren;
}) {
  const choice = (label: string, value: string, set: (value: string) => void, options: [string, string][]) => (
    <label>
      {label}
      <select value={value} onChange={(e) => set(e.currentTarget.value)}>
        {options.map(([key, name]) => <option key={key} value={key}>{name}</option>)}
      </select>
    </label>
  );
  const plane = planeOf(look, view);
  const names = [...new Set([...view.cameras.map((camera) => camera.name), "fitted", "follow"])].map((name): [string, string] => [name, name]);
  const cameras: [string, string][] = [["", "automatic"], ...names];
  if (isFree(look)) cameras.push([look.camera, "as turned"]);
  return (
    <div class="look">
      {choice("view", viewOf(look), (name) => onLook(withView(look, name)), kViews)}
      {choice("cutaway", look.cutaway.slice(0, 1), (cutaway) => onLook({ ...look, cutaway }),
        [["", "none"], ...kAxes.map((axis): [string, string] => [axis, `across ${axis}`])])}
      {plane && (
        <div class="plane">
          <label>
            at
            <input type="range" min={Math.ceil(plane.least)} max={Math.floor(plane.most)} step="0.5" value={plane.place}
              aria-label={`Place of the cutaway along ${kAxes[plane.axis]}, in mm`}
              onInput={(e) => onLook({ ...look, cutaway: `${kAxes[plane.axis]}=${Number(e.currentTarget.value)}` })} />
            <output>{plane.place.toFixed(1)} mm</output>
          </label>
          <button type="button" class="quiet" onClick={onOtherSide}>other side</button>
        </div>
      )}
      {choice("camera", look.camera, (camera) => onLook({ ...look, camera }), cameras)}
      {children}
    </div>
  );
}

/** What the colours mean, from the lowest value to the highest. */
export function LegendBar({ legend }: { legend: Legend }) {
  return (
    <div class="legend" role="img" aria-label={`${legend.title}: ${legend.low} to ${legend.high}`}>
      <span>{legend.title}</span>
      <span class="number">{legend.low}</span>
      <svg viewBox={`0 0 ${legend.colours.length} 1`} preserveAspectRatio="none" aria-hidden="true">
        {legend.colours.map(([r, g, b], i) => <rect key={i} x={i} width="1.02" height="1" fill={`rgb(${255 * r} ${255 * g} ${255 * b})`} />)}
      </svg>
      <span class="number">{legend.high}</span>
    </div>
  );
}
