"""The ColorChecker rendered under environments of measured lamps, for docs/emission.md and its picture."""

from __future__ import annotations

import tempfile
import warnings
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import OpenEXR

import uplift
from benchmarks import DOCS, record
from benchmarks.checker import OF_LIGHTS, Layout, caption, chart, draw, measured_spectra, start_mitsuba
from benchmarks.checker import render as render_chart
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.gamut import SRGB, conversion
from uplift.colorimetry.observer import lamps
from uplift.common.arrays import Array
from uplift.io.texture.uplifter import SPECTRAL_LAYOUT, spectral_channels

VARIANT = "llvm_ad_spectral"
TRUE, MITSUBA, KNOWN, UNKNOWN = "measured spectra", "Mitsuba 3", "table, lamps known", "table, lamps left out"
OTHER_SEED = "measured spectra, another seed"
LAYOUT, SPP = Layout(patch=32, gap=4), 512
HEIGHT, WIDTH = 16, 32
"""Pixels of an environment, which has no sharp edges."""
SUN = 60.0


class Lamp(NamedTuple):
    """A lamp of colour-science on an environment: a soft spot at ``(u, v)`` of ``size``, in shares of the height."""

    name: str
    u: float
    v: float
    size: float
    luminance: float


@dataclass(frozen=True)
class Sky:
    """A name, the light of the whole sphere and its luminance, and lamps. Spectra are known for every pixel."""

    name: str
    ambient: str
    luminance: float
    lamps: tuple[Lamp, ...]

    @property
    def lamp_names(self) -> tuple[str, ...]:
        """Names of all its lights."""
        return self.ambient, *(lamp.name for lamp in self.lamps)

    def power(self) -> Array:
        """Return the power (height, width, N) of luminance as stated, at the wavelengths of `lamps`."""
        known = lamps()
        spectra = dict(zip(known.names, known.power, strict=True))
        v, u = (np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5) / HEIGHT
        total = self.luminance * np.ones((HEIGHT, WIDTH, 1)) * spectra[self.ambient]
        for lamp in self.lamps:
            across = np.minimum(np.abs(u - lamp.u), WIDTH / HEIGHT - np.abs(u - lamp.u))
            spot = np.exp(-(across**2 + (v - lamp.v) ** 2) / (2 * lamp.size**2))
            total = total + lamp.luminance * spot[..., None] * spectra[lamp.name]
        return np.asarray(total)


DUSK = Lamp("C100S54 (HPS)", 0.3, 0.35, 0.05, SUN), Lamp("Mercury", 1.4, 0.4, 0.04, SUN / 4)
OFFICE = Lamp("D65", 0.2, 0.5, 0.12, 6.0), Lamp("F34/CW/RS/EW (Cool White FL)", 1.2, 0.15, 0.08, 20.0)
SHOP = Lamp("LED-B1", 0.4, 0.3, 0.04, SUN), Lamp("LED-RGB1", 1.1, 0.35, 0.06, SUN / 3)
SKIES = (
    Sky("street at dusk", "D75", 0.15, DUSK),
    Sky("office", "T8 Polylux 4000", 0.3, OFFICE),
    Sky("shop", "PHOS-2", 0.1, SHOP),
)
ByMethod = dict[tuple[str, str], Array]
"""Arrays by sky and method."""


def main() -> None:
    """Render, draw and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    version = start_mitsuba(VARIANT)
    with tempfile.TemporaryDirectory() as folder:
        images, whites, delta_e = render(SKIES, Path(folder), LAYOUT, SPP)
    captions = {key: "" if key[1] == TRUE else caption(errors) for key, errors in delta_e.items()}
    # XYZ relative to a white is a gamut, whose (1, 1, 1) Bradford adaptation takes to the white of the screen.
    to_screen = {
        name: conversion(SimpleNamespace(rgb_to_xyz=np.diag(white / white[1])), SRGB) / white
        for name, white in whites.items()
    }
    picture, size = DOCS / "emission" / "environments.png", (12.5, 2.6 * len(SKIES))
    draw(images, captions, to_screen, (TRUE, KNOWN, UNKNOWN, MITSUBA), LAYOUT, picture, size)
    record(
        "environment",
        precision="full",
        mitsuba=version,
        variant=VARIANT,
        samples=LAYOUT.patch**2 * SPP,
        skies=[{"sky": sky.name, "lights": ", ".join(sky.lamp_names)} for sky in SKIES],
        rows=[summary(*key, errors) for key, errors in delta_e.items() if key[1] != TRUE],
    )


def render(
    skies: tuple[Sky, ...], folder: Path, layout: Layout, spp: int
) -> tuple[ByMethod, dict[str, Array], ByMethod]:
    """Render the chart under all skies with all methods and one seed, and the truth with another seed too.

    Returns XYZ images, XYZ (3,) of a perfect reflector by sky, and ΔE00 (24,) of the patches.
    """
    reflectances, perfect = measured_spectra(chart()), [{"type": "uniform", "value": 1.0}] * 24
    images, whites, delta_e = {}, {}, {}
    for sky in skies:
        emitters = methods(sky, folder)
        true = emitters[TRUE]
        image = partial(render_chart, layout=layout, spp=spp, integrator=OF_LIGHTS)
        white = layout.means(image(true, perfect, seed=2)).mean(axis=0)
        found = {method: image(emitter, reflectances, seed=0) for method, emitter in emitters.items()}
        found[OTHER_SEED] = image(true, reflectances, seed=1)
        labs = {method: lab(layout.means(one), white) for method, one in found.items()}
        whites[sky.name] = white
        images |= {(sky.name, method): one for method, one in found.items()}
        delta_e |= {(sky.name, method): delta_e_2000(labs[TRUE], values) for method, values in labs.items()}
    return images, whites, delta_e


def methods(sky: Sky, folder: Path) -> dict[str, dict[str, Any]]:
    """Return the emitters by method: the spectra of the sky, or its RGB uplifted."""
    table, power, stem = uplift.load_emission(), sky.power(), sky.name.replace(" ", "-")
    names = spectral_channels("S0", table.wavelengths)
    spectral = _write(folder / f"{stem}-spectral.exr", names, power, **SPECTRAL_LAYOUT)
    rgb = _write(folder / f"{stem}.exr", ("R", "G", "B"), table.rgb(power))
    without = folder / f"{stem}.uplift"
    uplift.build_emission(without=sky.lamp_names).save(without)
    return {
        TRUE: {"type": "uplift_envmap", "filename": spectral},
        KNOWN: {"type": "uplift_envmap", "filename": rgb},
        UNKNOWN: {"type": "uplift_envmap", "filename": rgb, "cube": str(without)},
        MITSUBA: {"type": "envmap", "filename": rgb},
    }


def _write(path: Path, names: tuple[str, ...], planes: Array, **header: Any) -> str:
    channels = {name: np.ascontiguousarray(planes[..., place], dtype=np.float32) for place, name in enumerate(names)}
    OpenEXR.File({"type": OpenEXR.scanlineimage, **header}, channels).write(str(path))
    return str(path)


def summary(sky: str, method: str, errors: Array) -> dict[str, Any]:
    """Summarise the errors (24,) of the patches."""
    median, high = np.percentile(errors, (50, 95))
    quantiles = {"mean": errors.mean(), "median": median, "p95": high, "worst": errors.max()}
    return {"sky": sky, "method": method, **quantiles}


if __name__ == "__main__":
    main()
