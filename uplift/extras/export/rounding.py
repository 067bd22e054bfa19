"""Bounds of the change of reflectances by the single precision of programs."""

import numpy as np

from uplift.common.arrays import Array
from uplift.cube.data import CubeData
from uplift.extras.export.program_table import moved_cells
from uplift.lookup.interpolate import around, fading_share
from uplift.models.model import Model, reflectance
from uplift.models.moments import Moments

SPECTRA = 1 << 13
"""Spectra by which the change by single precision is bounded."""
SAMPLES = 1 << 9
"""Random colours of each of two kinds of mixtures."""
SEED = 0
SPACING = 2.0
"""Step in nm of the wavelengths of spectra."""
WAVELENGTH_ERROR = 5e-5
"""Error of wavelengths in single precision, in nm."""
OPERATIONS = 4
"""Factor from a product of matrices to all operations."""
LEAST_ERROR = 3e-6
"""Error of the arctangent and of sums."""


def rounding_error(data: CubeData, mode: str) -> float:
    """Return a bound of the change of reflectances by single precision, of colours in
    cells whose answers stay.

    In cells next to unrealisable nodes answers are moved. They may be steps, which
    single precision cannot place.
    """
    first, last, _ = data.sensor.range
    wavelengths = np.arange(first, last + 1, SPACING)
    cells = data.lattice.complete_cells(data.points.present)
    staying = data.lattice.corner_points(cells & ~moved_cells(data, mode))
    nodes = data.smoothed_multipliers(np.flatnonzero(staying))
    entries = data.atlas.spectra
    arithmetic = max(
        _arithmetic_error(data.model, nodes, wavelengths),
        _arithmetic_error(entries.model, entries.multipliers, wavelengths),
    )
    mixing = _mixing_error(data, wavelengths) if mode == "moments" else 0.0
    return LEAST_ERROR + OPERATIONS * (arithmetic + mixing)


def _mixing_error(data: CubeData, wavelengths: Array) -> float:
    """Return the largest change of spectra of mixtures of coefficients, whose sums and
    weights are rounded.

    The colours are random ones, many of them dark, and some level with nodes, where
    weights are 0.

    Moments are rounded as numbers near 1 are: that much is lost in their conversion.
    """
    random = np.random.default_rng(SEED)
    rgb = random.random((SAMPLES, 3)) ** random.uniform(1, 4, (SAMPLES, 1))
    level = np.where(
        random.random(rgb.shape) < 0.5,
        random.choice(data.lattice.nodes, rgb.shape),
        rgb,
    )
    rgb = np.concatenate([rgb, level])
    points = around(data, rgb[fading_share(data, rgb) == 0])
    corners = data.points.coefficients[points.points].astype(float)
    mixed = (points.weights[:, :, None] * corners).sum(axis=1)
    least = 1.0 if isinstance(data.model, Moments) else 0.0
    unit = np.maximum(np.abs(corners).max(axis=1), least) / 2**24
    changed = mixed + unit * random.choice([-1, 1], mixed.shape)
    change = reflectance(data.model, changed, wavelengths) - reflectance(
        data.model, mixed, wavelengths
    )
    return float(np.abs(change).max(initial=0))


def _arithmetic_error(model: Model, multipliers: Array, wavelengths: Array) -> float:
    """Return the largest change of spectra in single precision, of those with the
    largest multipliers (n, C).
    """
    steepest = np.argsort(-np.abs(multipliers).sum(axis=1))[:SPECTRA]
    exact = multipliers[steepest]
    basis = model.basis(wavelengths).T
    x = exact @ basis
    single = exact.astype(np.float32) @ basis.astype(np.float32)
    shifted = exact @ model.basis(wavelengths + WAVELENGTH_ERROR).T
    error = np.abs(single - x) + np.abs(shifted - x)
    # Spectra change most where x is 0, which may be between two wavelengths.
    crosses = x[:, 1:] * x[:, :-1] < 0
    smallest = np.where(crosses, 0, np.minimum(np.abs(x[:, 1:]), np.abs(x[:, :-1])))
    change = np.maximum(error[:, 1:], error[:, :-1]) * model.derivative(smallest)
    return float(change.max(initial=0))
