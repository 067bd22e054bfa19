// A page of paint: tubes with sliders, the mixture, and the recipes of a colour.
const sliders = names.map((_, paint) => byId(`parts-${paint}`));
const outputs = sliders.map(slider => slider.nextElementSibling);

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
  byId("curve").setAttribute("d", curve(wavelengths, reflectances));
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

function findRecipes() {
  const code = byId("target").value;
  const linear = [1, 3, 5].map(i => decode(parseInt(code.slice(i, i + 2), 16) / 255));
  const goal = xyzToLab(multiply(numbers.toXyz, linear), daylight.white);
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

for (const slider of [...sliders, byId("thickness")]) slider.addEventListener("input", drawMixture);
byId("clear").addEventListener("click", () => squeeze([0], [1]));
byId("target").addEventListener("input", findRecipes);
byId("count").addEventListener("change", findRecipes);
squeeze(names.length > 2 ? [0, 1, 2] : [0], names.length > 2 ? [4, 2, 1] : [1]);
findRecipes();
ready();
