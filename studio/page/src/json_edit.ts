// Changes of single values in JSON text, which leave the rest of the text as its author wrote it.
import { findNodeAtLocation, type JSONPath, type Node, parseTree } from "jsonc-parser";

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** A part of a text, and what stands there instead. */
export interface Change {
  from: number;
  to: number;
  insert: string;
}

const kLine = 100; // characters that stay on one line
const kStep = "  ";

/** A value as text: on one line if it is short, else a line for each of its members. `indent`: that of its first line. */
export function written(value: Json, indent: string): string {
  if (value === null || typeof value !== "object") return JSON.stringify(value);
  const isList = Array.isArray(value);
  const within = indent + kStep;
  const members = (deep: string) => isList ? value.map((v) => written(v, deep)) : Object.entries(value).map(([k, v]) => `${JSON.stringify(k)}: ${written(v, deep)}`);
  const short = members(indent).join(", ");
  if (isList && value.every((v) => typeof v === "number")) return `[${short}]`;
  if (short.length <= kLine && !short.includes("\n")) return isList ? `[${short}]` : short ? `{ ${short} }` : "{}";
  return `${isList ? "[" : "{"}\n${members(within).map((m) => within + m).join(",\n")}\n${indent}${isList ? "]" : "}"}`;
}

/** The blanks with which the line of that place begins. */
function indentAt(text: string, at: number): string {
  return /^[ \t]*/.exec(text.slice(text.lastIndexOf("\n", at - 1) + 1, at))![0];
}

/** Adds a member after the last one of an object or a list. */
function added(text: string, node: Node, member: (indent: string) => string): Change {
  const last = node.children?.at(-1);
  if (!last) {
    const indent = indentAt(text, node.offset), body = member(indent);
    const [open, close] = node.type === "array" ? ["[", "]"] : ["{ ", " }"];
    return { from: node.offset, to: node.offset + node.length, insert: open + body + close };
  }
  const end = last.offset + last.length;
  // Members that have lines of their own get a new line.
  const before = text.slice(node.offset, node.children![0].offset);
  if (!before.includes("\n")) {
    const indent = indentAt(text, node.offset), body = member(indent);
    if (node.length + body.length <= kLine) return { from: end, to: end, insert: `, ${body}` };
    // The line would become too long: each member gets a line of its own.
    const members = [...node.children!.map((child) => text.slice(child.offset, child.offset + child.length)), member(indent + kStep)];
    const [open, close] = node.type === "array" ? ["[", "]"] : ["{", "}"];
    return { from: node.offset, to: node.offset + node.length, insert: `${open}\n${members.map((m) => indent + kStep + m).join(",\n")}\n${indent}${close}` };
  }
  const indent = indentAt(text, last.offset);
  return { from: end, to: end, insert: `,\n${indent}${member(indent)}` };
}

/** Sets the value at a path; what is missing on the way is made, and a list takes new values at its end. Null: the text cannot take it. */
export function setValue(text: string, path: JSONPath, value: Json): Change | null {
  const root = parseTree(text);
  if (!root) return null;
  const present = findNodeAtLocation(root, path);
  if (present) return { from: present.offset, to: present.offset + present.length, insert: written(value, indentAt(text, present.offset)) };
  for (let depth = path.length - 1; depth >= 0; --depth) {
    const parent = depth === 0 ? root : findNodeAtLocation(root, path.slice(0, depth));
    if (!parent) continue;
    // What is missing below the parent becomes a part of the value.
    let whole = value;
    for (const key of path.slice(depth + 1).reverse()) whole = typeof key === "number" ? [whole] : { [key]: whole };
    const key = path[depth];
    if (parent.type === "array" && typeof key === "number") return added(text, parent, (indent) => written(whole, indent));
    if (parent.type === "object" && typeof key === "string")
      return added(text, parent, (indent) => `${JSON.stringify(key)}: ${written(whole, indent)}`);
    return null;
  }
  return null;
}

/** Removes the member at a path with its comma. Null: there is none. */
export function removeValue(text: string, path: JSONPath): Change | null {
  const root = parseTree(text);
  const value = root && findNodeAtLocation(root, path);
  if (!value) return null;
  const member = value.parent?.type === "property" ? value.parent : value;
  const siblings = member.parent?.children ?? [];
  const i = siblings.indexOf(member), end = member.offset + member.length;
  if (siblings.length === 1) return { from: member.parent!.offset + 1, to: member.parent!.offset + member.parent!.length - 1, insert: "" };
  if (i > 0) return { from: siblings[i - 1].offset + siblings[i - 1].length, to: end, insert: "" };
  return { from: member.offset, to: siblings[i + 1].offset, insert: "" };
}

export function applied(text: string, change: Change): string {
  return text.slice(0, change.from) + change.insert + text.slice(change.to);
}

/** The value at a path; undefined: there is none. */
export function findJson(value: Json | undefined, path: JSONPath): Json | undefined {
  for (const key of path) {
    if (typeof value !== "object" || value === null) return undefined;
    value = Array.isArray(value) ? value[key as number] : value[key as string];
  }
  return value;
}
