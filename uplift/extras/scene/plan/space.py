"""The candidates for a scene: their costs, lower bounds of their errors, and their
measurement.

What a model of spectra, a lattice, and few wavelengths change is measured once each.
Changes of XYZ by a model and by a lattice add, to predict the error of a cube. The
squares of the errors of a cube and of the wavelengths add.
"""

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from itertools import product
from typing import Any

import numpy as np

from uplift.atlas.atlas import Atlas
from uplift.atlas.sources import read_atlas
from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.common.progress import Progress, ProgressCallback
from uplift.cube.file import contents
from uplift.cube.schema import POINTS
from uplift.extras import texture
from uplift.extras.papers.wavelengths.sampling import make_setup
from uplift.extras.scene.plan.candidates import (
    INDEX,
    PIXELS,
    RGB,
    Candidate,
    Cost,
    Pixel,
    SearchGrid,
)
from uplift.extras.scene.plan.evaluation import (
    SAMPLE_OPERATIONS,
    ErrorSummary,
    EvaluationSet,
    Rendering,
    renderings,
)
from uplift.extras.scene.plan.files import SceneFile
from uplift.extras.texture.scene_colours import (
    ColourSet,
    Images,
    PixelSample,
    cells_touched,
    sample_colours,
)
from uplift.fit.problem import Problem
from uplift.lattice.lattice import Lattice, axis_nodes
from uplift.lookup.cube import Cube
from uplift.models.model import Model
from uplift.models.sigmoid import Sigmoid
from uplift.pipeline.entries import split_by_gamut
from uplift.pipeline.options import Options
from uplift.pipeline.stages import Learnt, build_stages, learn, problem_of

FLOOR = 0.5
"""Share of the tolerance below which errors count as equal."""
CEILING = 2.0
"""Share of the tolerance above which candidates are not measured."""
MARGIN = 0.85
"""Share of a predicted error that is its lower bound."""
FINE = 64
"""Nodes along each axis of the cubes that measure models."""
PROBE = 9
"""Coefficients of the cubes that measure lattices."""
LEAST_BYTES = 4
"""Bytes of a coefficient, unless colours need 8."""
POINT_NUMBER = 4
"""Bytes of the number of a node in a sparse file."""


class CandidateSpace:
    """A scene with its files read, and the candidates for it, measured with the pixels
    of the first sample.

    ``materials`` are the atlas entries within the RGB space. Raises `AtlasError`,
    `TextureError`, `PlanFileError`.
    """

    def __init__(
        self, scene: SceneFile, grid: SearchGrid, progress: ProgressCallback
    ) -> None:
        self.scene = scene
        self.grid = grid
        self.progress = progress
        self.sensor = scene.sensor()
        self.atlas = read_atlas(*scene.atlases) if scene.atlases else None
        # `uplift build --plan` repeats the warnings, also those of trial builds.
        with warnings.catch_warnings(action="ignore", category=UpliftWarning):
            self.materials, _ = split_by_gamut(self.atlas or Atlas(), self.sensor)
        images = Images(scene.textures, scene.encoding)
        sizes = (grid.predicting, grid.confirming)
        self.colours = sample_colours(images, self.sensor, sizes, progress)
        self.learnt: dict[tuple[Model, Model], Learnt] = {}
        self.floor = FLOOR * scene.tolerance
        self.ceiling = CEILING * scene.tolerance
        self.reference = self._reference_options()
        self._measure_reference()

    def _reference_options(self) -> Options:
        """Options of the cube with which others are compared."""
        scene = self.scene
        # Entries hold under the scene's lights and the illuminant of the RGB space.
        lights = dict.fromkeys((self.sensor.illuminant, *scene.lights))
        return Options(
            dim=self.grid.reference,
            coefficients=self.grid.models[Options.warp][-1],
            space=scene.space,
            illuminant=scene.illuminant,
            observer=scene.observer,
            lights=tuple(lights),
        )

    def _measure_reference(self) -> None:
        """Build the reference cube, and measure its renderings, colours and sizes."""
        self.progress(Progress("reference cube", 0, 1))
        tests = self.evaluation_set(self.colours.predicting)
        others = self.sensor.observer if self.grid.others else None
        self.renderings = renderings(
            self.grid.samples, tests, self.floor, self.progress, others
        )
        self.cubes = {self.reference: tests.reference}
        self.tests = tests
        self.matrices = tests.matrices()
        self.base = self._xyz(self.reference)
        arrays = contents(tests.reference.data)[0]
        self.row_bytes = sum(
            arrays[name][0].nbytes
            for name in POINTS
            if name in arrays and name != "coefficients"
        )
        self.other_bytes = sum(
            array.nbytes for name, array in arrays.items() if name not in POINTS
        )

    def cube(self, rgb: Array, options: Options) -> Cube:
        """Build a sparse cube for linear RGB (n, 3)."""

        def shared(problem: Problem, entry_model: Model, *rest: Any) -> Learnt:
            models = problem.model, entry_model
            if models not in self.learnt:
                self.learnt[models] = learn(problem, entry_model, *rest)
            return self.learnt[models]

        with warnings.catch_warnings(action="ignore", category=UpliftWarning):
            options, problem = problem_of(options)
            return build_stages(
                self.atlas, options, problem, scene=ColourSet(rgb), learn=shared
            )

    def evaluation_set(self, sample: PixelSample) -> EvaluationSet:
        """Pixels with the spectra of a reference cube for them, and the materials as
        measured.
        """
        rgb = np.concatenate([sample.rgb, self.materials.rgb])
        reference = self.cube(rgb, self.reference)
        spectra = np.concatenate(
            [reference.reflectance(sample.rgb), self.materials.reflectances]
        )
        pixels = len(sample.rgb)
        count = len(self.materials.rgb)
        weights = np.concatenate([sample.share, np.full(count, 1 / max(count, 1))])
        groups = {"textures": slice(0, pixels)} | (
            {"materials": slice(pixels, pixels + count)} if count else {}
        )
        nm = self.sensor.wavelengths
        observer_name = self.sensor.observer
        setup = make_setup(
            spectra, self.scene.lights, wavelengths=nm, observer_name=observer_name
        )
        return EvaluationSet(
            reference, setup, rgb, weights, groups, self.scene.quantile
        )

    def candidates(self) -> list[Candidate]:
        """All candidates with their costs and the lower bounds of their errors; RGB
        alone is the first.

        Cubes are left out where they cannot save anything: where RGB have no error, or
        colours are few.
        """
        colours = self.colours
        without_spectra = Cost(colours.size, 3 * SAMPLE_OPERATIONS, 3)
        candidates = [Candidate(Pixel(RGB), without_spectra)]
        self.without_spectra = self.measure(None, candidates)[0].error
        for rendering in self.renderings:
            if rendering.sampling is not None and colours.few is not None:
                cost = Cost(
                    colours.pixels + 2 * len(colours.few) * rendering.surface,
                    rendering.operations,
                    rendering.samples,
                )
                candidates.append(Candidate(Pixel(INDEX, "half"), cost, rendering))
        self.considered = len(candidates)
        if colours.few is None and self.without_spectra.quantile > self.floor:
            candidates += self._with_cubes()
        return candidates

    def measure(
        self, choice: Options | None, candidates: Sequence[Candidate]
    ) -> list[Candidate]:
        """Build the cube that candidates share, and measure their errors."""
        self.progress(Progress(candidates[0].name, 0, 1))
        cube = self._cube(choice) if choice else self.tests.reference
        return self.errors(cube, candidates, self.tests)

    def errors(
        self, cube: Cube, candidates: Sequence[Candidate], tests: EvaluationSet
    ) -> list[Candidate]:
        """Measure the errors of candidates that share a cube, or need none."""
        traced = dict.fromkeys(
            filter(None, (candidate.rendering for candidate in candidates))
        )
        needed = [rendering.wavelengths for rendering in traced]
        nm = np.concatenate([[], *needed])
        ends = np.cumsum([0, *map(len, needed)])
        columns = dict(zip(traced, map(slice, ends, ends[1:]), strict=False))
        spectra = cache(lambda pixel: pixel.decoded(cube, tests.rgb, nm))

        def measured(candidate: Candidate) -> Candidate:
            rendering = candidate.rendering
            if rendering is None:
                xyz = tests.rgb @ self.matrices.mT
            else:
                xyz = rendering.xyz(spectra(candidate.pixel)[:, columns[rendering]])
            return replace(candidate, error=tests.error(xyz))

        return list(map(measured, candidates))

    def _with_cubes(self) -> Iterator[Candidate]:
        """Candidates that need a cube and whose bounds are below the ceiling."""
        base = _quantiles(self.tests.error(self.base))
        lattices = self._lattices()
        points = {lattice: self._points(lattice) for lattice in lattices}
        for (model, by_model), (lattice, by_lattice) in product(
            self._models().items(), lattices.items()
        ):
            choice = replace(model, dim=lattice.dim, axis=lattice.axis)
            of_cube = _quantiles(self.tests.error(self.base + by_model + by_lattice))
            for rendering in self.renderings:
                # Errors of independent choices add in squares; both include that of the
                # reference.
                squares = of_cube**2 + _quantiles(rendering.error) ** 2 - base**2
                bound = MARGIN * float(np.sqrt(squares.max()))
                candidates = list(
                    self._with_pixels(choice, points[lattice], rendering, bound)
                )
                self.considered += len(candidates)
                if bound <= self.ceiling:
                    yield from candidates

    def _with_pixels(
        self,
        choice: Options,
        points: tuple[int, int],
        rendering: Rendering,
        bound: float,
    ) -> Iterator[Candidate]:
        """Candidates of a cube, of ``points`` nodes with all cells and with those of
        the textures, and a rendering.
        """
        colours = self.colours
        count = round(rendering.surface)
        for sparse, pixel in product((False, True)[: 1 + self.scene.sparse], PIXELS):
            if choice.model == Sigmoid.name and pixel.form == texture.Moments.name:
                continue
            if rendering.sampling is None and pixel.form != texture.Spectrum.name:
                continue  # a texture has the numbers of the representation
            row = (
                self.row_bytes
                + POINT_NUMBER * sparse
                + LEAST_BYTES * choice.coefficients
            )
            texels = (
                colours.pixels * pixel.size(choice.coefficients, count)
                if pixel.depth
                else colours.size
            )
            memory = self.other_bytes + points[sparse] * row + texels
            time = pixel.operations(choice, count) + rendering.operations
            yield Candidate(
                pixel,
                Cost(memory, time, rendering.samples),
                rendering,
                choice,
                sparse,
                bound,
            )

    def _models(self) -> dict[Options, Array]:
        """Changes of XYZ (K, n, 3) by models of spectra, on a fine lattice: the
        sigmoid, and moments of each warp.
        """
        fine = replace(self.reference, dim=min(FINE, self.grid.reference))
        series = {}
        for warp, counts in self.grid.models.items():
            series[warp] = [
                replace(fine, coefficients=count, warp=warp) for count in counts
            ]
        series[fine.warp].insert(0, replace(fine, model=Sigmoid.name, coefficients=3))
        return self._changes("models of spectra", list(series.values()), fine)

    def _lattices(self) -> dict[Options, Array]:
        """Changes of XYZ (K, n, 3) by lattices, with `PROBE` coefficients: more and
        more nodes along each axis.
        """
        probe = replace(self.reference, coefficients=PROBE)
        series = []
        for axis in self.grid.axes:
            series.append(
                [replace(probe, dim=dim, axis=axis) for dim in self.grid.dims]
            )
        return self._changes("lattices", series, probe)

    def _changes(
        self, stage: str, series: Sequence[Sequence[Options]], finest: Options
    ) -> dict[Options, Array]:
        """Changes of XYZ from the ``finest``, of each series up to the first below the
        floor.
        """
        changes = dict[Options, Array]()
        reference = self._xyz(finest)
        for done, choices in enumerate(series):
            self.progress(Progress(stage, done, len(series)))
            for choice in choices:
                changes[choice] = self._xyz(choice) - reference
                if self.tests.error(self.base + changes[choice]).quantile <= self.floor:
                    break
        return changes

    def _xyz(self, choice: Options) -> Array:
        return self.tests.xyz(self._cube(choice).reflectance(self.tests.rgb))

    def _cube(self, choice: Options) -> Cube:
        """Cube for the test colours, built once."""
        if choice not in self.cubes:
            self.cubes[choice] = self.cube(self.tests.rgb, choice)
        return self.cubes[choice]

    def _points(self, choice: Options) -> tuple[int, int]:
        """Numbers of the nodes of a lattice, and of those around one colour of every
        bin of the textures.
        """
        lattice = Lattice(axis_nodes(choice.axis, int(choice.dim)))
        needed = lattice.corner_points(
            lattice.mask(cells_touched(lattice, self.colours.colour_bins))
        )
        return lattice.size, int(needed.sum())


def _quantiles(error: ErrorSummary) -> Array:
    return np.array([group.quantile for group in error.parts])
