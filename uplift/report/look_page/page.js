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
let frame = 0;

const codesOf = (light, reflectance) => toCodes(linearRgb(light, multiply(light.xyz, reflectance)), luminance);

function requestFrame() {
  frame ||= requestAnimationFrame(show);
}

function show() {
  frame = 0;
  q = goals.size ? solveGoals(model, [...goals].map(([i, goal]) => ({ light: lights[i], goal }))) : q.map(() => 0);
  const reflectance = reflectanceOf(model, q);
  byId("curve").setAttribute("d", curve(wavelengths, reflectance));
  byId("spectrum").dataset.reflectance = JSON.stringify(reflectance);
  showSwatch("build", build, reflectance);
  lights.forEach((_, i) => showLight(i, reflectance));
  byId("toml").value = toml(reflectance);
}

function showSwatch(name, light, reflectance) {
  const codes = [toHex(codesOf(light, answer)), toHex(codesOf(light, reflectance))];
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
    const colour = isInGamut(rgb) ? toHex(toCodes(rgb, luminance)) : rgb.map(value => Number(value.toFixed(5)));
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
  const matrix = byId(`region-${i}`).getScreenCTM().inverse();
  const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
  choose(i, scales[i].toAb([x, y]));
}

const DIRECTIONS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
function press(i, event) {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const direction = DIRECTIONS[event.key];
  const step = event.shiftKey ? 5 : 0.5;
  if (direction) {
    const from = goals.get(i) ?? labOf(lights[i], reflectanceOf(model, q)).slice(1);
    choose(i, [0, 1].map(axis => from[axis] + step * direction[axis]));
  } else if (["0", "Delete", "Backspace"].includes(event.key)) release(i);
  else return;
  event.preventDefault();
}

lights.forEach((light, i) => {
  const region = byId(`region-${i}`);
  drawRegion(i, light, scales[i], answers[i], luminance);
  region.addEventListener("pointerdown", event => {
    region.setPointerCapture(event.pointerId);
    follow(i, event);
  });
  region.addEventListener("pointermove", event => {
    if (region.hasPointerCapture(event.pointerId)) follow(i, event);
  });
  region.addEventListener("keydown", event => press(i, event));
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
document.querySelector("main").setAttribute("aria-busy", "false");
