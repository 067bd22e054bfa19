// Linear sRGB to display codes (IEC 61966-2-1) with a table; its step is at most a twentieth of an 8-bit code.
const STEPS = 65535;
const encode = linear => 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
const CODES = Uint8Array.from({ length: STEPS + 1 }, (_, step) => Math.round(encode(step / STEPS)));
const code = linear => CODES[linear > 0 ? (linear < 1 ? (linear * STEPS + 0.5) | 0 : STEPS) : 0];
const hex = rgb => "#" + rgb.map(linear => code(linear).toString(16).padStart(2, "0")).join("");
const opaque = (r, g, b) => 0xff000000 | (code(b) << 16) | (code(g) << 8) | code(r);
const TOLERANCE = 1 / 510;
const outOfRange = linear => linear < -TOLERANCE || linear > 1 + TOLERANCE;
const isClipped = (r, g, b) => outOfRange(r) || outOfRange(g) || outOfRange(b);

// Multiply the m coefficients of every labelled pixel by the 3 × m matrix (row-major). Other pixels do not change.
// Returns the number of clipped pixels.
function light(pixels, labels, matrix, out) {
  const m = matrix.length / 3;
  let clipped = 0;
  for (let p = 0; p < out.length; p++) {
    if (!labels[p]) continue;
    let r = 0, g = 0, b = 0;
    for (let k = 0, at = p * m; k < m; k++, at++) {
      const c = pixels[at];
      r += matrix[k] * c;
      g += matrix[m + k] * c;
      b += matrix[2 * m + k] * c;
    }
    if (isClipped(r, g, b)) clipped++;
    out[p] = opaque(r, g, b);
  }
  return clipped;
}
