/* Mixes RGB colours as paints: blue and yellow are green. An ES module.

   Written by uplift ${version} from the cube ${digest}. BSD-3-Clause.
   RGB is linear ${space} under ${illuminant} for the ${observer}, in [0, 1]: numbers outside are clipped, NaN is 0.

   import { mixSrgb } from "./${file}";
   mixSrgb([0, 0.13, 0.52], [0.99, 0.82, 0], 0.5); */

const BANDS = ${bands};
const DIM = ${dim};
const STRIDE = 2 * BANDS;
const UNITS = [${units}];

/* From reflectances in bands to linear RGB. */
const TO_RGB = [
${to_rgb}];

/* Square roots of reflectance and scattering in bands, in units, by red, green and blue: 16-bit numbers, little-endian.
   Nodes are even in the square root of linear RGB. */
const TABLE = decodeTable(
  "${numbers}");

function decodeTable(text) {
  const bytes = Uint8Array.from(atob(text), character => character.charCodeAt(0));
  return Float32Array.from({ length: bytes.length / 2 }, (_, k) => bytes[2 * k] + 256 * bytes[2 * k + 1]);
}

const clip = x => (x > 0 ? Math.min(x, 1) : 0);

/* Length of a latent. */
export const SIZE = 3 * BANDS + 3;

/* Latent numbers of linear RGB: absorption, scattering and reflectance in bands, and RGB. They mix as numbers do: a colour
   that is mixed often, such as that of a brush, has them computed once. */
export function latent(rgb) {
  const numbers = new Float64Array(SIZE);
  const offset = [0, 0, 0];
  let node = 0;
  for (let c = 0; c < 3; ++c) {
    const inside = clip(rgb[c]);
    const position = Math.sqrt(inside) * (DIM - 1);
    const cell = Math.min(Math.floor(position), DIM - 2);
    offset[c] = position - cell;
    node = node * DIM + cell;
    numbers[3 * BANDS + c] = inside;
  }
  for (let corner = 0; corner < 8; ++corner) {
    const r = corner >> 2, g = (corner >> 1) & 1, b = corner & 1;
    const weight =
      (r ? offset[0] : 1 - offset[0]) * (g ? offset[1] : 1 - offset[1]) * (b ? offset[2] : 1 - offset[2]);
    const first = STRIDE * (node + (r * DIM + g) * DIM + b);
    for (let k = 0; k < BANDS; ++k) {
      numbers[2 * BANDS + k] += weight * TABLE[first + k];
      numbers[BANDS + k] += weight * TABLE[first + BANDS + k];
    }
  }
  for (let k = 0; k < BANDS; ++k) {
    const R = (numbers[2 * BANDS + k] * UNITS[0]) ** 2;
    const S = (numbers[BANDS + k] * UNITS[1]) ** 2;
    numbers[k] = (S * (1 - R) ** 2) / (2 * R); /* Kubelka and Munk: R is that of K and S */
    numbers[BANDS + k] = S;
    numbers[2 * BANDS + k] = R;
  }
  return numbers;
}

/* Linear RGB of latent numbers. */
export function colour(numbers) {
  const rgb = [numbers[3 * BANDS], numbers[3 * BANDS + 1], numbers[3 * BANDS + 2]];
  for (let k = 0; k < BANDS; ++k) {
    const K = numbers[k], S = numbers[BANDS + k];
    const change = S / (K + S + Math.sqrt(K * (K + 2 * S)) + 1e-30) - numbers[2 * BANDS + k];
    for (let c = 0; c < 3; ++c) rgb[c] += change * TO_RGB[c][k];
  }
  return rgb.map(clip);
}

/* Sum of latents by parts, which need not have the sum 1; without a positive part, black. */
export function mixLatents(latents, parts) {
  const positive = Array.from(parts, part => (part > 0 ? part : 0));
  const total = positive.reduce((sum, part) => sum + part, 0);
  const sum = new Float64Array(SIZE);
  positive.forEach((part, i) => {
    if (part > 0) for (let k = 0; k < SIZE; ++k) sum[k] += (part / total) * latents[i][k];
  });
  return sum;
}

/* Mix two colours, linear RGB; the share is that of the second, in [0, 1]. */
export function mix(first, second, share) {
  const t = clip(share);
  const one = latent(first), other = latent(second);
  for (let k = 0; k < SIZE; ++k) one[k] = (1 - t) * one[k] + t * other[k];
  return colour(one);
}

/* Mix any number of colours, linear RGB, by their parts. */
export function mixAll(colours, parts) {
  return colour(mixLatents(colours.map(latent), parts));
}

/* Mix two colours as codes in [0, 1] of the curve of sRGB. */
export function mixSrgb(first, second, share) {
  return mix(first.map(decode), second.map(decode), share).map(encode);
}

export function decode(code) {
  const inside = clip(code);
  return inside <= 0.04045 ? inside / 12.92 : ((inside + 0.055) / 1.055) ** 2.4;
}

export function encode(linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
}
