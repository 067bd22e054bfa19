"""Candidates of a plan, what they cost (bytes, operations per pixel and light, samples
per ray), and the search.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import compress
from math import prod
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.extras import texture
from uplift.extras.scene.plan.evaluation import (
    UNMEASURED,
    ErrorSummary,
    Rendering,
    dominated,
)
from uplift.extras.scene.plan.files import CostName, Minimised
from uplift.lattice.lattice import AXES
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import refined_multipliers
from uplift.models.model import evaluate, reflectance
from uplift.models.sigmoid import Sigmoid
from uplift.pipeline.options import Options

MODELS: Mapping[str, tuple[int, ...]] = {
    "none": (3, 5, 7, 9, 11, 13, 15, 17),
    "vision": (5, 7, 9, 11),
    "colour": (3, 5, 7, 9),
}
"""Numbers of coefficients by warp: warps are for few."""


@dataclass(frozen=True)
class SearchGrid:
    """Candidates, in ascending order, and sizes of the pixel samples.

    ``models`` are numbers of coefficients of moments by warp. ``samples`` are numbers
    of wavelengths, which other representations are compared with if ``others``. The
    reference has the last number of coefficients without a warp, and ``reference``
    nodes along each axis. Candidates are chosen by ``predicting`` pixels and verified
    on ``confirming`` ones.
    """

    models: Mapping[str, tuple[int, ...]] = field(default_factory=lambda: MODELS)
    dims: tuple[int, ...] = (8, 12, 16, 24, 32, 48, 64, 96)
    axes: tuple[str, ...] = AXES
    samples: tuple[int, ...] = (3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20)
    reference: int = 96
    predicting: int = 1500
    confirming: int = 4000
    others: bool = True


QUICK = SearchGrid(
    {"none": (5, 9, 13, 17)},
    (8, 16, 32, 48),
    AXES[:1],
    (3, 5, 6, 7, 8, 10),
    64,
    400,
    1000,
    others=False,
)
"""Fewer candidates and pixels: seconds."""

DEPTHS: dict[str, np.dtype[Any]] = {
    "half": np.dtype(np.float16),
    "float": np.dtype(np.float32),
}
RGB = "rgb"
"""Form of pixels without a pixel encoding: colours."""
INDEX = "index"
"""The other form: numbers of a list of spectra."""


class Cost(NamedTuple):
    """Costs of a candidate.

    ``memory``: bytes of the cube file, of a list of spectra, and of the pixels of all
    textures. ``time``: floating-point operations of a pixel that one light illuminates:
    its lookup, the product with the light, and the share of a sample in the sum to XYZ.
    ``samples``: numbers of a ray.
    """

    memory: float
    time: float
    samples: float

    def ranked(self, minimise: Minimised) -> tuple[float, ...]:
        """Sort key: the minimised cost, and the product of all three where that is
        equal.
        """
        balance = prod(self)
        return balance if minimise == "balance" else getattr(self, minimise), balance


@dataclass(frozen=True)
class Pixel:
    """What a texture stores per pixel: a pixel encoding, RGB, or an index; and a
    renderer does with it.

    ``depth`` is "half" or "float", empty for the numbers of the image itself, and
    ``mode`` the lookup in the cube that RGB need: "spectra" or "moments", as programs
    of ``uplift export`` have them.
    """

    form: str
    depth: str = ""
    mode: str = ""

    @property
    def name(self) -> str:
        """Short text."""
        if self.mode:
            return f"RGB, lookup of {self.mode}"
        return f"{self.form}, {self.depth}" if self.depth else self.form

    def size(self, count: int, samples: int) -> int:
        """Bytes of a pixel of a texture for a cube of ``count`` coefficients, 0 for the
        numbers of the image itself.
        """
        numbers = samples if self.form == texture.Spectrum.name else count
        return numbers * DEPTHS[self.depth].itemsize if self.depth else 0

    def operations(self, cube: Options, samples: int) -> int:
        """Floating-point operations until the reflectances of a pixel are known.

        Sums of cosines by Clenshaw's recurrence and an arctangent are 4 C + 15 for each
        sample, a sigmoid 10. From moments to multipliers there are 28 C²
        (docs/mathematics.md, 4), between eight nodes 16 for each number.
        """
        count = cube.coefficients
        is_sigmoid = cube.model == Sigmoid.name
        evaluation = samples * (10 if is_sigmoid else 4 * count + 15)
        conversion = 0 if is_sigmoid else 28 * count**2
        return {
            texture.Spectrum.name: 0,
            texture.Moments.name: conversion + evaluation,
            texture.Multipliers.name: evaluation,
            "spectra": 8 * evaluation + 16 * samples,
            "moments": 16 * count + conversion + evaluation,
        }[self.mode or self.form]

    def decoded(self, cube: Cube, rgb: Array, nm: Array) -> Array:
        """Reflectances (n, W) at wavelengths (W,) in nm that a renderer reads for
        linear RGB (n, 3).

        NaN where no spectrum has the rounded moments.
        """
        kind = DEPTHS[self.depth or "float"]
        if self.mode or self.form in (texture.Spectrum.name, INDEX):
            reflectances = cube.reflectance(rgb, nm, self.mode or "spectra")
            return reflectances.astype(kind).astype(float)
        if self.form == texture.Multipliers.name:
            values = refined_multipliers(cube.data, rgb).astype(kind)
            return evaluate(cube.data.model, values.astype(float), nm)
        try:
            values = cube.coefficients(rgb).astype(kind)
            return reflectance(cube.data.model, values.astype(float), nm)
        except UpliftError:
            return np.full((len(rgb), len(nm)), np.nan)


def _pixels() -> Iterator[Pixel]:
    for name, form in texture.PIXEL_ENCODINGS.items():
        for depth in form().depths:
            yield Pixel(name, depth)
    for mode in ("spectra", "moments"):
        yield Pixel(RGB, mode=mode)


PIXELS = tuple(_pixels())
"""Pixels that need a cube."""


@dataclass(frozen=True)
class Candidate:
    """A complete choice: pixels, wavelengths or None for RGB × light, a cube with all
    cells or those of the textures.

    Without a cube, pixels are RGB or an index. ``bound`` is a lower bound of its ΔE00,
    ``error`` that of the test colours once it is measured.
    """

    pixel: Pixel
    cost: Cost
    rendering: Rendering | None = None
    cube: Options | None = None
    sparse: bool = False
    bound: float = 0.0
    error: ErrorSummary = UNMEASURED

    @property
    def cube_name(self) -> str:
        """Short text, with all that differs from the defaults; empty without a cube."""
        cube = self.cube
        if cube is None:
            return ""
        spectra = cube.model if cube.model == Sigmoid.name else cube.coefficients
        words = [f"{cube.dim}³ × {spectra}", cube.warp, cube.axis]
        named = [word for word in words if word not in (Options.warp, Options.axis)]
        return ", ".join(named) + " sparse" * self.sparse

    @property
    def traced(self) -> str:
        """Short text; without spectra RGB, by a matrix for each light."""
        return self.rendering.name if self.rendering else "RGB × light"

    @property
    def name(self) -> str:
        """Short text."""
        return "; ".join(filter(None, (self.cube_name, self.traced, self.pixel.name)))


Measure = Callable[[Options | None, Sequence[Candidate]], list[Candidate]]
"""Builds the cube that candidates share, and measures their errors."""


def explore(
    candidates: Iterable[Candidate], measure: Measure, floor: float
) -> list[Candidate]:
    """Measure the candidates that may be on the Pareto front, by branch and bound,
    cubes of few bytes first.

    Candidates that share a cube are measured together, as they cost one build. One is
    left out if a measured one dominates it: no cost is larger, and its error is at most
    the lower bound of the other's. Errors below the ``floor`` count as equal. If every
    bound holds, none that is left out costs less than the cheapest measured one of its
    error.
    """
    groups: dict[Options | None, list[Candidate]] = defaultdict(list)
    for candidate in candidates:
        groups[candidate.cube].append(candidate)
    measured = list[Candidate]()
    best = np.empty((0, 4))

    def smallest(cube: Options | None) -> float:
        return min(candidate.cost.memory for candidate in groups[cube])

    for cube in sorted(groups, key=smallest):
        group = groups[cube]
        rows = np.array(
            [(*candidate.cost, max(candidate.bound, floor)) for candidate in group]
        )
        promising = list(compress(group, ~dominated(rows, best)))
        if promising:
            measured += measure(cube, promising)
            best = positions(pareto_front(measured), floor)
    return measured


def front(rows: Array) -> list[int]:
    """Numbers of the rows (m, k) that no other dominates, smallest rows first; of equal
    rows the first.
    """
    kept = list[int]()
    # what dominates a row comes before it
    for row in np.lexsort(rows.T[::-1]).tolist():
        if not dominated(rows[[row]], rows[kept])[0]:
            kept.append(row)
    return kept


def positions(measured: Sequence[Candidate], floor: float = 0.0) -> Array:
    """Costs and errors (m, 4) of candidates."""
    rows = [
        (*candidate.cost, max(candidate.error.quantile, floor))
        for candidate in measured
    ]
    return np.array(rows).reshape(-1, 4)


def pareto_front(measured: Sequence[Candidate]) -> list[Candidate]:
    """Candidates that no other dominates in cost and error, by ascending error; one of
    equal ones.
    """
    rows = front(positions(measured))
    return sorted(map(measured.__getitem__, rows), key=attrgetter("error.quantile"))


def cheapest_first(
    measured: Iterable[Candidate], minimise: Minimised
) -> list[Candidate]:
    """Candidates by cost, then by error."""
    return sorted(
        sorted(measured, key=attrgetter("error.quantile")),
        key=lambda candidate: candidate.cost.ranked(minimise),
    )


def sufficient(
    measured: Iterable[Candidate],
    tolerance: float,
    minimise: Minimised,
    limits: Mapping[CostName, float],
) -> list[Candidate]:
    """Candidates within the tolerance and the limits of costs, cheapest first."""

    def is_sufficient(candidate: Candidate) -> bool:
        if not candidate.error.quantile <= tolerance:
            return False
        cost = candidate.cost
        return all(getattr(cost, key) <= limit for key, limit in limits.items())

    return cheapest_first(filter(is_sufficient, measured), minimise)
