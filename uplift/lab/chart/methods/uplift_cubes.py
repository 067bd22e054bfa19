"""Ours: cubes of both models, of several sizes, with and without an atlas, asked in every mode and type."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np

from uplift.common.arrays import Array
from uplift.lab.chart.method import Claims, Family, Method, PreparedMethod, Uplift, nbytes, stopwatch
from uplift.lab.chart.task import Task
from uplift.lookup import MODES, Cube
from uplift.models import Moments, Sigmoid
from uplift.pipeline.options import ModelName

DIMS = (8, 16, 32, 64)
COUNTS = (3, 5, 9, 13, 17)
EXACT = Claims(round_trip=0.01)
"""Of modes ``spectra`` and ``bulk``, and of ``refined`` where the model is moments; other modes promise nothing."""


@dataclass(frozen=True)
class Recipe:
    """What a cube is built from."""

    model: ModelName
    count: int
    dim: int
    atlas: bool

    @property
    def name(self) -> str:
        model = f"{self.model}{self.count if self.model == Moments.name else ''}"
        return f"{model}-{self.dim}{'-atlas' if self.atlas else ''}"

    @property
    def title(self) -> str:
        model = f"{self.model} {self.count}" if self.model == Moments.name else self.model
        return f"{model}, {self.dim}³{', atlas' if self.atlas else ''}"

    @property
    def line(self) -> str:
        """The command that builds it."""
        model = f"--moments {self.count - 1}" if self.model == Moments.name else f"--model {self.model}"
        return f"uplift build {'--atlas FILE ' if self.atlas else ''}--dim {self.dim} {model}"


@dataclass(frozen=True)
class Asking:
    """How a cube is asked: a mode of `Cube.reflectance`, or ``bulk``, and the type of the answer."""

    mode: str
    dtype: str

    @property
    def suffix(self) -> str:
        return self.mode if self.mode == "bulk" or self.dtype == "float64" else f"{self.mode}-{self.dtype}"

    @property
    def call(self) -> str:
        if self.mode == "bulk":
            return "uplift.lookup.bulk.spectra(cube)(rgb)"
        dtype = "" if self.dtype == "float64" else ', dtype="float32"'
        return f'cube.reflectance(rgb, mode="{self.mode}"{dtype})'


ASKINGS = (
    *(Asking(mode, dtype) for mode in MODES for dtype in ("float64", "float32")),
    Asking("bulk", "float32"),
)


@lru_cache(maxsize=1)
def _cube(task: Task, recipe: Recipe) -> tuple[Cube, float]:
    """The cube, and the CPU seconds of its last build; what is compiled once is compiled by then."""
    from uplift.pipeline import build

    for _ in range(task.effort.builds):
        cube, seconds = stopwatch(
            lambda: build(
                task.kept if recipe.atlas else None,
                dim=recipe.dim,
                model=recipe.model,
                coefficients=recipe.count,
            )
        )
    return cube, seconds


def _prepare(task: Task, recipe: Recipe, asking: Asking) -> PreparedMethod:
    cube, seconds = _cube(task, recipe)
    if asking.mode == "bulk":
        sampler, more = stopwatch(lambda: _sampler(cube, task.sensor.wavelengths))
        return PreparedMethod(sampler[0], sampler[1], seconds + more)

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        found: Array = cube.reflectance(rgb, wavelengths, asking.mode, dtype=asking.dtype)
        return found

    data = cube.data
    arrays = (data.points.coefficients, data.lattice.nodes, data.atlas.rgb, data.atlas.coefficients)
    return PreparedMethod(uplift, nbytes(arrays), seconds)


def _sampler(cube: Cube, at: Array) -> tuple[Uplift, int]:
    """A sampler's wavelengths are fixed when it is made."""
    from uplift.lookup import bulk

    sampler = bulk.spectra(cube, at, threads=1)

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        assert np.array_equal(wavelengths, at)
        return np.asarray(sampler(rgb))

    return uplift, sampler.nbytes


def _usual(recipe: Recipe, asking: Asking) -> bool:
    """Of all that can be combined, one choice varied at a time about the default, and the ends."""
    nine = recipe.count == 9
    swept = (
        nine or (recipe.count == 17 and recipe.atlas) or (recipe.model == Sigmoid.name and not recipe.atlas)
    )
    if asking.mode == "bulk":
        return swept and recipe.model == Moments.name
    if asking.dtype == "float32":
        return nine and recipe.dim == 32
    return swept or recipe.dim == 32


def _quick(recipe: Recipe, asking: Asking) -> bool:
    """Enough to see the order of things."""
    plain = recipe.count == 9 and asking.dtype == "float64" and asking.mode in ("spectra", "moments")
    return plain and recipe.dim in ((16,) if recipe.atlas else (16, 64))


def _methods(model: ModelName, counts: tuple[int, ...], atlas: bool) -> Iterator[Method]:
    for recipe in (Recipe(model, count, dim, atlas) for count in counts for dim in DIMS):
        for asking in ASKINGS:
            exact = asking.mode in ("spectra", "bulk") or (asking.mode == "refined" and model == Moments.name)
            yield Method(
                f"{recipe.name}-{asking.suffix}",
                f"{recipe.title}, {asking.suffix.replace('-', ', ')}",
                partial(_prepare, recipe=recipe, asking=asking),
                EXACT if exact else Claims(),
                usual=_usual(recipe, asking),
                quick=_quick(recipe, asking),
                label=f"{recipe.count} · {recipe.dim}³ {asking.mode}",
                mode=asking.mode,
                build=recipe.line,
                ask=asking.call,
            )


def _family(title: str, colour: str, model: ModelName, counts: tuple[int, ...], *, atlas: bool) -> Family:
    methods = tuple(_methods(model, counts, atlas))
    return Family(f"uplift, {title}", "this package", colour, methods)


FAMILIES = (
    _family("moments with atlas", "#0b3c8c", "moments", COUNTS, atlas=True),
    _family("moments", "#4f9be8", "moments", COUNTS, atlas=False),
    _family("sigmoid with atlas", "#0a6b60", "sigmoid", (3,), atlas=True),
    _family("sigmoid", "#3dbfa9", "sigmoid", (3,), atlas=False),
)
