"""Run exported shaders on colours in headless Chromium: GLSL by WebGL 2, WGSL by WebGPU."""

from __future__ import annotations

import base64
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.browser import browser

Floats = NDArray[np.float32]

FRAGMENT = """#version 300 es
{code}
uniform sampler2D colours;
out vec4 found;
void main() {{
    found = cube_reflectances(texelFetch(colours, ivec2(gl_FragCoord.xy), 0).rgb, vec4({wavelengths}));
}}
"""
WEBGL = """(() => {
  const floats = text => new Float32Array(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer);
  const { code, table, textures, rows, columns, colours, side } = DATA;
  const gl = Object.assign(document.createElement("canvas"), { width: side, height: side }).getContext("webgl2");
  if (!gl || !gl.getExtension("EXT_color_buffer_float")) return null;
  const program = gl.createProgram();
  const vertex = `#version 300 es
    void main() { gl_Position = vec4(gl_VertexID == 1 ? 3. : -1., gl_VertexID == 2 ? 3. : -1., 0., 1.); }`;
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, code]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  gl.useProgram(program);
  const upload = (unit, name, width, height, values) => {
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, values);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
    if (name) gl.uniform1i(gl.getUniformLocation(program, name), unit);
  };
  if (table) upload(2, "cube_table", columns, rows, floats(table));
  Object.entries(textures).forEach(([name, text], k) => {
    const { width, height, depth, texels } = ktx2(text);
    gl.activeTexture(gl.TEXTURE2 + k);
    gl.uniform1i(gl.getUniformLocation(program, name), 2 + k);
    if (!depth) return upload(2 + k, name, width, height, texels);
    gl.bindTexture(gl.TEXTURE_3D, gl.createTexture());
    gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGBA32F, width, height, depth, 0, gl.RGBA, gl.FLOAT, texels);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_3D, side, gl.NEAREST);
  });
  upload(0, "colours", side, side, floats(colours));
  upload(1, "", side, side, null);
  const target = gl.getParameter(gl.TEXTURE_BINDING_2D);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
  gl.viewport(0, 0, side, side);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  globalThis.again = times => {
    for (let k = 0; k < times; k++) gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.FLOAT, new Float32Array(4));
  };
  const found = new Float32Array(4 * side * side);
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.FLOAT, found);
  let text = "";
  for (const byte of new Uint8Array(found.buffer)) text += String.fromCharCode(byte);
  return btoa(text);
})()"""
COMPUTE = """{code}
@group(0) @binding({binding}) var<storage, read> colours: array<vec4f>;
@group(0) @binding({binding} + 1) var<storage, read_write> found: array<vec4f>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {{
    if (id.x < arrayLength(&found)) {{
        found[id.x] = cube_reflectances(colours[id.x].xyz, vec4f({wavelengths}));
    }}
}}
"""
WEBGPU = """(async () => {
  const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const { code, table, textures, colours } = DATA;
  const adapter = navigator.gpu ? await navigator.gpu.requestAdapter() : null;
  if (!adapter) return null;
  const device = await adapter.requestDevice();
  const module = device.createShaderModule({ code });
  const wrong = (await module.getCompilationInfo()).messages.filter(each => each.type === "error");
  if (wrong.length) throw new Error(wrong.map(each => `${each.lineNum}: ${each.message}`).join());
  const buffer = (data, usage) => {
    const made = device.createBuffer({ size: data.byteLength, usage: usage | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(made, 0, data);
    return made;
  };
  const rgb = bytes(colours), { STORAGE, COPY_SRC, MAP_READ } = GPUBufferUsage;
  const found = buffer(new Uint8Array(rgb.byteLength), STORAGE | COPY_SRC);
  const result = buffer(new Uint8Array(rgb.byteLength), MAP_READ);
  const compute = { module, entryPoint: "main" };
  const pipeline = await device.createComputePipelineAsync({ layout: "auto", compute });
  const upload = text => {
    const { width, height, depth, texels } = ktx2(text), usage = GPUTextureUsage;
    const size = [width, height, depth || 1], dimension = depth ? "3d" : "2d";
    const made = device.createTexture(
      { size, dimension, format: "rgba32float", usage: usage.TEXTURE_BINDING | usage.COPY_DST });
    device.queue.writeTexture({ texture: made }, texels, { bytesPerRow: 16 * width, rowsPerImage: height }, size);
    return made.createView();
  };
  const held = table ? [{ buffer: buffer(bytes(table), STORAGE) }] : Object.values(textures).map(upload);
  const entries = [...held, { buffer: buffer(rgb, STORAGE) }, { buffer: found }].map((resource, binding) => (
    { binding, resource }));
  const group = device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries });
  const record = () => {
    const commands = device.createCommandEncoder(), pass = commands.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, group);
    pass.dispatchWorkgroups(Math.ceil(rgb.byteLength / 16 / 64));
    pass.end();
    return commands;
  };
  globalThis.again = async times => {
    device.queue.submit(Array.from({ length: times }, () => record().finish()));
    await device.queue.onSubmittedWorkDone();
  };
  const commands = record();
  commands.copyBufferToBuffer(found, 0, result, 0, rgb.byteLength);
  device.queue.submit([commands.finish()]);
  await result.mapAsync(GPUMapMode.READ);
  let text = "";
  for (const byte of new Uint8Array(result.getMappedRange())) text += String.fromCharCode(byte);
  return btoa(text);
})()"""
KTX2 = """const ktx2 = text => {
  const { buffer } = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const view = new DataView(buffer), number = at => view.getUint32(at, true);
  const [width, height, depth] = [20, 24, 28].map(number), start = number(80), length = number(88) / 4;
  return { width, height, depth, texels: new Float32Array(buffer, start, length) };
};
"""


@dataclass(frozen=True, eq=False)
class Run:
    """Reflectances (n, 4) of a shader, and the fewest CPU seconds of all processes of the browser per run of it."""

    reflectances: Floats
    seconds: float


def glsl(
    path: Path, rgb: Floats, wavelengths: list[float], form: str = "file", runs: int = 0, repeats: int = 1
) -> Run | None:
    """Evaluate linear RGB (n, 3) at four wavelengths; None without WebGL 2."""
    code = FRAGMENT.format(code=path.read_text(), wavelengths=listed(wavelengths))
    side = int(np.ceil(np.sqrt(len(rgb))))
    tables = _tables(path, form)
    rows = len(tables["table"]) * 3 // 4 // (2048 * 16)
    data = {"code": code, **tables, "columns": 2048, "rows": rows, "side": side}
    return _run(path, WEBGL, padded(rgb, side * side), len(rgb), data, runs, repeats)


def wgsl(
    path: Path, rgb: Floats, wavelengths: list[float], form: str = "file", runs: int = 0, repeats: int = 1
) -> Run | None:
    """Evaluate linear RGB (n, 3) at four wavelengths; None without WebGPU."""
    tables = _tables(path, form)
    binding = max(1, len(tables["textures"]))
    code = COMPUTE.format(code=path.read_text(), wavelengths=listed(wavelengths), binding=binding)
    return _run(path, WEBGPU, padded(rgb, len(rgb)), len(rgb), {"code": code, **tables}, runs, repeats)


def _tables(path: Path, form: str) -> dict[str, Any]:
    """Return the table as text, or textures as text by the names of their uniforms."""
    if form == "file":
        return {"table": text_of(path.with_suffix(".bin").read_bytes()), "textures": {}}
    files = {each.stem.split("-")[-1]: text_of(each.read_bytes()) for each in textures(path, ".ktx2")}
    names = {key: "cube_entries" if key == "entries" else f"cube_points_{key}" for key in files}
    return {"table": "", "textures": {names[key]: text for key, text in files.items()}}


def textures(path: Path, suffix: str) -> list[Path]:
    """Return the files of textures, that of the entries last."""
    return sorted(path.parent.glob(f"{path.stem}-*{suffix}"))


def _run(
    path: Path, script: str, colours: Floats, count: int, data: dict[str, Any], runs: int, repeats: int
) -> Run | None:
    page = path.with_suffix(".html")
    page.write_text("<!doctype html><main aria-busy='false'></main>")
    content = json.dumps({**data, "colours": text_of(colours.tobytes())})
    seconds = np.inf
    with browser() as opened:
        opened.open(page)
        found = opened.evaluate("{ " + KTX2 + script.replace("DATA", content) + " }")
        for _ in range(runs if found else 0):
            begin = opened.cpu()
            opened.evaluate(f"again({repeats})")
            seconds = min(seconds, (opened.cpu() - begin) / repeats)
    if found is None:
        return None
    return Run(np.frombuffer(base64.b64decode(found), np.float32).reshape(-1, 4)[:count], float(seconds))


def listed(wavelengths: list[float]) -> str:
    """Return numbers as arguments of a function."""
    return ", ".join(str(float(nm)) for nm in wavelengths)


def padded(rgb: Floats, count: int) -> Floats:
    """Return colours (count, 4) with a fourth channel."""
    colours = np.zeros((count, 4), np.float32)
    colours[: len(rgb), :3] = rgb
    return colours


def text_of(data: bytes) -> str:
    """Return bytes as text."""
    return base64.b64encode(data).decode()
