"""The content of a cube file: everything that a lookup needs, and how the cube was built."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.colorimetry.expected_error import COVERAGE, familiar_distance
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Indices, Mask
from uplift.lattice import Lattice, PointTable
from uplift.lattice.entry_boxes import EntryBoxes
from uplift.models import Model, evaluate


@dataclass(frozen=True, eq=False, repr=False)
class EntrySpectra:
    """The spectra that answer the colours of atlas entries.

    Entries are few and nodes are many, so the entries may have more coefficients than the nodes: the model is that of
    the cube, with the same or a larger number of coefficients.

    Parameters
    ----------
    model : Model
        Spectrum model of the entries.
    coefficients : ndarray, shape (E, K)
        Coefficients of the spectra in this model.
    """

    model: Model
    coefficients: Array

    def __repr__(self) -> str:
        return f"EntrySpectra({len(self.coefficients)} of {self.model.count} coefficients)"

    @cached_property
    def multipliers(self) -> Array:
        """(E, K) multipliers of the spectra."""
        return self.model.from_storage(self.coefficients)

    def reflectance(self, entries: Indices, wavelengths: Array) -> Array:
        """Evaluate the spectra of entries.

        Parameters
        ----------
        entries : ndarray of int, shape (k,)
            Rows of the entries.
        wavelengths : ndarray, shape (N,)
            Wavelengths in nm.

        Returns
        -------
        ndarray, shape (k, N)
            Reflectance in [0, 1].
        """
        return evaluate(self.model, self.multipliers[entries], wavelengths)


@dataclass(frozen=True, eq=False, repr=False)
class LeftOut:
    """Atlas entries as measured, and as answered without them: evidence for the errors of answers.

    Parameters
    ----------
    measured : ndarray of float32, shape (M, N)
        Measured reflectances at the wavelengths of the sensor, of all entries but looks.
    answered : ndarray of float32, shape (M, N)
        Reflectances at the colours of the entries, each predicted from the others.
    """

    measured: NDArray[np.float32]
    answered: NDArray[np.float32]

    def __repr__(self) -> str:
        return f"LeftOut({len(self.measured)} entries)"


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
        Coefficients of the entries in the model of the nodes, for uses that need one number of coefficients:
        interpolated coefficients, textures of moments, exported tables. Spectra are evaluated from
        `CubeData.entry_spectra`.
    half_width : ndarray, shape (E,)
        Half the width of each entry box in lattice steps, 0 to 1. 0 for an entry whose colour an earlier entry has.
    error : ndarray, shape (E,)
        ΔE00 between fitted and measured spectrum under `CubeData.error_illuminant`.
    spectra : EntrySpectra, optional
        The entries with more coefficients than the nodes; None if they have as many.
    left_out : LeftOut, optional
        Evidence for the errors of answers; None for a small atlas, and for files of earlier versions.
    looks : int, default 0
        Number of looks, which are the last entries: chosen spectra, of which no measurement is known. Their ``error``
        is the standard error of the other entries at their colours.
    """

    names: tuple[str, ...]
    rgb: Array
    coefficients: Array
    half_width: Array
    error: Array
    spectra: EntrySpectra | None = None
    left_out: LeftOut | None = None
    looks: int = 0

    @property
    def measured_count(self) -> int:
        """Number M of the entries that were measured, which are the first ones."""
        return len(self.names) - self.looks

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
            f"{sensor.space} under {sensor.illuminant}, {len(self.atlas.names)} entries{self._entry_count()})"
        )

    def _entry_count(self) -> str:
        return "" if self.atlas.spectra is None else f" with {self.entry_spectra.model.count} coefficients"

    @cached_property
    def entry_spectra(self) -> EntrySpectra:
        """The spectra that answer the colours of the entries, in the model of the nodes or with more coefficients."""
        return self.atlas.spectra or EntrySpectra(self.model, self.atlas.coefficients)

    @cached_property
    def entry_lab(self) -> Array:
        """(M, 3) CIE L*a*b* of the measured entries under the build illuminant."""
        return rgb_to_lab(self.sensor, self.atlas.rgb[: self.atlas.measured_count])

    @cached_property
    def familiar_distance(self) -> float:
        """ΔE*ab from the nearest entry up to which a colour is like those of the atlas."""
        return familiar_distance(self.entry_lab)

    @property
    def error_bound_factor(self) -> float:
        """Error bound in standard errors, under `error_illuminant`; 2 in cubes that do not record it."""
        return float(self.provenance.get("prior", {}).get("error_bound", COVERAGE[1][1]))

    @cached_property
    def entry_boxes(self) -> EntryBoxes:
        """Boxes around the atlas entries."""
        return EntryBoxes(self.lattice, self.atlas.rgb, self.atlas.half_width)

    @cached_property
    def complete_cells(self) -> Mask | None:
        """(n,) True for cells with eight present corners, by the number of the lowest. None if no point is absent."""
        return None if self.points.present.all() else self.lattice.complete_cells(self.points.present)

    @cached_property
    def inexact_cells(self) -> Mask | None:
        """(n,) True for cells with a corner that has not its own colour, by the number of the lowest. None without any.

        Corners are unrealisable in wide gamuts, or were not fitted.
        """
        exact = self.points.distance <= self.threshold
        return None if exact.all() else ~self.lattice.complete_cells(exact)
