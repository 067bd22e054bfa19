"""The part of a build that depends on a scene: which lattice points its colours require."""

from __future__ import annotations

from typing import Any, Protocol

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Mask
from uplift.common.progress import ProgressCallback
from uplift.lattice.entry_boxes import EntryBoxes


class SceneLike(Protocol):
    """Colours that restrict a build to the lattice points that they require."""

    def required_points(self, boxes: EntryBoxes, sensor: Sensor, progress: ProgressCallback) -> Mask:
        """Return the required lattice points.

        Parameters
        ----------
        boxes : EntryBoxes
            Entry boxes, and the lattice that they lie in.
        sensor : Sensor
            RGB space of the cube.
        progress : callable
            Called with `Progress` events of stage ``"images"``.

        Returns
        -------
        ndarray of bool, shape (dim³,)
            Mask of points.
        """
        ...

    def describe(self) -> list[dict[str, Any]]:
        """Describe the sources of the colours for the provenance of the cube.

        Returns
        -------
        list of dict
            JSON values, one dictionary per source.
        """
        ...
