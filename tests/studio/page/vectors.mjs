// Vectors of three numbers.
export const minus = (a, b) => a.map((x, i) => x - b[i]);
export const scaled = (a, by) => a.map((x) => x * by);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a) => Math.hypot(...a);
export const unit = (a) => scaled(a, 1 / length(a));
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
