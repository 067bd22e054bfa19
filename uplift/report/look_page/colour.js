// Colours of reflectances: XYZ, L*a*b* and sRGB, as uplift/colorimetry computes them.
const dot = (first, second) => first.reduce((sum, value, i) => sum + value * second[i], 0);
const multiply = (matrix, vector) => matrix.map(row => dot(row, vector));
const compress = t => (t > (6 / 29) ** 3 ? Math.cbrt(t) : (t * (29 / 6) ** 2) / 3 + 4 / 29);
const expand = f => (f > 6 / 29 ? f ** 3 : (f - 4 / 29) * 3 * (6 / 29) ** 2);

function xyzToLab(xyz, white) {
  const [x, y, z] = xyz.map((value, k) => compress(value / white[k]));
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

function labToXyz([lightness, a, b], white) {
  const y = (lightness + 16) / 116;
  return [y + a / 500, y, y - b / 200].map((f, k) => expand(f) * white[k]);
}

// Rows of the derivative of a* and b* with respect to XYZ.
function slopesOfAb(xyz, white) {
  const [x, y, z] = xyz.map((value, k) => 1 / (3 * Math.cbrt(Math.max(value / white[k], (6 / 29) ** 3)) ** 2 * white[k]));
  return [[500 * x, -500 * y, 0], [0, 200 * y, -200 * z]];
}

const labOf = (light, reflectance) => xyzToLab(multiply(light.xyz, reflectance), light.white);
const linearRgb = (light, xyz) => multiply(light.toRgb, xyz);
const isInGamut = rgb => rgb.every(value => value >= -1e-9 && value <= 1 + 1e-9);

// Move linear sRGB toward the grey of its luminance until it can be displayed.
function desaturate(rgb, luminance) {
  const grey = Math.min(Math.max(dot(rgb, luminance), 0), 1);
  const low = Math.min(...rgb);
  const high = Math.max(...rgb);
  const kept = Math.min(low < 0 ? grey / (grey - low) : 1, high > 1 ? (1 - grey) / (high - grey) : 1);
  return rgb.map(value => Math.min(Math.max(grey + kept * (value - grey), 0), 1));
}

const encode = value => (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055);
const toCodes = (rgb, luminance) => desaturate(rgb, luminance).map(value => Math.round(255 * encode(value)));
const toHex = codes => "#" + codes.map(code => code.toString(16).padStart(2, "0")).join("");
