"""Cubes of this package: both models, several sizes, with and without an atlas, in every mode and data type.

Domain: linear sRGB in [0, 1] under D65. Range: reflectance in [0, 1] at any wavelengths.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

import numpy as np

from uplift.common.arrays import Array
from uplift.lab.chart.method import (
    DTYPES,
    Claims,
    Family,
    Method,
    PreparedMethod,
    Task,
    Uplift,
    nbytes,
    ours,
    stopwatch,
)
from uplift.lookup import MODES, Cube, load
from uplift.models import Moments, Sigmoid
from uplift.pipeline.options import ModelName

DIMS = (8, 16, 32, 64)
COUNTS = (3, 5, 9, 13, 17)
EXACT = Claims(round_trip=0.01)
"""Claims of modes ``spectra`` and ``bulk``, and of ``refined`` with moments; other modes have none."""


@dataclass(frozen=True)
class CubeOptions:
    """Options of a build."""

    model: ModelName
    count: int
    dim: int
    atlas: bool

    @property
    def name(self) -> str:
        """Return the name for the command line."""
        model = f"{self.model}{self.count if self.model == Moments.name else ''}"
        return f"{model}-{self.dim}{'-atlas' if self.atlas else ''}"

    @property
    def title(self) -> str:
        """Return the name to display."""
        model = f"{self.model} {self.count}" if self.model == Moments.name else self.model
        return f"{model}, {self.dim}³{', atlas' if self.atlas else ''}"

    @property
    def label(self) -> str:
        """Return the label of a marker: coefficients and dim."""
        return f"{self.count} · {self.dim}³"

    @property
    def command(self) -> str:
        """Return the command that builds the cube."""
        model = f"--coefficients {self.count}" if self.model == Moments.name else f"--model {self.model}"
        return f"uplift build {'--atlas FILE ' if self.atlas else ''}--dim {self.dim} {model}"


@dataclass(frozen=True)
class Lookup:
    """A mode of `Cube.reflectance`, or ``bulk``, and the data type of the result."""

    mode: str
    dtype: str

    @property
    def suffix(self) -> str:
        """Return the end of the method's name."""
        return self.mode if self.mode == "bulk" or self.dtype == "float64" else f"{self.mode}-{self.dtype}"

    @property
    def call(self) -> str:
        """Return the call in Python."""
        if self.mode == "bulk":
            return "uplift.lookup.bulk.spectra(cube)(rgb)"
        dtype = "" if self.dtype == "float64" else ', dtype="float32"'
        return f'cube.reflectance(rgb, mode="{self.mode}"{dtype})'


LOOKUPS = (
    *(Lookup(mode, dtype) for mode in MODES for dtype in DTYPES),
    Lookup("bulk", "float32"),
)


@cache
def built_cube(task: Task, options: CubeOptions) -> tuple[Cube, float, float]:
    """Build a cube, store and load it, once for all methods that need it."""
    from uplift.fit.families import families_with
    from uplift.pipeline.build import build

    unknown = families_with(task.unseen)
    for _ in range(task.effort.builds):
        cube, seconds = stopwatch(
            lambda: build(
                task.kept if options.atlas else None,
                dim=options.dim,
                model=options.model,
                coefficients=options.count,
                leave_out=unknown,
            )
        )
    with tempfile.TemporaryDirectory() as folder:
        cube.save(Path(folder) / "cube.uplift")
        return (
            load(Path(folder) / "cube.uplift"),
            seconds,
            stopwatch(lambda: load(Path(folder) / "cube.uplift"))[1],
        )


def _prepare(task: Task, options: CubeOptions, lookup: Lookup) -> PreparedMethod:
    cube, seconds, loading = built_cube(task, options)
    if lookup.mode == "bulk":
        (uplift, size), more = stopwatch(lambda: _sampler(cube, task))
        return PreparedMethod(uplift, size, seconds, loading + more)

    def by_numpy(rgb: Array, wavelengths: Array) -> Array:
        spectra: Array = cube.reflectance(rgb, wavelengths, lookup.mode, dtype=lookup.dtype)
        return spectra

    data = cube.data
    arrays = (data.points.coefficients, data.lattice.nodes, data.atlas.rgb, data.entry_spectra.coefficients)
    return PreparedMethod(by_numpy, nbytes(arrays), seconds, loading)


def _sampler(cube: Cube, task: Task) -> tuple[Uplift, int]:
    """A bulk sampler of the sensor's wavelengths, without the compiled code of earlier ones, and its size."""
    import jax

    from uplift.lookup import bulk

    jax.clear_caches()  # type: ignore[no-untyped-call]
    at = task.sensor.wavelengths
    sampler = bulk.spectra(cube, at, threads=1)
    sampler(task.rgb[:1])

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        usual = np.array_equal(wavelengths, at)
        return np.asarray((sampler if usual else bulk.spectra(cube, wavelengths, threads=1))(rgb))

    return uplift, sampler.nbytes


def _usual(options: CubeOptions, lookup: Lookup) -> bool:
    """Whether one option at most differs from the defaults, or the options are extreme."""
    nine, default_size = options.count == 9, options.dim == 32
    swept = nine or (options.model == Sigmoid.name and not options.atlas)
    if lookup.mode == "bulk":
        return nine or (options.model == Moments.name and options.atlas and _is_large(options))
    if lookup.dtype == "float32":
        return swept and default_size and lookup.mode != "nearest"
    if lookup.mode == "nearest":
        return nine and options.dim == 64 and not options.atlas
    if lookup.mode == "refined":
        return swept and options.dim in (8, 32)
    if lookup.mode == "moments":
        return swept
    return swept or (options.atlas and _is_large(options))


def _is_large(options: CubeOptions) -> bool:
    return options.dim == 32 or (options.count, options.dim) == (17, 64)


def _quick(options: CubeOptions, lookup: Lookup) -> bool:
    """Whether the method is part of a quick run."""
    plain = options.count == 9 and lookup.dtype == "float64" and lookup.mode in ("spectra", "moments")
    return plain and options.dim in ((16,) if options.atlas else (16, 64))


def _methods(model: ModelName, counts: tuple[int, ...], atlas: bool) -> Iterator[Method]:
    for options in (CubeOptions(model, count, dim, atlas) for count in counts for dim in DIMS):
        for lookup in LOOKUPS:
            exact = lookup.mode in ("spectra", "bulk") or (lookup.mode == "refined" and model == Moments.name)
            yield Method(
                f"{options.name}-{lookup.suffix}",
                f"{options.title}, {lookup.suffix.replace('-', ', ')}",
                partial(_prepare, options=options, lookup=lookup),
                EXACT if exact else Claims(),
                dtype=lookup.dtype,
                judge=ours,
                usual=_usual(options, lookup),
                quick=_quick(options, lookup),
                label=f"{options.label} {lookup.mode}{' f32' if lookup.dtype == 'float32' else ''}",
                mode=lookup.mode,
                build=options.command,
                call=lookup.call,
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
