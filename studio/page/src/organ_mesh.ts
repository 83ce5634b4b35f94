import * as three from "three";
import { kCopiesNormal, kCorrectionSteps, type OrganTriangles, type OrganView } from "./protocol";
import type { Fall, ToolShadow } from "./tool_shadow";

/** sRGB as linear light. */
function linear(c: number): number {
  return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
}

// A cut bleeds, as in videos: a film on its walls, and its edges, so that a closed one stays visible. In linear light.
const kBlood = [0.34, 0, 0.006], kFilm = 0.34;
const kLip = [0.58, 0.1, 0.09], kNoLip = [1, 1, 1];

const kFront = "0.4", kAside = "0.9"; // how much glass covers of what is behind it, seen from the front and from aside
const kRim = "vec3(0.5, 0.46, 0.42)"; // light on its outline, which a dark organ needs on a dark ground

/** An organ's outside as glass: clear where it faces the viewer, and seen where it turns away. */
function makeGlass(material: three.MeshPhongMaterial): three.MeshPhongMaterial {
  material.transparent = true, material.depthWrite = false;
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace("#include <opaque_fragment>", `
      float turned = 1.0 - clamp(dot(normal, normalize(vViewPosition)), 0.0, 1.0);
      diffuseColor.a = mix(${kFront}, ${kAside}, turned * turned);
      outgoingLight += ${kRim} * turned * turned * turned * turned;
      #include <opaque_fragment>`);
  };
  return material;
}

/** Of the outside of an organ, of the walls of its cuts, and of an outside of glass. They outlive its triangles: the browser
    would compile them again for each cut, which takes longer than everything else in a picture. `shadow`: that falls on tissue. */
export function organMaterials(look: OrganView, shadow?: ToolShadow): three.MeshPhongMaterial[] {
  const shine = 0.04 + 0.09 * look.wetness;
  const material = (side: three.Side) =>
    new three.MeshPhongMaterial({ vertexColors: true, shininess: 34, specular: new three.Color(shine, shine, shine), side });
  // As in videos, what faces away is seen of the walls of cuts alone.
  const tissue = [material(three.FrontSide), material(three.DoubleSide)];
  for (const each of tissue) shadow?.fallOn(each);
  return [...tissue, makeGlass(material(three.FrontSide))];
}

/** The moving surface of one organ, with the walls of its cuts. */
export class OrganMesh {
  readonly mesh: three.Mesh;
  private readonly position: Float32Array;
  private readonly normal: Float32Array;
  private readonly index: Uint32Array; // all triangles
  private readonly whole: three.Mesh; // of all of them, to be met by rays
  private readonly facing: Uint32Array; // those that are drawn: the outer ones that face the viewer, and the walls of cuts
  private readonly faced = new three.Vector3(NaN, NaN, NaN); // the viewer's place when they were found
  private isColoured = false;

  /** `materials`: those of organMaterials(), which are the caller's. */
  constructor(private readonly triangles: OrganTriangles, private readonly look: OrganView, private readonly materials: three.MeshPhongMaterial[]) {
    this.index = triangles.index;
    this.position = new Float32Array(3 * triangles.vertexCount);
    this.normal = new Float32Array(3 * triangles.vertexCount);
    this.facing = this.index.slice();
    const geometry = this.geometryOf(this.facing, three.DynamicDrawUsage);
    geometry.setAttribute("color", new three.BufferAttribute(new Float32Array(3 * triangles.vertexCount), 3));
    const outer = 3 * triangles.outerTriangleCount;
    geometry.addGroup(0, outer, 0);
    if (outer < this.index.length) geometry.addGroup(outer, this.index.length - outer, 1);
    this.mesh = new three.Mesh(geometry, materials);
    this.mesh.frustumCulled = false;
    this.whole = new three.Mesh(this.geometryOf(this.index), new three.MeshBasicMaterial({ side: three.DoubleSide }));
  }

  private geometryOf(index: Uint32Array, usage: three.Usage = three.StaticDrawUsage): three.BufferGeometry {
    const geometry = new three.BufferGeometry();
    geometry.setIndex(new three.BufferAttribute(index, 1).setUsage(usage));
    geometry.setAttribute("position", new three.BufferAttribute(this.position, 3));
    geometry.setAttribute("normal", new three.BufferAttribute(this.normal, 3));
    return geometry;
  }

  /** Whether positions are of its vertices. */
  fits(position: Float32Array): boolean {
    return position.length === this.position.length;
  }

  update(position: Float32Array): void {
    this.position.set(position);
    this.computeNormals();
    if (!this.isColoured) this.colour();
    const { geometry } = this.mesh;
    geometry.attributes.position.needsUpdate = true;
    geometry.attributes.normal.needsUpdate = true;
    this.whole.geometry.boundingSphere = geometry.boundingSphere = null; // of positions before
    this.faced.setScalar(NaN);
    this.mesh.position.set(0, 0, 0), this.mesh.quaternion.identity(), this.mesh.scale.setScalar(1);
  }

  /** Draws the outside as tissue, or as glass through which its spheres are seen, or not at all. */
  show(as: "tissue" | "glass" | "nothing"): void {
    const [outside, walls, glass] = this.materials;
    this.mesh.visible = as !== "nothing";
    this.mesh.material = [as === "glass" ? glass : outside, walls];
  }

  /** Draws of the outside what faces a viewer alone, which is half of it: where the processor draws, a triangle that
      is left out only in the end costs as much as one that is seen. */
  drawFacing(viewer: three.Vector3): void {
    const eye = this.mesh.worldToLocal(viewer.clone());
    if (eye.equals(this.faced)) return;
    this.faced.copy(eye);
    const { position: p, index, facing } = this, outer = 3 * this.triangles.outerTriangleCount;
    let count = 0;
    for (let t = 0; t < outer; t += 3) {
      const a = 3 * index[t], b = 3 * index[t + 1], c = 3 * index[t + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const away = (uy * vz - uz * vy) * (eye.x - p[a]) + (uz * vx - ux * vz) * (eye.y - p[a + 1]) + (ux * vy - uy * vx) * (eye.z - p[a + 2]);
      if (away > 0) facing[count] = index[t], facing[count + 1] = index[t + 1], facing[count + 2] = index[t + 2], count += 3;
    }
    facing.set(index.subarray(outer), count);
    this.draws(count);
  }

  /** The first `outer` indices are of the outside, and those of walls follow. */
  private draws(outer: number): void {
    const { geometry } = this.mesh, walls = this.index.length - 3 * this.triangles.outerTriangleCount;
    geometry.clearGroups();
    geometry.addGroup(0, outer, 0);
    if (walls > 0) geometry.addGroup(outer, walls, 1);
    geometry.index!.clearUpdateRanges();
    geometry.index!.addUpdateRange(0, outer + walls);
    geometry.index!.needsUpdate = true;
  }

  /** Where a ray meets the surface first, seen or not. */
  meet(ray: three.Raycaster): three.Intersection | null {
    const { mesh, whole } = this;
    whole.position.copy(mesh.position), whole.quaternion.copy(mesh.quaternion), whole.scale.copy(mesh.scale);
    whole.updateMatrixWorld();
    return ray.intersectObject(whole, false)[0] ?? null;
  }

  /** Lets something fall onto its surface, as the newest frame has it. */
  catch(fall: Fall): void {
    fall.onto(this.position, this.index);
  }

  dispose(): void {
    this.mesh.geometry.dispose(), this.whole.geometry.dispose();
  }

  /** Normals of the vertices: the sum over their triangles, weighted by area. */
  private computeNormals(): void {
    const { position: p, normal: n, index } = this;
    n.fill(0);
    for (let t = 0; t < index.length; t += 3) {
      const a = 3 * index[t], b = 3 * index[t + 1], c = 3 * index[t + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      n[a] += x, n[a + 1] += y, n[a + 2] += z;
      n[b] += x, n[b + 1] += y, n[b + 2] += z;
      n[c] += x, n[c + 1] += y, n[c + 2] += z;
    }
    for (let v = 0; v < n.length; v += 3) this.setNormal(v, n[v], n[v + 1], n[v + 2]);
    this.correctNormals();
  }

  /** The normals of a cut organ as those of the whole one are, whose triangles are others; as in videos. */
  private correctNormals(): void {
    const { position: p, normal: n } = this, { neighbour, along, across } = this.triangles.corrections;
    for (let v = 0; v < neighbour.length; ++v) {
      if (neighbour[v] >= kCopiesNormal || (along[v] === 0 && across[v] === 0)) continue;
      const a = 3 * v, b = 3 * neighbour[v], nx = n[a], ny = n[a + 1], nz = n[a + 2];
      let x = p[b] - p[a], y = p[b + 1] - p[a + 1], z = p[b + 2] - p[a + 2];
      const out = x * nx + y * ny + z * nz;
      x -= out * nx, y -= out * ny, z -= out * nz;
      const length = Math.sqrt(x * x + y * y + z * z) * kCorrectionSteps;
      if (length === 0) continue;
      const f = along[v] / length, g = across[v] / length;
      this.setNormal(a, nx + f * x + g * (ny * z - nz * y), ny + f * y + g * (nz * x - nx * z), nz + f * z + g * (nx * y - ny * x));
    }
    for (let v = 0; v < neighbour.length; ++v)
      if (neighbour[v] >= kCopiesNormal) n.copyWithin(3 * v, 3 * (neighbour[v] - kCopiesNormal), 3 * (neighbour[v] - kCopiesNormal) + 3);
  }

  private setNormal(at: number, x: number, y: number, z: number): void {
    const { normal: n } = this, length = Math.sqrt(x * x + y * y + z * z) || 1; // hypot is many times slower
    n[at] = x / length, n[at + 1] = y / length, n[at + 2] = z / length;
  }

  /** Colours by vertex: stained tissue outside, darker in hollows; the inside's colour on the walls of cuts. */
  private colour(): void {
    this.isColoured = true;
    const colours = this.mesh.geometry.attributes.color as three.BufferAttribute;
    const outer = this.look.outer.map(linear), inner = this.look.inner.map((c, i) => linear(c) + kFilm * (kBlood[i] - linear(c)));
    const hollow = this.hollows();
    for (let v = 0; v < this.triangles.vertexCount; ++v) {
      const isWall = v >= this.triangles.outerVertexCount;
      const stain = 1 + 0.16 * (this.triangles.stain[v] / 127.5 - 1);
      const shade = isWall ? 1 : stain * Math.min(1.15, Math.max(0.55, 1 + 1.6 * hollow[v]));
      const lip = this.triangles.lip[v] > 0 ? kLip : kNoLip;
      const base = isWall ? inner : outer;
      colours.setXYZ(v, base[0] * shade * lip[0], base[1] * shade * lip[1], base[2] * shade * lip[2]);
    }
    colours.needsUpdate = true;
  }

  /** Height of a vertex above its neighbours over their distance: negative in hollows. */
  private hollows(): Float32Array {
    const { position: p, normal: n, index } = this;
    const sum = new Float32Array(this.triangles.vertexCount), count = new Float32Array(this.triangles.vertexCount);
    for (let t = 0; t < index.length; t += 3)
      for (let k = 0; k < 3; ++k) {
        const v = index[t + k], a = 3 * v, b = 3 * index[t + ((k + 1) % 3)];
        const x = p[b] - p[a], y = p[b + 1] - p[a + 1], z = p[b + 2] - p[a + 2];
        sum[v] -= (x * n[a] + y * n[a + 1] + z * n[a + 2]) / (Math.sqrt(x * x + y * y + z * z) || 1);
        count[v] += 1;
      }
    for (let v = 0; v < sum.length; ++v) sum[v] /= count[v] || 1;
    return sum;
  }
}
