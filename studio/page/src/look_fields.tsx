import { kCutaways, kViews, type Look, viewOf, withView } from "./look";
import type { CameraView, Legend } from "./protocol";

/** View, cutaway and camera, as `export` has them. */
export function LookFields({ look, onLook, cameras }: { look: Look; onLook: (look: Look) => void; cameras: CameraView[] }) {
  const choice = (label: string, value: string, set: (value: string) => void, options: [string, string][]) => (
    <label>
      {label}
      <select value={value} onChange={(e) => set(e.currentTarget.value)}>
        {options.map(([key, name]) => <option key={key} value={key}>{name}</option>)}
      </select>
    </label>
  );
  const own = cameras.map((camera): [string, string] => [camera.name, camera.name]);
  const first: [string, string][] = own.length > 0 ? [["", own[0][0]], ...own.slice(1)] : [["", "fitted"]];
  const others = ["fitted", "follow"].filter((name) => !first.some(([, known]) => known === name)).map((name): [string, string] => [name, name]);
  return (
    <div class="look">
      {choice("view", viewOf(look), (name) => onLook(withView(look, name)), kViews)}
      {choice("cutaway", look.cutaway, (cutaway) => onLook({ ...look, cutaway }), kCutaways)}
      {choice("camera", look.camera, (camera) => onLook({ ...look, camera }), [...first, ...others])}
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
