"""What an atlas does to materials unlike it, and to gradients, for docs/prior.md."""

from collections.abc import Iterator
from functools import cache
from itertools import permutations
from typing import Any

import numpy as np

from benchmarks import Row
from benchmarks.materials import FETCHED, MIXTURE, materials, split_tasks, task
from uplift.colorimetry import delta_e_spectra, observer
from uplift.common.arrays import Array
from uplift.extras.report.measures import delta_e_under
from uplift.lab.methods.cubes import cube
from uplift.lab.runner import ALL_LIGHTS, DELTA_E, measure, named_lights, pooled_errors
from uplift.lookup import Cube

DIM = 32
LIGHTS = ("A", "FL2", "FL11", "LED-B3", "LED-RGB1", "HP1")
RAMP_LIGHTS = ("A", "FL2", "FL11", "LED-B3", "HP1")
ATLASES = ("macbeth", "pmc", "cie2017", "rawtoaces", *FETCHED)
SETS = (*ATLASES, MIXTURE)
ALONE = cube(dim=DIM)
TRUSTING = {
    "learnt trust": cube(atlas=True, dim=DIM),
    "full trust": cube(atlas=True, dim=DIM, trust_atlas=True),
}
SPECTRA: dict[str, dict[str, Any]] = {"smoothed": {}, "exact": {"exact_entries": True}}
"""Options of cubes by the spectra of their entries."""
CODES = 14
"""Codes of a ramp to each side of an entry."""
DIRECTIONS = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])


def own() -> Iterator[Row]:
    """Yield the errors at unseen halves of sets whose other halves are the atlas."""
    methods = {"without an atlas": ALONE, **TRUSTING}
    for name in SETS:
        for row in measure(methods, split_tasks(name), named_lights(LIGHTS), set=name):
            if (row["light"], row["measure"]) == (ALL_LIGHTS, DELTA_E):
                yield row


@cache
def errors_alone(name: str) -> Array:
    """Return the mean ΔE00 (L,) at a set of a cube without an atlas."""
    lights = list(named_lights(LIGHTS).values())
    return pooled_errors(ALONE, [task(name)], lights).delta_e.mean(axis=0)


def others() -> Iterator[Row]:
    """Yield how many times the errors of a cube without an atlas those of one with
    another set as atlas are: the mean over lights, and the worst light.
    """
    lights = list(named_lights(LIGHTS).values())
    for atlas, queried in permutations(ATLASES, 2):
        alone = errors_alone(queried)
        query = task(queried, materials(atlas).atlas)
        for trust, method in TRUSTING.items():
            errors = pooled_errors(method, [query], lights).delta_e.mean(axis=0)
            row = {"atlas": atlas, "queried": queried, "trust": trust}
            ratios = errors / alone
            yield row | {"mean": errors.mean() / alone.mean(), "worst": ratios.max()}


def gradients() -> Iterator[Row]:
    """Yield how steep gradients through the entries of a set are."""
    for name in SETS:
        for spectra, options in SPECTRA.items():
            built = materials(name).cube(dim=DIM, **options)
            excess = steepest(built)
            yield {
                "set": name,
                "spectra": spectra,
                "entries": len(excess),
                "smoothed": len(built.data.provenance["smoothed"]),
                "largest": excess.max(),
                "above": (excess > 1).sum(),
            }


def steepest(cube: Cube) -> Array:
    """The largest ΔE00 (E,) by which a light's step of an 8-bit code exceeds that of
    daylight, on ramps through each entry.
    """
    spectra = cube.reflectance(ramps(cube, cube.data.atlas.rgb))
    before = spectra[:, :, :-1].reshape(-1, spectra.shape[-1])
    after = spectra[:, :, 1:].reshape(-1, spectra.shape[-1])
    daylight = delta_e_spectra(observer.light("D65"), before, after)
    lights = list(named_lights(RAMP_LIGHTS).values())
    excess = delta_e_under(lights, before, after).max(axis=1) - daylight
    return excess.reshape(len(spectra), -1).max(axis=1)


def ramps(cube: Cube, rgb: Array) -> Array:
    """Linear RGB (n, D, 2 CODES + 1, 3) of ramps through colours (n, 3)."""
    codes = np.round(cube.encode(rgb))
    offsets = np.arange(-CODES, CODES + 1)[:, None] * DIRECTIONS[:, None]
    return cube.decode(np.clip(codes[:, None, None] + offsets, 0, 255))


QUESTIONS = {"own": own, "others": others, "gradients": gradients}
