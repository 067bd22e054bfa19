// The layers of each picture lie on top of one another: two methods divided by a line, or the map of their difference.
const { balanced } = JSON.parse(byId("numbers").textContent);  // by light, as the switch was left
const form = document.querySelector(".choices");
const [first, second, map, balance] = ["first", "second", "map", "balance"].map(byId);

function choose(event) {
  const light = form.elements.light.value;
  if (event?.target === balance) balanced[light] = balance.checked;
  balance.checked = balanced[light];
  const pair = [first.value, second.value].sort().join("-");
  const original = String(first.options.length - 1);
  const asMap = map.checked && first.value !== second.value && ![first.value, second.value].includes(original);
  for (const view of document.querySelectorAll(".view")) {
    view.classList.toggle("map", asMap);
    for (const layer of view.querySelectorAll("img")) {
      const { shows } = layer.dataset;
      const state = layer.dataset.balanced ?? String(balanced[light]);
      const here = !layer.dataset.light || (layer.dataset.light === light && state === String(balanced[light]));
      layer.classList.toggle("first", here && !asMap && shows === first.value);
      layer.classList.toggle("second", here && !asMap && shows === second.value && shows !== first.value);
      layer.classList.toggle("shown", here && (asMap ? shows === pair : shows === first.value && shows === second.value));
    }
    view.querySelector(".tag.first").textContent = first.selectedOptions[0].textContent;
    view.querySelector(".tag.second").textContent = second.selectedOptions[0].textContent;
    const figure = view.closest("figure");
    figure.querySelector(".split").hidden = asMap;
    figure.querySelector(".scale").hidden = !asMap;
    figure.querySelector(".pair").textContent =
      `ΔE00 between ${first.selectedOptions[0].textContent} and ${second.selectedOptions[0].textContent}`;
  }
}

for (const view of document.querySelectorAll(".view")) {
  const split = view.closest("figure").querySelector(".split");
  const move = () => view.style.setProperty("--split", `${split.value}%`);
  const drag = event => {
    const { left, width } = view.getBoundingClientRect();
    split.value = (100 * (event.clientX - left)) / width;
    move();
  };
  split.addEventListener("input", move);
  onDrag(view, event => view.classList.contains("map") || drag(event));
  move();
}
form.addEventListener("change", choose);
form.addEventListener("submit", event => event.preventDefault());
choose();
ready();
