// Inverse of `pack` of relight_page.py: base64 of deflated byte planes, the first bytes of all numbers before the second ones.
async function unpackBytes(id, width) {
  const text = atob(byId(id).textContent);
  const deflated = Uint8Array.from(text, letter => letter.charCodeAt(0));
  const stream = new Blob([deflated]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const count = planes.length / width;
  const bytes = new Uint8Array(planes.length);
  for (let i = 0; i < count; i++) for (let k = 0; k < width; k++) bytes[i * width + k] = planes[k * count + i];
  return bytes;
}

// Half precision (IEEE 754 binary16), decoded with a table.
async function unpackHalves(id) {
  const decode = code => {
    const [sign, exponent, fraction] = [code >> 15 ? -1 : 1, (code >> 10) & 31, code & 1023];
    return sign * (exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : 2 ** -24 * fraction);
  };
  const table = Float32Array.from({ length: 65536 }, (_, code) => decode(code));
  const bytes = await unpackBytes(id, 2);
  const view = new DataView(bytes.buffer);
  return Float32Array.from({ length: bytes.length / 2 }, (_, i) => table[view.getUint16(2 * i, true)]);
}
// Linear sRGB to display codes (IEC 61966-2-1) with a table; its step is at most a twentieth of an 8-bit code.
const STEPS = 65535;
const CODES = Uint8Array.from({ length: STEPS + 1 }, (_, step) => Math.round(255 * encode(step / STEPS)));
const code = linear => CODES[linear > 0 ? (linear < 1 ? (linear * STEPS + 0.5) | 0 : STEPS) : 0];
const hex = rgb => hexOfCodes(rgb.map(code));
const opaque = (r, g, b) => 0xff000000 | (code(b) << 16) | (code(g) << 8) | code(r);
const BACKGROUND = opaque(0.025, 0.025, 0.025); // under every light, so that black bodies show
const TOLERANCE = 1 / 510;
const outOfRange = linear => linear < -TOLERANCE || linear > 1 + TOLERANCE;
const isClipped = (r, g, b) => outOfRange(r) || outOfRange(g) || outOfRange(b);

// Multiply the m coefficients of every labelled pixel by the 3 × m matrix (row-major). Other pixels do not change.
// Returns the number of clipped pixels.
function light(pixels, labels, matrix, out) {
  const m = matrix.length / 3;
  let clipped = 0;
  for (let p = 0; p < out.length; p++) {
    if (!labels[p]) continue;
    let r = 0, g = 0, b = 0;
    for (let k = 0, at = p * m; k < m; k++, at++) {
      const c = pixels[at];
      r += matrix[k] * c;
      g += matrix[m + k] * c;
      b += matrix[2 * m + k] * c;
    }
    if (isClipped(r, g, b)) clipped++;
    out[p] = opaque(r, g, b);
  }
  return clipped;
}
// Weights of the lights. Positions are on a disc of radius 1 with y pointing down.
const weightedSum = (weights, rows) => rows[0].map((_, k) => dot(weights, rows.map(row => row[k])));

// Positions of the lights on the rim, the first at the top.
function rimPositions(count) {
  const angle = j => (2 * Math.PI * j) / count - Math.PI / 2;
  return Array.from({ length: count }, (_, j) => [Math.cos(angle(j)), Math.sin(angle(j))]);
}

// Shares of the lights at a position by the inverse square of their distance; 1 for a light at the position itself.
function shares([x, y], lights) {
  const squares = lights.map(([u, v]) => (x - u) ** 2 + (y - v) ** 2);
  const here = squares.findIndex(square => square < 1e-12);
  if (here >= 0) return squares.map((_, j) => Number(j === here));
  const total = squares.reduce((inverse, square) => inverse + 1 / square, 0);
  return squares.map(square => 1 / square / total);
}

function clampToDisc([x, y]) {
  const radius = Math.max(1, Math.hypot(x, y));
  return [x / radius, y / radius];
}
// Drawing of the dial and of the spectrum.
const DISC = 84;

// Disc in the colours of white under each mix, scaled to the display; lights around it; handle.
function drawDial(names, white) {
  const positions = rimPositions(names.length);
  const across = 2 * DISC;
  const disc = createSvg("image", { href: discImage(positions, white), x: -DISC, y: -DISC, width: across, height: across });
  const knob = createSvg("g", { id: "handle" }, createSvg("circle", { r: 10 }), createSvg("circle", { r: 3 }));
  const marks = names.map((name, j) => lightMark(name, positions[j], white[j], `share-${j}`));
  byId("dial").append(disc, createSvg("circle", { r: DISC, class: "rim" }), ...marks, knob);
}

function discImage(positions, white) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 2 * DISC;
  const context = canvas.getContext("2d");
  const image = context.createImageData(2 * DISC, 2 * DISC);
  const out = new Uint32Array(image.data.buffer);
  for (let row = 0; row < 2 * DISC; row++)
    for (let column = 0; column < 2 * DISC; column++) {
      const position = [(column + 0.5) / DISC - 1, (row + 0.5) / DISC - 1];
      if (Math.hypot(...position) > 1) continue;
      out[row * 2 * DISC + column] = opaque(...toDisplay(weightedSum(shares(position, positions), white)));
    }
  context.putImageData(image, 0, 0);
  return canvas.toDataURL();
}

const toDisplay = rgb => rgb.map(linear => linear / Math.max(1e-9, ...rgb));

// Name of a light and its share of the mix.
function lightMark(name, [x, y], white, share) {
  const short = name.length > 12 ? name.slice(0, 11) + "…" : name;
  const anchor = Math.abs(x) < 0.3 ? "middle" : x > 0 ? "start" : "end";
  const attributes = { x: x * (DISC + 13), y: y * (DISC + 22) - 1.5, "text-anchor": anchor };
  const spot = createSvg("circle", { cx: x * DISC, cy: y * DISC, r: 7, fill: hex(toDisplay(white)) });
  const below = createSvg("tspan", { id: share, x: attributes.x, dy: 11, class: "share" });
  return createSvg("g", { class: "light-mark" }, createSvg("title", {}, name), spot, createSvg("text", attributes, short, below));
}

function showDial([x, y], text, strongest) {
  byId("handle").setAttribute("transform", `translate(${x * DISC} ${y * DISC})`);
  byId("dial").setAttribute("aria-valuetext", text);
  byId("dial").setAttribute("aria-valuenow", Math.round(100 * strongest));
}

// A line for each light, and an area for their sum. The power of a designed light may be negative where its bounds allow it.
function showSpectrum(wavelengths, power, weights) {
  const parts = power.map((values, j) => values.map(value => weights[j] * value));
  const total = weightedSum(weights, power);
  const low = Math.min(0, ...total);
  const box = { ...CURVE, low, high: Math.max(low + 1e-9, ...total) };
  const { left, right, top, bottom, high } = box;
  const zero = bottom + ((bottom - top) * low) / (high - low);
  byId("zero").setAttribute("d", `M${left} ${zero}H${right}`);
  byId("curve").setAttribute("d", `${curve(wavelengths, total, box)}L${right} ${zero}L${left} ${zero}Z`);
  byId("parts").replaceChildren(...parts.map(values => createSvg("path", { d: curve(wavelengths, values, box) })));
}
// State: position of the dial, sliders of the lights, exposure. Each frame shows the picture for the current state.
const numbers = JSON.parse(byId("numbers").textContent);
const { lights, materials, wavelengths, power, white, colours, toRgb } = numbers;
const positions = rimPositions(lights.length);
const START = positions[numbers.start];
const picture = byId("picture").getContext("2d");
const image = picture.createImageData(picture.canvas.width, picture.canvas.height);
const out = new Uint32Array(image.data.buffer).fill(BACKGROUND);
const [pixels, labels] = await Promise.all([unpackHalves("pixels"), unpackBytes("labels", 1)]);
const gains = lights.map((_, j) => byId(`gain-${j}`));
const exposure = byId("exposure");
let position = START;

const percent = share => `${Math.round(100 * share)} %`;
const weights = () => shares(position, positions).map((share, j) => (share * gains[j].value) / 100);

// One frame: the picture first, then the texts. Exposure scales the display, not the lights.
function show() {
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
  gains.forEach((gain, j) => (byId(`gain-${j}-text`).value = gain.value === "100" ? "full" : percent(gain.value / 100)));
  mix.forEach((weight, j) => (byId(`share-${j}`).textContent = `${percent(weight)} of the mix`));
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

const requestFrame = frameOf(show);

function move(to) {
  position = clampToDisc(to);
  requestFrame();
}

function selectLight(j) {
  gains[j].value = 100;
  move(positions[j]);
}

const dial = byId("dial");
onDrag(dial, event => move(placeIn(dial, event).map(place => place / DISC)));
onKey(dial, (key, arrow, shift) => {
  const step = shift ? 0.2 : 0.02;
  if (arrow) move(position.map((place, axis) => place + step * arrow[axis]));
  else if (key === "0") move([0, 0]);
  else if (key >= "1" && key <= "9" && key <= lights.length) move(positions[key - 1]);
  else return false;
});

for (const slider of [...gains, exposure]) slider.addEventListener("input", requestFrame);
for (const button of document.querySelectorAll("[data-light]"))
  button.addEventListener("click", () => selectLight(Number(button.dataset.light)));
byId("reset").addEventListener("click", () => {
  for (const slider of [...gains, exposure]) slider.value = slider.defaultValue;
  move(START);
});

drawDial(lights, white);
show();
ready();
// Highlighting: pointing at a name dims the other materials in the picture; pointing at the picture shows the name.
const mask = byId("mask").getContext("2d");
const names = [...document.querySelectorAll("[data-material]")];
let pinned = 0;

function highlight(number) {
  const overlay = mask.createImageData(mask.canvas.width, mask.canvas.height);
  const pixels32 = new Uint32Array(overlay.data.buffer);
  if (number) labels.forEach((label, p) => (pixels32[p] = label === number ? 0 : 0xd0202020));
  mask.putImageData(overlay, 0, 0);
  showName(number);
}

function showName(number) {
  names.forEach((button, i) => button.closest("tr").classList.toggle("highlighted", i + 1 === number));
  byId("pointed").textContent = number ? materials[number - 1] : "";
}

names.forEach((button, i) => {
  const row = button.closest("tr");
  row.addEventListener("pointerenter", () => highlight(i + 1));
  row.addEventListener("pointerleave", () => highlight(pinned));
  button.addEventListener("click", () => {
    pinned = pinned === i + 1 ? 0 : i + 1;
    names.forEach((other, j) => other.setAttribute("aria-pressed", j + 1 === pinned));
    highlight(pinned);
  });
});

const view = byId("mask");
view.addEventListener("pointermove", ({ offsetX, offsetY }) => {
  const column = Math.floor((offsetX * view.width) / view.clientWidth);
  const row = Math.floor((offsetY * view.height) / view.clientHeight);
  showName(labels[Math.min(row, view.height - 1) * view.width + Math.min(column, view.width - 1)] || pinned);
});
view.addEventListener("pointerleave", () => showName(pinned));
