"""Failures of a build, smoothness, round trips, calibration of errors."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.likely_errors import COVERAGE
from uplift.common.arrays import Array
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


def compute_smoothness(data: CubeData) -> tuple[NDArray[np.float32], Array]:
    """rms differences (k,) over wavelength between neighbours, each pair once, and RGB
    (2, 3) of the largest's pair.

    The lattice is processed by planes of equal red: spectra of two planes are in memory
    at a time.
    """
    dim = data.lattice.dim
    wavelengths = data.sensor.wavelengths
    parts = []
    # of a plane; NaN for absent nodes
    none = spectra = np.full((dim, dim, len(wavelengths)), np.nan)
    for first in range(0, dim**3, dim**2):
        before = spectra
        spectra = none
        nodes = first + np.arange(dim**2).reshape(dim, dim)
        present = data.points.present[nodes]
        if not present.any():
            continue
        spectra = none.copy()
        spectra[present] = reflectance(
            data.model, data.points.coefficients[nodes[present]], wavelengths
        )
        for low, second, high, step in (
            (spectra[:, :-1], spectra[:, 1:], nodes[:, 1:], 1),  # along blue
            (spectra[:-1], spectra[1:], nodes[1:], dim),  # along green
            (before, spectra, nodes, dim**2),  # along red
        ):
            rms = np.sqrt(((second - low) ** 2).mean(axis=-1))
            known = ~np.isnan(rms)
            parts.append((rms[known], high[known], high[known] - step))
    rms, high, low = map(np.concatenate, zip(*parts, strict=True))
    steepest = np.stack([low, high])[:, rms.argmax()]
    return rms.astype(np.float32), data.lattice.target(steepest)


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
    cells.
    """
    random = np.random.default_rng(SEED)
    rgb = random.random((COLOURS, 3))
    if data.complete_cells is None:
        return rgb
    low = data.lattice.position(
        random.choice(np.flatnonzero(data.complete_cells), COLOURS)
    )
    return data.lattice.nodes[low] + rgb * (
        data.lattice.nodes[low + 1] - data.lattice.nodes[low]
    )


# largest factor, in both directions, between actual and predicted errors that counts as
# agreement
TOLERANCE = 1.25


@dataclass(frozen=True)
class Calibration:
    """Actual errors of entries against predicted ones, ΔE00 under the cube's error
    illuminant.
    """

    count: int  # Number of entries
    # Mean that they should have had, so that 68 % of the entries were within
    actual: float
    predicted: float  # Mean of the standard errors
    # Fraction of the entries whose error is at most its standard error
    within_error: float
    within_bound: float  # The same of its error bound

    @property
    def verdict(self) -> int:
        """Return 0 if both agree, 1 if the actual errors are larger, −1 if they are
        smaller.
        """
        if self.actual > TOLERANCE * self.predicted:
            return 1
        return -1 if self.predicted > TOLERANCE * self.actual else 0

    def to_json(self) -> dict[str, float]:
        """Return the numbers by their names in JSON output."""
        return {
            "count": self.count,
            "real": self.actual,
            "stated": self.predicted,
            "within_error": self.within_error,
            "within_bound": self.within_bound,
        }


def check_calibration(
    actual: Array, predicted: Array | None, bound: Array | None
) -> Calibration | None:
    """Compare actual errors (n,) with standard errors and error bounds (n,); None if
    the cube has none.
    """
    if predicted is None or bound is None:
        return None
    mean = float(predicted.mean())
    ratio = actual / np.maximum(predicted, np.finfo(float).tiny)
    return Calibration(
        count=len(actual),
        actual=mean * float(np.quantile(ratio, COVERAGE[0][0])),
        predicted=mean,
        within_error=float((actual <= predicted).mean()),
        within_bound=float((actual <= bound).mean()),
    )
