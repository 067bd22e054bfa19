"""What a cube file holds: everything that a lookup needs, and how the cube was made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.lattice import Lattice, Status
from uplift.models import Model
from uplift.sensor import Array, Sensor


@dataclass(frozen=True, eq=False)
class AtlasTable:
    """The entries that the cube is constrained by: names (E), linear RGB (E, 3), coefficients (E, C)."""

    names: tuple[str, ...]
    rgb: Array
    coefficients: Array


@dataclass(frozen=True, eq=False)
class CubeData:
    """A lattice of spectra. Per point (n = dim³, blue fastest):

    Parameters
    ----------
    coefficients : (n, C) what ``model.from_storage`` takes.
    rgb : (n, 3) lattice RGB: what the stored spectrum evaluates to, linear.
    distance : (n,) fitting distance, max |target − lattice RGB|.
    status : (n,) `Status`.
    entry : (n,) row of ``atlas`` that the point is based on, −1 for none.
    round : (n,) round that fitted the point, −1 for none; None without debug information.
    threshold : the largest fitting distance that counts as fitted.
    provenance : how the cube was made: version, options, atlas names and digests; JSON values.
    """

    model: Model
    lattice: Lattice
    sensor: Sensor
    threshold: float
    atlas: AtlasTable
    coefficients: Array
    rgb: NDArray[np.float32]
    distance: NDArray[np.float32]
    status: NDArray[np.uint8]
    entry: NDArray[np.int32]
    round: NDArray[np.int16] | None
    provenance: Mapping[str, Any]

    def counts(self) -> dict[str, int]:
        """Points of each status, in the order of `Status`."""
        found = np.bincount(self.status, minlength=len(Status))
        return {status.label: int(found[status]) for status in Status}
