"""Run exported programs: each function takes a program, linear RGB (n, 3), four wavelengths and the form of the table.

It returns reflectances (n, 4), and skips the test if the compiler, the browser or the driver is lacking.
"""

from __future__ import annotations

import base64
import json
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from benchmarks.browser import browser, chromium

BLENDER = Path(__file__).parents[3] / ".osl" / "bin" / "python"
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
LOAD_FILE = """const char *problem = cube_load("cube.bin");
    if (problem) return fputs(problem, stderr), 1;"""
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
SHADER = """{code}
shader lookup(output color found = 0)
{{
    float rgb[3], place[4], lanes[3] = {{{wavelengths}}}, total[3];
    for (int k = 0; k < 3; ++k) {{
        total[k] = 0;
        rgb[k] = texture("{colours}", (P[0] + 1) / 2, (1 - P[1]) / 2, "firstchannel", k, "interp", "closest");
    }}
    int entry = cube_locate("{table}", rgb, place);
    cube_answer("{table}", place, entry, lanes, total);
    found = color(total[0], total[1], total[2]);
}}
"""
KERNEL = """#include "{header}"
extern "C" __global__ void lookup(const float *table, const float *rgb, const float *wavelengths, float *found)
{{
    int at = blockIdx.x * blockDim.x + threadIdx.x;
    cube_reflectances(table, rgb + 3 * at, wavelengths, found + 4 * at);
}}
"""
KTX2 = """const ktx2 = text => {
  const { buffer } = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const view = new DataView(buffer), number = at => view.getUint32(at, true);
  const [width, height, depth] = [20, 24, 28].map(number), start = number(80), length = number(88) / 4;
  return { width, height, depth, texels: new Float32Array(buffer, start, length) };
};
"""
PIXEL = """{code}
StructuredBuffer<float4> colours : register(t{binding});
RWStructuredBuffer<float4> found : register(u{after});
[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {{
    found[id.x] = cube_reflectances(colours[id.x].xyz, float4({wavelengths}));
}}
"""


def c(path, rgb, wavelengths, form="header", compiler=("cc", "-std=c99")):
    load = LOAD_FILE if form == "file" else ""
    return _compiled(path, rgb, wavelengths, compiler, "rgb, wavelengths, 4, found", load)


def cpp(path, rgb, wavelengths):
    return c(path, rgb, wavelengths, "header", ("c++", "-std=c++11", "-x", "c++"))


def cuda(path, rgb, wavelengths, form="file"):
    """On the host, where the same functions are C++."""
    load = LOAD.format(size=path.with_suffix(".bin").stat().st_size // 4)
    compiler = ("c++", "-std=c++11", "-x", "c++")
    return _compiled(path, rgb, wavelengths, compiler, "table, rgb, wavelengths, found", load)


def ptx(path):
    """Compile to PTX, the assembly language of graphics processors. Returns it."""
    if shutil.which("nvcc") is None:
        pytest.skip("needs nvcc, of the CUDA toolkit")
    path.with_suffix(".cu").write_text(KERNEL.format(header=path.name))
    command = [
        "nvcc",
        "-ptx",
        "-Werror",
        "all-warnings",
        path.with_suffix(".cu"),
        "-o",
        path.with_suffix(".ptx"),
    ]
    subprocess.run(command, check=True)
    return path.with_suffix(".ptx").read_text()


def osl(path, rgb, wavelengths, form="file"):
    """In Blender, three wavelengths at a time."""
    if not BLENDER.exists():
        pytest.skip("needs Blender: make osl")
    side = int(np.ceil(np.sqrt(len(rgb))))
    pixels = np.ascontiguousarray(_padded(rgb, side * side)[:, :3].reshape(side, side, 3))
    colours, shader, out = (path.with_name(name) for name in ("colours.exr", "lookup.osl", "found.exr"))
    _exr(colours, pixels)
    code, table = path.read_text(), path.with_suffix(".exr")
    code = code[: code.index("shader cube_reflectance")]
    found = []
    for three in (wavelengths[:3], wavelengths[1:]):
        words = {"wavelengths": _listed(three), "colours": colours, "table": table}
        shader.write_text(SHADER.format(code=code, **words))
        command = [BLENDER, Path(__file__).with_name("render_osl.py"), shader, str(side), out]
        subprocess.run(command, check=True, capture_output=True)
        found.append(OpenEXR.File(str(out)).channels()["RGBA"].pixels.reshape(-1, 4)[: len(rgb), :3])
    return np.concatenate([found[0], found[1][:, 2:]], axis=1)


def _exr(path, pixels):
    header = {"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION}
    OpenEXR.File(header, {"RGB": pixels}).write(str(path))


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


def glsl(path, rgb, wavelengths, form="file"):
    """In Chromium, by WebGL 2."""
    code = FRAGMENT.format(code=path.read_text(), wavelengths=_listed(wavelengths))
    side = int(np.ceil(np.sqrt(len(rgb))))
    tables = _tables(path, form)
    rows = len(tables["table"]) * 3 // 4 // (2048 * 16)
    shape = {"columns": 2048, "rows": rows, "side": side}
    return _in_browser(path, WEBGL, _padded(rgb, side * side), code=code, **tables, **shape)[: len(rgb)]


def wgsl(path, rgb, wavelengths, form="file"):
    """In Chromium, by WebGPU."""
    tables = _tables(path, form)
    places = {"wavelengths": _listed(wavelengths), "binding": max(1, len(tables["textures"]))}
    code = COMPUTE.format(code=path.read_text(), **places)
    return _in_browser(path, WEBGPU, _padded(rgb, len(rgb)), code=code, **tables)


def _tables(path, form):
    """Return the table as text, or textures as text by the names of their uniforms."""
    if form == "file":
        return {"table": _text(path.with_suffix(".bin").read_bytes()), "textures": {}}
    names = [each.stem.split("-") for each in textures(path, ".ktx2")]
    names = ["cube_entries" if name[-1] == "entries" else f"cube_points_{name[-1]}" for name in names]
    files = (_text(each.read_bytes()) for each in textures(path, ".ktx2"))
    return {"table": "", "textures": dict(zip(names, files, strict=True))}


def textures(path, suffix):
    """Return the files of textures, that of the entries last."""
    return sorted(path.parent.glob(f"{path.stem}-*{suffix}"))


def _in_browser(path, script, colours, **data):
    if chromium() is None:
        pytest.skip("needs Chromium")
    page = path.with_suffix(".html")
    page.write_text("<!doctype html><main aria-busy='false'></main>")
    content = json.dumps({**data, "colours": _text(colours.tobytes())})
    with browser() as opened:
        opened.open(page)
        found = opened.evaluate("{ " + KTX2 + script.replace("DATA", content) + " }")
    if found is None:
        pytest.skip("the browser has no such graphics interface")
    return np.frombuffer(base64.b64decode(found), np.float32).reshape(-1, 4)


def hlsl(path, rgb, wavelengths, form="file"):
    """Compiled to SPIR-V, and by Vulkan: needs glslangValidator and wgpu."""
    if shutil.which("glslangValidator") is None:
        pytest.skip("needs glslangValidator")
    folder, count = path.parent, -(-len(rgb) // 64) * 64
    binding = 1 if form == "file" else len(textures(path, ".dds"))
    places = {"wavelengths": _listed(wavelengths), "binding": binding, "after": binding + 1}
    (folder / "main.hlsl").write_text(PIXEL.format(code=path.read_text(), **places))
    command = ["glslangValidator", "-D", "-V", "-S", "comp", "-e", "main", "main.hlsl", "-o", "main.spv"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    wgpu = pytest.importorskip("wgpu", reason="needs wgpu: pip install uplift[gpu]")
    try:
        device = wgpu.gpu.request_adapter_sync().request_device_sync()
    except (RuntimeError, AttributeError, OSError) as error:
        pytest.skip(f"needs a Vulkan driver: {error}")
    storage, source = wgpu.BufferUsage.STORAGE, wgpu.BufferUsage.COPY_SRC
    colours = _padded(rgb, count)
    if form == "file":
        data = path.with_suffix(".bin").read_bytes()
        held = [_whole(device.create_buffer_with_data(data=data, usage=storage))]
    else:
        held = [_dds(wgpu, device, each.read_bytes()) for each in textures(path, ".dds")]
    given = device.create_buffer_with_data(data=colours.tobytes(), usage=storage)
    found = device.create_buffer(size=colours.nbytes, usage=storage | source)
    module = device.create_shader_module(code=(folder / "main.spv").read_bytes())
    compute = {"module": module, "entry_point": "main"}
    pipeline = device.create_compute_pipeline(layout="auto", compute=compute)
    resources = [*held, _whole(given), _whole(found)]
    entries = [{"binding": place, "resource": each} for place, each in enumerate(resources)]
    group = device.create_bind_group(layout=pipeline.get_bind_group_layout(0), entries=entries)
    commands = device.create_command_encoder()
    work = commands.begin_compute_pass()
    work.set_pipeline(pipeline)
    work.set_bind_group(0, group)
    work.dispatch_workgroups(count // 64)
    work.end()
    device.queue.submit([commands.finish()])
    return np.frombuffer(device.queue.read_buffer(found), np.float32).reshape(-1, 4)[: len(rgb)]


def _whole(buffer):
    return {"buffer": buffer, "offset": 0, "size": buffer.size}


def _dds(wgpu, device, data):
    """Upload a texture."""
    height, width = struct.unpack_from("<2I", data, 12)
    depth = struct.unpack_from("<I", data, 24)[0]
    size, dimension = (width, height, depth or 1), "3d" if depth else "2d"
    usage = wgpu.TextureUsage.TEXTURE_BINDING | wgpu.TextureUsage.COPY_DST
    texture = device.create_texture(size=size, dimension=dimension, format="rgba32float", usage=usage)
    layout = {"bytes_per_row": 16 * width, "rows_per_image": height}
    device.queue.write_texture({"texture": texture}, data[148:], layout, size)
    return texture.create_view()


def _listed(wavelengths):
    return ", ".join(str(float(nm)) for nm in wavelengths)


def _padded(rgb, count):
    """Colours (count, 4) with a fourth channel."""
    colours = np.zeros((count, 4), np.float32)
    colours[: len(rgb), :3] = rgb
    return colours


def _text(data):
    return base64.b64encode(data).decode()
