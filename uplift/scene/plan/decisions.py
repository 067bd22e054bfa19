"""The decisions of a plan: coefficients, lattice, wavelengths, and contents of a pixel.

Each function measures the candidates of one decision in order of cost, until no more are requested.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.observer import AXES
from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.common.progress import Progress
from uplift.io import texture
from uplift.io.scene_colours import cells_touched
from uplift.lattice import Lattice
from uplift.lookup import Cube
from uplift.models import evaluate, reflectance
from uplift.scene.plan.context import PlanContext
from uplift.scene.plan.evaluation import EvaluationSet, Trial
from uplift.scene.wavelengths import Sampling, choose, make_setup
from uplift.viz.format import format_size

BYTES_PER_COEFFICIENT = 4
MAX_AXIS_RATIO = 2.0
"""An axis whose error exceeds the other's by this factor is not tried at larger dims."""
COUNTS = (3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20, 24, 32, 40)
"""Numbers of wavelengths to try before the whole grid."""
FEW = 200
"""Colours of each group that wavelengths are fitted to."""
DIGITS = 2
"""Decimals of a wavelength in nm, so that the measured wavelengths are those of the command line."""
DEPTHS: dict[str, np.dtype[Any]] = {"half": np.dtype(np.float16), "float": np.dtype(np.float32)}


def wavelength_args(nm: Array) -> str:
    """Option of ``uplift texture`` for wavelengths in nm."""
    return f"--wavelengths {','.join(f'{each:g}' for each in nm)}"


def coefficient_trials(context: PlanContext, tests: EvaluationSet) -> Iterator[Trial]:
    """Numbers of coefficients at the reference dim, where the lattice adds no error."""
    counts, dim = context.grid.coefficients, context.grid.reference
    for done, count in enumerate(counts):
        context.progress(Progress(f"{count} coefficients", done, len(counts)))
        cube = context.cube(tests.rgb, dim=dim, coefficients=count)
        error = tests.error(cube.reflectance(tests.rgb))
        cost = f"{format_size(BYTES_PER_COEFFICIENT * count)} per point"
        yield Trial(str(count), count, cost, f"--coefficients {count}", {"coefficients": count}, error)


def lattice_trials(context: PlanContext, tests: EvaluationSet, count: int) -> Iterator[Trial]:
    """Dims and axes, by the number of lattice points around one colour of every bin of the textures."""
    sizes = []
    for dim, axis in product((*context.grid.dims, context.grid.reference), AXES):
        lattice = Lattice(observer.axis_nodes(axis, dim))
        needed = lattice.corner_points(lattice.mask(cells_touched(lattice, context.colours.colour_bins)))
        sizes.append((int(needed.sum()), dim, axis))
    latest: dict[str, float] = {}
    for done, (points, dim, axis) in enumerate(sorted(sizes)):
        if latest.get(axis, 0) > MAX_AXIS_RATIO * min(latest.values(), default=1):
            continue
        context.progress(Progress(f"dim {dim}, {axis} axis", done, len(sizes)))
        cube = context.cube(tests.rgb, coefficients=count, dim=dim, axis=axis)
        error = tests.error(cube.reflectance(tests.rgb))
        latest[axis] = error.quantile
        cost = f"{points:,} points, {format_size(BYTES_PER_COEFFICIENT * count * points)}"
        choice = {"dim": dim, "axis": axis}
        yield Trial(f"{dim}³, {axis}", points, cost, f"--dim {dim} --axis {axis}", choice, error)


def wavelength_trials(context: PlanContext, tests: EvaluationSet, cube: Cube) -> Iterator[Trial]:
    """Wavelengths, and weights that serve all lights, fitted to a subsample of the spectra of the cube."""
    setup = make_setup(
        cube.reflectance(tests.subsample(FEW).rgb),
        [light.name for light in tests.lights],
        wavelengths=context.sensor.wavelengths,
        observer_name=context.sensor.observer,
    )
    whole_grid = Sampling(setup.wavelengths, setup.cmfs, setup.lights, setup.powers)
    for done, count in enumerate((*COUNTS, len(whole_grid))):
        context.progress(Progress(f"{count} wavelengths", done, len(COUNTS) + 1))
        sampling = whole_grid if done == len(COUNTS) else _rounded(choose(setup, count=count).sampling)
        nm = sampling.wavelengths
        error = tests.error_of_xyz(sampling.xyz(cube.reflectance(tests.rgb, nm)))
        cost, choice = f"{count} samples per ray", {"count": count}
        yield Trial(str(count), count, cost, wavelength_args(nm), choice, error, sampling)


def _rounded(sampling: Sampling) -> Sampling:
    """Round wavelengths to `DIGITS`, all distinct."""
    steps = np.arange(len(sampling)) / 10**DIGITS
    distinct = np.maximum.accumulate(np.round(sampling.wavelengths, DIGITS) - steps) + steps
    return replace(sampling, wavelengths=np.round(distinct, DIGITS))


@dataclass(frozen=True)
class Storage:
    """Contents of a texture's pixel: a name of `uplift.io.texture.PIXEL_ENCODINGS`, and "half" or "float"."""

    form: str
    depth: str

    @property
    def cli_args(self) -> str:
        """Options of ``uplift texture``."""
        return f"--representation {self.form} --depth {self.depth}"

    def bytes_per_pixel(self, cube: Cube, nm: Array) -> int:
        """Size of a pixel before compression, without the RGB that textures also store."""
        count = len(nm) if self.form == texture.Spectrum.name else cube.data.model.count
        return count * DEPTHS[self.depth].itemsize

    def decoded_reflectance(self, cube: Cube, rgb: Array, nm: Array) -> Array:
        """Reflectances (n, K) at wavelengths (K,) in nm that a renderer reads for linear RGB (n, 3).

        NaN where no spectrum has the rounded moments.
        """
        is_spectrum = self.form == texture.Spectrum.name
        encoding = texture.Spectrum(tuple(nm.tolist())) if is_spectrum else texture.PIXEL_ENCODINGS[self.form]()
        values = encoding.make_sampler(cube, 1)(rgb.astype(np.float32)).astype(DEPTHS[self.depth]).astype(float)
        if is_spectrum:
            return values
        try:
            return (evaluate if self.form == texture.Multipliers.name else reflectance)(cube.data.model, values, nm)
        except UpliftError:
            return np.full((len(rgb), len(nm)), np.nan)


STORAGES = tuple(Storage(name, depth) for name, form in texture.PIXEL_ENCODINGS.items() for depth in form().depths)


def storage_trials(context: PlanContext, tests: EvaluationSet, cube: Cube, sampling: Sampling) -> Iterator[Trial]:
    """Pixels by size; of equal sizes spectra first, which renderers need not evaluate."""
    nm = sampling.wavelengths
    for done, storage in enumerate(sorted(STORAGES, key=lambda storage: storage.bytes_per_pixel(cube, nm))):
        form, depth, size = storage.form, storage.depth, storage.bytes_per_pixel(cube, nm)
        context.progress(Progress(f"{form} as {depth}", done, len(STORAGES)))
        error = tests.error_of_xyz(sampling.xyz(storage.decoded_reflectance(cube, tests.rgb, nm)))
        choice = {"as": form, "depth": depth}
        cost = f"{format_size(size)} per pixel"
        yield Trial(f"{form}, {depth}", size, cost, storage.cli_args, choice, error, storage)
