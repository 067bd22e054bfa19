// Mixtures of measured paints by Kubelka and Munk: `members` are paints by number, `parts` theirs.
const numbers = JSON.parse(byId("numbers").textContent);
const { names, wavelengths, absorption, scattering, outside, inside, lights } = numbers;
const samples = wavelengths.length;
const transmitted = (1 - outside) * (1 - inside);
const daylight = lights[0];

const throughSurface = internal => outside + transmitted * internal / (1 - inside * internal);
const beneathSurface = measured => {
  const inner = measured - outside;
  return Math.min(Math.max(inner / (transmitted + inside * inner), 0), 1);
};

// K and S of a mixture of the paints `members` in `parts` (Duncan 1940).
function mixed(members, parts, values, at) {
  let sum = 0;
  let total = 0;
  members.forEach((paint, i) => {
    sum += parts[i] * values[paint][at];
    total += parts[i];
  });
  return sum / total;
}

function opaque(members, parts) {
  const reflectances = new Float64Array(samples);
  for (let at = 0; at < samples; ++at) {
    const K = mixed(members, parts, absorption, at);
    const S = mixed(members, parts, scattering, at);
    reflectances[at] = throughSurface(S / (K + S + Math.sqrt(K * (K + 2 * S))));
  }
  return reflectances;
}

function film(members, parts, thickness, ground) {
  const reflectances = new Float64Array(samples);
  const below = beneathSurface(ground);
  for (let at = 0; at < samples; ++at) {
    const K = mixed(members, parts, absorption, at);
    const S = mixed(members, parts, scattering, at);
    const gamma = Math.sqrt(K * (K + 2 * S));
    const path = gamma * thickness;
    const sine = path > 0 ? -Math.expm1(-2 * path) / (2 * gamma) : thickness;
    const denominator = (K + S) * sine + (1 + Math.exp(-2 * path)) / 2;
    const R = S * sine / denominator;
    const T = Math.exp(-path) / denominator;
    reflectances[at] = throughSurface(R + T * T * below / (1 - R * below));
  }
  return reflectances;
}

const xyzOf = (reflectances, light) => light.xyz.map(row => dot(row, reflectances));
const labOf = reflectances => xyzToLab(xyzOf(reflectances, daylight), daylight.white);
const codesOf = (reflectances, light) =>
  multiply(light.toRgb, xyzOf(reflectances, light)).map(value => Math.round(255 * encode(Math.min(Math.max(value, 0), 1))));
const hexOf = (reflectances, light = daylight) => hexOfCodes(codesOf(reflectances, light));
