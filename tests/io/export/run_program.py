"""Run exported programs: each function takes a program, linear RGB (n, 3) and four wavelengths.

It returns reflectances (n, 4), and skips the test if the compiler, the browser or the driver is lacking.
"""

from __future__ import annotations

import base64
import json
import shutil
import subprocess

import numpy as np
import pytest

from benchmarks.browser import browser, chromium

HOST = r"""
#include <stdio.h>
#include <stdlib.h>
#define CUBE_WIDTH 4
#include "{header}"

int main(void)
{{
    float rgb[3], wavelengths[4] = {{{wavelengths}}}, found[4];
    {load}
    while (fread(rgb, sizeof rgb, 1, stdin) == 1) {{
        cube_reflectances({call});
        fwrite(found, sizeof found, 1, stdout);
    }}
    return 0;
}}
"""
LOAD = """static float table[{size}];
    FILE *file = fopen("cube.bin", "rb");
    if (!file || fread(table, 1, sizeof table, file) != sizeof table) return 1;"""
STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Werror", "-Wno-unused-function", "-O1")
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
  const { code, table, rows, columns, colours, side } = DATA;
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
  upload(0, "cube_table", columns, rows, floats(table));
  upload(1, "colours", side, side, floats(colours));
  upload(2, "", side, side, null);
  const target = gl.getParameter(gl.TEXTURE_BINDING_2D);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
  gl.viewport(0, 0, side, side);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const found = new Float32Array(4 * side * side);
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.FLOAT, found);
  let text = "";
  for (const byte of new Uint8Array(found.buffer)) text += String.fromCharCode(byte);
  return btoa(text);
})()"""
COMPUTE = """{code}
@group(0) @binding(1) var<storage, read> colours: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> found: array<vec4f>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {{
    if (id.x < arrayLength(&found)) {{
        found[id.x] = cube_reflectances(colours[id.x].xyz, vec4f({wavelengths}));
    }}
}}
"""
WEBGPU = """(async () => {
  const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const { code, table, colours } = DATA;
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
  const entries = [buffer(bytes(table), STORAGE), buffer(rgb, STORAGE), found].map((each, binding) => (
    { binding, resource: { buffer: each } }));
  const commands = device.createCommandEncoder(), pass = commands.beginComputePass();
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }));
  pass.dispatchWorkgroups(Math.ceil(rgb.byteLength / 16 / 64));
  pass.end();
  commands.copyBufferToBuffer(found, 0, result, 0, rgb.byteLength);
  device.queue.submit([commands.finish()]);
  await result.mapAsync(GPUMapMode.READ);
  let text = "";
  for (const byte of new Uint8Array(result.getMappedRange())) text += String.fromCharCode(byte);
  return btoa(text);
})()"""
PIXEL = """{code}
StructuredBuffer<float4> colours : register(t1);
RWStructuredBuffer<float4> found : register(u2);
[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {{
    found[id.x] = cube_reflectances(colours[id.x].xyz, float4({wavelengths}));
}}
"""


def c(path, rgb, wavelengths, compiler=("cc", "-std=c99")):
    return _compiled(path, rgb, wavelengths, compiler, "rgb, wavelengths, 4, found", "")


def cpp(path, rgb, wavelengths):
    return c(path, rgb, wavelengths, ("c++", "-std=c++11", "-x", "c++"))


def cuda(path, rgb, wavelengths):
    """On the host, where the same functions are C++."""
    load = LOAD.format(size=path.with_suffix(".bin").stat().st_size // 4)
    compiler = ("c++", "-std=c++11", "-x", "c++")
    return _compiled(path, rgb, wavelengths, compiler, "table, rgb, wavelengths, found", load)


def _compiled(path, rgb, wavelengths, compiler, call, load):
    if shutil.which(compiler[0]) is None:
        pytest.skip(f"needs a compiler, {compiler[0]}")
    folder = path.parent
    text = HOST.format(header=path.name, wavelengths=_listed(wavelengths), call=call, load=load)
    (folder / "main.c").write_text(text)
    subprocess.run([*compiler, *STRICT, "main.c", "-o", "main", "-lm"], cwd=folder, check=True)
    done = subprocess.run(
        [folder / "main"], cwd=folder, input=rgb.astype(np.float32).tobytes(), capture_output=True, check=True
    )
    return np.frombuffer(done.stdout, np.float32).reshape(-1, 4)


def glsl(path, rgb, wavelengths):
    """In Chromium, by WebGL 2."""
    code = FRAGMENT.format(code=path.read_text(), wavelengths=_listed(wavelengths))
    side = int(np.ceil(np.sqrt(len(rgb))))
    table = path.with_suffix(".bin").read_bytes()
    shape = {"columns": 2048, "rows": len(table) // (2048 * 16), "side": side}
    return _in_browser(path, WEBGL, _padded(rgb, side * side), code=code, table=_text(table), **shape)[
        : len(rgb)
    ]


def wgsl(path, rgb, wavelengths):
    """In Chromium, by WebGPU."""
    code = COMPUTE.format(code=path.read_text(), wavelengths=_listed(wavelengths))
    table = _text(path.with_suffix(".bin").read_bytes())
    return _in_browser(path, WEBGPU, _padded(rgb, len(rgb)), code=code, table=table)


def _in_browser(path, script, colours, **data):
    if chromium() is None:
        pytest.skip("needs Chromium")
    page = path.with_suffix(".html")
    page.write_text("<!doctype html><main aria-busy='false'></main>")
    content = json.dumps({**data, "colours": _text(colours.tobytes())})
    with browser() as opened:
        opened.open(page)
        found = opened.evaluate(script.replace("DATA", content))
    if found is None:
        pytest.skip("the browser has no such graphics interface")
    return np.frombuffer(base64.b64decode(found), np.float32).reshape(-1, 4)


def hlsl(path, rgb, wavelengths):
    """Compiled to SPIR-V, and by Vulkan: needs glslangValidator and wgpu."""
    if shutil.which("glslangValidator") is None:
        pytest.skip("needs glslangValidator")
    folder, count = path.parent, -(-len(rgb) // 64) * 64
    (folder / "main.hlsl").write_text(PIXEL.format(code=path.read_text(), wavelengths=_listed(wavelengths)))
    command = ["glslangValidator", "-D", "-V", "-S", "comp", "-e", "main", "main.hlsl", "-o", "main.spv"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    wgpu = pytest.importorskip("wgpu")
    try:
        device = wgpu.gpu.request_adapter_sync().request_device_sync()
    except (RuntimeError, AttributeError, OSError) as error:
        pytest.skip(f"needs a Vulkan driver: {error}")
    storage, source = wgpu.BufferUsage.STORAGE, wgpu.BufferUsage.COPY_SRC
    colours = _padded(rgb, count)
    buffers = [
        device.create_buffer_with_data(data=path.with_suffix(".bin").read_bytes(), usage=storage),
        device.create_buffer_with_data(data=colours.tobytes(), usage=storage),
        device.create_buffer(size=colours.nbytes, usage=storage | source),
    ]
    module = device.create_shader_module(code=(folder / "main.spv").read_bytes())
    pipeline = device.create_compute_pipeline(
        layout="auto", compute={"module": module, "entry_point": "main"}
    )
    entries = [
        {"binding": place, "resource": {"buffer": each, "offset": 0, "size": each.size}}
        for place, each in enumerate(buffers)
    ]
    group = device.create_bind_group(layout=pipeline.get_bind_group_layout(0), entries=entries)
    commands = device.create_command_encoder()
    work = commands.begin_compute_pass()
    work.set_pipeline(pipeline)
    work.set_bind_group(0, group)
    work.dispatch_workgroups(count // 64)
    work.end()
    device.queue.submit([commands.finish()])
    return np.frombuffer(device.queue.read_buffer(buffers[2]), np.float32).reshape(-1, 4)[: len(rgb)]


def _listed(wavelengths):
    return ", ".join(str(float(nm)) for nm in wavelengths)


def _padded(rgb, count):
    """Colours (count, 4) with a fourth channel."""
    colours = np.zeros((count, 4), np.float32)
    colours[: len(rgb), :3] = rgb
    return colours


def _text(data):
    return base64.b64encode(data).decode()
