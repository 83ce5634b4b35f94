// Where the names beside handles go, so that none covers another.

/** A handle with its name: the handle's middle, and the name's box as wide and high as it is drawn [px]. */
export interface Label {
  x: number;
  y: number;
  width: number; // 0: its name is not shown
  height: number;
  isLeft: boolean; // of its handle
  isBelow: boolean; // it, where arrows stand around it
}

export const kBeside = 11; // from a handle's middle to its name [px]
const kDot = 10; // from a handle's middle to its edge [px]
const kBelow = 13; // from a handle's middle to a name below it [px]
const kBetween = 2; // two names [px]

interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

const meet = (a: Box, b: Box) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

/** How far down each name is moved, in the order of `labels`: the first ones stay, later ones go to the nearest free row. */
export function apart(labels: Label[], height: number): number[] {
  const dots = labels.map(({ x, y }): Box => ({ left: x - kDot, top: y - kDot, right: x + kDot, bottom: y + kDot }));
  const taken: Box[] = [];
  return labels.map((label, i) => {
    if (label.width === 0) return 0;
    const others = dots.filter((_, j) => j !== i);
    const boxAt = (down: number): Box => {
      const left = label.isBelow ? label.x - label.width / 2 : label.isLeft ? label.x - kBeside - label.width : label.x + kBeside;
      const top = label.y + down + (label.isBelow ? kBelow : -label.height / 2);
      return { left, top, right: left + label.width, bottom: top + label.height };
    };
    const isFree = (down: number, boxes: Box[]) => {
      const box = boxAt(down);
      return (down === 0 || (box.top >= 0 && box.bottom <= height)) && !boxes.some((other) => meet(box, other));
    };
    const downs = [...rows(label, i, taken)];
    // A name on another's handle can be read, but hides it: better than a name on a name.
    const down = downs.find((d) => isFree(d, [...taken, ...others])) ?? downs.find((d) => isFree(d, taken)) ?? 0;
    taken.push(boxAt(down));
    return down;
  });
}

/** Ways down to try, the shortest first: none, or just above or below what is taken or handles nearby, and whole rows. */
function rows(label: Label, count: number, taken: Box[]): number[] {
  const half = label.height / 2, step = label.height + kBetween;
  const downs = [0];
  for (const box of taken) downs.push(box.bottom + kBetween + half - label.y, box.top - kBetween - half - label.y);
  for (let row = 1; row <= count + 1; ++row) downs.push(row * step, -row * step);
  return downs.sort((a, b) => Math.abs(a) - Math.abs(b));
}
