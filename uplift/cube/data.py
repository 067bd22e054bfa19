"""The content of a cube file: everything that a lookup needs, and how the cube was
built.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.colorimetry.likely_errors import LeftOut, familiar_distance
from uplift.colorimetry.object_colours import Solid, solid
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Indices, Mask
from uplift.common.errors import OptionError
from uplift.common.text import pluralise
from uplift.lattice.entry_boxes import MARGIN, EntryBoxes, OutsideBoxes
from uplift.lattice.lattice import Lattice
from uplift.lattice.point_table import PointTable
from uplift.models.model import Model, evaluate

MAX_SIZE = 500.0
"""Largest Σ |p| of the multipliers of nodes that have not their own colours, in
mixtures of spectra.
"""


@dataclass(frozen=True, eq=False, repr=False)
class EntrySpectra:
    """The spectra that answer the colours of atlas entries: ``coefficients`` (E, K) in
    a ``model``.

    Entries are few and nodes are many, so the entries may have more coefficients than
    the nodes: the model is that of the cube, with the same or a larger number of
    coefficients.
    """

    model: Model
    coefficients: Array

    def __repr__(self) -> str:
        return (
            f"EntrySpectra({len(self.coefficients)} of "
            f"{pluralise(self.model.count, 'coefficient')})"
        )

    @cached_property
    def multipliers(self) -> Array:
        """(E, K) multipliers of the spectra."""
        return self.model.from_storage(self.coefficients)

    def reflectance(self, entries: Indices, wavelengths: Array) -> Array:
        """Evaluate the spectra of ``entries`` (k,) at wavelengths (N,) in nm:
        reflectance (k, N) in [0, 1].
        """
        return evaluate(self.model, self.multipliers[entries], wavelengths)


@dataclass(frozen=True, eq=False, repr=False)
class AtlasTable:
    """The E atlas entries that constrain a cube. The last ones may be looks."""

    names: tuple[str, ...]
    """Unique names."""
    rgb: Array
    """(E, 3) linear RGB."""
    coefficients: Array
    """(E, C) coefficients in the model of the nodes, for uses that need one number of
    coefficients.
    """
    half_width: Array
    """(E,) half the width of each entry box in lattice steps, 0 to 1. 0 if an earlier
    entry has the colour.
    """
    error: Array
    """(E,) ΔE00 between fitted and measured spectrum; for looks the standard error at
    their colours.
    """
    spectra: EntrySpectra
    """The spectra that answer the colours of the entries, in the model of the nodes or
    with more coefficients.
    """
    measured: NDArray[np.float32] | None = None
    """(M, N) measured reflectances at the wavelengths of the sensor; None for a small
    atlas and in earlier files.
    """
    left_out: NDArray[np.float32] | None = None
    """(M, N) reflectances at the colours of these entries, each predicted from the
    others; evidence for errors.
    """
    looks: int = 0
    """Number of looks: chosen spectra, of which no measurement is known."""
    outside: "AtlasTable | None" = None
    """The O entries outside the RGB space, which answer XYZ and textures; their boxes
    have steps of 1 / (dim − 1).
    """

    @property
    def measured_count(self) -> int:
        """Number M of the entries that were measured, which are the first ones."""
        return len(self.names) - self.looks

    @property
    def with_outside(self) -> "AtlasTable":
        """All entries: those in the RGB space, then those outside it."""
        if (more := self.outside) is None:
            return self

        columns = ("rgb", "coefficients", "half_width", "error")
        both: dict[str, Any] = {
            name: np.concatenate([getattr(self, name), getattr(more, name)])
            for name in columns
        }
        stored = [table.spectra.coefficients for table in (self, more)]
        spectra = EntrySpectra(self.spectra.model, np.concatenate(stored))
        return AtlasTable(names=(*self.names, *more.names), spectra=spectra, **both)

    def __repr__(self) -> str:
        return f"AtlasTable({pluralise(len(self.names), 'entry')})"


@dataclass(frozen=True, eq=False, repr=False)
class CubeData:
    """A lattice of spectra, and the sensor and atlas that it was built with."""

    model: Model
    lattice: Lattice
    sensor: Sensor
    threshold: float
    """Largest fitting distance, in linear RGB, of a fitted node."""
    atlas: AtlasTable
    points: PointTable
    error_illuminant: str
    """Illuminant of all ΔE00 values in the cube."""
    provenance: Mapping[str, Any]
    """How the cube was built, such as its options and the names and digests of its
    atlas files. JSON values.
    """
    families: LeftOut | None = None
    """Families of measured materials, predicted without each of them: evidence for
    errors where the atlas is too small. None in earlier files.
    """

    def __repr__(self) -> str:
        sensor = self.sensor
        coefficients = pluralise(self.model.count, "coefficient")
        entries = pluralise(len(self.atlas.names), "entry")
        entry_model = self.atlas.spectra.model
        if entry_model != self.model:
            entries += f" with {pluralise(entry_model.count, 'coefficient')}"
        if self.atlas.outside is not None:
            entries += f" and {len(self.atlas.outside.names)} outside"
        return (
            f"CubeData({self.model.name} with {coefficients}, dim {self.lattice.dim}, "
            f"{sensor.space} under {sensor.illuminant}, {entries})"
        )

    @cached_property
    def entry_lab(self) -> Array:
        """(M, 3) CIE L*a*b* of the measured entries under the build illuminant."""
        return rgb_to_lab(self.sensor, self.atlas.rgb[: self.atlas.measured_count])

    @cached_property
    def evidence_lab(self) -> Array:
        """(M, 3) CIE L*a*b* of the materials that errors are learnt from."""
        if self.families is None:
            return self.entry_lab
        return rgb_to_lab(self.sensor, self.families.rgb)

    @cached_property
    def familiar_distance(self) -> float:
        """ΔE*ab from the nearest of these up to which a colour is like theirs."""
        return familiar_distance(self.evidence_lab)

    @property
    def error_bound_factor(self) -> float:
        """Error bound in standard errors, under `error_illuminant`; 2 in cubes that do
        not record it.
        """
        return float(self.provenance.get("prior", {}).get("error_bound", 2.0))

    @cached_property
    def entry_boxes(self) -> EntryBoxes:
        """Boxes around the atlas entries."""
        return EntryBoxes(self.lattice, self.atlas.rgb, self.atlas.half_width)

    @cached_property
    def outside_boxes(self) -> OutsideBoxes:
        """Boxes around the atlas entries outside the RGB space."""
        outside = self.atlas.outside
        if outside is None:
            return OutsideBoxes(np.zeros((0, 3)), np.zeros(0))
        # The lattice has no steps outside [0, 1]: half widths are in those of a linear
        # axis.
        return OutsideBoxes(outside.rgb, outside.half_width / (self.lattice.dim - 1))

    @cached_property
    def solid(self) -> Solid:
        """The colours that reflectances have under the build illuminant."""
        return solid(self.sensor.matrix)

    @cached_property
    def is_sparse(self) -> bool:
        """Whether nodes are absent: only colours whose tetrahedron is there are
        answered.
        """
        return not self.points.present.all()

    @cached_property
    def inexact_cells(self) -> Mask | None:
        """(n,) True for cells with a corner that has not its own colour, by the number
        of the lowest. None without any.

        Corners are unrealisable in wide gamuts, or were not fitted.
        """
        # Mixtures Σ w g_i have the colour x = Σ w x_i only if every corner has r_i =
        # x_i.
        inexact = self.points.present & ~(self.points.distance <= self.threshold)
        return self.lattice.cells_around(inexact) if inexact.any() else None

    @cached_property
    def inexact_corners(self) -> Mask | None:
        """(n,) True for the corners of `inexact_cells`. None without any."""
        cells = self.inexact_cells
        return None if cells is None else self.lattice.corner_points(cells)

    def missing_points(self, rgb: Array | None = None) -> Indices:
        """Return the absent nodes that linear RGB (n, 3) need, or all absent nodes."""
        absent = ~self.points.present
        if rgb is not None:
            evaluated = self.entry_boxes.nodes(rgb).lattice_rgb(rgb)
            absent &= self.lattice.needed(evaluated, MARGIN)[1]
        return np.flatnonzero(absent)

    def smoothed_multipliers(self, points: Indices) -> Array:
        """Return multipliers (m, C) of nodes for mixtures, with less steep steps where
        colours are not exact.

        Spectra near the boundary of the solid are steps, which single precision cannot
        place; answers there are moved.
        """
        multipliers = self.model.from_storage(self.points.coefficients[points])
        rows = np.flatnonzero(self.points.distance[points] > self.threshold)
        multipliers[rows] *= np.minimum(
            1, MAX_SIZE / np.abs(multipliers[rows]).sum(axis=1)
        )[:, None]
        return multipliers


def common_sensor(cubes: Iterable[CubeData]) -> Sensor:
    """Return the sensor of the first of cubes of one RGB space, illuminant and
    observer; `OptionError` otherwise.
    """
    sensors = [cube.sensor for cube in cubes]
    spaces = {(sensor.space, sensor.illuminant, sensor.observer) for sensor in sensors}
    if len(spaces) > 1:
        names = " and ".join(", ".join(space) for space in sorted(spaces))
        problem = (
            "cubes that are used together must have one RGB space, illuminant and "
            f"observer, got {names}"
        )
        hint = "build the cube with the settings of the other"
        raise OptionError(problem, code="cubes-of-different-spaces", hint=hint)
    return sensors[0]
