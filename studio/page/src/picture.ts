import * as three from "three";

const kInARow = 4; // pictures of a size, more than come of one moment of a session

/** The picture of a canvas, drawn with more or fewer pixels than the screen has. A browser that draws with the processor takes
    as long for a canvas of another size as for a third of a picture, so that a few pictures of another size are copied into
    it; more of them in a row are faster in a canvas of their own size. */
export class Picture {
  private readonly targets = new Map<number, three.WebGLRenderTarget>(); // of each number of pixels for one of the page
  private target: three.WebGLRenderTarget | null = null; // null: the canvas
  private ratio = 0; // pixels for one of the page, along each side
  private alike = 0; // pictures in a row that had the same before this one
  private height = 0;

  /** `smoothsEdges`: the canvas has samples of its own, into which no other picture can be copied. */
  constructor(private readonly renderer: three.WebGLRenderer, private readonly smoothsEdges: boolean) {
    renderer.setScissorTest(true);
  }

  /** Begins an empty one; `width`, `height` of the canvas on the page. */
  begin(width: number, height: number, ratio: number): void {
    const { renderer } = this, size = renderer.getSize(new three.Vector2());
    if (size.x !== width || size.y !== height) renderer.setSize(width, height, false);
    const screen = Math.min(devicePixelRatio, 2), fitting = ratio > screen && !this.smoothsEdges ? screen : ratio;
    this.alike = ratio === this.ratio ? this.alike + 1 : 0;
    const goesOn = this.alike >= kInARow || fitting !== ratio || this.smoothsEdges;
    if (goesOn && renderer.getPixelRatio() !== fitting) renderer.setPixelRatio(fitting);
    this.ratio = ratio, this.height = height;
    this.target = ratio === renderer.getPixelRatio() ? null : this.targetOf(ratio, Math.floor(width * ratio), Math.floor(height * ratio));
    this.fill(0, width);
    renderer.clear();
  }

  /** What follows is drawn between `from` and `from + width`. */
  fill(from: number, width: number): void {
    const { renderer, target, ratio, height } = this;
    if (target) {
      for (const box of [target.viewport, target.scissor]) box.set(from, 0, width, height).multiplyScalar(ratio).floor();
    } else {
      renderer.setViewport(from, 0, width, height);
      renderer.setScissor(from, 0, width, height);
    }
    if (target || renderer.getRenderTarget()) renderer.setRenderTarget(target);
  }

  /** Puts it onto the canvas. */
  end(): void {
    const { renderer, target } = this;
    if (!target) return;
    renderer.setRenderTarget(null);
    const gl = renderer.getContext() as WebGL2RenderingContext;
    const { __webglFramebuffer: drawn } = renderer.properties.get(target) as { __webglFramebuffer: WebGLFramebuffer };
    renderer.state.bindFramebuffer(gl.READ_FRAMEBUFFER, drawn);
    renderer.state.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null as unknown as WebGLFramebuffer);
    gl.disable(gl.SCISSOR_TEST);
    gl.blitFramebuffer(0, 0, target.width, target.height, 0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.COLOR_BUFFER_BIT, gl.LINEAR);
    renderer.state.bindFramebuffer(gl.READ_FRAMEBUFFER, null as unknown as WebGLFramebuffer);
    renderer.state.setScissorTest(true);
  }

  private targetOf(ratio: number, width: number, height: number): three.WebGLRenderTarget {
    let target = this.targets.get(ratio);
    if (!target) {
      target = new three.WebGLRenderTarget(width, height, { colorSpace: three.SRGBColorSpace });
      // As three.js marks what it draws for a headset: shaders write into it what they write onto the canvas.
      Object.assign(target, { isXRRenderTarget: true });
      target.scissorTest = true;
      this.targets.set(ratio, target);
    }
    if (target.width !== width || target.height !== height) target.setSize(width, height);
    return target;
  }

  dispose(): void {
    for (const target of this.targets.values()) target.dispose();
  }
}
