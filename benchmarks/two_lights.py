"""Spectra from photographs under several lights, for docs/guides/two-lights.md."""

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import product
from pathlib import Path

import numpy as np

from benchmarks import UPLIFT, Row, six_numbers, summary
from benchmarks.materials import FETCHED, SENSOR, SHIPPED, materials, other_halves
from benchmarks.timing import ratio, run_command, time_in_turn
from benchmarks.two_lights_picture import draw_pictures, take_photographs
from uplift.common.arrays import Array
from uplift.extras.images.exr import make_part, write_parts
from uplift.extras.images.picture import read_picture
from uplift.extras.photographs.answers import Photographs
from uplift.extras.photographs.errors import photographed
from uplift.extras.photographs.photograph import Noise
from uplift.lab.runner import Errors, Task, join, named_lights, spectrum_errors
from uplift.lookup.cube import Cube
from uplift.lookup.errors_under_lights import Evidence, errors_from, evidence
from uplift.samples import sample_path

DIM = 32
SETS = (*SHIPPED, *FETCHED)
CHART = "macbeth"
CHART_LIKE = ("macbeth", "babelcolor")
"""Sets that are measurements of the chart: its matrix knows their patches."""
OTHERS = tuple(name for name in SHIPPED if name not in CHART_LIKE)
TOGETHER = "all but the chart"
"""All shipped sets but measurements of the chart."""
LIGHTS = ("A", "FL2", "FL11", "LED-B3", "LED-RGB1", "HP1")
FURTHER = (("A",), ("LED-B3",), ("A", "FL11"))
"""Lights of the photographs next to that under D65."""
SHARES = (0.0, 0.005, 0.02)
"""Standard deviations of the noise, as shares of each value."""
FLOOR = 0.1
"""Floor of the noise, relative to its share."""
CUBE = "one photograph"
OURS = "photographs"
FORMULA = "formula of 81 samples"
PCA = "principal components"
CHART_MATRIX = "chart matrix"
IMAGE = "still-life.png"
TILES = (8, 4, 1)
"""Repetitions of the image in the photographs of a texture."""
TEXTURE_RUNS = 3


@dataclass(frozen=True)
class Case:
    """Further lights of photographs, and the share of their noise."""

    further: tuple[str, ...]
    share: float

    @property
    def noise(self) -> Noise:
        """Return the noise of all photographs."""
        return Noise(self.share, FLOOR * self.share)

    @property
    def unseen(self) -> tuple[str, ...]:
        """Return the lights that no photograph has."""
        return tuple(name for name in LIGHTS if name not in self.further)

    @property
    def columns(self) -> Row:
        """Return the columns of rows."""
        return {"further": ", ".join(self.further), "noise": f"{100 * self.share:g} %"}


CASES = [Case(further, share) for further, share in product(FURTHER, SHARES)]
Found = dict[tuple[Case, str], Errors]
"""Errors by case and method."""


def of_half(cube: Cube, task: Task, seed: int) -> Found:
    """Photograph materials; return the errors of all methods under the unseen lights,
    and those that we state.
    """
    errors = {}
    for case in CASES:
        photographs, rgb, others = take_photographs(
            cube, task.queried, case.further, case.noise, seed
        )
        lights = list(named_lights(case.unseen).values())
        for method, spectra in answers(photographs, rgb, others).items():
            errors[case, method] = spectrum_errors(spectra, task.queried, lights)
        known = photographed(photographs)
        stated = [errors_from(cube.data, light, known)(rgb) for light in lights]
        ours = errors[case, OURS]
        errors[case, OURS] = replace(ours, stated=np.stack(stated, axis=1))
    return errors


def answers(photographs: Photographs, rgb: Array, others: Array) -> dict[str, Array]:
    """Return the spectra (n, 81) of all methods from linear RGB under all lights."""
    cube = photographs.cube
    matrix = np.concatenate([SENSOR.matrix, photographs.matrix])
    observed = matrix, photographs.noise, np.concatenate([rgb, others], axis=1)
    left_out = evidence(cube.data)
    known = np.asarray(left_out.measured, dtype=float)
    chart = materials(CHART).measured
    expected = cube.reflectance(rgb)
    covariance = second_moment(left_out)
    return {
        CUBE: expected,
        OURS: photographs.reflectance(rgb, others),
        FORMULA: six_numbers.posterior_mean(expected, covariance, *observed),
        PCA: six_numbers.trained(known, six_numbers.projected(known), *observed),
        CHART_MATRIX: six_numbers.trained(chart, chart, *observed),
    }


def second_moment(known: Evidence) -> Array:
    """Covariance (81, 81) of the differences of left-out materials."""
    differences = np.asarray(known.measured - known.left_out, dtype=float)
    # A variance of nothing keeps the equations of noiseless numbers solvable.
    least = 1e-12 * np.eye(differences.shape[1])
    return differences.T @ differences / len(differences) + least


@cache
def of_set(name: str) -> Found:
    """Return the errors at the unseen halves of a set, or of all sets together."""
    if name == TOGETHER:
        parts = [of_set(other) for other in OTHERS]
    else:
        halves = enumerate(other_halves(name, dim=DIM))
        parts = [of_half(*half, seed) for seed, half in halves]
    joined = {}
    for key in parts[0]:
        joined[key] = join([part[key] for part in parts])
    return joined


def errors() -> Iterator[Row]:
    """Yield the errors under all unseen lights, by set, case and method.

    Ratios are those of the means of the photographs to those of the method, over all
    lights and under the least favourable one.
    """
    for name in (*SETS, TOGETHER):
        found = of_set(name)
        for (case, method), of_method in found.items():
            if method == CHART_MATRIX and name in CHART_LIKE:
                continue
            ours = found[case, OURS].delta_e
            delta_e = of_method.delta_e
            row = {
                "set": name,
                **case.columns,
                "method": method,
                **summary(delta_e),
                "ratio": ours.mean() / delta_e.mean(),
                "worst_light": (ours.mean(axis=0) / delta_e.mean(axis=0)).max(),
            }
            if of_method.stated is not None:
                within = delta_e[:, :, None] <= of_method.stated
                row["standard"], row["bound"] = within.mean(axis=(0, 1))
            yield row


def by_light() -> Iterator[Row]:
    """Yield the errors of `TOGETHER` under each light, from one photograph and more."""
    found = of_set(TOGETHER)
    for case in CASES:
        for method, further in ((CUBE, ()), (OURS, case.further)):
            known = {"photographs": ", ".join(["D65", *further])}
            yield from found[case, method].rows(case.unseen, **case.columns, **known)


def texture() -> Row:
    """Return CPU time and memory of textures from one photograph and from two."""
    still_life = read_picture(sample_path(IMAGE), SENSOR, max_side=1000).rgb
    day = np.tile(still_life, TILES)
    planes = dict(zip("RGB", np.moveaxis(day, -1, 0), strict=True))
    with tempfile.TemporaryDirectory() as folder:
        first = Path(folder, "day.exr")
        second = Path(folder, "tungsten.exr")
        write_parts([make_part("", {}, planes)], first)
        run_command([UPLIFT, "relight", first, "-o", second, "--light", "A"])
        one = [UPLIFT, "texture", first, "-o", Path(folder, "out.exr"), "--force"]
        two = [*one, "--also", f"A:{second}"]
        times = time_in_turn(
            {"one": partial(run_command, one), "two": partial(run_command, two)},
            TEXTURE_RUNS,
        )
    return {
        "size": day.shape[:2],
        "ratio": ratio(times["two"], times["one"]),
        "megabytes": {name: timing.megabytes for name, timing in times.items()},
    }


QUESTIONS = {
    "texture": texture,
    "errors": errors,
    "by_light": by_light,
    "scene": draw_pictures,
}
