"""Run exported programs: each function takes a program, linear RGB (n, 3), four wavelengths and the form of the table.

It returns reflectances (n, 4), and skips the test if the compiler, the browser or the driver is lacking.
"""

import subprocess

import numpy as np
import pytest

from tests.io.export import webgl
from tests.parts import CC, CHROMIUM, CXX, GLSLANG, NVCC, VULKAN, need, vulkan_device
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
STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-O1")
KERNEL = """#include "{header}"
extern "C" __global__ void lookup(const float *table, const float *rgb, const float *wavelengths, float *found)
{{
    int at = blockIdx.x * blockDim.x + threadIdx.x;
    cube_reflectances(table, rgb + 3 * at, wavelengths, found + 4 * at);
}}
"""
PIXEL = """{code}
StructuredBuffer<float4> colours : register(t1);
RWStructuredBuffer<float4> found : register(u2);
[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {{
    found[id.x] = cube_reflectances(colours[id.x].xyz, float4({wavelengths}));
}}
"""


def c(path, rgb, wavelengths, form="header", compiler=("cc", "-std=c99")):
    load = LOAD_FILE if form == "file" else ""
    return _compiled(path, rgb, wavelengths, compiler, "rgb, wavelengths, 4, found", load)


def cpp(path, rgb, wavelengths, form="header"):
    return c(path, rgb, wavelengths, form, ("c++", "-std=c++11", "-x", "c++"))


def cuda(path, rgb, wavelengths, form="file"):
    """On the host, where the same functions are C++."""
    load = LOAD.format(size=path.with_suffix(".bin").stat().st_size // 4)
    compiler = ("c++", "-std=c++11", "-x", "c++")
    return _compiled(path, rgb, wavelengths, compiler, "table, rgb, wavelengths, found", load)


def ptx(path):
    """Compile to PTX, the assembly language of graphics processors. Returns it."""
    need(NVCC)
    path.with_suffix(".cu").write_text(KERNEL.format(header=path.name))
    options = ("-ptx", "-Werror", "all-warnings")
    subprocess.run(["nvcc", *options, path.with_suffix(".cu"), "-o", path.with_suffix(".ptx")], check=True)
    return path.with_suffix(".ptx").read_text()


def _compiled(path, rgb, wavelengths, compiler, call, load):
    need({"cc": CC, "c++": CXX}[compiler[0]])
    folder = path.parent
    text = HOST.format(header=path.name, wavelengths=listed(wavelengths), call=call, load=load)
    (folder / "main.c").write_text(text)
    casts = ["-Wold-style-cast"] if compiler[0] == "c++" else []
    subprocess.run([*compiler, *STRICT, *casts, "main.c", "-o", "main", "-lm"], cwd=folder, check=True)
    done = subprocess.run(
        [folder / "main"], cwd=folder, input=rgb.astype(np.float32).tobytes(), capture_output=True, check=True
    )
    return np.frombuffer(done.stdout, np.float32).reshape(-1, 4)


def listed(wavelengths):
    return ", ".join(str(float(nm)) for nm in wavelengths)


def padded(rgb, count):
    """Return colours (count, 4) with a fourth channel."""
    colours = np.zeros((count, 4), np.float32)
    colours[: len(rgb), :3] = rgb
    return colours


def glsl(path, rgb, wavelengths, form="file"):
    """In Chromium, by WebGL 2."""
    need(CHROMIUM)
    side = int(np.ceil(np.sqrt(len(rgb))))
    found = webgl.run(path, padded(rgb, side * side), listed(wavelengths))
    if found is None:
        pytest.skip("the browser has no WebGL 2")
    return found[: len(rgb)]


def hlsl(path, rgb, wavelengths, form="file"):
    """Compiled to SPIR-V, and by Vulkan: needs glslangValidator and wgpu."""
    need(GLSLANG, VULKAN)
    folder, count = path.parent, -(-len(rgb) // 64) * 64
    (folder / "main.hlsl").write_text(PIXEL.format(code=path.read_text(), wavelengths=listed(wavelengths)))
    command = ["glslangValidator", "-D", "-V", "-S", "comp", "-e", "main", "main.hlsl", "-o", "main.spv"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return call_in_child(_by_vulkan, path, rgb, count, seconds=60)


def _by_vulkan(path, rgb, count):
    """Run in a child process: drivers may crash."""
    import wgpu

    device = vulkan_device()
    storage, source = wgpu.BufferUsage.STORAGE, wgpu.BufferUsage.COPY_SRC
    colours = padded(rgb, count)
    table = device.create_buffer_with_data(data=path.with_suffix(".bin").read_bytes(), usage=storage)
    given = device.create_buffer_with_data(data=colours.tobytes(), usage=storage)
    found = device.create_buffer(size=colours.nbytes, usage=storage | source)
    module = device.create_shader_module(code=path.with_name("main.spv").read_bytes())
    compute = {"module": module, "entry_point": "main"}
    pipeline = device.create_compute_pipeline(layout="auto", compute=compute)
    buffers = enumerate((table, given, found))
    entries = [{"binding": k, "resource": {"buffer": each, "offset": 0, "size": each.size}} for k, each in buffers]
    group = device.create_bind_group(layout=pipeline.get_bind_group_layout(0), entries=entries)
    commands = device.create_command_encoder()
    work = commands.begin_compute_pass()
    work.set_pipeline(pipeline)
    work.set_bind_group(0, group)
    work.dispatch_workgroups(count // 64)
    work.end()
    device.queue.submit([commands.finish()])
    return np.frombuffer(device.queue.read_buffer(found), np.float32).reshape(-1, 4)[: len(rgb)]
