"""The decisions of a plan: coefficients, lattice, wavelengths, contents of a pixel, and another representation."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.common.progress import Progress
from uplift.io import texture
from uplift.lattice import Lattice
from uplift.lookup import Cube
from uplift.models import evaluate, reflectance
from uplift.pipeline.options import AXES
from uplift.scene.plan.context import PlanContext, occupied_cells
from uplift.scene.plan.evaluation import WORST_DELTA_E, Decision, EvaluationSet, Trial, decide
from uplift.scene.plan.scene_file import SceneFile
from uplift.scene.representations import Representation, all_representations
from uplift.scene.representations.samples import STEP, wavelengths, xyz_weights
from uplift.scene.wavelengths import Sampling, choose, make_setup
from uplift.scene.wavelengths.sampling import RenderSetup
from uplift.viz.format import format_size

BYTES_PER_COEFFICIENT = 4
MAX_AXIS_RATIO = 2.0
"""An axis whose error exceeds the other's by this factor is not tried at larger dims."""
COUNTS = (3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20, 24, 32, 40)
"""Numbers of wavelengths to try before the whole grid."""
FEW = 200
"""Colours of each group that wavelengths are fitted to, and that representations are evaluated on."""
DIGITS = 2
"""Decimals of a wavelength in nm, so that the measured wavelengths are those of the command line."""
DEPTHS: dict[str, DTypeLike] = {"half": np.float16, "float": np.float32}


def cube_args(options: Mapping[str, Any]) -> str:
    """Options of ``uplift build`` for fields of `Options` that have an option of their own name."""
    return " ".join(f"--{name} {value}" for name, value in options.items())


def wavelength_args(wavelengths: Array) -> str:
    """Option of ``uplift texture`` for wavelengths in nm."""
    return f"--wavelengths {','.join(f'{each:g}' for each in wavelengths)}"


def choose_coefficients(context: PlanContext, tests: EvaluationSet, limit: float) -> Decision:
    """Choose the number of coefficients at the reference dim, where the lattice adds no error."""
    counts, dim = context.grid.coefficients, context.grid.reference

    def trials() -> Iterator[Trial]:
        for done, count in enumerate(counts):
            context.progress(Progress(f"{count} coefficients", done, len(counts)))
            options = {"coefficients": count}
            cube = context.cube(tests.rgb, dim=dim, **options)
            cost = f"{format_size(BYTES_PER_COEFFICIENT * count)} per point"
            error = tests.error(cube.reflectance(tests.rgb))
            yield Trial(str(count), count, cost, cube_args(options), options, error)

    return decide("coefficients", "Coefficients per spectrum", "coefficients", limit, trials())


def choose_lattice(context: PlanContext, tests: EvaluationSet, limit: float, count: int) -> Decision:
    """Choose dim and axis by the number of lattice points that the textures need."""
    dims = (*context.grid.dims, context.grid.reference)
    sizes = sorted((_points_needed(context, axis, dim), dim, axis) for dim, axis in product(dims, AXES))
    latest: dict[str, float] = {}

    def trials() -> Iterator[Trial]:
        for done, (points, dim, axis) in enumerate(sizes):
            if latest.get(axis, 0) > MAX_AXIS_RATIO * min(latest.values(), default=1):
                continue
            context.progress(Progress(f"dim {dim}, {axis} axis", done, len(sizes)))
            options = {"dim": dim, "axis": axis}
            cube = context.cube(tests.rgb, coefficients=count, **options)
            cost = f"{points:,} points, {format_size(BYTES_PER_COEFFICIENT * count * points)}"
            error = tests.error(cube.reflectance(tests.rgb))
            latest[axis] = error.quantile
            yield Trial(f"{dim}³, {axis}", points, cost, cube_args(options), options, error)

    return decide("lattice", "Lattice", "lattice points that the textures need", limit, trials())


def _points_needed(context: PlanContext, axis: str, dim: int) -> int:
    """Estimate the lattice points that the textures need: those around one colour of every bin."""
    lattice = Lattice(observer.axis_nodes(axis, dim))
    return int(lattice.corner_points(occupied_cells(lattice, context.colours.colour_bins)).sum())


def choose_wavelengths(
    context: PlanContext, tests: EvaluationSet, limit: float, cube: Cube
) -> tuple[Decision, Sampling]:
    """Choose wavelengths, and weights that serve all lights, for the spectra of the cube.

    They are fitted to a subsample of the pixels and materials; all are evaluated.
    """
    setup = make_setup(
        cube.reflectance(tests.subsample(FEW).rgb),
        [light.name for light in tests.lights],
        wavelengths=context.sensor.wavelengths,
        observer_name=context.sensor.observer,
    )
    measured: list[Sampling] = []

    def trials() -> Iterator[Trial]:
        for count in (*COUNTS, None):
            if count is None:
                sampling = Sampling(setup.wavelengths, setup.cmfs, setup.lights, setup.powers)
            else:
                context.progress(Progress(f"{count} wavelengths", len(measured), len(COUNTS) + 1))
                sampling = _rounded_sampling(setup, count)
            measured.append(sampling)
            nm, number = sampling.wavelengths, len(sampling)
            error = tests.error_of_xyz(sampling.xyz(cube.reflectance(tests.rgb, nm)))
            cost = f"{number} samples per ray"
            yield Trial(str(number), number, cost, wavelength_args(nm), {"count": number}, error)

    decision = decide("wavelengths", "Wavelengths", "wavelengths", limit, trials())
    return decision, measured[decision.selected]


def _rounded_sampling(setup: RenderSetup, count: int) -> Sampling:
    """Wavelengths rounded to `DIGITS`, all distinct."""
    sampling = choose(setup, count=count).sampling
    steps = np.arange(count) / 10**DIGITS
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

    def bytes_per_pixel(self, cube: Cube, wavelengths: Array) -> int:
        """Size of a pixel before compression, without the RGB that textures also store."""
        count = len(wavelengths) if self.form == texture.Spectrum.name else cube.data.model.count
        return count * np.dtype(DEPTHS[self.depth]).itemsize

    def decoded_reflectance(self, cube: Cube, rgb: Array, wavelengths: Array) -> Array:
        """Reflectances (n, K) at wavelengths (K,) in nm that a renderer reads for linear RGB (n, 3).

        NaN where no spectrum has the rounded moments.
        """
        is_spectrum = self.form == texture.Spectrum.name
        encoding = (
            texture.Spectrum(tuple(wavelengths.tolist())) if is_spectrum else texture.PIXEL_ENCODINGS[self.form]()
        )
        numbers = encoding.make_sampler(cube, 1)(rgb.astype(np.float32))
        values = numbers.astype(DEPTHS[self.depth]).astype(float)
        if is_spectrum:
            return values
        model = cube.data.model
        if self.form == texture.Multipliers.name:
            return evaluate(model, values, wavelengths)
        try:
            return reflectance(model, values, wavelengths)
        except UpliftError:
            return np.full((len(rgb), len(wavelengths)), np.nan)


STORAGES = tuple(Storage(name, depth) for name, form in texture.PIXEL_ENCODINGS.items() for depth in form().depths)


def choose_storage(
    context: PlanContext, tests: EvaluationSet, limit: float, cube: Cube, sampling: Sampling
) -> Decision:
    """Choose the smallest pixel; of equal sizes spectra first, which renderers need not evaluate."""
    nm = sampling.wavelengths
    order = sorted(STORAGES, key=lambda storage: storage.bytes_per_pixel(cube, nm))

    def trials() -> Iterator[Trial]:
        for done, storage in enumerate(order):
            form, depth = storage.form, storage.depth
            context.progress(Progress(f"{form} as {depth}", done, len(order)))
            error = tests.error_of_xyz(sampling.xyz(storage.decoded_reflectance(cube, tests.rgb, nm)))
            size = storage.bytes_per_pixel(cube, nm)
            choice = {"as": form, "depth": depth}
            cost = f"{format_size(size)} per pixel"
            yield Trial(f"{form}, {depth}", size, cost, storage.cli_args, choice, error)

    return decide("storage", "Texture pixel", "bytes per pixel", limit, trials())


def choose_representation(context: PlanContext, tests: EvaluationSet, limit: float, cube: Cube) -> Decision:
    """Choose a representation for renderers that do not use the plan's wavelengths.

    The cost is the floats per surface, then those per light.
    """
    dense, powers = _dense_tests(context, tests)
    surfaces = cube.reflectance(dense.rgb, wavelengths())
    representations = all_representations(powers, surfaces)
    cli_args = _compare_command(context.scene, limit)
    measured = []
    for done, each in enumerate(representations):
        context.progress(Progress(f"representation {each.name}", done, len(representations)))
        code = each.encode_surface(surfaces)
        floats = float(each.storage(code).mean())
        light_floats = float(each.storage(each.encode_light(powers)).mean())
        error = dense.error_of_xyz([_product_xyz(each, power, code, len(surfaces)) for power in powers])
        cost = f"{floats:.4g} floats per surface, {light_floats:.4g} per light"
        choice = {"representation": each.name, "family": each.family}
        measured.append(Trial(each.name, floats + light_floats / 1000, cost, cli_args, choice, error))
    ordered = sorted(measured, key=lambda trial: trial.cost)
    return decide("representation", "Alternative representation", "floats per surface", limit, ordered)


def _dense_tests(context: PlanContext, tests: EvaluationSet) -> tuple[EvaluationSet, Array]:
    """Test colours on the 1 nm grid of representations, and powers (L, 401) of the lights."""
    few, nm = tests.subsample(FEW), wavelengths()
    powers = np.stack([observer.illuminant_spd(light.name, step=STEP) for light in few.lights])
    powers = powers / (powers @ xyz_weights()[:, 1:2])
    groups = []
    for group in few.groups:
        spectra = [np.interp(nm, context.sensor.wavelengths, spectrum) for spectrum in group.reflectances]
        groups.append(replace(group, reflectances=np.stack(spectra)))
    lights = tuple(
        Light(light.name, (power[:, None] * xyz_weights()).T) for light, power in zip(few.lights, powers, strict=True)
    )
    return EvaluationSet(tuple(groups), lights, few.quantile), powers


def _product_xyz(representation: Representation, power: Array, surfaces: Any, count: int) -> Array:
    """XYZ (count, 3) of a light on encoded surfaces; the worst where no spectrum has the code."""
    light = representation.encode_light(np.broadcast_to(power, (count, len(power))))
    try:
        return representation.xyz(representation.multiply(light, surfaces))
    except UpliftError:
        return np.full((count, 3), WORST_DELTA_E)


def _compare_command(scene: SceneFile, limit: float) -> str:
    """``uplift compare`` for the lights and materials of a scene."""
    words = [word for path in scene.atlases for word in ("--atlas", str(path))]
    words += [word for light in scene.lights for word in ("--light", light)]
    return shlex.join(["uplift", "compare", *words, "--tolerance", f"{limit:.3g}"])
