// What is seen of a session, in the words of `export`.

export interface Look {
  view: string; // surface, spheres, both, elements
  by: string; // of elements; empty: stretch
  cutaway: string; // empty: none
  camera: string; // empty: the scene's first
}

export const kPlainLook: Look = { view: "surface", by: "", cutaway: "", camera: "" };

/** Views with what colours them, and their names. */
export const kViews: [string, string][] = [
  ["surface", "surface"], ["spheres", "spheres"], ["both", "both"],
  ["elements stretch", "elements by stretch"], ["elements tilt", "elements by tilt"], ["elements force", "elements by force"],
];
export const kCutaways: [string, string][] = [["", "none"], ["x", "across x"], ["y", "across y"], ["z", "across z"]];

export function viewOf(look: Look): string {
  return look.by ? `${look.view} ${look.by}` : look.view;
}
export function withView(look: Look, name: string): Look {
  const [view, by = ""] = name.split(" ");
  return { ...look, view, by };
}

export function lookParameters(look: Look): { [key: string]: string | undefined } {
  return { view: look.view, by: look.by || undefined, cutaway: look.cutaway || undefined, camera: look.camera || undefined };
}

/** The same as words of a command. */
export function lookWords(look: Look): string[] {
  return [
    ...(look.camera ? ["--camera", look.camera] : []), ...(look.view !== kPlainLook.view ? ["--view", look.view] : []),
    ...(look.by ? ["--by", look.by] : []), ...(look.cutaway ? ["--cutaway", look.cutaway] : []),
  ];
}
