"""Sigmoids of quadratic polynomials from the table of Mitsuba 3: from Python a colour
per call, and compiled by LLVM.

Domain: linear sRGB in [0, 1]. Range: reflectance in [0, 1] at any wavelengths. The
table of 64 points along each edge is part of Mitsuba. From Python its lookup takes one
colour per call. A bitmap texture looks up those of all its texels when it is loaded,
and its evaluation is vectorised.

Jakob & Hanika 2019, "A low-dimensional function space for efficient spectral
upsampling", Computer Graphics Forum 38(2).
"""

import math
from functools import cache, partial
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.extras.timing import stopwatch
from uplift.lab.method import (
    Method,
    NotInstalledError,
    PreparedMethod,
    stated_sensor,
)
from uplift.lab.runner import Task
from uplift.models.sigmoid import evaluate_unscaled

VARIANT = "scalar_spectral"
"""The spectral variant that does not need LLVM."""
COMPILED = "llvm_ad_spectral"
"""The vectorised one."""
XYZ_TO_RGB = np.array(
    [
        [3.240479, -1.53715, -0.498535],
        [-0.969256, 1.875991, 0.041556],
        [0.055648, -0.204043, 1.057311],
    ]
)
"""From XYZ to linear sRGB, in rgb2spec, the program that fitted the table."""
AT_ONCE = 4
"""Wavelengths of an evaluation."""
MITSUBA = "Mitsuba 3: pip install mitsuba"
LLVM = (
    "LLVM 19, with which Mitsuba 3.9 works: apt install libllvm19, or name its "
    "library by DRJIT_LIBLLVM_PATH"
)
"""What the methods need."""


@cache
def reference_sensor() -> Sensor:
    """Return the sensor of the matrix of rgb2spec, under D65."""
    return stated_sensor(XYZ_TO_RGB)


def table_file() -> Path:
    """Return the file of the table, without loading Mitsuba; raise `NotInstalledError`
    if it is not installed.
    """
    spec = find_spec("mitsuba")
    if spec is None or spec.origin is None:
        raise NotInstalledError(f"needs {MITSUBA}")
    return Path(spec.origin).parent / "data" / "srgb.coeff"


def _mitsuba(variant: str) -> Any:
    mitsuba = import_module("mitsuba")
    mitsuba.set_variant(variant)
    return mitsuba


def prepare(task: Task) -> PreparedMethod:
    """Locate the table; Mitsuba loads it."""
    return PreparedMethod(spectra, table_file().stat().st_size, None)


def spectra(rgb: Array, wavelengths: Array) -> Array:
    """Return the reflectances (n, N) that Mitsuba gives linear sRGB (n, 3) at
    wavelengths (N,) in nm.
    """
    mitsuba = _mitsuba(VARIANT)
    coefficients = [mitsuba.srgb_model_fetch(colour) for colour in rgb.tolist()]
    return evaluate_unscaled(np.array(coefficients, dtype=float), wavelengths)


def prepare_compiled(task: Task) -> PreparedMethod:
    """Load Mitsuba's vectorised variant, without the kernels of earlier calls."""
    size = table_file().stat().st_size
    drjit = import_module("drjit")
    # True does not mean that LLVM works.
    if not drjit.has_backend(drjit.JitBackend.LLVM):
        raise NotInstalledError(f"needs {LLVM}")
    drjit.flush_kernel_cache()
    _, run = stopwatch(lambda: compiled_spectra(task.rgb[:1], task.sensor.wavelengths))
    return PreparedMethod(compiled_spectra, size, None, run.cpu)


def compiled_spectra(rgb: Array, wavelengths: Array) -> Array:
    """Return the reflectances (n, N) of a bitmap texture with the texels ``rgb`` (n,
    3), computed on one thread.
    """
    mitsuba = _mitsuba(COMPILED)
    drjit = import_module("drjit")
    threads = drjit.thread_count()
    drjit.set_thread_count(1)
    try:
        return _evaluate(mitsuba, drjit, rgb, wavelengths)
    finally:  # Mitsuba cannot write OpenEXR files with one thread
        drjit.set_thread_count(threads)


def _evaluate(mitsuba: Any, drjit: Any, rgb: Array, wavelengths: Array) -> Array:
    side = math.isqrt(len(rgb) - 1) + 1
    texels = np.zeros((side * side, 3), np.float32)
    texels[: len(rgb)] = rgb
    bitmap = mitsuba.Bitmap(
        texels.reshape(side, side, 3), mitsuba.Bitmap.PixelFormat.RGB
    )
    bitmap.set_srgb_gamma(False)
    texture = mitsuba.load_dict(
        {"type": "bitmap", "bitmap": bitmap, "filter_type": "nearest"}
    )
    at = drjit.zeros(mitsuba.SurfaceInteraction3f, len(rgb))
    index = drjit.arange(mitsuba.UInt32, len(rgb))
    at.uv = (mitsuba.Point2f(index % side, index // side) + 0.5) / side
    channels = []
    for start in range(0, len(wavelengths), AT_ONCE):
        block = wavelengths[start : start + AT_ONCE]
        at.wavelengths = type(at.wavelengths)(*np.resize(block, AT_ONCE).tolist())
        values = texture.eval(at)
        channels += [values[k] for k in range(len(block))]
    drjit.eval(channels)
    return np.stack(channels).T


_table = partial(
    Method,
    source="Jakob et al., Mitsuba 3, the table of Jakob & Hanika 2019 for sRGB",
    reference_sensor=reference_sensor,
    claimed_error=0.1,
)
METHODS = (
    _table(
        method="mitsuba3-table",
        title="Mitsuba 3, table of 64",
        prepare=prepare,
        note="coefficients from Python, one colour per call; spectra by numpy",
        needs=MITSUBA,
    ),
    _table(
        method="mitsuba3-llvm",
        title="Mitsuba 3, LLVM, table of 64",
        prepare=prepare_compiled,
        dtype="float32",
        note=(
            "a bitmap texture with a texel for each colour, loaded and evaluated, on "
            "one thread"
        ),
        needs=LLVM,
    ),
)
