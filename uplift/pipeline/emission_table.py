"""The order of the build of an emission table: lamps → prior → nodes → table."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer as observers
from uplift.colorimetry.lamp_errors import relit_delta_e
from uplift.colorimetry.lights import STANDARD_ILLUMINANTS, Lamps
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.common.quoting import format_value
from uplift.common.threads import single_threaded_blas
from uplift.common.version import VERSION
from uplift.cube import EmissionData, LampEntries
from uplift.fit.chromaticity_lattice import locus_lattice
from uplift.fit.emission import mix_with_rim, nearest_lights
from uplift.fit.lamp_prior import covariance, fit_lamp_prior
from uplift.lattice.chromaticity import DENOMINATOR, ChromaticityLattice, chromaticity
from uplift.lookup import EmissionTable

MAX_RADIUS = 0.01
"""Largest radius in u′v′ of the disc around a lamp."""
FAR_SHARE = 1e-3
"""Weight of the mean error of all lamps, which far from them is the expected one."""
MAX_KNOTS, MAX_RINGS = 1024, 512


@single_threaded_blas()
def build_emission(
    *,
    knots: int = 96,
    rings: int = 24,
    space: str = "sRGB",
    observer: str = observers.DEFAULT_OBSERVER,
    progress: ProgressCallback = ignore_progress,
) -> EmissionTable:
    """Build a table of the spectra of lights.

    Lights scale, so the table is a lattice over chromaticity, the whole spectral locus.

    Parameters
    ----------
    knots : int, default 96
        Nodes around white, at least as many as the spectral locus has corners.
    rings : int, default 24
        Nodes from white to the locus.
    space : str, default "sRGB"
        RGB space of queries, by its name in colour-science.
    observer : str, default "CIE 1931 2 Degree Standard Observer"
        Colour-matching functions.
    progress : callable, optional
        Called with `Progress` events of the stage ``"fit"``.

    Returns
    -------
    EmissionTable
        The table, ready for queries; `EmissionTable.save` writes it.

    Raises
    ------
    OptionError
        An option outside its range.
    UnknownNameError
        An unknown space or observer.
    """
    _check_count("knots", knots, MAX_KNOTS)
    _check_count("rings", rings, MAX_RINGS)
    sensor = observers.sensor(space, "D65", observer)
    radiometry = sensor.cmfs / sensor.cmfs[:, 1].sum()
    matrix = observers.primaries(space).rgb_to_xyz
    lattice, rim = locus_lattice(
        radiometry, chromaticity(matrix @ np.ones(3)), int(knots), np.linspace(0, 1, int(rings))
    )
    lamps = observers.lamps(observer)
    prior, left_out = fit_lamp_prior(lamps.power, radiometry)
    uv = lattice.nodes[:, :-1].reshape(-1, 2)
    progress(Progress("fit", 0, len(uv)))
    power = mix_with_rim(nearest_lights(prior(uv), uv, radiometry), uv, lattice, rim, radiometry)
    progress(Progress("fit", len(uv), len(uv)))
    spectra = np.concatenate([power.reshape(len(rim), -1, power.shape[1]), rim[:, None]], axis=1)
    return EmissionTable(
        EmissionData(
            space=sensor.space,
            observer=sensor.observer,
            rgb_to_xyz=matrix,
            wavelengths=sensor.wavelengths,
            cmfs=sensor.cmfs,
            lattice=lattice,
            spectra=spectra.astype(np.float32),
            error=_expected_error(lamps, left_out, prior.uv, lattice, radiometry),
            entries=_entries(_standard(lamps), lattice, radiometry),
            provenance={"uplift": VERSION, "options": {"knots": int(knots), "rings": int(rings)}},
        )
    )


def _expected_error(
    lamps: Lamps, left_out: Array, uv: Array, lattice: ChromaticityLattice, radiometry: Array
) -> NDArray[np.float32]:
    """ΔE00 (K, R) of the ColorChecker lit by an answer: the errors of left-out lamps, averaged by distance."""
    surfaces = on_grid(read_atlas("macbeth"), observers.grid())
    errors = relit_delta_e(lamps.power, left_out, surfaces, radiometry).mean(axis=1)
    weights = covariance(lattice.nodes.reshape(-1, 2), uv)
    expected = (weights @ errors + FAR_SHARE * errors.mean()) / (weights.sum(axis=1) + FAR_SHARE)
    return np.asarray(expected.reshape(lattice.shape), dtype=np.float32)


def _standard(lamps: Lamps) -> Lamps:
    rows = [lamps.names.index(name) for name in STANDARD_ILLUMINANTS]
    return Lamps(STANDARD_ILLUMINANTS, lamps.power[rows])


def _entries(lamps: Lamps, lattice: ChromaticityLattice, radiometry: Array) -> LampEntries:
    """Give each lamp a disc that reaches half of the way to the next one, and does not leave the lattice."""
    power = lamps.power / (lamps.power @ radiometry @ DENOMINATOR)[:, None]
    uv = chromaticity(power @ radiometry)
    apart = np.linalg.norm(uv[:, None] - uv, axis=-1) + np.diag(np.full(len(uv), np.inf))
    radius = np.minimum(apart.min(axis=1, initial=np.inf) / 2, MAX_RADIUS)
    radius = np.minimum(radius, _distance_to_rim(uv, lattice))
    return LampEntries(lamps.names, uv, power, radius)


def _distance_to_rim(uv: Array, lattice: ChromaticityLattice) -> Array:
    edges = np.roll(lattice.knots, -1, axis=0) - lattice.knots
    offset = uv[:, None] - lattice.knots
    across = edges[:, 0] * offset[..., 1] - edges[:, 1] * offset[..., 0]
    return np.asarray((across / np.linalg.norm(edges, axis=1)).min(axis=1).clip(0.0))


def _check_count(name: str, value: Any, most: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or not 3 <= value <= most:
        raise OptionError(
            f"{name} must be a whole number from 3 to {most}, got {format_value(value)}",
            code="nodes-out-of-range",
        )
