// Drawing of the dial and of the spectrum.
const DISC = 84;
const SPECTRUM = { left: 8, right: 312, top: 4, bottom: 78 };
const byId = id => document.getElementById(id);

function createSvg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

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

// Axis and ticks. `showSpectrum` adds a line for each light and an area for their sum.
function drawSpectrum(wavelengths) {
  const { left, right, bottom } = SPECTRUM;
  const [first, last] = [wavelengths[0], wavelengths.at(-1)];
  const toX = nm => left + ((right - left) * (nm - first)) / (last - first);
  const ticks = [400, 500, 600, 700].filter(nm => nm >= first && nm <= last);
  const label = nm => (nm === ticks[0] ? `${nm} nm` : nm);
  const marks = ticks.map(nm => createSvg("text", { x: toX(nm), y: bottom + 14, "text-anchor": "middle" }, label(nm)));
  const lines = ticks.map(nm => createSvg("path", { d: `M${toX(nm)} ${bottom}v4`, class: "axis" }));
  const axis = createSvg("path", { id: "zero", class: "axis" });
  byId("spectrum").append(createSvg("path", { id: "total" }), createSvg("g", { id: "parts" }), axis, ...lines, ...marks);
}

// The power of a designed light may be negative where its bounds allow it.
function showSpectrum(wavelengths, power, weights) {
  const { left, right, top, bottom } = SPECTRUM;
  const parts = power.map((values, j) => values.map(value => weights[j] * value));
  const total = weightedSum(weights, power);
  const lowest = Math.min(0, ...total);
  const step = (right - left) / (wavelengths.at(-1) - wavelengths[0]);
  const scale = (bottom - top) / Math.max(Math.max(...total) - lowest, 1e-9);
  const toX = nm => (left + step * (nm - wavelengths[0])).toFixed(1);
  const toY = value => (bottom - scale * (value - lowest)).toFixed(1);
  const line = values => "M" + values.map((value, i) => `${toX(wavelengths[i])} ${toY(value)}`).join("L");
  byId("zero").setAttribute("d", `M${left} ${toY(0)}H${right}`);
  byId("total").setAttribute("d", `${line(total)}L${right} ${toY(0)}L${left} ${toY(0)}Z`);
  byId("parts").replaceChildren(...parts.map(values => createSvg("path", { d: line(values) })));
}
