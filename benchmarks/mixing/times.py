"""CPU times of mixtures; results are checked before timing."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from benchmarks.mixing.pictures import colour
from uplift.colorimetry.observer import colour_science
from uplift.common.arrays import Array
from uplift.design.mixing import Ingredients, Medium, dispersive, make_coat, overpainter
from uplift.design.mixing.heuristics import hsl_to_rgb
from uplift.design.mixing.pigments import Pigment, from_opaque
from uplift.design.mixing.theories import mixers, spectral_models
from uplift.lab.timing import Spread, time_calls
from uplift.lookup import Cube

MIXTURES, PIXELS, COLOURS = 20_000, 1_000_000, 1_000_000
RUNS = 5
CHECKED = 20


def measure(cube: Cube) -> dict[str, Any]:
    """Time mixtures, and operations on images."""
    return {
        "runs": RUNS,
        "mixtures": MIXTURES,
        "pixels": PIXELS,
        "colours": COLOURS,
        "mixture_times": mixtures(cube),
        "pixel_times": images(cube),
    }


def mixtures(cube: Cube) -> list[dict[str, Any]]:
    """Return nanoseconds per mixture of two, from RGB to RGB and between spectra."""
    rng = np.random.default_rng(0)
    rgb, parts = rng.random((MIXTURES, 2, 3)), rng.random((MIXTURES, 2)) + 0.1
    spectra = cube.reflectance(rgb)
    rows, spectral_mixers = [], spectral_models(cube.data.sensor)
    for mixer in mixers(cube):
        _check(mixer.mix, rgb, parts)
        between = spectral_mixers.get(mixer.name)
        spectral = _ns(partial(between[1], spectra, parts), MIXTURES) if between else None
        rows.append({"mixer": mixer.title, "rgb": _ns(partial(mixer.mix, rgb, parts), MIXTURES), "spectra": spectral})
    return rows


def _check(mix: Callable[[Array, Array], Array], rgb: Array, parts: Array) -> None:
    """Raise `RuntimeError` unless a batch gives the same results as single mixtures."""
    batch = mix(rgb[:CHECKED], parts[:CHECKED])
    expected = np.array([mix(one, share) for one, share in zip(rgb[:CHECKED], parts[:CHECKED], strict=True)])
    if not np.allclose(batch, expected, atol=1e-9):
        raise RuntimeError("wrong result: nothing to time")


def images(cube: Cube) -> list[dict[str, Any]]:
    """Return nanoseconds of a coat over an image, and of HSL to RGB."""
    rng = np.random.default_rng(0)
    spectrum = cube.reflectance(colour(cube, "red"))
    scattering = dispersive(cube.data.sensor)
    coat = make_coat("pigment", Ingredients(spectrum[None]), [1], Medium(0.5, scattering=scattering))
    brush = overpainter(cube, coat, threads=1)
    image = rng.random((PIXELS, 3)).astype(np.float32)
    expected = cube.data.sensor.rgb(coat.over(cube.reflectance(image[:CHECKED])))
    if np.abs(brush.paint(image)[:CHECKED] - expected).max() > 1e-5:
        raise RuntimeError("wrong result: nothing to time")
    colours = rng.random((COLOURS, 3))
    peer = colour_science().HSL_to_RGB
    if not np.allclose(hsl_to_rgb(colours), peer(colours)):
        raise RuntimeError("wrong result: nothing to time")
    spectra = cube.reflectance(image[:MIXTURES])
    paint = partial(_over, from_opaque(spectrum[None], scattering), spectra)
    operations: dict[str, tuple[Callable[[], object], int]] = {
        "coat over a painting, RGB to RGB": (lambda: brush.paint(image), PIXELS),
        "Kubelka–Munk layer on a ground, 81 wavelengths": (paint, MIXTURES),
        "HSL to RGB (5.3.5)": (lambda: hsl_to_rgb(colours), COLOURS),
        "HSL to RGB, colour-science": (lambda: peer(colours), COLOURS),
    }
    return [{"operation": name, "ns": _ns(function, count)} for name, (function, count) in operations.items()]


def _over(paint: Pigment, grounds: Array) -> Array:
    thickness = np.linspace(0.01, 3, len(grounds))
    return paint.mix([1]).layer(thickness).over(grounds)


def _ns(function: Callable[[], object], count: int) -> Spread:
    """Return CPU nanoseconds per item, warm."""
    function()
    _, cpu = time_calls(function, RUNS)
    return cpu.scaled(1e9 / count)
