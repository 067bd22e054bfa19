"""The content of a cube file: everything that a lookup needs, and how the cube was built."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Mask
from uplift.lattice import Lattice, PointTable
from uplift.lattice.entry_boxes import EntryBoxes
from uplift.models import Model


@dataclass(frozen=True, eq=False, repr=False)
class AtlasTable:
    """The atlas entries that constrain a cube.

    Parameters
    ----------
    names : tuple of str
        Unique names of the E entries.
    rgb : ndarray, shape (E, 3)
        Linear RGB.
    coefficients : ndarray, shape (E, C)
        Coefficients of the fitted spectra.
    half_width : ndarray, shape (E,)
        Half the width of each entry box in lattice steps, 0 to 1. 0 for an entry whose colour an earlier entry has.
    error : ndarray, shape (E,)
        ΔE00 between fitted and measured spectrum under `CubeData.error_illuminant`.
    """

    names: tuple[str, ...]
    rgb: Array
    coefficients: Array
    half_width: Array
    error: Array

    def __repr__(self) -> str:
        return f"AtlasTable({len(self.names)} entries)"


@dataclass(frozen=True, eq=False, repr=False)
class CubeData:
    """A lattice of spectra, and the sensor and atlas that it was built with.

    Parameters
    ----------
    model : Model
        Spectrum model of the coefficients.
    lattice : Lattice
        Axis nodes in linear RGB.
    sensor : Sensor
        RGB space, illuminant and observer.
    threshold : float
        Largest fitting distance, in linear RGB, of a fitted point.
    atlas : AtlasTable
        The entries that constrain the cube.
    points : PointTable
        Arrays over the lattice points.
    error_illuminant : str
        Illuminant of all ΔE00 values in the cube.
    provenance : mapping
        How the cube was built: version, options, names and digests of the atlas files. JSON values.
    """

    model: Model
    lattice: Lattice
    sensor: Sensor
    threshold: float
    atlas: AtlasTable
    points: PointTable
    error_illuminant: str
    provenance: Mapping[str, Any]

    def __repr__(self) -> str:
        sensor = self.sensor
        return (
            f"CubeData({self.model.name} with {self.model.count} coefficients, dim {self.lattice.dim}, "
            f"{sensor.space} under {sensor.illuminant}, {len(self.atlas.names)} entries)"
        )

    @cached_property
    def entry_boxes(self) -> EntryBoxes:
        """Boxes around the atlas entries."""
        return EntryBoxes(self.lattice, self.atlas.rgb, self.atlas.half_width)

    @cached_property
    def complete_cells(self) -> Mask | None:
        """(n,) True for cells with eight present corners, by the number of the lowest. None if no point is absent."""
        return None if self.points.present.all() else self.lattice.complete_cells(self.points.present)
