// From linear sRGB to the screen (IEC 61966-2-1). Steps of 1/65535 are a twentieth of an 8-bit code where it is steepest.
const STEPS = 65535;
const encoded = linear => 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
const CODES = Uint8Array.from({ length: STEPS + 1 }, (_, step) => Math.round(encoded(step / STEPS)));
const code = linear => CODES[linear > 0 ? (linear < 1 ? (linear * STEPS + 0.5) | 0 : STEPS) : 0];
const hex = rgb => "#" + rgb.map(linear => code(linear).toString(16).padStart(2, "0")).join("");
const SLACK = 1 / 510;
const beyond = (r, g, b) => r < -SLACK || g < -SLACK || b < -SLACK || r > 1 + SLACK || g > 1 + SLACK || b > 1 + SLACK;

// Puts the 3 × m matrix, row after row, on every pixel's m coefficients; returns how many the screen cannot show.
function light(pixels, matrix, out) {
  const m = matrix.length / 3;
  let clipped = 0;
  for (let p = 0, at = 0; p < out.length; p++) {
    let r = 0, g = 0, b = 0;
    for (let k = 0; k < m; k++, at++) {
      const c = pixels[at];
      r += matrix[k] * c;
      g += matrix[m + k] * c;
      b += matrix[2 * m + k] * c;
    }
    if (beyond(r, g, b)) clipped++;
    out[p] = 0xff000000 | (code(b) << 16) | (code(g) << 8) | code(r);
  }
  return clipped;
}
