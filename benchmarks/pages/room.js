// A room traced by WebGL: three renderings with other numbers of the same surfaces, summed over frames, then decoded.
const numbers = JSON.parse(byId("numbers").textContent);
const canvas = byId("picture");
const MAX_SAMPLES = 600;
const BRIGHTNESS = 3.5;

// A path tracer that knows red, green and blue alone. Surfaces are numbers of the 24 patches.
const TRACE = `#version 300 es
precision highp float;
uniform vec3 surface[24];
uniform uint frame;
uniform float size;
uniform sampler2D before;
out vec4 sum;
uint state;
float random() {
  state = state * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return float((word >> 22u) ^ word) / 4294967296.0;
}
const float FAR = 1e9;
struct Hit { float t; vec3 normal; int patchNumber; bool lamp; };
const vec3 BALL = vec3(0.5, -0.68, -0.15);
const float BALL_RADIUS = 0.32;
const vec3 LOW = vec3(-0.72, -1.0, -0.6);
const vec3 HIGH = vec3(-0.28, -0.1, -0.16);
const vec2 LAMP_HALF = vec2(0.25, 0.3);

int chart(vec2 at) {
  vec2 cell = (at - vec2(-0.6, 0.08)) / 0.2;
  if (cell.x < 0.0 || cell.x >= 6.0 || cell.y < 0.0 || cell.y >= 4.0) return -1;
  vec2 inside = fract(cell);
  if (min(inside.x, inside.y) < 0.07 || max(inside.x, inside.y) > 0.93) return -1;
  return (3 - int(cell.y)) * 6 + int(cell.x);
}
void plane(inout Hit hit, vec3 origin, vec3 ray, vec3 normal, int number) {
  float towards = dot(ray, normal);
  if (towards >= 0.0) return;
  float t = -(dot(origin, normal) + 1.0) / towards;
  if (t > 1e-3 && t < hit.t) hit = Hit(t, normal, number, false);
}
Hit nearest(vec3 origin, vec3 ray) {
  Hit hit = Hit(FAR, vec3(0.0), 0, false);
  plane(hit, origin, ray, vec3(0.0, 1.0, 0.0), 20);
  plane(hit, origin, ray, vec3(0.0, -1.0, 0.0), 18);
  plane(hit, origin, ray, vec3(1.0, 0.0, 0.0), 14);
  plane(hit, origin, ray, vec3(-1.0, 0.0, 0.0), 13);
  plane(hit, origin, ray, vec3(0.0, 0.0, 1.0), 21);
  vec3 at = origin + hit.t * ray;
  if (hit.t < FAR && hit.normal.z > 0.5) {
    int number = chart(at.xy);
    if (number >= 0) hit.patchNumber = number;
  }
  if (hit.t < FAR && hit.normal.y < -0.5) {
    vec2 from = abs(vec2(abs(at.x) - 0.55, at.z));
    hit.lamp = from.x < LAMP_HALF.x && from.y < LAMP_HALF.y;
  }
  vec3 off = origin - BALL;
  float b = dot(off, ray);
  float root = b * b - dot(off, off) + BALL_RADIUS * BALL_RADIUS;
  if (root > 0.0) {
    float t = -b - sqrt(root);
    if (t > 1e-3 && t < hit.t) hit = Hit(t, normalize(off + t * ray), 7, false);
  }
  vec3 first = (LOW - origin) / ray;
  vec3 second = (HIGH - origin) / ray;
  vec3 near = min(first, second);
  vec3 far = max(first, second);
  float enter = max(max(near.x, near.y), near.z);
  float leave = min(min(far.x, far.y), far.z);
  if (enter < leave && enter > 1e-3 && enter < hit.t) {
    vec3 face = vec3(equal(near, vec3(enter)));
    hit = Hit(enter, -sign(ray) * face, 15, false);
  }
  return hit;
}
vec3 scattered(vec3 normal) {
  float angle = 6.2831853 * random();
  float height = 2.0 * random() - 1.0;
  vec3 point = vec3(sqrt(max(1.0 - height * height, 0.0)) * vec2(cos(angle), sin(angle)), height);
  return normalize(normal + 0.999 * point);
}
void main() {
  uvec2 pixel = uvec2(gl_FragCoord.xy);
  state = (pixel.x * 1973u + pixel.y * 9277u + frame * 26699u) | 1u;
  random();
  vec2 at = (gl_FragCoord.xy + vec2(random(), random()) - 0.5) / size * 2.0 - 1.0;
  vec3 origin = vec3(0.0, 0.0, 3.9);
  vec3 ray = normalize(vec3(at * 0.354, -1.0));
  vec3 through = vec3(1.0);
  vec3 light = vec3(0.0);
  for (int bounce = 0; bounce < 6; bounce++) {
    Hit hit = nearest(origin, ray);
    if (hit.t == FAR) break;
    if (hit.lamp) {
      if (bounce == 0) light += through * 4.0;
      break;
    }
    through *= surface[hit.patchNumber];
    origin += hit.t * ray + 1e-3 * hit.normal;
    float side = random() < 0.5 ? -0.55 : 0.55;
    vec2 spot = (vec2(random(), random()) * 2.0 - 1.0) * LAMP_HALF;
    vec3 to = vec3(side + spot.x, 0.999, spot.y) - origin;
    float distance2 = dot(to, to);
    vec3 direction = to * inversesqrt(distance2);
    float cosine = dot(hit.normal, direction) * direction.y;
    if (cosine > 0.0 && dot(hit.normal, direction) > 0.0 && nearest(origin, direction).t > sqrt(distance2) - 5e-3)
      light += through * 4.0 * cosine * 8.0 * LAMP_HALF.x * LAMP_HALF.y / (3.14159265 * max(distance2, 1e-3));
    ray = scattered(hit.normal);
  }
  sum = texelFetch(before, ivec2(pixel), 0) + vec4(light, 1.0);
}`;

const DECODE = `#version 300 es
precision highp float;
${GLSL_SRGB}
uniform sampler2D first, second, plain;
uniform mat3 fromFirst, fromSecond, fromPlain;
uniform float split, size;
out vec4 colour;
vec3 mean(sampler2D sums) {
  vec4 sum = texelFetch(sums, ivec2(gl_FragCoord.xy), 0);
  return sum.rgb / max(sum.a, 1.0);
}
void main() {
  float from = gl_FragCoord.x / size - split;
  vec3 rgb = from < 0.0 ? fromPlain * mean(plain) : fromFirst * mean(first) + fromSecond * mean(second);
  colour = abs(from) * size < 1.0 ? vec4(1.0) : vec4(encode(rgb), 1.0);
}`;

const transpose = matrix => matrix[0].map((_, column) => matrix.map(row => row[column]));
const product = (left, right) => transpose(transpose(right).map(column => multiply(left, column)));
const scaled = (matrix, factors) => matrix.map(row => row.map((value, column) => value * factors[column]));

const mixed = (values, lamp, share) => values[0].map((value, i) => (1 - share) * value + share * values[lamp][i]);

// From linear sRGB to linear sRGB, so that a white becomes (1, 1, 1), by the cone responses of Bradford.
function balancing(white) {
  const { toCones, fromCones } = numbers;
  const target = multiply(toCones, [1, 1, 1]);
  const source = multiply(toCones, white);
  const gains = target.map((value, i) => value / Math.max(source[i], 1e-3));
  return product(fromCones, gains.map((gain, row) => toCones[row].map(value => gain * value)));
}

// Matrices of both passes and of RGB for the light that the sliders choose: numbers of the light, decoding, white, exposure.
function matrices() {
  const lamp = Number(byId("lamp").value);
  const share = Number(byId("mix").value);
  const light = mixed(numbers.lights, lamp, share);
  const rgb = mixed(numbers.lightRgb, lamp, share);
  const gain = BRIGHTNESS * 2 ** Number(byId("exposure").value);
  const identity = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const white = byId("balance").checked ? balancing(rgb) : identity;
  const shown = white.map(row => row.map(value => gain * value));
  return [
    product(shown, scaled(numbers.decoding[0], light.slice(0, 3))),
    product(shown, scaled(numbers.decoding[1], light.slice(3))),
    product(shown, scaled(identity, rgb)),
  ];
}

function target(gl) {
  const sums = texture(gl, 0, gl.RGBA32F, canvas.width, canvas.height, gl.FLOAT, null);
  const frame = gl.createFramebuffer();
  attach(gl, frame, [sums]);
  gl.clear(gl.COLOR_BUFFER_BIT);
  return { sums, frame };
}

function start(gl) {
  const trace = compile(gl, TRACE);
  const shown = compile(gl, DECODE);
  gl.viewport(0, 0, canvas.width, canvas.height);
  const sums = numbers.surfaces.map(() => [target(gl), target(gl)]);
  let samples = 0;

  function render() {
    gl.useProgram(trace.program);
    gl.uniform1ui(trace.at("frame"), samples);
    gl.uniform1f(trace.at("size"), canvas.width);
    gl.activeTexture(gl.TEXTURE0);
    gl.uniform1i(trace.at("before"), 0);
    numbers.surfaces.forEach((surface, row) => {
      const [from, to] = sums[row];
      gl.uniform3fv(trace.at("surface"), surface.flat());
      gl.bindTexture(gl.TEXTURE_2D, from.sums);
      gl.bindFramebuffer(gl.FRAMEBUFFER, to.frame);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      sums[row] = [to, from];
    });
    samples += 1;
  }

  function show() {
    gl.useProgram(shown.program);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    ["first", "second", "plain"].forEach((name, row) => {
      gl.activeTexture(gl.TEXTURE0 + row);
      gl.bindTexture(gl.TEXTURE_2D, sums[row][0].sums);
      gl.uniform1i(shown.at(name), row);
    });
    ["fromFirst", "fromSecond", "fromPlain"].forEach((name, row) =>
      gl.uniformMatrix3fv(shown.at(name), true, matrices()[row].flat()));
    gl.uniform1f(shown.at("split"), Number(byId("split").value));
    gl.uniform1f(shown.at("size"), canvas.width);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    byId("samples").textContent = `samples per pixel: ${samples}`;
  }

  function frame() {
    render();
    show();
    ready();
    if (samples < MAX_SAMPLES) requestAnimationFrame(frame);
  }
  for (const id of ["lamp", "mix", "split", "exposure", "balance"]) byId(id).addEventListener("input", show);
  const view = document.querySelector(".view");
  onDrag(view, event => {
    const box = view.getBoundingClientRect();
    byId("split").value = (event.clientX - box.left) / box.width;
    show();
  });
  frame();
}

const gl = webgl(canvas);
if (gl) start(gl);
else {
  canvas.hidden = true;
  byId("wait").textContent = "This page needs WebGL 2 with float textures, which this browser does not offer.";
}
