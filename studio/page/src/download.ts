import type { Connection } from "./connection";

const kKept = 60000; // until a download has begun [ms]

/** Hands a film or a picture to its viewer, as a download. */
export async function download(connection: Connection, path: string): Promise<void> {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await connection.film(path));
  link.download = path.replace(/^.*\//, "");
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), kKept);
}
