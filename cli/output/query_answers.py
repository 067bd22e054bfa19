"""Answers of ``uplift query``, block by block."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from uplift.common.errors import UpliftWarning

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Light
    from uplift.common.arrays import Array
    from uplift.lookup import Bounds, Cube, QueryResult

DIVISIONS, SINGLE_DIVISIONS = 2, 3
"""Density of the directions of bounds: 162 of each of many colours, 642 of a single one."""


@dataclass
class Answers:
    """Answers to blocks of linear RGB (n, 3), and the numbers of colours that were mapped or filled."""

    cube: Cube
    method: str
    wavelengths: Array | None
    mode: str
    lights: Sequence[Light]
    fill_missing: bool
    count: int = 0
    mapped: int = 0
    filled: int = 0
    max_change: float = 0.0

    def results(self, blocks: Iterable[Array]) -> Iterator[list[QueryResult]]:
        """Answer block by block, each before the next one is read."""
        from uplift.colorimetry.gamut import map_to_gamut
        from uplift.lookup import query

        for block in blocks:
            mapped = map_to_gamut(block, self.cube.data.sensor, self.method)
            self.count += len(block)
            self.mapped += mapped.count
            self.max_change = max(self.max_change, mapped.max_change)
            if self.fill_missing:
                self.filled += int((~self.cube.covers(mapped.rgb)).sum())
                self.cube = self.cube.fill_missing(mapped.rgb)
            results = query(self.cube, mapped.rgb, self.wavelengths, self.mode, mapped.requested, self.lights)
            yield list(results)
            sys.stdout.flush()

    def result_of_xyz(self, xyz: tuple[float, float, float]) -> list[list[QueryResult]]:
        """Answer one colour by XYZ."""
        from uplift.lookup import query_xyz

        return [list(query_xyz(self.cube, [xyz], self.wavelengths, self.mode, self.lights))]

    def bounds(self, block: Sequence[QueryResult], *, single: bool) -> list[Bounds]:
        """Compute the bounds of a block under each light, from more directions for a single colour."""
        import numpy as np

        from uplift.lookup import bounds

        rgb = np.stack([result.rgb for result in block])
        divisions = SINGLE_DIVISIONS if single else DIVISIONS
        return [bounds(self.cube, rgb, light, self.mode, divisions) for light in self.lights]

    def warn(self) -> None:
        """Warn of colours that were mapped or filled."""
        if self.mapped:
            problem = (
                f"{self.mapped} of {self.count} colours lie outside [0, 1]: mapped into the gamut ({self.method}), "
                f"a component by up to {self.max_change:.3g}"
            )
            warnings.warn(UpliftWarning(problem, code="colours-mapped"), stacklevel=1)
        if self.filled:
            count = f"{self.filled} of {self.count} colours"
            problem = f"{count} are not in the cube's scene: filled from the packaged cube"
            warnings.warn(UpliftWarning(problem, code="colours-filled"), stacklevel=1)
