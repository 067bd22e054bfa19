// The drawn parts: the dial and the spectrum. Both are given what to show, and know nothing of how it came about.
const DISC = 84;
const SPECTRUM = { left: 8, right: 312, top: 4, bottom: 78 };
const byId = id => document.getElementById(id);

function drawn(tag, attributes, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

// The disc in the colours that white has there, brought to the screen's white; the lights around it; the handle.
function drawDial(names, white) {
  const stands = places(names.length);
  const across = 2 * DISC;
  const disc = drawn("image", { href: discImage(stands, white), x: -DISC, y: -DISC, width: across, height: across });
  const knob = drawn("g", { id: "handle" }, drawn("circle", { r: 10 }), drawn("circle", { r: 3 }));
  const marks = names.map((name, j) => stand(name, stands[j], white[j]));
  byId("dial").append(disc, drawn("circle", { r: DISC, class: "rim" }), ...marks, knob);
}

function discImage(stands, white) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 2 * DISC;
  const context = canvas.getContext("2d");
  const image = context.createImageData(2 * DISC, 2 * DISC);
  const out = new Uint32Array(image.data.buffer);
  for (let row = 0; row < 2 * DISC; row++)
    for (let column = 0; column < 2 * DISC; column++) {
      const position = [(column + 0.5) / DISC - 1, (row + 0.5) / DISC - 1];
      if (Math.hypot(...position) > 1) continue;
      out[row * 2 * DISC + column] = opaque(...onScreen(sum(shares(position, stands), white)));
    }
  context.putImageData(image, 0, 0);
  return canvas.toDataURL();
}

const onScreen = rgb => rgb.map(linear => linear / Math.max(1e-9, ...rgb));

function stand(name, [x, y], white) {
  const short = name.length > 12 ? name.slice(0, 11) + "…" : name;
  const anchor = Math.abs(x) < 0.3 ? "middle" : x > 0 ? "start" : "end";
  const words = { x: x * (DISC + 13), y: y * (DISC + 18) + 3.5, "text-anchor": anchor };
  const spot = drawn("circle", { cx: x * DISC, cy: y * DISC, r: 7, fill: hex(onScreen(white)) });
  return drawn("g", { class: "stand" }, drawn("title", {}, name), spot, drawn("text", words, short));
}

function showDial([x, y], told, strongest) {
  byId("handle").setAttribute("transform", `translate(${x * DISC} ${y * DISC})`);
  byId("dial").setAttribute("aria-valuetext", told);
  byId("dial").setAttribute("aria-valuenow", Math.round(100 * strongest));
}

// Axis and ticks; then, at every change, the lights' parts as lines and their sum as an area.
function drawSpectrum(wavelengths) {
  const { left, right, bottom } = SPECTRUM;
  const [first, last] = [wavelengths[0], wavelengths.at(-1)];
  const place = nm => left + ((right - left) * (nm - first)) / (last - first);
  const ticks = [400, 500, 600, 700].filter(nm => nm >= first && nm <= last);
  const words = nm => (nm === ticks[0] ? `${nm} nm` : nm);
  const marks = ticks.map(nm => drawn("text", { x: place(nm), y: bottom + 14, "text-anchor": "middle" }, words(nm)));
  const lines = ticks.map(nm => drawn("path", { d: `M${place(nm)} ${bottom}v4`, class: "axis" }));
  const axis = drawn("path", { id: "zero", class: "axis" });
  byId("spectrum").append(drawn("path", { id: "total" }), drawn("g", { id: "parts" }), axis, ...lines, ...marks);
}

// A designed light may have less than no power somewhere, if its palette lets it.
function showSpectrum(wavelengths, power, weights) {
  const { left, right, top, bottom } = SPECTRUM;
  const parts = power.map((values, j) => values.map(value => weights[j] * value));
  const total = sum(weights, power);
  const least = Math.min(0, ...total);
  const step = (right - left) / (wavelengths.at(-1) - wavelengths[0]);
  const slope = (bottom - top) / Math.max(Math.max(...total) - least, 1e-9);
  const across = nm => (left + step * (nm - wavelengths[0])).toFixed(1);
  const up = value => (bottom - slope * (value - least)).toFixed(1);
  const line = values => "M" + values.map((value, i) => `${across(wavelengths[i])} ${up(value)}`).join("L");
  byId("zero").setAttribute("d", `M${left} ${up(0)}H${right}`);
  byId("total").setAttribute("d", `${line(total)}L${right} ${up(0)}L${left} ${up(0)}Z`);
  byId("parts").replaceChildren(...parts.map(values => drawn("path", { d: line(values) })));
}
