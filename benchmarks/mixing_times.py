"""What a mixture takes; answers are checked before they are timed."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from benchmarks.mixing_pictures import colour
from benchmarks.page import table
from uplift.colorimetry.observer import colour_science
from uplift.common.arrays import Array
from uplift.design.mixing import coats, hsl, kubelka_munk, overpaint
from uplift.design.mixing.mixers import SPECTRAL, mixers
from uplift.design.mixing.pigments import Pigment
from uplift.lab.timing import Spread, timed
from uplift.lookup import Cube

MIXTURES, PIXELS, COLOURS = 20_000, 1_000_000, 1_000_000
RUNS = 5
CHECKED = 20


def mixtures(cube: Cube) -> str:
    """Nanoseconds of a mixture of two, through RGB and between spectra."""
    rng = np.random.default_rng(0)
    rgb, parts = rng.random((MIXTURES, 2, 3)), rng.random((MIXTURES, 2)) + 0.1
    spectra = cube.reflectance(rgb)
    rows = []
    for mixer in mixers(cube):
        between = SPECTRAL.get(mixer.name)
        _check(mixer.mix, rgb, parts)
        whole = _ns(partial(mixer.mix, rgb, parts), MIXTURES)
        alone = f"{_ns(partial(between[1], spectra, parts), MIXTURES):,.0f}" if between else "–"
        rows.append([mixer.title, f"{whole:,.0f}", alone])
    words = (
        f"Nanoseconds of CPU for a mixture of two, of {MIXTURES:,} at once on one thread: median "
        f"(least–most) of {RUNS} runs. From RGB to RGB both colours are uplifted first, which is most of it;"
        " between spectra they are there, at 81 wavelengths."
    )
    return table("What a mixture takes", words, ["", "RGB to RGB", "between spectra"], rows)


def _check(mix: Callable[[Array, Array], Array], rgb: Array, parts: Array) -> None:
    """All at once give what each gives by itself."""
    found = mix(rgb[:CHECKED], parts[:CHECKED])
    expected = np.array([mix(one, share) for one, share in zip(rgb[:CHECKED], parts[:CHECKED], strict=True)])
    if not np.allclose(found, expected, atol=1e-9):
        raise RuntimeError("a wrong answer is not worth timing")


def images(cube: Cube) -> str:
    """A coat over an image, and HSL to RGB."""
    rng = np.random.default_rng(0)
    red = coats.palette([coats.paint(cube.reflectance(colour(cube, "red")))])
    coat = coats.of_paints(red, [1], 0.5)
    brush = overpaint.prepare(cube, coat, threads=1)
    image = rng.random((PIXELS, 3)).astype(np.float32)
    expected = cube.data.sensor.rgb(coat.over(cube.reflectance(image[:CHECKED])))
    if np.abs(brush.paint(image)[:CHECKED] - expected).max() > 1e-5:
        raise RuntimeError("a wrong answer is not worth timing")
    colours = rng.random((COLOURS, 3))
    peer = colour_science().HSL_to_RGB
    if not np.allclose(hsl.to_rgb(colours), peer(colours)):
        raise RuntimeError("a wrong answer is not worth timing")
    spectra = cube.reflectance(image[:MIXTURES])
    paint = partial(_over, red, spectra)
    rows = [
        ["a coat over a painting, RGB to RGB", _told(_ns(lambda: brush.paint(image), PIXELS))],
        ["K–M layer made and laid on a ground, 81 wavelengths", _told(_ns(paint, MIXTURES))],
        ["HSL to RGB (5.3.5)", _told(_ns(lambda: hsl.to_rgb(colours), COLOURS))],
        ["HSL to RGB, colour-science", _told(_ns(lambda: peer(colours), COLOURS))],
    ]
    words = f"The same for each of {PIXELS:,} pixels, {MIXTURES:,} layers of different thickness, {COLOURS:,} colours."
    return table("What a pixel takes", words, ["", "ns"], rows)


def _over(paint: Pigment, grounds: Array) -> Array:
    thickness = np.linspace(0.01, 3, len(grounds))
    return kubelka_munk.layer(paint.mixed([1]), thickness).over(grounds)


def _ns(function: Callable[[], object], count: int) -> Spread:
    """CPU nanoseconds each, warm."""
    function()
    _, cpu = timed(function, RUNS)
    return cpu.scaled(1e9 / count)


def _told(spread: Spread) -> str:
    return f"{spread:,.0f}"
