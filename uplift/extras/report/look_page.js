// Colours of reflectances, as uplift/colorimetry computes them.
// Rows of the derivative of a* and b* with respect to XYZ.
function slopesOfAb(xyz, white) {
  const [x, y, z] = xyz.map((value, k) => 1 / (3 * Math.cbrt(Math.max(value / white[k], (6 / 29) ** 3)) ** 2 * white[k]));
  return [[500 * x, -500 * y, 0], [0, 200 * y, -200 * z]];
}

const labOf = (light, reflectance) => xyzToLab(multiply(light.xyz, reflectance), light.white);
const linearRgb = (light, xyz) => multiply(light.toRgb, xyz);
const isInGamut = rgb => rgb.every(value => value >= -1e-9 && value <= 1 + 1e-9);

// Move linear sRGB toward the grey of its luminance until it can be displayed.
function desaturate(rgb, luminance) {
  const grey = Math.min(Math.max(dot(rgb, luminance), 0), 1);
  const low = Math.min(...rgb);
  const high = Math.max(...rgb);
  const kept = Math.min(low < 0 ? grey / (grey - low) : 1, high > 1 ? (1 - grey) / (high - grey) : 1);
  return rgb.map(value => Math.min(Math.max(grey + kept * (value - grey), 0), 1));
}

const toCodes = (rgb, luminance) => desaturate(rgb, luminance).map(value => Math.round(255 * encode(value)));
// Spectra 1 / (1 + exp(−x − B q)), where x is that of the cube's answer. The solver moves q, in the metric of least
// change, to goals for a* and b* under some lights, and keeps the RGB.
const RGB_WEIGHT = 300; // a residual of linear RGB counts as much as this one of a* or b*
const TOLERANCE = 1e-3; // of weighted residuals
const MAX_STEPS = 60;
const MAX_CHANGE = 4; // of x + B q in one step
const FIRST_DAMPING = 1e-6;
const MAX_RGB_ERROR = 1e-5;
const STAGES = 6; // between the answer and goals that are not reached at once

const logistic = x => 1 / (1 + Math.exp(-x));
const argumentsOf = (model, q) => model.start.map((x, i) => x + dot(model.basis[i], q));
const reflectanceOf = (model, q) => argumentsOf(model, q).map(logistic);

// Weighted residuals, and rows of weights over the wavelengths whose products with the slopes are their derivatives.
function equations(model, goals, reflectance) {
  const rgb = multiply(model.sensor, reflectance);
  const off = model.target.map((value, k) => RGB_WEIGHT * (value - rgb[k]));
  const rows = model.sensor.map(row => row.map(value => RGB_WEIGHT * value));
  for (const { light, goal } of goals) {
    const xyz = multiply(light.xyz, reflectance);
    const [, a, b] = xyzToLab(xyz, light.white);
    off.push(goal[0] - a, goal[1] - b);
    for (const slopes of slopesOfAb(xyz, light.white))
      rows.push(light.xyz[0].map((_, i) => slopes[0] * light.xyz[0][i] + slopes[1] * light.xyz[1][i] + slopes[2] * light.xyz[2][i]));
  }
  return { off, rows };
}

function jacobian(model, rows, reflectance, count) {
  const slope = reflectance.map(value => value * (1 - value));
  return rows.map(row => {
    const found = new Array(count).fill(0);
    row.forEach((weight, i) => {
      const factor = weight * slope[i];
      model.basis[i].forEach((value, c) => (found[c] += factor * value));
    });
    return found;
  });
}

// Solve (A + shift I) y = b for symmetric positive A by L D Lᵀ. Pivots are kept positive: a step may be long, never NaN.
function solve(matrix, shift, right) {
  const n = right.length;
  const floor = 1e-22 * matrix.reduce((sum, row, i) => sum + row[i], 0) + 1e-300;
  const lower = matrix.map(row => row.slice());
  const pivots = new Array(n);
  for (let j = 0; j < n; j++) {
    let pivot = matrix[j][j] + shift;
    for (let k = 0; k < j; k++) pivot -= lower[j][k] ** 2 * pivots[k];
    pivots[j] = Math.max(pivot, floor);
    for (let i = j + 1; i < n; i++) {
      let value = matrix[i][j];
      for (let k = 0; k < j; k++) value -= lower[i][k] * lower[j][k] * pivots[k];
      lower[i][j] = value / pivots[j];
    }
  }
  const y = right.slice();
  for (let i = 0; i < n; i++) for (let k = 0; k < i; k++) y[i] -= lower[i][k] * y[k];
  for (let i = 0; i < n; i++) y[i] /= pivots[i];
  for (let i = n - 1; i >= 0; i--) for (let k = i + 1; k < n; k++) y[i] -= lower[k][i] * y[k];
  return y;
}

// Of all changes that cancel the residuals to first order, the smallest. Rows are scaled to length 1 for the damping.
function leastChange(rows, off, damping) {
  const scales = rows.map(row => 1 / Math.sqrt(dot(row, row) + 1e-30));
  const scaled = rows.map((row, i) => row.map(value => value * scales[i]));
  const gram = scaled.map(first => scaled.map(second => dot(first, second)));
  const y = solve(gram, damping, off.map((value, i) => value * scales[i]));
  return rows[0].map((_, c) => scaled.reduce((sum, row, i) => sum + row[c] * y[i], 0));
}

// Steps from q until the residuals are small. A step is taken if it reduces them.
function descend(model, goals, start, tolerance = TOLERANCE) {
  let q = start;
  let reflectance = reflectanceOf(model, q);
  let { off, rows } = equations(model, goals, reflectance);
  let damping = FIRST_DAMPING;
  for (let step = 0; step < MAX_STEPS && Math.max(...off.map(Math.abs)) > tolerance; step++) {
    const change = leastChange(jacobian(model, rows, reflectance, q.length), off, damping);
    const largest = Math.max(...model.basis.map(row => Math.abs(dot(row, change))));
    const trial = q.map((value, c) => value + change[c] * Math.min(1, MAX_CHANGE / largest));
    const trialReflectance = reflectanceOf(model, trial);
    const next = equations(model, goals, trialReflectance);
    if (dot(next.off, next.off) < dot(off, off)) {
      q = trial;
      reflectance = trialReflectance;
      ({ off, rows } = next);
      damping = Math.max(damping / 4, 1e-12);
    } else damping *= 4;
  }
  return { q, size: Math.sqrt(dot(off, off)) };
}

const rgbError = (model, q) => {
  const rgb = multiply(model.sensor, reflectanceOf(model, q));
  return Math.max(...rgb.map((value, k) => Math.abs(value - model.target[k])));
};

// q for the goals, in one go from the answer or, if they are not reached, in stages. It depends on nothing but the goals.
// The RGB has priority: without it, the answer stays.
function solveGoals(model, goals) {
  const zero = model.basis[0].map(() => 0);
  let best = descend(model, goals, zero);
  if (best.size > 0.1) {
    const answer = reflectanceOf(model, zero);
    const from = goals.map(({ light }) => labOf(light, answer).slice(1));
    let q = zero;
    for (let stage = 1; stage <= STAGES; stage++) {
      const between = goals.map(({ light, goal }, k) => ({ light, goal: goal.map((value, axis) => from[k][axis] + (stage / STAGES) * (value - from[k][axis])) }));
      const found = descend(model, between, q);
      q = found.q;
      if (stage === STAGES && found.size < best.size) best = found;
    }
  }
  const { q } = descend(model, [], best.q, 1e-6);
  return rgbError(model, q) <= MAX_RGB_ERROR ? q : zero;
}
// Drawing of the regions in a* and b*, and of the spectrum.
const PLOT = { left: 38, right: 294, top: 6, bottom: 262 };
const PIXELS = 96;
const MIN_EXTENT = 5;
const NEARLY = 0.999;

// A square of a* and b* around the region, and its map to the plot.
function scaleOf(points) {
  const low = [0, 1].map(axis => Math.min(...points.map(point => point[axis])));
  const high = [0, 1].map(axis => Math.max(...points.map(point => point[axis])));
  const half = Math.max(0.56 * Math.max(high[0] - low[0], high[1] - low[1]), MIN_EXTENT / 2);
  const middle = [0, 1].map(axis => (low[axis] + high[axis]) / 2);
  const unit = (PLOT.right - PLOT.left) / (2 * half);
  return {
    half,
    middle,
    toPlot: ([a, b]) => [PLOT.left + unit * (a - middle[0] + half), PLOT.bottom - unit * (b - middle[1] + half)],
    toAb: ([x, y]) => [(x - PLOT.left) / unit + middle[0] - half, (PLOT.bottom - y) / unit + middle[1] - half],
  };
}

const pathOf = points => points.map(point => point.map(value => value.toFixed(2)).join(" ")).join("L");

function drawRegion(number, light, scale, answer, luminance) {
  const outline = `M${pathOf(light.region.map(scale.toPlot))}Z`;
  const clip = createSvg("clipPath", { id: `clip-${number}` }, createSvg("path", { d: outline }));
  const side = PLOT.right - PLOT.left;
  const box = { x: PLOT.left, y: PLOT.top, width: side, height: side };
  const colours = createSvg("image", { ...box, href: colourImage(light, scale, answer[0], luminance), "clip-path": `url(#clip-${number})` });
  const parts = [clip, ...drawAxes(scale), colours, createSvg("path", { d: outline, class: "outline" })];
  if (light.likely) parts.push(createSvg("path", { d: `M${pathOf(light.likely.map(scale.toPlot))}Z`, class: "likely" }));
  const [x, y] = scale.toPlot(answer.slice(1));
  parts.push(createSvg("path", { d: `M${x - 5} ${y}h10M${x} ${y - 5}v10`, class: "answer" }));
  parts.push(createSvg("circle", { id: `goal-${number}`, r: 9, class: "goal" }));
  parts.push(createSvg("circle", { id: `point-${number}`, r: 4.5, class: "point" }));
  byId(`region-${number}`).append(...parts);
}

// Colours of one lightness over a* and b*.
function colourImage(light, scale, lightness, luminance) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = PIXELS;
  const context = canvas.getContext("2d");
  const image = context.createImageData(PIXELS, PIXELS);
  const step = (2 * scale.half) / PIXELS;
  for (let row = 0; row < PIXELS; row++)
    for (let column = 0; column < PIXELS; column++) {
      const a = scale.middle[0] - scale.half + step * (column + 0.5);
      const b = scale.middle[1] + scale.half - step * (row + 0.5);
      const rgb = linearRgb(light, labToXyz([lightness, a, b], light.white));
      image.data.set([...toCodes(rgb, luminance), 255], 4 * (row * PIXELS + column));
    }
  context.putImageData(image, 0, 0);
  return canvas.toDataURL();
}

function drawAxes(scale) {
  const step = [1, 2, 5, 10, 20, 50, 100].find(each => (2 * scale.half) / each <= 6);
  const parts = [];
  for (const axis of [0, 1]) {
    const [low, high] = [scale.middle[axis] - scale.half, scale.middle[axis] + scale.half];
    for (let value = Math.ceil(low / step) * step; value <= high; value += step) {
      const point = axis ? [scale.middle[0], value] : [value, scale.middle[1]];
      const [x, y] = scale.toPlot(point);
      parts.push(createSvg("path", { d: axis ? `M${PLOT.left} ${y}H${PLOT.right}` : `M${x} ${PLOT.top}V${PLOT.bottom}`, class: "grid-line" }));
      const at = axis ? { x: PLOT.left - 5, y: y + 3, "text-anchor": "end" } : { x, y: PLOT.bottom + 13, "text-anchor": "middle" };
      parts.push(createSvg("text", at, String(value).replace("-", "−")));
    }
  }
  parts.push(createSvg("text", { x: PLOT.right, y: PLOT.bottom - 5, "text-anchor": "end" }, "a*"));
  parts.push(createSvg("text", { x: PLOT.left + 4, y: PLOT.top + 9 }, "b*"));
  return parts;
}

// A point, or where the segment from `inside` to it nearly leaves the polygon.
function clampToPolygon(point, polygon, inside) {
  let share = 1;
  const [dx, dy] = [point[0] - inside[0], point[1] - inside[1]];
  polygon.forEach((first, i) => {
    const second = polygon[(i + 1) % polygon.length];
    const [ex, ey] = [second[0] - first[0], second[1] - first[1]];
    const [fx, fy] = [first[0] - inside[0], first[1] - inside[1]];
    const cross = dx * ey - dy * ex;
    if (!cross) return;
    const along = (fx * ey - fy * ex) / cross;
    const across = (fx * dy - fy * dx) / cross;
    if (across >= 0 && across <= 1 && along > 0) share = Math.min(share, along);
  });
  return share < 1 ? [inside[0] + NEARLY * share * dx, inside[1] + NEARLY * share * dy] : point;
}
// State: the goals of some lights in a* and b*, and q, the change of the spectrum that meets them.
const numbers = JSON.parse(byId("numbers").textContent);
const { lights, wavelengths, luminance, build } = numbers;
const model = numbers;
const REACHED = 0.5; // distance in a* and b* that counts as reached
const answer = reflectanceOf(model, numbers.basis[0].map(() => 0));
const answers = lights.map(light => labOf(light, answer));
const scales = lights.map((light, i) => scaleOf([...light.region, ...(light.likely ?? []), answers[i].slice(1)]));
const middles = lights.map(({ region }) => [0, 1].map(axis => region.reduce((sum, point) => sum + point[axis], 0) / region.length));
let q = numbers.basis[0].map(() => 0);
let goals = new Map();

const codesOf = (light, reflectance) => toCodes(linearRgb(light, multiply(light.xyz, reflectance)), luminance);

const requestFrame = frameOf(show);

function show() {
  q = goals.size ? solveGoals(model, [...goals].map(([i, goal]) => ({ light: lights[i], goal }))) : q.map(() => 0);
  const reflectance = reflectanceOf(model, q);
  byId("curve").setAttribute("d", curve(wavelengths, reflectance));
  byId("spectrum").dataset.reflectance = JSON.stringify(reflectance);
  showSwatch("build", build, reflectance);
  lights.forEach((_, i) => showLight(i, reflectance));
  byId("toml").value = toml(reflectance);
}

function showSwatch(name, light, reflectance) {
  const codes = [hexOfCodes(codesOf(light, answer)), hexOfCodes(codesOf(light, reflectance))];
  [...byId(`swatch-${name}`).children].forEach((half, i) => (half.style.background = codes[i]));
  const displayed = isInGamut(linearRgb(light, multiply(light.xyz, reflectance))) ? "" : ", outside sRGB";
  byId(`code-${name}`).textContent = codes[1] + displayed;
}

function showLight(i, reflectance) {
  const lab = labOf(lights[i], reflectance);
  const at = lab.slice(1);
  const goal = goals.get(i);
  const short = goal ? Math.hypot(goal[0] - at[0], goal[1] - at[1]) : 0;
  const moved = Math.hypot(...lab.map((value, k) => value - answers[i][k]));
  place(`point-${i}`, scales[i].toPlot(at));
  place(`goal-${i}`, scales[i].toPlot(goal ?? at));
  byId(`region-${i}`).classList.toggle("chosen", Boolean(goal));
  showSwatch(i, lights[i], reflectance);
  const text = ["L*", "a*", "b*"].map((name, k) => `${name} ${lab[k].toFixed(1)}`).join(", ").replaceAll("-", "−");
  byId(`lab-${i}`).textContent = text;
  byId(`state-${i}`).textContent = !goal ? "free" : short <= REACHED ? "chosen" : `chosen; ${short.toFixed(1)} short of the goal`;
  byId(`release-${i}`).disabled = !goal;
  const slider = byId(`region-${i}`);
  slider.setAttribute("aria-valuenow", moved.toFixed(1));
  slider.setAttribute("aria-valuetext", `${text}, ${byId(`state-${i}`).textContent}`);
}

function place(id, [x, y]) {
  byId(id).setAttribute("transform", `translate(${x.toFixed(2)} ${y.toFixed(2)})`);
}

// The look as an entry of a file for `uplift build --look`.
function toml(reflectance) {
  if (!goals.size) return "# Drag a colour under a light.";
  const written = value => (typeof value === "string" ? `"${value}"` : `[${value.join(", ")}]`);
  const lines = [...goals.keys()].sort((a, b) => a - b).map(i => {
    const rgb = linearRgb(lights[i], multiply(lights[i].xyz, reflectance));
    const colour = isInGamut(rgb) ? hexOfCodes(toCodes(rgb, luminance)) : rgb.map(value => Number(value.toFixed(5)));
    return `${/^[\w-]+$/.test(lights[i].name) ? lights[i].name : JSON.stringify(lights[i].name)} = ${written(colour)}`;
  });
  return ["[[look]]", `rgb = ${written(numbers.rgb)}`, ...lines].join("\n");
}

function choose(i, ab) {
  goals.set(i, clampToPolygon(ab, lights[i].region, middles[i]));
  requestFrame();
}

function release(i) {
  goals.delete(i);
  requestFrame();
}

function follow(i, event) {
  choose(i, scales[i].toAb(placeIn(byId(`region-${i}`), event)));
}

function press(i, key, arrow, shift) {
  const step = shift ? 5 : 0.5;
  if (arrow) {
    const from = goals.get(i) ?? labOf(lights[i], reflectanceOf(model, q)).slice(1);
    choose(i, [from[0] + step * arrow[0], from[1] - step * arrow[1]]);
  } else if (["0", "Delete", "Backspace"].includes(key)) release(i);
  else return false;
}

lights.forEach((light, i) => {
  const region = byId(`region-${i}`);
  drawRegion(i, light, scales[i], answers[i], luminance);
  onDrag(region, event => follow(i, event));
  onKey(region, (...pressed) => press(i, ...pressed));
  byId(`release-${i}`).addEventListener("click", () => {
    release(i);
    region.focus();
  });
});
byId("reset").addEventListener("click", () => {
  goals = new Map();
  requestFrame();
});
byId("copy").addEventListener("click", async () => {
  const field = byId("toml");
  field.select();
  try {
    await navigator.clipboard.writeText(field.value);
  } catch {
    document.execCommand("copy"); // pages without the clipboard interface
  }
  byId("copied").textContent = "Copied.";
});
byId("base").setAttribute("d", curve(wavelengths, answer));
show();
ready();
