// CIEDE2000 (Sharma, Wu & Dalal 2005), as uplift/colorimetry/delta_e.py.
const degrees = Math.PI / 180;
const weight7 = chroma => Math.sqrt(chroma ** 7 / (chroma ** 7 + 25 ** 7));

function deltaE(first, second) {
  const chroma = (Math.hypot(first[1], first[2]) + Math.hypot(second[1], second[2])) / 2;
  const stretch = 1.5 - 0.5 * weight7(chroma);
  const [one, two] = [first, second].map(([light, a, b]) => {
    const hue = Math.atan2(b, stretch * a);
    return { light, chroma: Math.hypot(stretch * a, b), hue: hue < 0 ? hue + 2 * Math.PI : hue };
  });
  const isGrey = one.chroma * two.chroma === 0;
  let turn = isGrey ? 0 : two.hue - one.hue;
  if (Math.abs(turn) > Math.PI) turn -= 2 * Math.PI * Math.sign(turn);
  let hue = one.hue + two.hue;
  if (!isGrey) {
    hue /= 2;
    if (Math.abs(one.hue - two.hue) > Math.PI) hue += hue < Math.PI ? Math.PI : -Math.PI;
  }
  const light = (one.light + two.light) / 2 - 50;
  const meanChroma = (one.chroma + two.chroma) / 2;
  const wave = (factor, multiple, phase) => factor * Math.cos(multiple * hue + phase * degrees);
  const T = 1 + wave(-0.17, 1, -30) + wave(0.24, 2, 0) + wave(0.32, 3, 6) + wave(-0.2, 4, -63);
  const SL = 1 + 0.015 * light ** 2 / Math.sqrt(20 + light ** 2);
  const SC = 1 + 0.045 * meanChroma;
  const SH = 1 + 0.015 * meanChroma * T;
  const rotation = 60 * degrees * Math.exp(-(((hue / degrees - 275) / 25) ** 2));
  const dL = (two.light - one.light) / SL;
  const dC = (two.chroma - one.chroma) / SC;
  const dH = 2 * Math.sqrt(one.chroma * two.chroma) * Math.sin(turn / 2) / SH;
  const RT = -2 * weight7(meanChroma) * Math.sin(rotation);
  return Math.sqrt(Math.max(dL * dL + dC * dC + dH * dH + RT * dC * dH, 0));
}
