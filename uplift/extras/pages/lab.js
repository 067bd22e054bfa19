// CIE L*a*b*, as uplift/colorimetry computes it.
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
