// Pictures that the program draws, in place of the page's own.
import type { Drawing } from "./protocol";

/** Shows a drawing; null: what is below. */
export function drawInto(canvas: HTMLCanvasElement, drawing: Drawing | null): void {
  canvas.hidden = drawing === null;
  if (!drawing) return;
  const { width, height, rgb } = drawing, image = new ImageData(width, height);
  for (let from = 0, to = 0; from < rgb.length; from += 3, to += 4) image.data[to] = rgb[from], image.data[to + 1] = rgb[from + 1], image.data[to + 2] = rgb[from + 2], image.data[to + 3] = 255;
  canvas.width = width, canvas.height = height;
  canvas.getContext("2d")!.putImageData(image, 0, 0);
}

/** The picture of a canvas follows the size of its place. */
export function watchSize(canvas: HTMLCanvasElement, onSize: () => void): () => void {
  let timer = 0;
  const observer = new ResizeObserver(() => {
    clearTimeout(timer);
    timer = window.setTimeout(onSize, 100); // until it stays
  });
  observer.observe(canvas);
  return () => (clearTimeout(timer), observer.disconnect());
}

/** The size of each of some drawings beside each other that fill a canvas: even numbers, which videos need. */
export function sizeOf(canvas: HTMLCanvasElement, beside: number): string {
  const even = (x: number) => Math.max(64, 2 * Math.round(x / 2));
  return `${even(canvas.clientWidth / Math.max(1, beside))}x${even(canvas.clientHeight)}`;
}
