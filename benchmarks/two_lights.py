"""Spectra from photographs under several lights, for docs/guides/two-lights.md."""

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import product
from pathlib import Path

import numpy as np

from benchmarks import UPLIFT, Row, six_numbers, summary
from benchmarks.materials import (
    FETCHED,
    SENSOR,
    SHIPPED,
    Materials,
    materials,
    other_halves,
)
from benchmarks.two_lights_picture import draw_pictures
from uplift.common.arrays import Array
from uplift.extras.images.exr import make_part, write_parts
from uplift.extras.photographs import Noise, Photographs, photograph, prepare
from uplift.extras.photographs.errors import photographed
from uplift.extras.texture.picture import read_picture
from uplift.lab.runner import Errors, join, named_lights, spectrum_errors
from uplift.lab.timing import run_call, run_command, time_in_turn
from uplift.lookup import Cube
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
SPEED_COLOURS = 1 << 17
SPEED_RUNS = 12
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


def of_case(cube: Cube, queried: Materials, case: Case, seed: int) -> dict[str, Errors]:
    """Photograph materials; return the errors of all methods under the unseen lights,
    and those that we state.
    """
    random = np.random.default_rng(seed)
    further = [photograph(SENSOR, name) for name in case.further]
    photographs = prepare(cube, further, case.noise)
    rgb = np.clip(noisy(queried.rgb, case.noise, random), 0, 1)
    others = noisy(queried.measured @ photographs.matrix.T, case.noise, random)
    lights = list(named_lights(case.unseen).values())
    errors = {
        method: spectrum_errors(spectra, queried.measured, lights)
        for method, spectra in answers(photographs, rgb, others).items()
    }
    known = photographed(photographs)
    stated = [errors_from(cube.data, light, known)(rgb) for light in lights]
    return {**errors, OURS: replace(errors[OURS], stated=np.stack(stated, axis=1))}


def noisy(values: Array, noise: Noise, random: np.random.Generator) -> Array:
    """Return values of a photograph with noise."""
    scale = np.sqrt(noise.variance(values))
    return values + scale * random.standard_normal(values.shape)


def answers(photographs: Photographs, rgb: Array, others: Array) -> dict[str, Array]:
    """Return the spectra (n, 81) of all methods from linear RGB under all lights."""
    cube = photographs.cube
    variance = photographs.noise.variance
    matrix = np.concatenate([SENSOR.matrix, photographs.matrix])
    numbers = np.concatenate([rgb, others], axis=1)
    left_out = evidence(cube.data)
    known = np.asarray(left_out.measured, dtype=float)
    chart = materials(CHART).measured
    expected = cube.reflectance(rgb)
    return {
        CUBE: expected,
        OURS: photographs.reflectance(rgb, others),
        FORMULA: six_numbers.posterior_mean(
            expected, second_moment(left_out), matrix, variance(numbers), numbers
        ),
        PCA: six_numbers.principal_components(
            known, matrix, variance(known @ matrix.T), numbers
        ),
        CHART_MATRIX: six_numbers.chart_matrix(
            chart, matrix, variance(chart @ matrix.T), numbers
        ),
    }


def second_moment(known: Evidence) -> Array:
    """Covariance (81, 81) of the differences of left-out materials."""
    differences = np.asarray(known.measured - known.left_out, dtype=float)
    # A variance of nothing keeps the equations of noiseless numbers solvable.
    least = 1e-12 * np.eye(differences.shape[1])
    return differences.T @ differences / len(differences) + least


@cache
def of_set(name: str) -> dict[Case, dict[str, Errors]]:
    """Return the errors at the unseen halves of a set, or of all sets together."""
    if name == TOGETHER:
        return {
            case: joined([of_set(other)[case] for other in OTHERS]) for case in CASES
        }
    halves = list(enumerate(other_halves(name, dim=DIM)))
    return {
        case: joined([of_case(*half, case, seed) for seed, half in halves])
        for case in CASES
    }


def joined(parts: list[dict[str, Errors]]) -> dict[str, Errors]:
    """Pool the errors of each method."""
    return {method: join([part[method] for part in parts]) for method in parts[0]}


def errors() -> Iterator[Row]:
    """Yield the errors under all unseen lights, by set, case and method.

    Ratios are those of the means of the photographs to those of the method, over all
    lights and under the least favourable one.
    """
    for name, case in product((*SETS, TOGETHER), CASES):
        ours = of_set(name)[case][OURS]
        for method, found in of_set(name)[case].items():
            if method == CHART_MATRIX and name in CHART_LIKE:
                continue
            row = {"set": name, **case.columns, "method": method}
            ratios = ours.delta_e.mean(axis=0) / found.delta_e.mean(axis=0)
            row |= summary(found.delta_e)
            row["ratio"] = ours.delta_e.mean() / found.delta_e.mean()
            row["worst_light"] = ratios.max()
            if found.stated is not None:
                within = found.delta_e[:, :, None] <= found.stated
                row["standard"], row["bound"] = within.mean(axis=(0, 1))
            yield row


def by_light() -> Iterator[Row]:
    """Yield the errors of `TOGETHER` under each light, from one photograph and more."""
    for case, by_method in of_set(TOGETHER).items():
        for method, known in ((CUBE, ("D65",)), (OURS, ("D65", *case.further))):
            columns = {**case.columns, "photographs": ", ".join(known)}
            delta_e = by_method[method].delta_e
            for name, of_light in zip(case.unseen, delta_e.T, strict=True):
                yield {**columns, "light": name, **summary(of_light)}


def speed() -> Row:
    """Return how many times the CPU time of one photograph two take for a colour."""
    cube, _ = other_halves("rawtoaces", dim=DIM)[0]
    photographs = prepare(cube, [photograph(SENSOR, "A")])
    rgb = np.random.default_rng(0).random((SPEED_COLOURS, 3))
    others = cube.reflectance(rgb) @ photographs.matrix.T
    one = partial(cube.reflectance, rgb)
    two = partial(photographs.reflectance, rgb, others)
    two()  # compiles
    tasks = {"one": partial(run_call, one), "two": partial(run_call, two)}
    times = time_in_turn(tasks, SPEED_RUNS)
    return {"ratio": times["two"].ratio_to(times["one"])}


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
        "ratio": times["two"].ratio_to(times["one"]),
        "megabytes": {name: timing.megabytes for name, timing in times.items()},
    }


QUESTIONS = {
    "texture": texture,
    "errors": errors,
    "by_light": by_light,
    "scene": draw_pictures,
    "speed": speed,
}
