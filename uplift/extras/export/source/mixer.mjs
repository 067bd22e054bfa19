/* Mixes RGB colours as paints: blue and yellow are green. An ES module.

   Written by uplift ${version} from the cube ${digest}. BSD-3-Clause.
   RGB is linear ${space} under ${illuminant} for the ${observer}, in [0, 1]: other numbers are a RangeError.

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
const SLACK = 1e-6; /* distance from [0, 1] that is rounding */

function inside(name, x) {
  if (Number.isFinite(x) && x >= -SLACK && x <= 1 + SLACK) return clip(x);
  throw new RangeError(`$${name} must be a number in [0, 1], got $${x}`);
}

/* Length of a latent. */
export const SIZE = 3 * BANDS + 3;

/* Latent numbers of linear RGB: absorption, scattering and reflectance in bands, and RGB. They mix as numbers do: a colour
   that is mixed often, such as that of a brush, has them computed once. */
export function latent(rgb) {
  return fill(rgb, new Float64Array(SIZE));
}

/* Place of a component between the nodes, and the node below it. */
const position = component => Math.sqrt(component) * (DIM - 1);
const cell = place => Math.min(place | 0, DIM - 2);

function fill(rgb, numbers) {
  const red = inside("red", rgb[0]), green = inside("green", rgb[1]), blue = inside("blue", rgb[2]);
  const r = position(red), g = position(green), b = position(blue);
  const i = cell(r), j = cell(g), l = cell(b);
  const r1 = r - i, g1 = g - j, b1 = b - l;
  const r0 = 1 - r1, g0 = 1 - g1, b0 = 1 - b1;
  const w00 = r0 * g0, w01 = r0 * g1, w10 = r1 * g0, w11 = r1 * g1;
  const r0g0 = STRIDE * ((i * DIM + j) * DIM + l), r0g1 = r0g0 + STRIDE * DIM;
  const r1g0 = r0g0 + STRIDE * DIM * DIM, r1g1 = r1g0 + STRIDE * DIM;
  for (let k = 0; k < STRIDE; ++k) {
    const next = k + STRIDE;
    numbers[BANDS + k] =
      b0 * (w00 * TABLE[r0g0 + k] + w01 * TABLE[r0g1 + k] + w10 * TABLE[r1g0 + k] + w11 * TABLE[r1g1 + k]) +
      b1 * (w00 * TABLE[r0g0 + next] + w01 * TABLE[r0g1 + next] + w10 * TABLE[r1g0 + next] + w11 * TABLE[r1g1 + next]);
  }
  for (let k = 0; k < BANDS; ++k) {
    const root = numbers[BANDS + k] * UNITS[0], scatteringRoot = numbers[2 * BANDS + k] * UNITS[1];
    const R = root * root, S = scatteringRoot * scatteringRoot;
    numbers[k] = (S * (1 - R) * (1 - R)) / (2 * R); /* Kubelka and Munk: R is that of K and S */
    numbers[BANDS + k] = S;
    numbers[2 * BANDS + k] = R;
  }
  numbers[3 * BANDS] = red;
  numbers[3 * BANDS + 1] = green;
  numbers[3 * BANDS + 2] = blue;
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
  return [clip(rgb[0]), clip(rgb[1]), clip(rgb[2])];
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

const ONE = new Float64Array(SIZE), OTHER = new Float64Array(SIZE);

/* Mix two colours, linear RGB; the share is that of the second, in [0, 1]. */
export function mix(first, second, share) {
  const t = inside("share", share);
  fill(first, ONE);
  fill(second, OTHER);
  for (let k = 0; k < SIZE; ++k) ONE[k] = (1 - t) * ONE[k] + t * OTHER[k];
  return colour(ONE);
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
  const x = inside("code", code);
  return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
}

export function encode(linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
}
