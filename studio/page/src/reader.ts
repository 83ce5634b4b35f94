// Reads the numbers of a binary message, one after the other.
import type { Vector } from "./protocol";

export class Reader {
  at = 0;
  readonly view: DataView;
  constructor(readonly bytes: ArrayBuffer) {
    this.view = new DataView(bytes);
  }
  u32(): number {
    return this.view.getUint32(this.take(4), true);
  }
  i32(): number {
    return this.view.getInt32(this.take(4), true);
  }
  f32(): number {
    return this.view.getFloat32(this.take(4), true);
  }
  f64(): number {
    return this.view.getFloat64(this.take(8), true);
  }
  vector(): Vector {
    return [this.f32(), this.f32(), this.f32()];
  }
  // Typed arrays read the machine's own byte order, which is little-endian wherever browsers run.
  array<T>(make: new (buffer: ArrayBuffer, at: number, count: number) => T, size: number, count: number): T {
    return new make(this.bytes, this.take(size * count), count);
  }
  pad(): void {
    this.take((4 - (this.at % 4)) % 4);
  }
  /** Goes over so many bytes; returns where they begin. */
  take(bytes: number): number {
    const from = this.at;
    if (from + bytes > this.bytes.byteLength) throw new RangeError("a message is shorter than it says");
    this.at += bytes;
    return from;
  }
  /** Whether something follows. */
  get hasMore(): boolean {
    return this.at < this.bytes.byteLength;
  }
}
