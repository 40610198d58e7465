// Colour scales that stay apart for colour-blind eyes.

const stops = [[0, [0.20, 0.30, 0.55]], [0.35, [0.16, 0.56, 0.55]], [0.65, [0.55, 0.75, 0.30]], [0.9, [0.98, 0.80, 0.20]], [1, [0.80, 0.15, 0.12]]];

/** Colour of a use between 0 and 1; above 1 dark red. */
export function useColour(value) {
  if (value === null || value === undefined) return [0.72, 0.75, 0.78];
  if (value > 1) return [0.45, 0, 0.05];
  for (let k = 1; k < stops.length; ++k) {
    const [hi, b] = stops[k], [lo, a] = stops[k - 1];
    if (value <= hi) {
      const t = (value - lo) / (hi - lo);
      return [0, 1, 2].map((i) => a[i] + t * (b[i] - a[i]));
    }
  }
  return stops[0][1];
}

/** Diverging colour of a signed value in [-1, 1]: blue, grey, red. */
export function signedColour(value) {
  const v = Math.max(-1, Math.min(1, value));
  const grey = [0.85, 0.86, 0.87];
  const end = v > 0 ? [0.78, 0.16, 0.16] : [0.13, 0.35, 0.70];
  const t = Math.abs(v);
  return [0, 1, 2].map((i) => grey[i] + t * (end[i] - grey[i]));
}

export const css = ([r, g, b]) => `rgb(${Math.round(255 * r)}, ${Math.round(255 * g)}, ${Math.round(255 * b)})`;

export function gradient(colour, from, to) {
  const parts = [];
  for (let k = 0; k <= 10; ++k) parts.push(css(colour(from + (to - from) * k / 10)));
  return `linear-gradient(to right, ${parts.join(', ')})`;
}
