// Functions that pages share: elements, vectors, encoded sRGB (IEC 61966-2-1) of linear values, curves, pointers and keys.
const byId = id => document.getElementById(id);
const dot = (first, second) => first.reduce((sum, value, i) => sum + value * second[i], 0);
const multiply = (matrix, vector) => matrix.map(row => dot(row, vector));
const encode = linear => (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
const decode = code => (code <= 0.04045 ? code / 12.92 : ((code + 0.055) / 1.055) ** 2.4);
const hexOfCodes = codes => "#" + codes.map(code => code.toString(16).padStart(2, "0")).join("");
const ready = () => document.querySelector("main").setAttribute("aria-busy", "false");

function createSvg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

// The path of values from `low` to `high` over wavelengths, in a box of the plot.
const CURVE = { left: 8, right: 312, top: 8, bottom: 104, low: 0, high: 1 };
function curve(wavelengths, values, { left, right, top, bottom, low, high } = CURVE) {
  const step = (right - left) / (wavelengths.at(-1) - wavelengths[0]);
  const scale = (bottom - top) / (high - low);
  const points = Array.from(values, (value, i) => [left + step * (wavelengths[i] - wavelengths[0]), bottom - scale * (value - low)]);
  return `M${points.map(point => point.map(place => place.toFixed(1)).join(" ")).join("L")}`;
}

// Call `follow` where a pointer is pressed, and while it moves until it is released.
function onDrag(element, follow) {
  element.addEventListener("pointerdown", event => {
    element.setPointerCapture(event.pointerId);
    follow(event);
  });
  element.addEventListener("pointermove", event => {
    if (element.hasPointerCapture(event.pointerId)) follow(event);
  });
}

// Place of a pointer in the coordinates of a plot.
function placeIn(plot, event) {
  const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(plot.getScreenCTM().inverse());
  return [x, y];
}

// Call `press(key, arrow, shift)`, whose arrow points right and down, for each key; it returns false for keys of no use.
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
function onKey(element, press) {
  element.addEventListener("keydown", event => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (press(event.key, ARROWS[event.key], event.shiftKey) !== false) event.preventDefault();
  });
}

// At most one call of `show` for each frame.
function frameOf(show) {
  let frame = 0;
  const next = () => {
    frame = 0;
    show();
  };
  return () => (frame ||= requestAnimationFrame(next));
}
