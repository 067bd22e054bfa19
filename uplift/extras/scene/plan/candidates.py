"""Candidates of a plan, and what they cost: bytes, operations per pixel and light,
samples per ray.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import prod
from typing import Any, NamedTuple

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.extras.scene.plan.evaluation import UNMEASURED, ErrorSummary, Rendering
from uplift.extras.scene.plan.files import Minimised
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

    ``models`` are numbers of coefficients of moments by warp, and ``samples`` numbers
    of wavelengths. The reference has the last number of coefficients without a warp,
    and ``reference`` nodes along each axis. Candidates are chosen by ``predicting``
    pixels and verified on ``confirming`` ones.
    """

    models: Mapping[str, tuple[int, ...]] = field(default_factory=lambda: MODELS)
    dims: tuple[int, ...] = (8, 12, 16, 24, 32, 48, 64, 96)
    axes: tuple[str, ...] = AXES
    samples: tuple[int, ...] = (3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20)
    reference: int = 96
    predicting: int = 1500
    confirming: int = 4000


QUICK = SearchGrid(
    models={"none": (5, 9, 13, 17)},
    dims=(8, 16, 32, 48),
    axes=AXES[:1],
    samples=(3, 5, 6, 7, 8, 10),
    reference=64,
    predicting=400,
    confirming=1000,
)
"""Fewer candidates and pixels: seconds."""


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


DEPTHS: dict[str, np.dtype[Any]] = {
    "half": np.dtype(np.float16),
    "float": np.dtype(np.float32),
}
SPECTRUM, MOMENTS, MULTIPLIERS = "spectrum", "moments", "multipliers"
"""Forms of pixels of textures: representations of `uplift.extras.texture`."""
RGB = "rgb"
"""Form of pixels that stay as they are."""
INDEX = "index"
"""Form of pixels that are numbers of a list of spectra."""


@dataclass(frozen=True)
class Pixel:
    """What a texture stores per pixel, and a renderer does with it.

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
        numbers = samples if self.form == SPECTRUM else count
        return numbers * DEPTHS[self.depth].itemsize if self.depth else 0

    def operations(self, cube: Options, samples: int) -> int:
        """Floating-point operations until the reflectances of a pixel are known.

        Sums of cosines by Clenshaw's recurrence and an arctangent are 4 C + 15 for each
        sample, a sigmoid 10. From moments to multipliers there are 28 C²
        (docs/mathematics.md, 4), between four nodes 8 for each number.
        """
        count = cube.coefficients
        is_sigmoid = cube.model == Sigmoid.name
        evaluation = samples * (10 if is_sigmoid else 4 * count + 15)
        conversion = 0 if is_sigmoid else 28 * count**2
        if self.mode == "spectra":
            return 4 * evaluation + 8 * samples
        if self.mode == "moments":
            return 8 * count + conversion + evaluation
        stored = {MOMENTS: conversion + evaluation, MULTIPLIERS: evaluation}
        return stored.get(self.form, 0)

    def decoded(self, cube: Cube, rgb: Array, nm: Array) -> Array:
        """Reflectances (n, W) at wavelengths (W,) in nm that a renderer reads for
        linear RGB (n, 3).

        NaN where no spectrum has the rounded moments.
        """
        kind = DEPTHS[self.depth or "float"]
        model = cube.data.model
        if self.form == MULTIPLIERS:
            values = refined_multipliers(cube.data, rgb).astype(kind)
            return evaluate(model, values.astype(float), nm)
        if self.form == MOMENTS:
            try:
                values = cube.coefficients(rgb).astype(kind)
                return reflectance(model, values.astype(float), nm)
            except UpliftError:
                return np.full((len(rgb), len(nm)), np.nan)
        reflectances = cube.reflectance(rgb, nm, self.mode or "spectra")
        return reflectances.astype(kind).astype(float)


PIXELS = (
    Pixel(SPECTRUM, "half"),
    Pixel(SPECTRUM, "float"),
    Pixel(MOMENTS, "float"),
    Pixel(MOMENTS, "half"),
    Pixel(MULTIPLIERS, "float"),
    Pixel(RGB, mode="spectra"),
    Pixel(RGB, mode="moments"),
)
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
