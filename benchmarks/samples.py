"""How samples of spectra of one colour spread, compared with materials that were left
out, for docs/guides/gradients.md.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

import uplift
from benchmarks import DOCS, Row
from benchmarks.materials import inside, spectra
from benchmarks.timing import time_call
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.gamut import SRGB
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.marks import line, picture
from uplift.extras.pages.panels import Axis, Panel, draw, spectra_panel
from uplift.extras.photographs.photograph import photograph
from uplift.extras.photographs.samples import prepare_samples
from uplift.extras.timing import TimingStats
from uplift.lookup.cube import Cube
from uplift.lookup.errors_under_lights import evidence

LIGHTS = ("A", "FL2", "FL11", "LED-B3", "HP1")
LEVELS = (0.68, 0.95)
SETS = ("rawtoaces", "cie2017", "pmc")
DIM = 16
COUNT = 400
"""Samples of each material."""
SEED = 1
DRAWN = {"brown": (0.30, 0.14, 0.07), "green": (0.12, 0.27, 0.09)}
"""Colours of the picture, linear sRGB."""
SHOWN = 24
"""Samples of each in the picture."""
TIMED = 10_000
RUNS = 3


@dataclass(frozen=True, eq=False)
class Spread:
    """Materials (M, 81), the answers to their colours, and samples (M, n, 81)."""

    measured: Array
    around: Array
    samples: Array

    def under(self, name: str) -> Row:
        """Return mean ΔE00 of materials and samples from the answers under a light, and
        the percentage of materials within that of samples.
        """
        light = observer.light(name)
        spread = delta_e_spectra(light, self.samples, self.around[:, None])
        radii = np.quantile(spread, LEVELS, axis=1)
        error = delta_e_spectra(light, self.around, self.measured)
        within = 100 * (error <= radii).mean(axis=1)
        return {
            "light": name,
            "materials": error.mean(),
            "samples": spread.mean(),
            "within_68": within[0],
            "within_95": within[1],
        }


def left_out(cube: Cube) -> Spread:
    """The materials from which a cube learns, each without its family."""
    known = evidence(cube.data)
    sampler = prepare_samples(cube)
    measured = np.asarray(known.measured, dtype=float)
    rgb = np.clip(cube.data.sensor.rgb(measured), 0, 1)
    around = np.clip(np.asarray(known.left_out, dtype=float), 0, 1)
    covariance = sampler.metamers.left_out_covariance(known.family)
    random = np.random.default_rng(SEED)
    at = cube.wavelengths
    samples = sampler.draw(around, rgb, covariance, COUNT, random, at)
    return Spread(measured, around, samples)


def other_half(name: str) -> Spread:
    """Every second entry of a set, answered by a cube of the others."""
    atlas = spectra(name)
    cube = uplift.build(atlas[::2], dim=DIM, leave_out=[name])
    queried = inside(atlas[1::2])
    samples = prepare_samples(cube)(queried.rgb, COUNT, SEED)
    return Spread(queried.measured, cube.reflectance(queried.rgb), samples)


def examples() -> None:
    """Draw spectra of two colours, and their colours under lights."""
    sample = prepare_samples(uplift.load())
    cube = sample.cube
    sensor = cube.data.sensor
    matrices = [sensor.matrix]
    matrices += [photograph(sensor, name).matrix for name in LIGHTS]
    lights = Axis(names=(sensor.illuminant, *LIGHTS))
    panels = []
    for name, rgb in DRAWN.items():
        drawn = sample(rgb, SHOWN, SEED)
        colour = to_display_codes(rgb, SRGB) / 255
        marks = [
            line(cube.wavelengths, drawn.T, "", colour, linewidth=0.7, alpha=0.6),
            line(cube.wavelengths, cube.reflectance(rgb)),
        ]
        panels.append(spectra_panel(marks, f"one {name}"))
        colours = np.stack([drawn @ matrix.T for matrix in matrices])
        codes = to_display_codes(np.clip(colours, 0, 1), SRGB).astype(np.uint8)
        panels.append(Panel([picture(codes, aspect="auto")], y=lights))
    figure = draw(panels, 2, (4.8, 2.2))
    write_figure(figure, DOCS / "samples" / "samples.png", force=True)


def spread() -> Iterator[Row]:
    """Compare samples with the materials from which the packaged cube learnt, and with
    halves of sets, under each light.
    """
    spreads = {"packaged": left_out(uplift.load())}
    spreads |= {name: other_half(name) for name in SETS}
    for name, compared in spreads.items():
        of = {"cube": name, "count": len(compared.measured)}
        for light in LIGHTS:
            yield {**of, **compared.under(light)}


def seconds() -> TimingStats:
    """Time a sample of a colour."""
    sample = prepare_samples(uplift.load())
    rgb = np.random.default_rng(SEED).random((TIMED, 3))
    return time_call(lambda: sample(rgb, 1, SEED), RUNS).wall.scaled(1 / TIMED)


QUESTIONS = {"examples": examples, "spread": spread, "seconds": seconds}
