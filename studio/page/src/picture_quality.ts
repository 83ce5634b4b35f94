// How finely pictures are drawn: as the screen shows them, and coarser while they come late.

const kSteps = [1, 0.75, 0.55]; // pixels drawn for one of the screen, along each side; fewer would be seen by all
const kLate = 40, kEarly = 16; // of a picture until it is there [ms]
const kJudged = 8; // pictures that are judged together
const kStill = 4; // samples in a pixel of a picture that stands still, where the browser smooths no edges

/** Whether the browser draws with the processor. Pictures then come many times slower, and smoothing edges takes half
    of that time. */
function drawsWithProcessor(): boolean {
  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl2", { failIfMajorPerformanceCaveat: true });
  if (!gl) return true;
  const name = String(gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

let known: boolean | undefined; // the same for all pictures of the page

/** Follows how long pictures take. */
export class PictureQuality {
  readonly isByProcessor: boolean; // the browser draws with it
  readonly smoothsEdges: boolean; // while something moves
  private step = 0;
  private times: number[] = []; // of the last pictures [ms]

  constructor() {
    this.isByProcessor = known ??= drawsWithProcessor();
    this.smoothsEdges = !this.isByProcessor;
  }

  /** Pixels to draw for one of the page, along each side. */
  ratio(isStill: boolean): number {
    const screen = Math.min(devicePixelRatio, 2);
    if (!isStill) return screen * kSteps[this.step];
    return this.smoothsEdges ? screen : Math.min(screen * Math.sqrt(kStill), 2);
  }

  /** Whether a picture that stands still would be finer than while it moves. */
  get isReduced(): boolean {
    return this.ratio(true) !== this.ratio(false);
  }

  /** A picture of something that moves took that long [ms]. */
  add(time: number): void {
    this.times.push(time);
    if (this.times.length < kJudged) return;
    const usual = this.times.sort((a, b) => a - b)[kJudged >> 1];
    this.times = [];
    if (usual > kLate) this.step = Math.min(this.step + 1, kSteps.length - 1);
    else if (usual < kEarly) this.step = Math.max(this.step - 1, 0);
  }
}
