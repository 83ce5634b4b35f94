/** An egg of about that many triangles, as a scanner would write it [mm]; each vertex lies up to `rough` off. */
export function largeMesh(triangles, rough = 0) {
  const rings = Math.round(Math.sqrt(triangles / 2)), lines = [];
  const at = (ring, k) => (ring === 0 ? 1 : ring === rings ? 2 : 3 + (ring - 1) * rings + (k % rings));
  let seed = 1;
  const off = () => {
    seed = (seed * 16807) % 2147483647; // the same mesh every time
    return rough * ((2 * seed) / 2147483647 - 1);
  };
  lines.push("v 0 0 50", "v 0 0 -40");
  for (let ring = 1; ring < rings; ++ring)
    for (let k = 0; k < rings; ++k) {
      const polar = (Math.PI * ring) / rings, turn = (2 * Math.PI * k) / rings;
      const swell = 1 + off() / 50; // along its own ray, so that no triangle turns over
      lines.push(`v ${(60 * swell * Math.sin(polar) * Math.cos(turn)).toFixed(4)} ${(45 * swell * Math.sin(polar) * Math.sin(turn)).toFixed(4)} ${(5 + 45 * swell * Math.cos(polar)).toFixed(4)}`);
    }
  for (let ring = 0; ring < rings; ++ring)
    for (let k = 0; k < rings; ++k) {
      const [a, b, c, d] = [at(ring, k), at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1)];
      if (ring > 0) lines.push(`f ${a} ${c} ${b}`);
      if (ring < rings - 1) lines.push(`f ${b} ${c} ${d}`);
    }
  return Buffer.from(lines.join("\n") + "\n");
}
