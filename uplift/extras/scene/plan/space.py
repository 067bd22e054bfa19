"""The candidates for a scene: their costs, and lower bounds of their errors.

What a model of spectra, a lattice, and few wavelengths change is measured once each.
Changes of XYZ by a model and by a lattice add, to predict the error of a cube. The
squares of the errors of a cube and of the wavelengths add.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from uplift.common.arrays import Array
from uplift.common.progress import Progress, ProgressCallback
from uplift.cube.data import CubeData
from uplift.cube.file import contents
from uplift.cube.schema import POINTS
from uplift.extras.scene.plan.candidates import (
    INDEX,
    MOMENTS,
    PIXELS,
    RGB,
    Candidate,
    Cost,
    Pixel,
    SearchGrid,
)
from uplift.extras.scene.plan.evaluation import SAMPLE_OPERATIONS, Rendering
from uplift.extras.scene.plan.files import SceneFile
from uplift.extras.scene.plan.trial import Trial
from uplift.extras.texture.scene_colours import SampledColours
from uplift.lattice.entry_boxes import MARGIN as ROUNDING
from uplift.lattice.lattice import Lattice, axis_nodes
from uplift.models.sigmoid import Sigmoid
from uplift.pipeline.options import Options

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


def reference_options(scene: SceneFile, grid: SearchGrid) -> Options:
    """Return the options of the cube with which others are compared."""
    # Entries hold under the scene's lights and the illuminant of the RGB space.
    lights = dict.fromkeys((scene.sensor().illuminant, *scene.lights))
    return Options(
        dim=grid.reference,
        coefficients=grid.models[Options.warp][-1],
        space=scene.space,
        illuminant=scene.illuminant,
        observer=scene.observer,
        lights=tuple(lights),
    )


def without_cubes(
    colours: SampledColours, renderings: Sequence[Rendering]
) -> Iterator[Candidate]:
    """Yield the candidates that need no cube: RGB times light first, then lists of
    spectra for few colours.
    """
    yield Candidate(Pixel(RGB), Cost(colours.size, 3 * SAMPLE_OPERATIONS, 3))
    if colours.few is None:
        return
    for rendering in renderings:
        listed = 2 * len(colours.few) * rendering.samples
        cost = Cost(colours.pixels + listed, rendering.operations, rendering.samples)
        yield Candidate(Pixel(INDEX, "half"), cost, rendering)


@dataclass(frozen=True, eq=False)
class CubeChanges:
    """Changes of XYZ (K, n, 3) by models of spectra and by lattices, from those of the
    ``reference``.
    """

    reference: Array
    models: dict[Options, Array]
    lattices: dict[Options, Array]


def measure_changes(
    trial: Trial,
    reference: Options,
    grid: SearchGrid,
    floor: float,
    progress: ProgressCallback,
) -> CubeChanges:
    """Measure models on a fine lattice: the sigmoid, and moments of each warp; and
    lattices with `PROBE` coefficients. Each series ends below the floor.
    """
    base = trial.xyz(reference)

    def changes(
        stage: str, series: Sequence[Sequence[Options]], finest: Options
    ) -> dict[Options, Array]:
        measured = dict[Options, Array]()
        fine_xyz = trial.xyz(finest)
        for done, choices in enumerate(series):
            progress(Progress(stage, done, len(series)))
            for choice in choices:
                measured[choice] = trial.xyz(choice) - fine_xyz
                if trial.tests.error(base + measured[choice]).quantile <= floor:
                    break
        return measured

    fine = replace(reference, dim=min(FINE, grid.reference))
    models = {}
    for warp, counts in grid.models.items():
        models[warp] = [
            replace(fine, coefficients=count, warp=warp) for count in counts
        ]
    models[fine.warp].insert(0, replace(fine, model=Sigmoid.name, coefficients=3))
    probe = replace(reference, coefficients=PROBE)
    lattices = []
    for axis in grid.axes:
        lattices.append([replace(probe, dim=dim, axis=axis) for dim in grid.dims])
    return CubeChanges(
        base,
        changes("models of spectra", list(models.values()), fine),
        changes("lattices", lattices, probe),
    )


@dataclass(frozen=True, eq=False)
class CubeSizes:
    """Bytes of a cube file: those of a node but for coefficients, and of all else."""

    node: int
    others: int

    @classmethod
    def of(cls, data: CubeData) -> "CubeSizes":
        """Return the sizes of a cube."""
        arrays = contents(data)[0]
        others = [array for name, array in arrays.items() if name not in POINTS]
        of_nodes = {*POINTS} & {*arrays} - {"coefficients"}
        return cls(
            sum(arrays[name][0].nbytes for name in of_nodes),
            sum(array.nbytes for array in others),
        )

    def file(self, options: Options, nodes: int, *, sparse: bool) -> int:
        """Return the bytes of a file of this many nodes."""
        coefficients = LEAST_BYTES * options.coefficients
        return self.others + nodes * (self.node + POINT_NUMBER * sparse + coefficients)


def with_cubes(
    trial: Trial,
    scene: SceneFile,
    colours: SampledColours,
    renderings: Sequence[Rendering],
    changes: CubeChanges,
) -> Iterator[Candidate]:
    """Yield the candidates of all models, lattices and wavelengths."""
    tests = trial.tests
    sizes = CubeSizes.of(tests.reference.data)
    base = tests.error(changes.reference).quantiles
    nodes = {lattice: _nodes(lattice, colours) for lattice in changes.lattices}
    pairs = product(changes.models.items(), changes.lattices.items())
    for (model, by_model), (lattice, by_lattice) in pairs:
        options = replace(model, dim=lattice.dim, axis=lattice.axis)
        changed = changes.reference + by_model + by_lattice
        of_cube = tests.error(changed).quantiles
        for rendering, sparse in product(renderings, (False, True)[: 1 + scene.sparse]):
            # Errors of independent choices add in squares; both include that of the
            # reference.
            squares = of_cube**2 + rendering.error.quantiles**2 - base**2
            bound = MARGIN * float(np.sqrt(squares.max()))
            file = sizes.file(options, nodes[lattice][sparse], sparse=sparse)
            for pixel in PIXELS:
                if options.model == Sigmoid.name and pixel.form == MOMENTS:
                    continue
                cost = _cost(file, colours, options, rendering, pixel)
                yield Candidate(pixel, cost, rendering, options, sparse, bound)


def _cost(
    file: int,
    colours: SampledColours,
    options: Options,
    rendering: Rendering,
    pixel: Pixel,
) -> Cost:
    """Return the costs of a cube of a file of this size, with its textures."""
    count = rendering.samples
    size = pixel.size(options.coefficients, count)
    texels = colours.pixels * size if pixel.depth else colours.size
    time = pixel.operations(options, count) + rendering.operations
    return Cost(file + texels, time, count)


def _nodes(options: Options, colours: SampledColours) -> tuple[int, int]:
    """Numbers of the nodes of a lattice, and of those around one colour of every bin of
    the textures.
    """
    lattice = Lattice(axis_nodes(options.axis, int(options.dim)))
    _, points = lattice.needed(colours.colour_bins, ROUNDING)
    return lattice.size, int(points.sum())
