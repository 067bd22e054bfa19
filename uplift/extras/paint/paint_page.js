// A page of paint: tubes with sliders, the mixture, and the recipes of a colour.
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

const decode = code => (code <= 0.04045 ? code / 12.92 : ((code + 0.055) / 1.055) ** 2.4);

function findRecipes() {
  const code = byId("target").value;
  const linear = [1, 3, 5].map(i => decode(parseInt(code.slice(i, i + 2), 16) / 255));
  const goal = toLab(multiply(inverse(daylight.toRgb), linear), daylight.white);
  const count = Math.min(Number(byId("count").value), names.length);
  const found = recipesFor(goal, count);
  byId("recipes").replaceChildren(...found.map(recipeItem));
  const error = found[0].error;
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
