// How far a tool is above the tissue, and what shows it: a shadow straight below it, and a ring that closes as it comes down.
import * as three from "three";

const kRingPerGap = 0.4, kWidest = 0.008; // how much wider than the tool the ring is for its gap, and at most [m]
const kBlade = 0.0015; // radius for a tool without one [m]
const kFades = 0.0005; // gap in which the shadow fades on contact [m]

const kUniforms = `
  uniform vec3 shadowAt, shadowUp;
  uniform vec4 shadowSize; // radius, ring's radius, how far below, strength
  varying vec3 shadowPlace;`;

/** Darkens the tissue below the tool and draws the ring: only where it would be met, and around that as far as slopes lead there. */
const kShade = `
  if (shadowSize.w > 0.0) {
    vec3 away = shadowPlace - shadowAt;
    float below = -dot(away, shadowUp), aside = length(away + below * shadowUp), pixel = min(fwidth(aside), 0.0005);
    float near = shadowSize.w * (1.0 - smoothstep(0.8, 1.1, abs(below - shadowSize.z) / (aside + 0.003)));
    outgoingLight *= 1.0 - 0.7 * near * (1.0 - smoothstep(0.5 * shadowSize.x, shadowSize.y, aside));
    outgoingLight = mix(outgoingLight, vec3(0.9), 0.8 * near * (1.0 - smoothstep(0.7 * pixel, 1.7 * pixel, abs(aside - shadowSize.y))));
  }
  #include <opaque_fragment>`;

/** A tool's shadow on the organs whose materials take it. */
export class ToolShadow {
  private readonly uniforms = { shadowAt: { value: new three.Vector3() }, shadowUp: { value: new three.Vector3(0, 0, 1) }, shadowSize: { value: new three.Vector4() } };

  /** What is drawn with that material shows the shadow. */
  fallOn(material: three.Material): void {
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.uniforms);
      shader.vertexShader = shader.vertexShader.replace("void main() {", "varying vec3 shadowPlace;\nvoid main() {")
        .replace("#include <project_vertex>", "#include <project_vertex>\n  shadowPlace = (modelMatrix * vec4(transformed, 1.0)).xyz;");
      shader.fragmentShader = shader.fragmentShader.replace("void main() {", `${kUniforms}\nvoid main() {`).replace("#include <opaque_fragment>", kShade);
    };
  }

  /** Below a tool at that place, which would fall so far; null: there is none. */
  cast(at: three.Vector3, up: three.Vector3, radius: number, fall: Fall | null): void {
    const { shadowAt, shadowUp, shadowSize } = this.uniforms, size = Math.max(radius, kBlade);
    shadowAt.value.copy(at), shadowUp.value.copy(up);
    if (!fall?.meets) shadowSize.value.set(0, 0, 0, 0);
    else shadowSize.value.set(size, size + Math.min(kRingPerGap * fall.gap, kWidest), fall.gap + radius, Math.min(1, fall.gap / kFades));
  }
}

let across = new Float32Array(), along = new Float32Array(), height = new Float32Array(); // of vertices about the ball's middle

/** A ball, or a point, that falls straight down until it meets a surface. */
export class Fall {
  private way = Infinity; // of the ball
  private below = Infinity; // from its middle to the first triangle
  private isFromInside = false;

  constructor(private readonly at: three.Vector3, private readonly up: three.Vector3, private readonly radius: number) {}

  /** How far it falls [m]; none: Infinity. */
  get gap(): number {
    return Math.max(0, Math.min(this.way, this.below - this.radius));
  }
  /** Whether it meets anything, from outside. */
  get meets(): boolean {
    return this.gap < Infinity && !this.isFromInside;
  }
  /** Whether it is in what it would meet. */
  get isInside(): boolean {
    return this.isFromInside;
  }

  /** Meets a surface whose triangles are counter-clockwise from outside. Each vertex and each triangle once, with what is
      cheap first: this is done for each picture. */
  onto(position: Float32Array, index: Uint32Array): void {
    this.ontoVertices(position);
    const x = across, y = along, h = height;
    for (let t = 0; t < index.length; t += 3) {
      const a = index[t], b = index[t + 1], c = index[t + 2], isRight = x[a] > 0, isUp = y[a] > 0;
      if ((isRight === x[b] > 0 && isRight === x[c] > 0) || (isUp === y[b] > 0 && isUp === y[c] > 0)) continue;
      const ab = x[a] * y[b] - y[a] * x[b], bc = x[b] * y[c] - y[b] * x[c], ca = x[c] * y[a] - y[c] * x[a], area = ab + bc + ca;
      if (area === 0 || ab * area < 0 || bc * area < 0 || ca * area < 0) continue; // beside the middle
      const below = -(bc * h[a] + ca * h[b] + ab * h[c]) / area;
      if (below >= 0 && below < this.below) this.below = below, this.isFromInside = area < 0;
    }
  }

  private ontoVertices(p: Float32Array): void {
    const count = p.length / 3, { at, up } = this, square = this.radius ** 2;
    if (height.length < count) across = new Float32Array(count), along = new Float32Array(count), height = new Float32Array(count);
    const u = new three.Vector3(Math.abs(up.x) < 0.9 ? 1 : 0, Math.abs(up.x) < 0.9 ? 0 : 1, 0).cross(up).normalize(), v = up.clone().cross(u);
    for (let i = 0, k = 0; i < count; ++i, k += 3) {
      const dx = p[k] - at.x, dy = p[k + 1] - at.y, dz = p[k + 2] - at.z;
      const x = (across[i] = dx * u.x + dy * u.y + dz * u.z), y = (along[i] = dx * v.x + dy * v.y + dz * v.z);
      const h = (height[i] = dx * up.x + dy * up.y + dz * up.z), room = square - x * x - y * y;
      if (room > 0 && h <= 0) this.way = Math.min(this.way, -h - Math.sqrt(room));
    }
  }
}
