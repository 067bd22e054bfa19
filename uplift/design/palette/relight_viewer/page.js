// State: position of the dial, sliders of the lights, exposure. Each frame shows the picture for the current state.
const numbers = JSON.parse(byId("numbers").textContent);
const { lights, materials, wavelengths, power, white, colours, toRgb } = numbers;
const positions = rimPositions(lights.length);
const START = positions[numbers.start];
const picture = byId("picture").getContext("2d");
const image = picture.createImageData(picture.canvas.width, picture.canvas.height);
const out = new Uint32Array(image.data.buffer).fill(opaque(0, 0, 0));
const [pixels, labels] = await Promise.all([unpackHalves("pixels"), unpackBytes("labels", 1)]);
const gains = lights.map((_, j) => byId(`gain-${j}`));
const exposure = byId("exposure");
let position = START;
let frame = 0;

const percent = share => `${Math.round(100 * share)} %`;
const weights = () => shares(position, positions).map((share, j) => (share * gains[j].value) / 100);

// One frame: the picture first, then the texts. Exposure scales the display, not the lights.
function show() {
  frame = 0;
  const mix = weights();
  const stops = 2 ** exposure.value;
  const source = weightedSum(mix, numbers.light);
  const matrix = Float64Array.from(toRgb.flatMap(row => row.map((value, k) => stops * value * source[k])));
  const clipped = light(pixels, labels, matrix, out);
  picture.putImageData(image, 0, 0);
  showTexts(mix, clipped);
  showPatches(mix, source, stops);
  showSpectrum(wavelengths, power, mix);
}

function showTexts(mix, clipped) {
  showDial(position, lights.map((name, j) => `${name} ${percent(mix[j])}`).join(", "), Math.max(...mix));
  gains.forEach((gain, j) => (byId(`gain-${j}-text`).value = percent(gain.value / 100)));
  mix.forEach((weight, j) => (byId(`share-${j}`).textContent = percent(weight)));
  byId("exposure-text").value = `${exposure.value > 0 ? "+" : ""}${Number(exposure.value).toFixed(2)} EV`;
  const share = (100 * clipped) / out.length;
  byId("clipped").textContent = clipped ? `Clipped: ${Math.max(share, 0.1).toFixed(1)} % of the picture` : "";
}

function showPatches(mix, source, stops) {
  const expose = rgb => rgb.map(linear => stops * linear);
  patch("white", expose(weightedSum(mix, white)));
  materials.forEach((_, i) => {
    const factor = multiply(toRgb, source.map((value, k) => value * numbers.material[i][k]));
    patch(i, expose(weightedSum(mix, colours[i])), expose(factor));
  });
}

function patch(name, ...halves) {
  const codes = halves.map(hex);
  const parts = codes.map(colour => Object.assign(document.createElement("i"), { style: `background:${colour}` }));
  byId(`mixed-${name}`).replaceChildren(...parts);
  const texts = halves.map((rgb, half) => codes[half] + (isClipped(...rgb) ? " clipped" : ""));
  byId(`mixed-${name}-text`).textContent = [...new Set(texts)].join(" | ");
}

function requestFrame() {
  frame ||= requestAnimationFrame(show);
}

function move(to) {
  position = clampToDisc(to);
  requestFrame();
}

function selectLight(j) {
  gains[j].value = 100;
  move(positions[j]);
}

const dial = byId("dial");
function follow(event) {
  const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(dial.getScreenCTM().inverse());
  move([point.x / DISC, point.y / DISC]);
}
dial.addEventListener("pointerdown", event => {
  dial.setPointerCapture(event.pointerId);
  follow(event);
});
dial.addEventListener("pointermove", event => {
  if (dial.hasPointerCapture(event.pointerId)) follow(event);
});

const DIRECTIONS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
dial.addEventListener("keydown", event => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const direction = DIRECTIONS[event.key];
  const step = event.shiftKey ? 0.2 : 0.02;
  if (direction) move([position[0] + step * direction[0], position[1] + step * direction[1]]);
  else if (event.key === "0") move([0, 0]);
  else if (event.key >= "1" && event.key <= "9" && event.key <= lights.length) move(positions[event.key - 1]);
  else return;
  event.preventDefault();
});

for (const slider of [...gains, exposure]) slider.addEventListener("input", requestFrame);
for (const button of document.querySelectorAll("[data-light]"))
  button.addEventListener("click", () => selectLight(Number(button.dataset.light)));
byId("reset").addEventListener("click", () => {
  for (const slider of [...gains, exposure]) slider.value = slider.defaultValue;
  move(START);
});

drawDial(lights, white);
drawSpectrum(wavelengths);
show();
document.querySelector("main").setAttribute("aria-busy", "false");
