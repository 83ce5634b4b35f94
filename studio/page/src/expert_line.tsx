// An expert's cut on a trainee's organs, and what the trainee cut elsewhere.
import * as three from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { ExpertMarks } from "./protocol";

const kExpert = "#7cc0ff", kStray = "#ffb35c"; // as in videos
const kWidth = 3, kDot = 8; // [px]
const kNearer = 1.3e-3; // of the way to the eye: the line lies on the triangles, which would hide half of it

/** A dot with a dark rim, which is seen on every tissue. */
function dotPicture(): three.CanvasTexture {
  const canvas = document.createElement("canvas"), middle = 16;
  canvas.width = canvas.height = 2 * middle;
  const pen = canvas.getContext("2d")!;
  for (const [colour, radius] of [["#14181c", middle], [kStray, middle - 4]] as const) {
    pen.fillStyle = colour;
    pen.beginPath(), pen.arc(middle, middle, radius, 0, 2 * Math.PI), pen.fill();
  }
  const picture = new three.CanvasTexture(canvas);
  picture.colorSpace = three.SRGBColorSpace;
  return picture;
}

/** How both are drawn. Organs and tools hide the line; nothing hides the dots, which lie in the tissue. */
export class ExpertLine {
  readonly group = new three.Group();
  private readonly line = new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({ color: kExpert, linewidth: kWidth }));
  private readonly strays = new three.Points(new three.BufferGeometry(),
    new three.PointsMaterial({ size: kDot, sizeAttenuation: false, map: dotPicture(), transparent: true, depthTest: false }));

  constructor() {
    this.line.frustumCulled = this.strays.frustumCulled = false;
    this.strays.renderOrder = 2;
    // Three.js takes the size of the canvas, of which a picture may be half, and coarser or finer than that.
    this.line.onBeforeRender = (renderer) => {
      const seen = renderer.getRenderTarget()?.viewport ?? renderer.getViewport(new three.Vector4());
      const height = renderer.getSize(new three.Vector2()).y;
      this.line.material.resolution.set((seen.z / seen.w) * height, height);
    };
    this.strays.onBeforeRender = (renderer) => {
      const target = renderer.getRenderTarget(), height = renderer.getSize(new three.Vector2()).y;
      this.strays.material.size = kDot * (target ? target.viewport.w / height / renderer.getPixelRatio() : 1);
    };
    this.group.add(this.line, this.strays);
  }

  show(marks: ExpertMarks | null): void {
    this.line.visible = !!marks && marks.line.length > 0;
    this.strays.visible = !!marks && marks.strays.length > 0;
    if (this.line.visible) { // a geometry whose length changes is another one
      this.line.geometry.dispose();
      this.line.geometry = new LineSegmentsGeometry().setPositions(marks!.line);
    }
    if (this.strays.visible) {
      this.strays.geometry.dispose();
      this.strays.geometry = new three.BufferGeometry().setAttribute("position", new three.BufferAttribute(marks!.strays, 3));
    }
  }

  /** Nearer to a viewer, who sees it in the same place. */
  comeNearer(viewer: three.Vector3): void {
    this.line.scale.setScalar(1 - kNearer);
    this.line.position.copy(viewer).multiplyScalar(kNearer);
  }

  dispose(): void {
    this.line.geometry.dispose(), this.line.material.dispose();
    this.strays.geometry.dispose(), this.strays.material.map!.dispose(), this.strays.material.dispose();
  }
}

/** What both mean, of those that are there. */
export function ExpertLegend({ marks }: { marks: ExpertMarks | null }) {
  if (!marks || marks.line.length + marks.strays.length === 0) return null;
  return (
    <ul class="expert-legend" aria-label="Marks on the trainee's organ">
      {marks.line.length > 0 && <li><i class="line" />the expert's cut</li>}
      {marks.strays.length > 0 && <li><i class="strays" />cut where the expert did not</li>}
    </ul>
  );
}
