// RGB is linear in the spectrum. The colours of all nodes under both lights are therefore computed once per light, those
// of the pixels are interpolated once per image and light, and a frame only mixes the two.
const { columns, rows, points, wavelengths, lights, entries } = JSON.parse(byId("numbers").textContent);
const canvas = byId("view");
const gl = webgl(canvas);
const complain = text => { byId("problem").textContent = text; };
if (!gl) {
  complain("This page needs WebGL 2 with floating-point textures.");
  throw new Error("no WebGL 2");
}
const SIZE = Math.min(1024, gl.getParameter(gl.MAX_TEXTURE_SIZE));
const GROUPS = wavelengths.length / 4;
const ACROSS = 1024;
const kernel = byId("kernel").textContent;
const nodes = `#version 300 es
${kernel}
uniform vec4 at[${GROUPS}], red_a[${GROUPS}], green_a[${GROUPS}], blue_a[${GROUPS}];
uniform vec4 red_b[${GROUPS}], green_b[${GROUPS}], blue_b[${GROUPS}];
layout(location = 0) out vec4 first;
layout(location = 1) out vec4 second;
float reflectance(int number, float shape[CUBE_ROOM], float nm) {
  if (number < CUBE_LATTICE) return cube_evaluate_at(shape, nm);
  return cube_mix(0.0, number - CUBE_LATTICE, cube_abscissa(cube_warp(nm)), 0.5);
}
void main() {
  int number = int(gl_FragCoord.y) * ${ACROSS} + int(gl_FragCoord.x);
  first = second = vec4(0.0, 0.0, 0.0, 1.0);
  if (number >= CUBE_LATTICE + ${entries.length}) return;
  float shape[CUBE_ROOM];
  for (int k = 0; k < CUBE_ROOM; ++k) shape[k] = 0.0;
  if (number < CUBE_LATTICE) cube_load_row(number, 0, shape);
  for (int k = 0; k < ${GROUPS}; ++k) {
    vec4 g;
    for (int w = 0; w < 4; ++w) g[w] = reflectance(number, shape, at[k][w]);
    first.rgb += vec3(dot(red_a[k], g), dot(green_a[k], g), dot(blue_a[k], g));
    second.rgb += vec3(dot(red_b[k], g), dot(green_b[k], g), dot(blue_b[k], g));
  }
}`;
const relit = `#version 300 es
${kernel}
uniform sampler2D image, nodes_a, nodes_b;
layout(location = 0) out vec4 first;
layout(location = 1) out vec4 second;
${GLSL_SRGB}
void add(int number, float weight) {
  ivec2 place = ivec2(number % ${ACROSS}, number / ${ACROSS});
  first += weight * texelFetch(nodes_a, place, 0);
  second += weight * texelFetch(nodes_b, place, 0);
}
void main() {
  vec3 rgb = linear(texelFetch(image, ivec2(gl_FragCoord.xy), 0).rgb);
  float colour[3], place[CUBE_PLACE];
  int nodes[4];
  for (int axis = 0; axis < 3; ++axis) colour[axis] = rgb[axis];
  for (int k = 0; k < CUBE_PLACE; ++k) place[k] = 0.0;
  for (int k = 0; k < 4; ++k) nodes[k] = 0;
  int entry = cube_locate(colour, nodes, place);
  first = second = vec4(0.0);
  for (int k = 0; k < 4; ++k) add(nodes[k], place[4] * place[k]);
  if (entry >= 0) add(CUBE_LATTICE + entry, 1.0 - place[4]);
}`;
const shown = `#version 300 es
precision highp float;
uniform sampler2D image, first, second;
uniform vec3 white_a, white_b, balance;
uniform float share, exposure, split;
uniform vec2 cursor;
uniform int height;
out vec4 colour;
${GLSL_SRGB}
void main() {
  ivec2 place = ivec2(gl_FragCoord.x, float(height) - gl_FragCoord.y);
  vec3 plain = linear(texelFetch(image, place, 0).rgb) * mix(white_a, white_b, share);
  vec3 ours = mix(texelFetch(first, place, 0).rgb, texelFetch(second, place, 0).rgb, share);
  vec3 rgb = gl_FragCoord.x < split ? plain : ours;
  bool edge = abs(gl_FragCoord.x - split) < 1.0;
  float ring = distance(vec2(place), cursor);
  colour = vec4(edge || abs(ring - 6.0) < 1.0 ? vec3(1.0) : encode(exposure * rgb * balance), 1.0);
  if (abs(ring - 8.0) < 1.0) colour.rgb = vec3(0.0);
}`;
const spectrum = `#version 300 es
${kernel}
uniform vec3 rgb;
uniform vec4 at[${GROUPS}];
out vec4 found;
void main() { found = cube_reflectances(rgb, at[int(gl_FragCoord.x)]); }`;

// Units: 0 table, 1 image, 2 and 3 the image under each light, 4 a spectrum, 5 and 6 the nodes under each light.
const bytes = Uint8Array.from(atob(byId("table").textContent), letter => letter.charCodeAt(0));
texture(gl, 0, gl.RGBA32F, columns, rows, gl.FLOAT, new Float32Array(bytes.buffer));
const programs = { nodes: compile(gl, nodes), relit: compile(gl, relit), shown: compile(gl, shown), spectrum: compile(gl, spectrum) };
const frames = { nodes: gl.createFramebuffer(), relit: gl.createFramebuffer(), spectrum: gl.createFramebuffer() };
const DOWN = Math.ceil(points / ACROSS);
attach(gl, frames.nodes, [5, 6].map(unit => texture(gl, unit, gl.RGBA32F, ACROSS, DOWN, gl.FLOAT, null)));
attach(gl, frames.spectrum, [texture(gl, 4, gl.RGBA32F, GROUPS, 1, gl.FLOAT, null)]);

const source = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
const state = { width: 1, height: 1, pixels: null, made: [], place: [0, 0] };
const white = name => lights[name].map(row => row.reduce((sum, value) => sum + value, 0));
const chosen = () => [byId("light-a").value, byId("light-b").value];

// Show a picture, at most SIZE pixels wide and high.
function show(picture) {
  const scale = Math.min(1, SIZE / Math.max(picture.width, picture.height));
  state.width = source.canvas.width = canvas.width = Math.max(1, Math.round(picture.width * scale));
  state.height = source.canvas.height = canvas.height = Math.max(1, Math.round(picture.height * scale));
  source.drawImage(picture, 0, 0, state.width, state.height);
  state.pixels = source.getImageData(0, 0, state.width, state.height).data;
  state.made.forEach(each => gl.deleteTexture(each));
  const { width, height } = state;
  state.made = [
    texture(gl, 1, gl.RGBA, width, height, gl.UNSIGNED_BYTE, new Uint8Array(state.pixels.buffer)),
    texture(gl, 2, gl.RGBA32F, width, height, gl.FLOAT, null),
    texture(gl, 3, gl.RGBA32F, width, height, gl.FLOAT, null),
  ];
  attach(gl, frames.relit, state.made.slice(1));
  byId("split").max = width;
  byId("split").value = Math.round(width / 2);
  relight();
  inspect(width >> 1, height >> 1);
}

function relight() {
  const { program, at } = programs.nodes;
  gl.useProgram(program);
  gl.bindFramebuffer(gl.FRAMEBUFFER, frames.nodes);
  gl.viewport(0, 0, ACROSS, DOWN);
  gl.uniform1i(at("cube_table"), 0);
  gl.uniform4fv(at("at"), wavelengths);
  chosen().forEach((name, k) => ["red", "green", "blue"].forEach((channel, row) =>
    gl.uniform4fv(at(`${channel}_${"ab"[k]}`), lights[name][row])));
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  interpolate();
}

function interpolate() {
  const { program, at } = programs.relit;
  gl.useProgram(program);
  gl.bindFramebuffer(gl.FRAMEBUFFER, frames.relit);
  gl.viewport(0, 0, state.width, state.height);
  Object.entries({ cube_table: 0, image: 1, nodes_a: 5, nodes_b: 6 }).forEach(([name, unit]) => gl.uniform1i(at(name), unit));
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  draw();
}

function draw() {
  const { program, at } = programs.shown;
  const [a, b] = chosen().map(white), share = byId("mix").value / 100;
  const mixed = a.map((value, k) => (1 - share) * value + share * b[k]);
  gl.useProgram(program);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.viewport(0, 0, state.width, state.height);
  ["image", "first", "second"].forEach((name, k) => gl.uniform1i(at(name), k + 1));
  gl.uniform3fv(at("white_a"), a);
  gl.uniform3fv(at("white_b"), b);
  gl.uniform3fv(at("balance"), byId("balance").checked ? mixed.map(value => 1 / Math.max(value, 1e-3)) : [1, 1, 1]);
  gl.uniform1f(at("share"), share);
  gl.uniform1f(at("exposure"), 2 ** byId("exposure").value);
  gl.uniform1f(at("split"), byId("split").value);
  canvas.parentElement.style.setProperty("--split", `${(100 * byId("split").value) / canvas.width}%`);
  gl.uniform1i(at("height"), state.height);
  gl.uniform2fv(at("cursor"), document.activeElement === canvas ? state.place : [-99, -99]);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  byId("mix-text").value = `${byId("mix").value} %`;
  byId("exposure-text").value = `${byId("exposure").value} EV`;
}

function reflectances(rgb) {
  const { program, at } = programs.spectrum;
  gl.useProgram(program);
  gl.bindFramebuffer(gl.FRAMEBUFFER, frames.spectrum);
  gl.viewport(0, 0, GROUPS, 1);
  gl.uniform1i(at("cube_table"), 0);
  gl.uniform3fv(at("rgb"), rgb);
  gl.uniform4fv(at("at"), wavelengths);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const found = new Float32Array(4 * GROUPS);
  gl.readPixels(0, 0, GROUPS, 1, gl.RGBA, gl.FLOAT, found);
  return [...found];
}

// Spectrum of a pixel of the image, the nearest to a place.
function inspect(x, y) {
  x = Math.max(0, Math.min(state.width - 1, x));
  y = Math.max(0, Math.min(state.height - 1, y));
  state.place = [x, y];
  const start = 4 * (y * state.width + x);
  const codes = [...state.pixels.slice(start, start + 3)];
  const g = reflectances(codes.map(code => decode(code / 255)));
  byId("curve").setAttribute("d", curve(wavelengths, g));
  const hex = hexOfCodes(codes);
  byId("pixel").textContent = `${x}, ${y}: ${hex}`;
  byId("swatch").style.background = hex;
}

// A picture to start with: hues over lightness, and the atlas entries.
function sample() {
  const picture = new OffscreenCanvas(768, 512), context = picture.getContext("2d");
  for (let x = 0; x < 768; x++) {
    const ramp = context.createLinearGradient(0, 0, 0, 416);
    [["95%", 0], ["55%", 0.5], ["8%", 1]].forEach(([light, stop]) =>
      ramp.addColorStop(stop, `hsl(${(x * 360) / 768} ${stop === 0.5 ? "85%" : "45%"} ${light})`));
    context.fillStyle = ramp;
    context.fillRect(x, 0, 1, 416);
  }
  const patches = entries.length ? entries.slice(0, 48) : ["#000", "#444", "#888", "#ccc", "#fff"];
  const across = Math.min(patches.length, 24), step = 384 / across;
  const down = 96 / Math.ceil(patches.length / across);
  patches.forEach((code, k) => {
    context.fillStyle = code;
    for (const side of [0, 384])  // each patch on both sides of the line
      context.fillRect(side + (k % across) * step, 416 + Math.floor(k / across) * down, Math.ceil(step), Math.ceil(down));
  });
  return picture;
}

async function open(file) {
  complain("");
  try {
    show(await createImageBitmap(file));
  } catch {
    complain(`${file.name} is not an image that this browser reads.`);
  }
}

const requestDraw = frameOf(draw);
for (const id of ["light-a", "light-b"]) byId(id).addEventListener("change", relight);
for (const id of ["mix", "split", "exposure", "balance"])
  byId(id).addEventListener("input", requestDraw);
byId("file").addEventListener("change", event => event.target.files[0] && open(event.target.files[0]));
document.addEventListener("dragover", event => event.preventDefault());
document.addEventListener("drop", event => {
  event.preventDefault();
  if (event.dataTransfer.files[0]) open(event.dataTransfer.files[0]);
});
canvas.addEventListener("pointermove", ({ offsetX, offsetY }) => inspect(
  Math.floor((offsetX * state.width) / canvas.clientWidth),
  Math.floor((offsetY * state.height) / canvas.clientHeight)));
onKey(canvas, (key, arrow, shift) => {
  if (!arrow) return false;
  const length = shift ? 20 : 1;
  inspect(state.place[0] + length * arrow[0], state.place[1] + length * arrow[1]);
  requestDraw();
});
for (const kind of ["focus", "blur"]) canvas.addEventListener(kind, requestDraw);
show(sample());
ready();
