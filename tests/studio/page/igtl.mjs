// A device that speaks OpenIGTLink: sends poses, hears forces.
import { connect } from "node:net";

/** CRC-64 of ECMA-182, as the protocol's headers have it. */
function crc64(bytes) {
  const mask = (1n << 64n) - 1n;
  let crc = 0n;
  for (const byte of bytes) {
    crc ^= BigInt(byte) << 56n;
    for (let bit = 0; bit < 8; ++bit) crc = crc >> 63n ? ((crc << 1n) & mask) ^ 0x42f0e1eba9ea3693n : (crc << 1n) & mask;
  }
  return crc;
}

/** A TRANSFORM of version 1, not turned; position in millimetres. */
function transform(position) {
  const body = Buffer.alloc(48), head = Buffer.alloc(58);
  [1, 0, 0, 0, 1, 0, 0, 0, 1, ...position].forEach((x, i) => body.writeFloatBE(x, 4 * i));
  head.writeUInt16BE(1, 0);
  head.write("TRANSFORM", 2), head.write("Stylus", 14);
  head.writeBigUInt64BE(BigInt(body.length), 42);
  head.writeBigUInt64BE(crc64(body), 50);
  return Buffer.concat([head, body]);
}

export async function openDevice(port) {
  const socket = connect(port, "127.0.0.1");
  await new Promise((resolve, reject) => socket.once("connect", resolve).once("error", reject));
  let felt = 0, rest = Buffer.alloc(0);
  socket.on("error", () => {});
  socket.on("data", (data) => {
    rest = Buffer.concat([rest, data]);
    for (; rest.length >= 92; rest = rest.subarray(92)) // head, 10 bytes about the values, three of them
      felt = Math.max(felt, Math.hypot(...[68, 76, 84].map((at) => rest.readDoubleBE(at))));
  });
  return { move: (position) => socket.write(transform(position)), felt: () => felt, close: () => socket.destroy() };
}
