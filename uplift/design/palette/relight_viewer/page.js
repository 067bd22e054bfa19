// Hands set where the dial stands, the lights' sliders and exposure; a frame shows what follows from them.
const numbers = JSON.parse(byId("numbers").textContent);
const { lights, materials, wavelengths, power, white, colours, toRgb } = numbers;
const stands = places(lights.length);
const START = stands[0];
const picture = byId("picture").getContext("2d");
const image = picture.createImageData(picture.canvas.width, picture.canvas.height);
const out = new Uint32Array(image.data.buffer).fill(opaque(0, 0, 0));
const [pixels, labels] = await Promise.all([unpackedHalves("pixels"), unpacked("labels", 1)]);
const gains = lights.map((_, j) => byId(`gain-${j}`));
const exposure = byId("exposure");
let position = START;
let due = 0;

const percent = share => `${Math.round(100 * share)} %`;
const weights = () => shares(position, stands).map((share, j) => (share * gains[j].value) / 100);

// One frame: the picture first, then what tells of it. Exposure is of the screen, not of the light.
function show() {
  due = 0;
  const mix = weights();
  const stops = 2 ** exposure.value;
  const lamp = sum(mix, numbers.light);
  const matrix = Float64Array.from(toRgb.flatMap(row => row.map((value, k) => stops * value * lamp[k])));
  const clipped = light(pixels, labels, matrix, out);
  picture.putImageData(image, 0, 0);
  tell(mix, clipped);
  showPatches(mix, lamp, stops);
  showSpectrum(wavelengths, power, mix);
}

function tell(mix, clipped) {
  showDial(position, lights.map((name, j) => `${name} ${percent(mix[j])}`).join(", "), Math.max(...mix));
  mix.forEach((weight, j) => (byId(`gain-${j}-told`).value = percent(weight)));
  byId("exposure-told").value = `${exposure.value > 0 ? "+" : ""}${Number(exposure.value).toFixed(2)} EV`;
  const share = (100 * clipped) / out.length;
  byId("clipped").textContent = clipped ? `Clipped: ${Math.max(share, 0.1).toFixed(1)} % of the picture` : "";
}

function showPatches(mix, lamp, stops) {
  const bright = rgb => rgb.map(linear => stops * linear);
  patch("white", bright(sum(mix, white)));
  materials.forEach((_, i) => {
    const factor = times(toRgb, lamp.map((value, k) => value * numbers.material[i][k]));
    patch(i, bright(sum(mix, colours[i])), bright(factor));
  });
}

function patch(name, ...halves) {
  const told = halves.map(hex);
  const parts = told.map(colour => Object.assign(document.createElement("i"), { style: `background:${colour}` }));
  byId(`mixed-${name}`).replaceChildren(...parts);
  const marks = halves.map((rgb, half) => told[half] + (beyond(...rgb) ? " clipped" : ""));
  byId(`mixed-${name}-told`).textContent = [...new Set(marks)].join(" | ");
}

function soon() {
  due ||= requestAnimationFrame(show);
}

function move(to) {
  position = onDisc(to);
  soon();
}

function alone(j) {
  gains[j].value = 100;
  move(stands[j]);
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

const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
dial.addEventListener("keydown", event => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const way = WAYS[event.key];
  const step = event.shiftKey ? 0.2 : 0.02;
  if (way) move([position[0] + step * way[0], position[1] + step * way[1]]);
  else if (event.key === "0") move([0, 0]);
  else if (event.key >= "1" && event.key <= "9" && event.key <= lights.length) move(stands[event.key - 1]);
  else return;
  event.preventDefault();
});

for (const slider of [...gains, exposure]) slider.addEventListener("input", soon);
for (const button of document.querySelectorAll("[data-light]"))
  button.addEventListener("click", () => alone(Number(button.dataset.light)));
byId("reset").addEventListener("click", () => {
  for (const slider of [...gains, exposure]) slider.value = slider.defaultValue;
  move(START);
});

drawDial(lights, white);
drawSpectrum(wavelengths);
show();
document.querySelector("main").setAttribute("aria-busy", "false");
