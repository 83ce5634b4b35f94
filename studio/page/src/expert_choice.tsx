// Which session a trainee follows and is compared with.
import type { FileEntry, SceneOfSession } from "./protocol";

const kOwn = /(^|\/)mine-\d+\.ctpm$/; // as the Train room names what a trainee records

/** Sessions, experts' first; of sessions of the same kind the order stays. */
function expertsFirst(paths: string[]): string[] {
  const rank = (path: string) => (/expert/i.test(path) ? 0 : kOwn.test(path) ? 2 : 1);
  return paths.map((path, i) => ({ path, i })).sort((a, b) => rank(a.path) - rank(b.path) || a.i - b.i).map(({ path }) => path);
}

/** The session that is proposed in a scene: the first one of it that no trainee has recorded here; empty: there is none. */
export function proposedExpert(scenes: SceneOfSession[], sceneKey: string, own: string): string {
  const paths = scenes.filter(({ scene_key, path }) => sceneKey !== "" && scene_key === sceneKey && path !== own && !kOwn.test(path)).map(({ path }) => path);
  return expertsFirst(paths)[0] ?? "";
}

/** Sessions in groups, each with its title: those of the scene with that key and all others, or if none is chosen yet those of each
    scene; in one without a title while it is not known of which scenes they are. */
function groupsOf(paths: string[], scenes: SceneOfSession[], sceneKey: string): [string, string[]][] {
  if (scenes.length === 0) return [["", paths]];
  const of = new Map(scenes.map((one) => [one.path, one])), groups = new Map<string, string[]>();
  for (const title of sceneKey ? ["of this scene", "of other scenes"] : [...new Set(scenes.map(({ scene_name }) => `of the scene ${scene_name}`))].sort()) groups.set(title, []);
  for (const path of paths) {
    const scene = of.get(path);
    if (scene) groups.get(!sceneKey ? `of the scene ${scene.scene_name}` : scene.scene_key === sceneKey ? "of this scene" : "of other scenes")?.push(path);
  }
  return [...groups].filter(([, members]) => members.length > 0).map(([title, members]) => [title, expertsFirst(members)]);
}

const kProposed = "*"; // no session is called that

/** `sceneKey`: of the scene that is chosen; empty: none is. `expert`: null is whichever is proposed once there is a scene. Sessions that cannot be read are left out once that is known. */
export function ExpertChoice({ listing, scenes, sceneKey, expert, onExpert, use }: {
  listing: FileEntry[];
  scenes: SceneOfSession[];
  sceneKey: string;
  expert: string | null;
  onExpert: (path: string | null) => void;
  use: string;
}) {
  const options = (paths: string[]) => paths.map((path) => <option key={path} value={path}>{path}</option>);
  return (
    <label class="field">
      <span>the expert's session, {use}</span>
      <select value={expert ?? kProposed} onChange={(e) => onExpert(e.currentTarget.value === kProposed ? null : e.currentTarget.value)}>
        {expert === null && <option value={kProposed}>an expert's of the scene, if there is one</option>}
        <option value="">none</option>
        {groupsOf(listing.map(({ path }) => path), scenes, sceneKey).map(([title, paths]) => (title ? <optgroup key={title} label={title}>{options(paths)}</optgroup> : options(paths)))}
      </select>
    </label>
  );
}
