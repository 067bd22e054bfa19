"""Parts that a machine may lack or have broken. Each is used in a child process before
a test relies on it.

A part that is there need not work: Dr.Jit finds any LLVM and aborts with an old one.
Those that `make parts` has fetched come after the machine's own.
"""

import ctypes
import os
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

import numpy as np
import pytest

from benchmarks.browser import browser
from uplift.extras.processes import call_in_child

FETCHED = Path(__file__).parents[1] / "out" / "parts"
"""A virtual environment; see tests/fetch_parts.py."""
SWIFTSHADER = FETCHED / "vulkan"
PATIENCE = 60.0
"""Seconds that a trial may take."""
EMPTY_KERNEL = "__global__ void nothing() {}\n"
EMPTY_PROGRAM = "int main(void) { return 0; }\n"
SANITIZED = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")
STREAMS = "process.exitCode = globalThis.DecompressionStream ? 0 : 1;"
EMPTY_SHADER = "#version 430\nlayout(local_size_x = 1) in;\nvoid main() {}\n"

os.environ["PATH"] += os.pathsep + str(FETCHED / "bin")
if (library := FETCHED / "lib" / "libLLVM.so").exists():
    os.environ.setdefault("DRJIT_LIBLLVM_PATH", str(library))


@dataclass(frozen=True)
class Part:
    """A part of a machine, how to install it, and a trial that raises an error or
    crashes unless it works.
    """

    name: str
    installation: str
    trial: Callable[[], object]


def need(*parts: Part) -> None:
    """Skip the test, or the module that is being imported, unless these parts work."""
    for part in parts:
        if trouble := problem(part):
            reason = f"{part.name} ({part.installation}): {trouble}"
            pytest.skip(reason, allow_module_level=True)


@cache
def problem(part: Part) -> str:
    """Return why a part does not work, empty if it does."""
    try:
        call_in_child(part.trial, seconds=PATIENCE)
    except Exception as error:
        return (str(error).splitlines() or [type(error).__name__])[0][:100]
    return ""


def _evaluate_texture(variant: str) -> None:
    import drjit
    import mitsuba

    mitsuba.set_variant(variant)
    drjit.flush_kernel_cache()  # compiled by an LLVM that may be gone
    bitmap = mitsuba.Bitmap(np.full((2, 2, 3), 0.5, np.float32))
    texture = mitsuba.load_dict({"type": "bitmap", "bitmap": bitmap})
    at = drjit.zeros(mitsuba.SurfaceInteraction3f)
    at.wavelengths = mitsuba.Spectrum(400, 500, 600, 700)
    assert np.isfinite(np.array(texture.eval(at))).all()


def _compile(name: str, text: str, *commands: str) -> None:
    """Write a source to a folder, and run commands there."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, name).write_text(text)
        for command in commands:
            subprocess.run(command.split(), cwd=folder, check=True, capture_output=True)


def _open_tab() -> None:
    with browser() as tab:
        assert tab.evaluate("1 + 1") == 2


def vulkan_device():
    """Return a device of Vulkan: by OpenGL, wgpu's translation of SPIR-V gives other
    numbers.
    """
    import wgpu

    if SWIFTSHADER.exists():
        ctypes.CDLL(str(SWIFTSHADER / "libvulkan.so.1"))  # that wgpu opens by its name
        driver = SWIFTSHADER / "vk_swiftshader_icd.json"
        os.environ["VK_DRIVER_FILES"] = str(driver)
    adapters = wgpu.gpu.enumerate_adapters_sync()
    return next(
        each for each in adapters if each.info["backend_type"] == "Vulkan"
    ).request_device_sync()


def _open_device() -> None:
    vulkan_device()


MITSUBA = Part(
    "Mitsuba 3",
    "pip install '.[mitsuba]'",
    partial(_evaluate_texture, "scalar_spectral"),
)
LLVM = Part(
    "LLVM that Mitsuba works with",
    "apt install libllvm19",
    partial(_evaluate_texture, "llvm_ad_spectral"),
)
_cc = partial(_compile, "main.c", EMPTY_PROGRAM, "cc main.c -o main", "./main")
_cxx = partial(_compile, "main.cpp", EMPTY_PROGRAM, "c++ main.cpp -o main", "./main")
_clang = partial(_compile, "main.c", EMPTY_PROGRAM, "clang main.c -o main")
_glslang = partial(_compile, "a.comp", EMPTY_SHADER, "glslangValidator a.comp")
CC = Part("a C compiler, cc", "apt install gcc", _cc)
CLANG = Part("clang", "apt install clang", _clang)
CXX = Part("a C++ compiler, c++", "apt install g++", _cxx)
_sanitized = partial(
    _compile,
    "main.c",
    EMPTY_PROGRAM,
    f"cc {' '.join(SANITIZED)} main.c -o main",
    "./main",
)
SANITIZERS = Part("AddressSanitizer and UBSan", "apt install gcc", _sanitized)
NODE = Part(
    "node 18 or later",
    "apt install nodejs",
    partial(_compile, "main.mjs", STREAMS, "node main.mjs"),
)
WASM = Part(
    "clang and lld for WebAssembly",
    "apt install clang lld",
    partial(
        _compile,
        "main.c",
        EMPTY_PROGRAM,
        "clang --target=wasm32 -nostdlib -Wl,--no-entry main.c -o main.wasm",
    ),
)
CHROMIUM = Part("Chromium", "apt install chromium", _open_tab)
VULKAN = Part(
    "a Vulkan driver",
    "pip install '.[gpu]' and apt install mesa-vulkan-drivers",
    _open_device,
)
NVCC = Part(
    "nvcc",
    "the CUDA toolkit",
    partial(_compile, "a.cu", EMPTY_KERNEL, "nvcc -ptx a.cu"),
)
GLSLANG = Part("glslangValidator", "apt install glslang-tools", _glslang)
