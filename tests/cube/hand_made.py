"""A cube of known numbers, without a fit."""

from dataclasses import replace

import numpy as np

from tests.helpers import with_points
from uplift.colorimetry.observer import sensor
from uplift.common.arrays import Array
from uplift.cube.data import AtlasTable, CubeData, EntrySpectra
from uplift.cube.schema import POINTS
from uplift.lattice.lattice import Lattice, axis_nodes
from uplift.lattice.point_table import PointTable, Status
from uplift.models.model import Model
from uplift.models.moments import Moments


def table(
    names: tuple[str, ...],
    rgb: Array,
    model: Model,
    coefficients: Array,
    half_width: Array,
) -> AtlasTable:
    """Entries with as many coefficients as the nodes."""
    error = np.full(len(names), 0.1)
    return AtlasTable(
        names, rgb, coefficients, half_width, error, EntrySpectra(model, coefficients)
    )


def hand_made(dim: int = 4, **changes: object) -> CubeData:
    """A cube of ``dim``³ nodes with random coefficients; node 0 is 0.25 off, over the
    threshold.
    """
    lattice = Lattice(axis_nodes("srgb", dim))
    rng = np.random.default_rng(7)
    points = np.arange(lattice.size)
    rgb = (lattice.points + rng.uniform(-1e-4, 1e-4, lattice.points.shape)).astype(
        np.float32
    )
    rgb[0] = 0.25
    data = CubeData(
        model=Moments(3),
        lattice=lattice,
        sensor=sensor(),
        threshold=1e-4,
        atlas=table(
            ("grey", "über"),
            np.full((2, 3), 0.5),
            Moments(3),
            np.full((2, 3), 0.25),
            np.array([0.5, 0.0]),
        ),
        points=PointTable(
            coefficients=rng.normal(size=(lattice.size, 3)),
            rgb=rgb,
            distance=np.abs(rgb - lattice.points).max(axis=1).astype(np.float32),
            status=(points % Status.ABSENT).astype(np.uint8),
            entry=(points % 3 - 1).astype(np.int32),
            round=(points % 5 - 1).astype(np.int16),
            standard_error=rng.uniform(0.1, 2, lattice.size).astype(np.float32),
        ),
        error_illuminant="A",
        provenance={},
    )
    arrays = {name: changes.pop(name) for name in POINTS if name in changes}
    return replace(with_points(data, **arrays), **changes)
