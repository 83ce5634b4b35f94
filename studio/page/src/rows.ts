// Balls that the brush painted: many anchors that share a row of the list, and one stop of the tabulator.
import type { Item } from "./items";

const kStroke = 3; // balls that are shown as one row

/** Items row by row: balls of one size that follow each other in an organ, as the brush leaves them, share one. */
export function rowsOf(items: Item[]): Item[][] {
  const rows: Item[][] = [];
  for (const item of items) {
    const last = rows.at(-1)?.[0];
    const goesOn = last?.kind === "anchor" && item.kind === "anchor" && last.shape === "sphere" && item.shape === "sphere" && last.path[1] === item.path[1] && last.size.x === item.size.x;
    if (goesOn) rows.at(-1)!.push(item);
    else rows.push([item]);
  }
  return rows.flatMap((row) => (row.length < kStroke ? row.map((item) => [item]) : [row]));
}

/** Where a key leads from a place in a row of so many; null: it does not go along a row. */
export function alongRow(key: string, from: number, count: number): number | null {
  switch (key) {
    case "ArrowRight": case "ArrowDown": return Math.min(from + 1, count - 1);
    case "ArrowLeft": case "ArrowUp": return Math.max(from - 1, 0);
    case "Home": return 0;
    case "End": return count - 1;
    default: return null;
  }
}
