"""Failures of a build, smoothness, round trips, calibration of errors."""

from itertools import permutations
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.likely_errors import COVERAGE
from uplift.common.arrays import Array, Values
from uplift.cube.data import CubeData
from uplift.lattice.point_table import Status
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import MODES
from uplift.models.model import reflectance

MAX_LISTED = 24  # nodes over the threshold that a report lists


def collect_failures(data: CubeData) -> dict[str, Any]:
    """Failures that a cube records, as the report's JSON has them: the worst nodes over
    the threshold first.

    Entries are ``left_out`` by earlier versions only, and ``skipped`` where the atlas
    reader could not use them. ``smoothed`` ones keep a share of their spectra.
    ``softened`` counts the nodes that were moved towards their neighbours.
    """
    points = data.points
    recorded = data.provenance
    failed = np.isin(points.status, (Status.UNFITTED, Status.UNREALISABLE))
    rows = np.flatnonzero(failed | ~(points.distance <= data.threshold))
    worst = rows[np.argsort(-points.distance[rows], kind="stable")][:MAX_LISTED]
    listed = [
        {
            "rgb": data.lattice.points[row],
            "lattice_rgb": points.rgb[row],
            "distance": points.distance[row],
        }
        for row in worst
    ]
    left_out = recorded.get("left_out", ()) if data.atlas.outside is None else ()
    return {
        "over_threshold": len(rows),
        "worst": listed,
        "improvements": tuple(recorded.get("improvements", ())),
        "left_out": tuple(left_out),
        "skipped": tuple(recorded.get("skipped", ())),
        "smoothed": tuple(recorded.get("smoothed", ())),
        "softened": recorded.get("softened", 0),
    }


def compute_smoothness(data: CubeData) -> tuple[Values, Array]:
    """rms differences (k,) over wavelength between neighbours, each pair once, and RGB
    (2, 3) of the largest's pair.

    The lattice is processed by planes of equal red: spectra of two planes are in memory
    at a time.
    """
    dim = data.lattice.dim
    wavelengths = data.sensor.wavelengths
    parts = []
    largest = -1.0
    steepest = np.zeros(2, dtype=np.int64)
    absent = before = np.full((dim, dim, len(wavelengths)), np.nan)
    for first in range(0, dim**3, dim**2):
        nodes = first + np.arange(dim**2).reshape(dim, dim)
        present = data.points.present[nodes]
        if not present.any():
            before = absent
            continue
        spectra = absent.copy()
        coefficients = data.points.coefficients[nodes[present]]
        spectra[present] = reflectance(data.model, coefficients, wavelengths)
        # Steps to each node from the one before it along blue, green and red; NaN where
        # one of the two is absent
        steps = np.full((3, dim, dim), np.nan)
        steps[0, :, 1:] = _rms(np.diff(spectra, axis=1))
        steps[1, 1:] = _rms(np.diff(spectra, axis=0))
        steps[2] = _rms(spectra - before)
        before = spectra
        known = steps[~np.isnan(steps)]
        parts.append(known)
        if known.max(initial=-1.0) > largest:
            largest = known.max()
            along, row, column = np.argwhere(steps == largest)[0]
            high = nodes[row, column]
            steepest = np.array([high - dim**along, high])
    return np.concatenate(parts).astype(np.float32), data.lattice.target(steepest)


def _rms(differences: Array) -> Array:
    return np.sqrt((differences**2).mean(axis=-1))


COLOURS = 4096
SEED = 20200617  # all reports use the same random colours, so that they can be compared


def round_trip_errors(cube: Cube) -> dict[str, Array]:
    """Compute ΔE00 (n,) between random colours and those of their spectra, by mode of
    lookup.
    """
    rgb = _random_rgb(cube.data)
    sensor = cube.data.sensor
    rgb = rgb[cube.covers(rgb)]
    return {
        mode: delta_e_rgb(sensor, rgb, sensor.rgb(cube.reflectance(rgb, mode=mode)))
        for mode in MODES
    }


def _random_rgb(data: CubeData) -> Array:
    """Linear RGB (n, 3), uniform in the cube or, if it is sparse, in its complete
    tetrahedra.
    """
    random = np.random.default_rng(SEED)
    if not data.is_sparse:
        return random.random((COLOURS, 3))
    lattice = data.lattice
    low = lattice.position(np.flatnonzero(data.points.present))
    low = low[(low < lattice.dim - 1).all(axis=1)]
    orders = [np.argsort(order) for order in permutations(range(3))]
    steps = np.array(orders)[:, None] < np.arange(4)[:, None]
    corners = lattice.index(low[:, None, None] + steps).reshape(-1, 4)
    complete = corners[data.points.holds(corners)]
    chosen = lattice.target(random.choice(complete, COLOURS))
    weights = random.dirichlet(np.ones(4), COLOURS)
    rgb: Array = (weights[:, :, None] * chosen).sum(axis=1)
    return rgb


def check_calibration(actual: Array, stated: Array) -> dict[str, float]:
    """Compare actual errors (n,) with standard errors and error bounds (n, 2).

    ``stated`` is the mean standard error, ``real`` the mean with which 68 % of the
    errors would be within. The others are fractions of the errors.
    """
    predicted, bound = stated.T
    mean = float(predicted.mean())
    ratio = actual / np.maximum(predicted, np.finfo(float).tiny)
    return {
        "count": len(actual),
        "real": mean * float(np.quantile(ratio, COVERAGE[0][0])),
        "stated": mean,
        "within_error": float((actual <= predicted).mean()),
        "within_bound": float((actual <= bound).mean()),
    }
