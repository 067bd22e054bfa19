"""Run exported programs: each function takes a program, linear RGB (n, 3), four
wavelengths and the form of the table.

It returns reflectances (n, 4), and skips the test if the compiler, the browser or the
driver is lacking.
"""

import base64
import json
import subprocess
from functools import partial

import numpy as np
import pytest

from benchmarks.browser import browser
from tests.compiling import compile_in
from tests.helpers import output_of
from tests.parts import (
    CC,
    CHROMIUM,
    CXX,
    GLSLANG,
    NVCC,
    SANITIZED,
    SANITIZERS,
    VULKAN,
    need,
    vulkan_device,
)
from uplift.extras.processes import call_in_child

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
STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-O1")
KERNEL = """#include "{header}"
extern "C" __global__ void lookup(
    const float *table, const float *rgb, const float *wavelengths, float *found)
{{
    int at = blockIdx.x * blockDim.x + threadIdx.x;
    cube_reflectances(table, rgb + 3 * at, wavelengths, found + CUBE_WIDTH * at);
}}
"""
VULKAN_MAIN = """layout(location = 0) out vec4 found;
void main() { found = cube_reflectances(vec3(0.5), vec4(450, 500, 550, 600)); }
"""
PIXEL = """{code}
StructuredBuffer<float4> colours : register(t1);
RWStructuredBuffer<float4> found : register(u2);
[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {{
    found[id.x] = cube_reflectances(colours[id.x].xyz, float4(WAVELENGTHS));
}}
"""

FRAGMENT = """#version 300 es
{code}
uniform sampler2D colours;
out vec4 found;
void main() {{
    vec3 colour = texelFetch(colours, ivec2(gl_FragCoord.xy), 0).rgb;
    found = cube_reflectances(colour, vec4(WAVELENGTHS));
}}
"""
WEBGL = """(() => {
  const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const floats = text => new Float32Array(bytes(text).buffer);
  const data = DATA;
  const { code, table, colours, side } = data;
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: side, height: side });
  const gl = canvas.getContext("webgl2");
  if (!gl || !gl.getExtension("EXT_color_buffer_float")) return null;
  const program = gl.createProgram();
  const vertex = `#version 300 es
    void main() {
      float x = gl_VertexID == 1 ? 3. : -1., y = gl_VertexID == 2 ? 3. : -1.;
      gl_Position = vec4(x, y, 0., 1.);
    }`;
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, code]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
      throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  gl.useProgram(program);
  const upload = (unit, name, width, height, values) => {
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(
      gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, values);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
    if (name) gl.uniform1i(gl.getUniformLocation(program, name), unit);
  };
  UPLOAD
  upload(0, "colours", side, side, floats(colours));
  upload(1, "", side, side, null);
  const target = gl.getParameter(gl.TEXTURE_BINDING_2D);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(
    gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
  gl.viewport(0, 0, side, side);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const found = new Float32Array(4 * side * side);
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.FLOAT, found);
  let text = "";
  for (const byte of new Uint8Array(found.buffer)) text += String.fromCharCode(byte);
  return btoa(text);
})()"""

TABLE_UPLOAD = 'upload(2, "cube_table", data.columns, data.rows, floats(table));'


COMPILERS = {
    "c": (CC, ("cc", "-std=c99")),
    "cpp": (CXX, ("c++", "-std=c++11", "-x", "c++", "-Wold-style-cast")),
    "sanitized": (SANITIZERS, ("cc", *SANITIZED)),
    "fast": (CC, ("cc", "-O2", "-ffast-math")),  # as if nothing was NaN
}
"""What each way to compile needs, and its command."""


def run_c(path, host, given, compiler="c"):
    """Return what a host prints for numbers, next to the header of a path."""
    part, command = COMPILERS[compiler]
    need(part)
    folder = path.parent
    (folder / "main.c").write_text(host)
    program = compile_in(folder, command[0], *STRICT, *command[1:])
    done = subprocess.run(
        [program], cwd=folder, input=given.tobytes(), capture_output=True, check=True
    )
    return np.frombuffer(done.stdout, given.dtype)


def c(path, rgb, wavelengths, form="header", compiler="c"):
    load = LOAD_FILE if form == "file" else ""
    call = "rgb, wavelengths, 4, found"
    return _compiled(path, rgb, wavelengths, compiler, call, load)


cpp = partial(c, compiler="cpp")
fast = partial(c, compiler="fast")


def cuda(path, rgb, wavelengths, form="file"):
    """On the host, where the same functions are C++."""
    load = LOAD.format(size=path.with_suffix(".bin").stat().st_size // 4)
    call = "table, rgb, wavelengths, found"
    return _compiled(path, rgb, wavelengths, "cpp", call, load)


def _compiled(path, rgb, wavelengths, compiler, call, load):
    text = HOST.format(
        header=path.name, wavelengths=listed(wavelengths), call=call, load=load
    )
    return run_c(path, text, rgb.astype(np.float32), compiler).reshape(-1, 4)


def registers(path, width):
    """Compile for a graphics processor, for ``width`` wavelengths. Return the report of
    the assembler on registers.
    """
    need(NVCC)
    path.with_suffix(".cu").write_text(KERNEL.format(header=path.name))
    command = (
        f"nvcc -cubin -arch=sm_90 -DCUBE_WIDTH={width} -Xptxas -v -Werror all-warnings"
    )
    words = [
        *command.split(),
        path.with_suffix(".cu"),
        "-o",
        path.with_suffix(".cubin"),
    ]
    done = subprocess.run(words, check=True, capture_output=True, text=True)
    return done.stderr


def compile_vulkan(path, macros):
    """Compile a shader as it is written to SPIR-V, by GLSL 4.50. Return it as text."""
    need(GLSLANG)
    code = "\n".join(["#version 450", *macros, path.read_text(), VULKAN_MAIN])
    (path.parent / "main.frag").write_text(code)
    return output_of("glslangValidator", "-H", "-V", "main.frag", cwd=path.parent)


def listed(wavelengths):
    return ", ".join(str(float(nm)) for nm in wavelengths)


def padded(rgb, count):
    """Return colours (count, 4) with a fourth channel."""
    colours = np.zeros((count, 4), np.float32)
    colours[: len(rgb), :3] = rgb
    return colours


def glsl(path, rgb, wavelengths, form="file"):
    table = path.with_suffix(".bin").read_bytes()
    code = FRAGMENT.replace("WAVELENGTHS", listed(wavelengths))
    data = {
        "table": base64.b64encode(table).decode(),
        "columns": 2048,
        "rows": len(table) // (2048 * 16),
    }
    return shade(path, code, padded(rgb, len(rgb)), TABLE_UPLOAD, **data)


def shade(path, code, pixels, upload="", **data):
    """Return what a shader draws for pixels (n, 4), by WebGL 2 in Chromium."""
    need(CHROMIUM)
    side = int(np.ceil(np.sqrt(len(pixels))))
    colours = np.zeros((side * side, 4), np.float32)
    colours[: len(pixels)] = pixels
    shared = {
        "code": code.format(code=path.read_text()),
        "colours": base64.b64encode(colours.tobytes()).decode(),
        "side": side,
    }
    page = path.with_suffix(".html")
    page.write_text("<!doctype html><main aria-busy='false'></main>")
    data = {"table": "", **data, **shared}
    script = WEBGL.replace("UPLOAD", upload).replace("DATA", json.dumps(data))
    with browser() as opened:
        opened.open(page)
        found = opened.evaluate(script)
    if found is None:
        pytest.skip("the browser has no WebGL 2")
    rows = np.frombuffer(base64.b64decode(found), np.float32).reshape(-1, 4)
    return rows[: len(pixels)]


def hlsl(path, rgb, wavelengths, form="file"):
    """Compiled to SPIR-V, and by Vulkan: needs glslangValidator and wgpu."""
    need(GLSLANG, VULKAN)
    count = -(-len(rgb) // 64) * 64
    compile_hlsl(path, PIXEL.replace("WAVELENGTHS", listed(wavelengths)))
    return call_in_child(_by_vulkan, path, rgb, count, seconds=60)


def compile_hlsl(path, code):
    """Compile a shader to SPIR-V."""
    need(GLSLANG)
    main = path.with_name("main.hlsl")
    main.write_text(code.format(code=path.read_text()))
    command = "glslangValidator -D -V -S comp -e main main.hlsl -o main.spv"
    output_of(*command.split(), cwd=path.parent)
    return path.with_name("main.spv")


def _by_vulkan(path, rgb, count):
    """Run in a child process: drivers may crash."""
    import wgpu

    device = vulkan_device()
    storage = wgpu.BufferUsage.STORAGE
    source = wgpu.BufferUsage.COPY_SRC
    colours = padded(rgb, count)
    table = device.create_buffer_with_data(
        data=path.with_suffix(".bin").read_bytes(), usage=storage
    )
    given = device.create_buffer_with_data(data=colours.tobytes(), usage=storage)
    found = device.create_buffer(size=colours.nbytes, usage=storage | source)
    module = device.create_shader_module(code=path.with_name("main.spv").read_bytes())
    compute = {"module": module, "entry_point": "main"}
    pipeline = device.create_compute_pipeline(layout="auto", compute=compute)
    buffers = enumerate((table, given, found))
    entries = [
        {"binding": k, "resource": {"buffer": each, "offset": 0, "size": each.size}}
        for k, each in buffers
    ]
    group = device.create_bind_group(
        layout=pipeline.get_bind_group_layout(0), entries=entries
    )
    commands = device.create_command_encoder()
    work = commands.begin_compute_pass()
    work.set_pipeline(pipeline)
    work.set_bind_group(0, group)
    work.dispatch_workgroups(count // 64)
    work.end()
    device.queue.submit([commands.finish()])
    return np.frombuffer(device.queue.read_buffer(found), np.float32).reshape(-1, 4)[
        : len(rgb)
    ]
