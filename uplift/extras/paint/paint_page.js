// Mixtures of measured paints by Kubelka and Munk, and the recipes of a colour, in the browser.
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
const labOf = reflectances => toLab(xyzOf(reflectances, daylight), daylight.white);
const codesOf = (reflectances, light) =>
  multiply(light.toRgb, xyzOf(reflectances, light)).map(value => Math.round(255 * encode(Math.min(Math.max(value, 0), 1))));
const hexOf = (reflectances, light = daylight) => hexOfCodes(codesOf(reflectances, light));

// --- the palette ---

const sliders = names.map((_, paint) => byId(`parts-${paint}`));
const outputs = sliders.map(slider => slider.nextElementSibling);

function drawSpectrum(reflectances) {
  const x = at => 24 + 290 * at / (samples - 1);
  const y = value => 104 - 96 * Math.min(value, 1);
  const points = [...reflectances].map((value, at) => `${x(at).toFixed(1)},${y(value).toFixed(1)}`);
  const lines = [0, 0.5, 1].flatMap(value => [
    createSvg("line", { x1: 24, x2: 314, y1: y(value), y2: y(value) }),
    createSvg("text", { x: 20, y: y(value) + 3, "text-anchor": "end" }, String(value)),
  ]);
  const labels = [400, 500, 600, 700].map(nm =>
    createSvg("text", { x: 24 + 290 * (nm - 400) / 300, y: 116, "text-anchor": "middle" }, String(nm)));
  byId("spectrum").replaceChildren(...lines, ...labels, createSvg("path", { d: `M${points.join("L")}` }));
}

function drawMixture() {
  const parts = sliders.map(slider => Number(slider.value));
  outputs.forEach((output, paint) => { output.textContent = parts[paint]; });
  const members = parts.map((_, paint) => paint).filter(paint => parts[paint] > 0);
  if (!members.length) {
    sliders[0].value = 1;
    drawMixture();
    return;
  }
  const used = members.map(paint => parts[paint]);
  const reflectances = opaque(members, used);
  byId("mixture").style.background = hexOf(reflectances);
  byId("code").textContent = hexOf(reflectances);
  byId("recipe").textContent = members.map((paint, i) => `${used[i]} ${names[paint]}`).join(" + ");
  for (const patch of document.querySelectorAll("[data-light]"))
    patch.style.background = hexOf(reflectances, lights[patch.dataset.light]);
  drawSpectrum(reflectances);
  const middle = samples >> 1;
  const hiding = 1 / (mixed(members, used, absorption, middle) + mixed(members, used, scattering, middle));
  const thickness = hiding * Math.exp(Number(byId("thickness").value));
  byId("on-white").style.background = hexOf(film(members, used, thickness, 1));
  byId("on-black").style.background = hexOf(film(members, used, thickness, 0));
}

function squeeze(members, parts) {
  sliders.forEach(slider => { slider.value = 0; });
  const largest = Math.max(...parts);
  members.forEach((paint, i) => {
    sliders[paint].max = Math.max(20, largest);
    sliders[paint].value = parts[i];
  });
  drawMixture();
}

// --- recipes ---

const LEVELS = [-5, -3.5, -2, -1, 0, 1, 2, 3.5, 5];
const FOLLOWED = 24;
const SHOWN = 5;
const MOST_PARTS = 40;

function* setsOf(count, first = 0) {
  if (!count) yield [];
  else for (let paint = first; paint < names.length; ++paint)
    for (const others of setsOf(count - 1, paint + 1)) yield [paint, ...others];
}

const partsOf = ratios => [1, ...ratios.map(Math.exp)];
const errorOf = (members, ratios, goal) => deltaE(labOf(opaque(members, partsOf(ratios))), goal);

// The best of a grid of logarithms of ratios to the first paint.
function start(members, goal) {
  let best = { error: Infinity };
  const grid = members.slice(1).reduce((rows, _) => rows.flatMap(row => LEVELS.map(level => [...row, level])), [[]]);
  for (const ratios of grid) {
    const error = errorOf(members, ratios, goal);
    if (error < best.error) best = { members, ratios, error };
  }
  return best;
}

// Pattern search: the step halves where no neighbour is better.
function follow({ members, ratios, error }, goal) {
  for (let step = 0.8; step > 0.004;) {
    let isBetter = false;
    for (let i = 0; i < ratios.length; ++i) for (const sign of [-1, 1]) {
      const trial = ratios.with(i, ratios[i] + sign * step);
      const changed = errorOf(members, trial, goal);
      if (changed < error) [ratios, error, isBetter] = [trial, changed, true];
    }
    if (!isBetter) step /= 2;
  }
  return { members, ratios, error };
}

// The fewest whole parts that are nearly as good as any.
function whole({ members, ratios }, goal) {
  const shares = partsOf(ratios);
  const sum = shares.reduce((total, share) => total + share);
  let best = { error: Infinity };
  for (let total = 1; total <= MOST_PARTS; ++total) {
    const parts = shares.map(share => Math.round(total * share / sum));
    const kept = members.filter((_, i) => parts[i]);
    const counts = parts.filter(Boolean);
    if (!kept.length) continue;
    const error = deltaE(labOf(opaque(kept, counts)), goal);
    if (error < best.error - 0.1) best = { members: kept, parts: counts, error };
  }
  return best;
}

function findRecipes() {
  const code = byId("target").value;
  const linear = [1, 3, 5].map(i => parseInt(code.slice(i, i + 2), 16) / 255)
    .map(value => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4));
  const goal = toLab(multiply(inverse(daylight.toRgb), linear), daylight.white);
  const count = Math.min(Number(byId("count").value), names.length);
  const sizes = Array.from({ length: count }, (_, i) => i + 1);
  const starts = sizes.flatMap(size => [...setsOf(size)]).map(members => start(members, goal));
  const nearest = starts.sort((a, b) => a.error - b.error).slice(0, FOLLOWED);
  const found = nearest.map(recipe => whole(follow(recipe, goal), goal)).sort((a, b) => a.error - b.error);
  const keys = found.map(recipe => recipe.members.join());
  const distinct = found.filter((_, i) => keys.indexOf(keys[i]) === i).slice(0, SHOWN);
  byId("recipes").replaceChildren(...distinct.map(recipeItem));
  const error = distinct[0].error;
  byId("reach").textContent = error > 1
    ? `No mixture of ${count === 1 ? "one paint" : `${count} paints`} reaches the colour; the nearest differs by ${error.toFixed(1)}.`
    : "Click a recipe to squeeze it onto the palette.";
}

function recipeItem({ members, parts, error }) {
  const item = document.createElement("li");
  const button = document.createElement("button");
  button.type = "button";
  const patch = document.createElement("i");
  patch.style.background = hexOf(opaque(members, parts));
  const order = members.map((_, i) => i).sort((a, b) => parts[b] - parts[a]);
  const text = document.createElement("span");
  text.textContent = order.map(i => `${parts[i]} ${names[members[i]]}`).join(" + ");
  const difference = document.createElement("span");
  difference.textContent = `ΔE ${error.toFixed(2)}`;
  button.append(patch, text, difference);
  button.addEventListener("click", () => squeeze(members, parts));
  item.append(button);
  return item;
}

function inverse([[a, b, c], [d, e, f], [g, h, i]]) {
  const determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
  const rows = [
    [e * i - f * h, c * h - b * i, b * f - c * e],
    [f * g - d * i, a * i - c * g, c * d - a * f],
    [d * h - e * g, b * g - a * h, a * e - b * d],
  ];
  return rows.map(row => row.map(value => value / determinant));
}

for (const slider of [...sliders, byId("thickness")]) slider.addEventListener("input", drawMixture);
byId("clear").addEventListener("click", () => squeeze([0], [1]));
byId("target").addEventListener("input", findRecipes);
byId("count").addEventListener("change", findRecipes);
squeeze(names.length > 2 ? [0, 1, 2] : [0], names.length > 2 ? [4, 2, 1] : [1]);
findRecipes();
