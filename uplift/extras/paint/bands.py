"""A few bands of wavelengths that stand for whole spectra where paints mix.

In a band a paint has the mean reflectance R and the mean scattering S of its spectrum,
weighted by the sensitivity of RGB, and the absorption K that gives R. Bands mix as
wavelengths do, by Kubelka and Munk. Weights then turn their reflectances into linear
RGB. Edges and weights are chosen for mixtures of random pairs of colours, by their
errors relative to lightness.
"""

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Indices
from uplift.extras.colour.srgb import decode
from uplift.extras.paint.optics import as_shares
from uplift.extras.paint.pigments import DARKEST, Pigment, dispersive, from_opaque
from uplift.lookup.cube import Cube

BANDS = 8
"""One register of a processor with AVX2 holds the numbers of eight bands."""
PAIRS = 512
"""Random pairs of colours."""
PURE = 4
"""One pair of these is not mixed."""
SEED = 5
REALISED = 1e-3
"""Largest distance in linear RGB of a spectrum from its colour."""
MOVES = (-3, -2, -1, 1, 2, 3)
"""Changes of an edge that are tried, in eightieths of the range."""
DIM_LUMINANCE = 0.01
"""Luminance below which errors count alike."""


@dataclass(frozen=True, eq=False)
class Bands:
    """Bands of the wavelengths of a sensor.

    Parameters
    ----------
    means : ndarray of shape (BANDS, N)
        Weights of the wavelengths in each band; rows sum to 1.
    to_rgb : ndarray of shape (3, BANDS)
        From reflectances in bands to linear RGB; rows sum to 1.
    """

    means: Array
    to_rgb: Array


def opaque(reflectance: Array, scattering: Array) -> Pigment:
    """Return the paint of an opaque reflectance and a scattering, both (..., n)."""
    return from_opaque(reflectance, lambda _: scattering)


@dataclass(frozen=True, eq=False)
class Mixtures:
    """Mixtures of pairs of spectra, and their colours.

    ``reflectance``, ``scattering`` (m, 2, N) of the paints, ``shares`` (m, 2), ``rgb``
    (m, 3), linear, and the ``importance`` (m, 1) of errors in it.
    """

    reflectance: Array
    scattering: Array
    shares: Array
    rgb: Array
    importance: Array

    def in_bands(self, means: Array) -> Array:
        """Return the reflectances (m, BANDS) of the mixtures, mixed in bands."""
        reflectance = np.maximum(self.reflectance @ means.T, DARKEST)
        paints = opaque(reflectance, self.scattering @ means.T)
        return paints.mix(self.shares).opaque_reflectance()


def choose_bands(cube: Cube) -> Bands:
    """Choose the bands for the colours of a cube: edges move one by one while the error
    falls.
    """
    sensor = cube.data.sensor
    mixtures = random_mixtures(cube)
    unit = max(1, len(sensor.wavelengths) // 80)
    edges = _even_edges(sensor)
    best, error = _fit(sensor, edges, mixtures)
    improving = True
    while improving:
        improving = False
        for index in range(BANDS - 1):
            for move in MOVES:
                moved = edges.copy()
                moved[index] += unit * move
                if not _ascend(moved, len(sensor.wavelengths)):
                    continue
                bands, moved_error = _fit(sensor, moved, mixtures)
                if moved_error < error:
                    edges, best, error = moved, bands, moved_error
                    improving = True
    return best


def random_mixtures(cube: Cube) -> Mixtures:
    """Mix random pairs of colours of a cube by their spectra."""
    sensor = cube.data.sensor
    random = np.random.default_rng(SEED)
    colours = decode(random.random((PAIRS, 2, 3)))
    reflectance = cube.reflectance(colours)
    # Wide gamuts have colours that no reflectance has.
    missed = np.abs(sensor.rgb(reflectance) - colours).max(axis=(1, 2))
    reflectance = reflectance[missed < REALISED]
    paints = from_opaque(reflectance, dispersive(sensor))
    share = random.random(len(reflectance))
    share[::PURE] = 0
    shares = as_shares(np.stack([1 - share, share], axis=1))
    rgb = sensor.rgb(paints.mix(shares).opaque_reflectance())
    luminance = np.maximum(sensor.xyz(rgb)[:, 1:2], 0)
    importance = (luminance + DIM_LUMINANCE) ** (-2 / 3)  # the slope of L*
    return Mixtures(reflectance, paints.scattering, shares, rgb, importance)


def _ascend(edges: Indices, count: int) -> bool:
    """Whether no band between edges is empty."""
    bounds = np.concatenate([[0], edges, [count]])
    return bool((np.diff(bounds) > 0).all())


def _even_edges(sensor: Sensor) -> Indices:
    """Return edges (BANDS − 1,) between bands of equal sensitivity."""
    total = np.cumsum(_sensitivity(sensor))
    fractions = np.arange(1, BANDS) / BANDS
    return np.searchsorted(total / total[-1], fractions)


def _sensitivity(sensor: Sensor) -> Array:
    return np.abs(sensor.matrix).sum(axis=0)


def _fit(sensor: Sensor, edges: Indices, mixtures: Mixtures) -> tuple[Bands, float]:
    """Fit the weights of bands between edges; return the bands and the error."""
    numbers = np.searchsorted(edges, np.arange(len(sensor.wavelengths)), side="right")
    means = (numbers == np.arange(BANDS)[:, None]) * _sensitivity(sensor)
    means /= means.sum(axis=1, keepdims=True)
    reflectance = mixtures.in_bands(means)
    # Rows sum to 1: the last weight is 1 less the others.
    last = reflectance[:, -1:]
    weights, *_ = np.linalg.lstsq(
        (reflectance[:, :-1] - last) * mixtures.importance,
        (mixtures.rgb - last) * mixtures.importance,
    )
    to_rgb = np.vstack([weights, 1 - weights.sum(axis=0)]).T
    change = (reflectance @ to_rgb.T - mixtures.rgb) * mixtures.importance
    return Bands(means, to_rgb), float(np.square(change).mean())
