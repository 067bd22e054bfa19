"""What a cube file holds: everything that a lookup needs, and how the cube was made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Mask
from uplift.lattice import Lattice, Status
from uplift.lattice.entry_boxes import EntryBoxes
from uplift.models import Model


@dataclass(frozen=True, eq=False)
class AtlasTable:
    """The entries that the cube is constrained by.

    Parameters
    ----------
    names : (E) unique.
    rgb : (E, 3) linear RGB.
    coefficients : (E, C) of their spectra.
    reach : (E,) lattice steps to the faces of the box around an entry within which answers lead over to its
        spectrum; 0 for an entry whose colour an earlier one has.
    error : (E,) ΔE00 between stored and measured spectrum under the cube's reference light.
    """

    names: tuple[str, ...]
    rgb: Array
    coefficients: Array
    reach: Array
    error: Array


@dataclass(frozen=True, eq=False)
class CubeData:
    """A lattice of spectra. Per point (n = dim³, blue fastest), all 0 and no entry where it is absent:

    Parameters
    ----------
    coefficients : (n, C) what ``model.from_storage`` takes, float32 or, where that loses something, float64.
    rgb : (n, 3) lattice RGB: what the stored spectrum evaluates to, linear.
    distance : (n,) fitting distance, max |target − lattice RGB|.
    status : (n,) `Status`.
    entry : (n,) row of ``atlas`` that the point is based on, −1 for none.
    round : (n,) round that fitted the point, −1 for none; None without debug information.
    standard_error : (n,) root mean square by which answers are expected to miss measurements, ΔE00 under the
        light ``reference``; None where no atlas tells.
    threshold : the largest fitting distance that counts as fitted.
    provenance : how the cube was made: version, options, atlas names and digests; JSON values.
    """

    model: Model
    lattice: Lattice
    sensor: Sensor
    threshold: float
    atlas: AtlasTable
    coefficients: NDArray[Any]
    rgb: NDArray[np.float32]
    distance: NDArray[np.float32]
    status: NDArray[np.uint8]
    entry: NDArray[np.int32]
    round: NDArray[np.int16] | None
    standard_error: NDArray[np.float32] | None
    reference: str
    provenance: Mapping[str, Any]

    @cached_property
    def pins(self) -> EntryBoxes:
        """The entries as extra nodes of the lattice."""
        return EntryBoxes(self.lattice, self.atlas.rgb, self.atlas.reach)

    @cached_property
    def present(self) -> Mask:
        """(n,) which points have a spectrum: all, or those that the colours of a scene need."""
        return self.status != Status.ABSENT

    @cached_property
    def complete(self) -> Mask | None:
        """(n,) which cells have all their corners, by the number of the lowest; None if no point is absent."""
        return None if self.present.all() else self.lattice.cells_of(self.present)

    def counts(self) -> dict[str, int]:
        """Points of each status, in the order of `Status`."""
        found = np.bincount(self.status, minlength=len(Status))
        return {status.label: int(found[status]) for status in Status}
