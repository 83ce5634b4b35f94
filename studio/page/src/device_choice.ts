// A device over OpenIGTLink, in the words of `record`.

export interface DeviceChoice {
  how: "" | "listen" | "connect"; // empty: no device
  port: string;
  address: string;
  offset: string; // [mm]
  rotation: string;
  scale: string;
  tip: string;
  tool: string;
  buttons: string;
  name: string;
  timeout: string;
}

/** Fields of a device that may be left empty: key, label, what is taken then. */
export const kDeviceKeys: [keyof DeviceChoice, string, string][] = [
  ["offset", "its origin in the scene, x y z [mm]", "0 0 0"],
  ["rotation", "its frame's turn, quaternion w x y z", "1 0 0 0"],
  ["scale", "millimetres in the scene for one of the hand", "1"],
  ["tip", "from handle to tip in its own frame, x y z", "0 0 -1"],
  ["tool", "tool in the hand", "the scene's first"],
  ["buttons", "buttons, as 0=scalpel 1=", "none"],
  ["name", "its name, if others send too", "any"],
  ["timeout", "ends when nothing came for [s]", "5"],
];

const kNone: DeviceChoice = { how: "", port: "18944", address: "", offset: "", rotation: "", scale: "", tip: "", tool: "", buttons: "", name: "", timeout: "" };
const kStored = "ctpm.device";

/** The device of the last time, which is not in the hand until it is chosen. */
export function storedDevice(): DeviceChoice {
  try {
    return { ...kNone, ...(JSON.parse(localStorage.getItem(kStored) ?? "{}") as object), how: "" };
  } catch {
    return kNone;
  }
}

export function storeDevice(choice: DeviceChoice): void {
  localStorage.setItem(kStored, JSON.stringify(choice));
}

const words = (text: string): string[] => text.trim().split(/[\s,]+/).filter(Boolean);
const numbers = (text: string): number[] | undefined => (text.trim() ? words(text).map(Number) : undefined);
/** What is no number is sent as it is, for the program to refuse. */
const number = (text: string): number | string | undefined => (text.trim() ? (Number.isNaN(Number(text)) ? text : Number(text)) : undefined);

/** The device of `train.begin`; undefined: none. */
export function deviceParameters(choice: DeviceChoice): object | undefined {
  if (!choice.how) return undefined;
  return {
    ...(choice.how === "listen" ? { listen_port: number(choice.port) } : { address: choice.address.trim() }),
    offset_m: numbers(choice.offset)?.map((mm) => mm / 1e3), rotation: numbers(choice.rotation), tip: numbers(choice.tip),
    scale: number(choice.scale), timeout_s: number(choice.timeout), tool: choice.tool.trim() || undefined,
    name: choice.name.trim() || undefined, buttons: choice.buttons.trim() ? words(choice.buttons) : undefined,
  };
}

/** The same as words of a command. */
export function deviceWords(choice: DeviceChoice): string[] {
  const list = (flag: string, text: string) => (text.trim() ? [flag, ...words(text)] : []);
  return [
    ...(choice.how === "listen" ? ["--igtl-listen", choice.port] : ["--igtl", choice.address]),
    ...list("--device-offset-mm", choice.offset), ...list("--device-rotation", choice.rotation), ...list("--device-scale", choice.scale),
    ...list("--device-tip", choice.tip), ...(choice.tool.trim() ? ["--device-tool", choice.tool.trim()] : []),
    ...words(choice.buttons).flatMap((button) => ["--device-button", button]), ...(choice.name.trim() ? ["--igtl-name", choice.name.trim()] : []),
    ...list("--device-timeout-s", choice.timeout),
  ];
}
