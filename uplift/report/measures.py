"""Facts about a cube or an emission table, failures of a build, smoothness, round trips, calibration of errors."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.expected_error import COVERAGE
from uplift.common.arrays import Array, Indices
from uplift.cube import CubeData, digest
from uplift.lattice import Status
from uplift.lights.table import KIND, EmissionData, emission_digest
from uplift.lookup import MODES, Cube
from uplift.models import reflectance

MAX_LISTED = 24  # points over the threshold that a report lists


@dataclass(frozen=True, eq=False)
class Failures:
    """Failures that a cube records."""

    counts: dict[str, int]  # Lattice points by status
    over_threshold: int  # Number of lattice points over the threshold
    worst_points: Indices  # (k,) Indices of the worst of these, worst first
    improvements: tuple[dict[str, Any], ...]  # Steps of the improvement pass
    left_out: tuple[str, ...]  # Entries outside the RGB space that a cube of an earlier version does not have
    skipped: tuple[str, ...]  # Entries that the atlas reader could not use


def collect_failures(data: CubeData) -> Failures:
    """Collect the failures that a cube records."""
    points, recorded = data.points, data.provenance
    failed = np.isin(points.status, (Status.UNFITTED, Status.UNREALISABLE))
    rows = np.flatnonzero(failed | ~(points.distance <= data.threshold))
    return Failures(
        counts=points.counts(),
        over_threshold=len(rows),
        worst_points=rows[np.argsort(-points.distance[rows], kind="stable")][:MAX_LISTED],
        improvements=tuple(recorded.get("improvements", ())),
        left_out=tuple(recorded.get("left_out", ())) if data.atlas.outside is None else (),
        skipped=tuple(recorded.get("skipped", ())),
    )


NO_PAIR = -1.0  # placeholder for a difference to an absent point


@dataclass(frozen=True, eq=False)
class Smoothness:
    """rms differences over wavelength between the spectra of neighbours along an axis."""

    differences: NDArray[np.float32]  # (k,) Difference of every pair of neighbours, in units of reflectance
    steepest: Array  # (2, 3) Linear RGB of the pair that differs most


def compute_smoothness(data: CubeData) -> Smoothness:
    """Compare the spectra of all neighbours, each pair once.

    The lattice is processed by planes of equal red: spectra of two planes are in memory at a time.
    """
    parts: list[NDArray[np.float32]] = []
    largest = NO_PAIR
    pair: tuple[tuple[int, ...], ...] = ()
    previous: Array | None = None
    for red in range(data.lattice.dim):
        plane = _plane(data, red)
        for axis, (first, second) in enumerate(_neighbours(previous, plane)):
            rms = np.nan_to_num(np.sqrt(((second - first) ** 2).mean(axis=-1)), nan=NO_PAIR)
            parts.append(rms[rms != NO_PAIR].astype(np.float32))
            if rms.max() > largest:
                largest = float(rms.max())
                pair = _positions(axis, red, np.unravel_index(int(rms.argmax()), rms.shape))
        previous = plane
    return Smoothness(np.concatenate(parts), data.lattice.nodes[np.array(pair)])


def _plane(data: CubeData, red: int) -> Array:
    """Spectra (dim, dim, N) of the points of one red, green first; NaN if absent."""
    dim, wavelengths = data.lattice.dim, data.sensor.wavelengths
    rows = slice(red * dim**2, (red + 1) * dim**2)
    present = data.points.present[rows]
    plane = np.full((dim**2, len(wavelengths)), np.nan)
    plane[present] = reflectance(data.model, data.points.coefficients[rows][present], wavelengths)
    return plane.reshape(dim, dim, -1)


def _neighbours(previous: Array | None, plane: Array) -> list[tuple[Array, Array]]:
    """Pairs along blue and green within a plane, and along red to the previous plane."""
    within = [(plane[:, :-1], plane[:, 1:]), (plane[:-1], plane[1:])]
    return within if previous is None else [*within, (previous, plane)]


def _positions(axis: int, red: int, index: tuple[np.intp, ...]) -> tuple[tuple[int, ...], ...]:
    """Positions (red, green, blue) of two neighbours; ``axis`` 0 is blue, 1 green, 2 red."""
    green, blue = (int(part) for part in index)
    first = [red, green, blue]
    second = list(first)
    if axis == 2:
        first[0] -= 1
    else:
        second[2 - axis] += 1
    return tuple(first), tuple(second)


COLOURS = 4096
SEED = 20200617  # all reports use the same random colours, so that they can be compared


def round_trip_errors(cube: Cube) -> dict[str, Array]:
    """Compute ΔE00 (n,) between random colours and those of their spectra, by mode of lookup."""
    rgb, sensor = _random_rgb(cube.data), cube.data.sensor
    rgb = rgb[cube.covers(rgb)]
    return {mode: delta_e_rgb(sensor, rgb, sensor.rgb(cube.reflectance(rgb, mode=mode))) for mode in MODES}


def _random_rgb(data: CubeData) -> Array:
    """Linear RGB (n, 3), uniform in the cube or, if it is sparse, in its complete cells."""
    random = np.random.default_rng(SEED)
    rgb = random.random((COLOURS, 3))
    if data.complete_cells is None:
        return rgb
    low = data.lattice.position(random.choice(np.flatnonzero(data.complete_cells), COLOURS))
    return data.lattice.nodes[low] + rgb * (data.lattice.nodes[low + 1] - data.lattice.nodes[low])


TOLERANCE = 1.25  # largest factor, in both directions, between actual and predicted errors that counts as agreement


@dataclass(frozen=True)
class Calibration:
    """Actual errors of entries against predicted ones, ΔE00 under the cube's error illuminant."""

    count: int  # Number of entries
    actual: float  # Mean that they should have had, so that 68 % of the entries were within
    predicted: float  # Mean of the standard errors
    # Shares in [0, 1] of the entries whose error is at most its standard error, and its error bound
    within_error: float
    # Shares in [0, 1] of the entries whose error is at most its standard error, and its error bound
    within_bound: float

    @property
    def verdict(self) -> int:
        """Return 0 if both agree, 1 if the actual errors are larger, −1 if they are smaller."""
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


def check_calibration(actual: Array, predicted: Array | None, bound: Array | None) -> Calibration | None:
    """Compare actual errors (n,) with standard errors and error bounds (n,); None if the cube has none."""
    if predicted is None or bound is None:
        return None
    mean, ratio = float(predicted.mean()), actual / np.maximum(predicted, np.finfo(float).tiny)
    return Calibration(
        count=len(actual),
        actual=mean * float(np.quantile(ratio, COVERAGE[0][0])),
        predicted=mean,
        within_error=float((actual <= predicted).mean()),
        within_bound=float((actual <= bound).mean()),
    )


def summarise(data: CubeData) -> dict[str, Any]:
    """Summarise a cube, most general facts first."""
    points = data.points
    present, errors = points.present, points.standard_error
    return {
        "model": data.model.describe(),
        "coefficients": data.model.count,
        "entry_coefficients": data.entry_spectra.model.count,
        "dim": data.lattice.dim,
        "points": int(np.count_nonzero(present)),
        "lattice_points": data.lattice.size,
        "space": data.sensor.space,
        "illuminant": data.sensor.illuminant,
        "observer": data.sensor.observer,
        "threshold": data.threshold,
        "worst_distance": float(points.distance.max()),
        "mean_distance": float(points.distance[present].mean(dtype=np.float64)),
        "reference": data.error_illuminant,
        "mean_standard_error": None if errors is None else float(errors[present].mean(dtype=np.float64)),
        "status": points.counts(),
        "entries": list(data.atlas.names),
        "outside": [] if data.atlas.outside is None else list(data.atlas.outside.names),
        "debug": points.round is not None,
        "rounds": None if points.round is None else int(points.round.max()) + 1,
        "provenance": dict(data.provenance),
        "digest": digest(data),
    }


def summarise_emission(data: EmissionData) -> dict[str, Any]:
    """Summarise an emission table, most general facts first."""
    knots, rings = data.lattice.shape
    first, second = data.wavelengths[:2].tolist()
    return {
        "format": KIND.format,
        "knots": knots,
        "rings": rings,
        "nodes": knots * rings,
        "space": data.space,
        "observer": data.observer,
        "wavelengths": {"first": first, "last": float(data.wavelengths[-1]), "step": second - first},
        "mean_expected_error": float(data.error.mean(dtype=np.float64)),
        "largest_expected_error": float(data.error.max()),
        "lamps": list(data.entries.names),
        "provenance": dict(data.provenance),
        "digest": emission_digest(data),
    }
