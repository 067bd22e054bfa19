"""Run exported programs: each function takes a program, linear RGB (n, 3), four wavelengths and the form of the table.

It returns reflectances (n, 4), and skips the test if the compiler, the browser or the driver is lacking.
"""

from __future__ import annotations

import struct
import subprocess
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from benchmarks.programs import shaders
from benchmarks.programs.shaders import listed, padded, textures
from tests.parts import BLENDER, BLENDER_PYTHON, CC, CHROMIUM, CXX, GLSLANG, NVCC, VULKAN, need
from uplift.common.processes import call_in_child

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
    need(NVCC)
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
    need(BLENDER)
    side = int(np.ceil(np.sqrt(len(rgb))))
    pixels = np.ascontiguousarray(padded(rgb, side * side)[:, :3].reshape(side, side, 3))
    colours, shader, out = (path.with_name(name) for name in ("colours.exr", "lookup.osl", "found.exr"))
    _exr(colours, pixels)
    code, table = path.read_text(), path.with_suffix(".exr")
    code = code[: code.index("shader cube_reflectance")]
    found = []
    for three in (wavelengths[:3], wavelengths[1:]):
        words = {"wavelengths": listed(three), "colours": colours, "table": table}
        shader.write_text(SHADER.format(code=code, **words))
        command = [BLENDER_PYTHON, Path(__file__).with_name("render_osl.py"), shader, str(side), out]
        subprocess.run(command, check=True, capture_output=True)
        found.append(OpenEXR.File(str(out)).channels()["RGBA"].pixels.reshape(-1, 4)[: len(rgb), :3])
    return np.concatenate([found[0], found[1][:, 2:]], axis=1)


def _exr(path, pixels):
    header = {"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION}
    OpenEXR.File(header, {"RGB": pixels}).write(str(path))


def _compiled(path, rgb, wavelengths, compiler, call, load):
    need({"cc": CC, "c++": CXX}[compiler[0]])
    folder = path.parent
    text = HOST.format(header=path.name, wavelengths=listed(wavelengths), call=call, load=load)
    (folder / "main.c").write_text(text)
    subprocess.run([*compiler, *STRICT, "main.c", "-o", "main", "-lm"], cwd=folder, check=True)
    done = subprocess.run(
        [folder / "main"], cwd=folder, input=rgb.astype(np.float32).tobytes(), capture_output=True, check=True
    )
    return np.frombuffer(done.stdout, np.float32).reshape(-1, 4)


def glsl(path, rgb, wavelengths, form="file"):
    """In Chromium, by WebGL 2."""
    return _in_browser(shaders.glsl, path, rgb, wavelengths, form)


def wgsl(path, rgb, wavelengths, form="file"):
    """In Chromium, by WebGPU."""
    return _in_browser(shaders.wgsl, path, rgb, wavelengths, form)


def _in_browser(run, *arguments):
    need(CHROMIUM)
    found = run(*arguments)
    if found is None:
        pytest.skip("the browser has no such graphics interface")
    return found.reflectances


def hlsl(path, rgb, wavelengths, form="file"):
    """Compiled to SPIR-V, and by Vulkan: needs glslangValidator and wgpu."""
    need(GLSLANG, VULKAN)
    folder, count = path.parent, -(-len(rgb) // 64) * 64
    binding = 1 if form == "file" else len(textures(path, ".dds"))
    places = {"wavelengths": listed(wavelengths), "binding": binding, "after": binding + 1}
    (folder / "main.hlsl").write_text(PIXEL.format(code=path.read_text(), **places))
    command = ["glslangValidator", "-D", "-V", "-S", "comp", "-e", "main", "main.hlsl", "-o", "main.spv"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return call_in_child(_by_vulkan, path, rgb, form, count, seconds=60)


def _by_vulkan(path, rgb, form, count):
    """Run in a child process: drivers may crash."""
    import wgpu

    device = wgpu.gpu.request_adapter_sync().request_device_sync()
    storage, source = wgpu.BufferUsage.STORAGE, wgpu.BufferUsage.COPY_SRC
    colours = padded(rgb, count)
    if form == "file":
        data = path.with_suffix(".bin").read_bytes()
        held = [_whole(device.create_buffer_with_data(data=data, usage=storage))]
    else:
        held = [_dds(wgpu, device, each.read_bytes()) for each in textures(path, ".dds")]
    given = device.create_buffer_with_data(data=colours.tobytes(), usage=storage)
    found = device.create_buffer(size=colours.nbytes, usage=storage | source)
    module = device.create_shader_module(code=path.with_name("main.spv").read_bytes())
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
