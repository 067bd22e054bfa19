"""Composite models: a smooth part in few coefficients, and spikes.

Sun, Drew & Fracchia 1999, "Representing spectral functions by a composite model of
smooth and spiky components for efficient full-spectrum photorealism". Deville, Merzouk,
Cazier & Paul 1994, "Spectral data modeling for a lighting application". Kment 2011,
sections 4.3, 5.4 and 5.5.
"""

import functools
from typing import NamedTuple

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array, Indices
from uplift.common.errors import OptionError
from uplift.extras.papers.representations import samples
from uplift.extras.papers.representations.samples import Representation

NOISE = 1e-9
"""Heights below this fraction of the highest sample are rounding."""


class CompositeCode(NamedTuple):
    """Code of the smooth part, and heights (n, P) of spikes, or 0, at ``positions``
    (P,) of the 5 nm table.
    """

    smooth: Array
    positions: Indices
    heights: Array

    def at(self, positions: Indices) -> Array:
        """Heights (n, Q) at ``positions`` (Q,), a superset of those of the spikes."""
        heights = np.zeros((len(self.heights), len(positions)))
        heights[:, np.searchsorted(positions, self.positions)] = self.heights
        return heights


def split_spikes(spectra: Array, threshold: float) -> CompositeCode:
    """Split dense spectra (n, 401) into a smooth part (n, 401), linear between 5 nm,
    and spikes.

    Choices that the text leaves open: the gradient is that between two samples of the 5
    nm table, relative to the highest sample of the spectrum. The smooth part is the
    largest spectrum below the given one that is nowhere steeper than the threshold. The
    spikes are the difference.
    """
    table = spectra[:, :: samples.TABLE_STRIDE]
    highest = table.max(axis=1)
    step = threshold * highest
    smooth = table.copy()
    # Limit the gradient by one sweep in each direction.
    for index in range(1, smooth.shape[1]):
        smooth[:, index] = np.minimum(smooth[:, index], smooth[:, index - 1] + step)
    for index in reversed(range(smooth.shape[1] - 1)):
        smooth[:, index] = np.minimum(smooth[:, index], smooth[:, index + 1] + step)
    heights = table - smooth
    heights[heights < NOISE * highest[:, None]] = 0
    positions = np.flatnonzero(heights.any(axis=0))
    return CompositeCode(
        (table - heights) @ samples.hat_functions(observer.grid()),
        positions,
        heights[:, positions],
    )


@functools.cache
def spike_xyz() -> Array:
    """XYZ (81, 3) of a spike of height 1 at each position: a triangle as wide as linear
    interpolation makes it.
    """
    return samples.hat_functions(observer.grid()) @ samples.xyz_weights()


def composite(
    name: str, family: str, smooth: Representation, decoder: Array, threshold: float
) -> Representation:
    """Smooth part in another representation, and spikes steeper than a threshold.

    ``code @ decoder`` (C, 81) is the smooth part at 5 nm. ``threshold`` is the largest
    relative gradient of the smooth part between samples of the 5 nm table. In a
    product, a spike meets the spike and the smooth part of the other spectrum at its
    position.
    """

    def encode(power: Array) -> CompositeCode:
        split = split_spikes(power, threshold)
        return split._replace(smooth=smooth.encode_light(split.smooth))

    def multiply(light: CompositeCode, surface: CompositeCode) -> CompositeCode:
        positions = np.union1d(light.positions, surface.positions)
        of_light = light.at(positions)
        of_surface = surface.at(positions)
        below_light, below_surface = (
            code.smooth @ decoder[:, positions] for code in (light, surface)
        )
        heights = of_light * (below_surface + of_surface) + below_light * of_surface
        return CompositeCode(
            smooth.multiply(light.smooth, surface.smooth), positions, heights
        )

    def storage(code: CompositeCode) -> Array:
        # A spike is a position and a height.
        return smooth.storage(code.smooth) + 2 * (code.heights != 0).sum(
            axis=1, dtype=float
        )

    def xyz(light: CompositeCode) -> Array:
        return smooth.xyz(light.smooth) + light.heights @ spike_xyz()[light.positions]

    return Representation(name, family, encode, encode, xyz, multiply, storage)


def fourier_coefficients(count: int) -> Representation:
    """Coefficients a_0 to a_m and b_1 to b_m of a real Fourier basis: the smooth part
    of Sun's composite model.

    The period is 380–780 nm, so a spectrum whose ends differ has a jump there. Choices
    that the text leaves open: the coefficients are those of eq. 4.7 over the 5 nm
    table, with the mean of both ends where they meet. A product, computed point by
    point as in the text, keeps as many coefficients as its factors have: it has twice
    the highest frequency, and at 2C points in the period none of it is aliased to a
    lower one (the "Shannon theorem" of the text). Raises `OptionError` unless the
    number is odd and positive.
    """
    if count < 1 or count % 2 == 0:
        hint = "a mean and pairs of cosine and sine are an odd number"
        raise OptionError(
            f"number of Fourier coefficients must be odd and positive, got {count}",
            hint=hint,
        )
    dense = waves(count)
    product = _waves(np.pi * np.arange(2 * count) / count, count)

    def encode(power: Array) -> Array:
        periodic = power[:, : -1 : samples.TABLE_STRIDE].copy()
        periodic[:, 0] = (power[:, 0] + power[:, -1]) / 2
        return _analyse(periodic, dense[:, : -1 : samples.TABLE_STRIDE])

    return Representation(
        f"F{count}",
        "Fourier coefficients",
        encode,
        encode,
        lambda light: light @ (dense @ samples.xyz_weights()),
        lambda light, surface: _analyse(
            (light @ product) * (surface @ product), product
        ),
    )


def waves(count: int) -> Array:
    """Fourier basis (count, 401) at the dense wavelengths."""
    period = observer.END - observer.START
    phase = 2 * np.pi * (samples.wavelengths() - observer.START) / period
    return _waves(phase, count)


def _waves(phase: Array, count: int) -> Array:
    """Basis (count, K) of 1, cos φ, sin φ, cos 2φ, sin 2φ, … at phases (K,)."""
    orders = np.arange(1, count // 2 + 1)[:, None]
    pairs = np.stack([np.cos(orders * phase), np.sin(orders * phase)], axis=1)
    return np.concatenate([np.ones((1, len(phase))), pairs.reshape(-1, len(phase))])


def _analyse(values: Array, waves: Array) -> Array:
    """Coefficients (n, C) of values (n, K) at K evenly spaced points of a period, for
    waves (C, K).
    """
    return values @ waves.T / (waves**2).sum(axis=1)


SUN_THRESHOLD = 0.3
"""Relative gradient of spikes of `sun_composite`, from Kment 2011, section 6.1."""
ENHANCED_THRESHOLD = 0.2
"""Likewise of `enhanced_riemann`."""


def sun_composite(count: int, threshold: float = SUN_THRESHOLD) -> Representation:
    """Sun's composite model (CS): spikes, and ``count`` Fourier coefficients of the
    smooth part.
    """
    smooth = fourier_coefficients(count)
    decoder = waves(count)[:, :: samples.TABLE_STRIDE]
    return composite(f"CS{count}", "Sun's composite", smooth, decoder, threshold)


def enhanced_riemann(
    count: int, threshold: float = ENHANCED_THRESHOLD
) -> Representation:
    """Enhanced Riemann sums (RE): spikes, which meet the mean of their cell, and
    Riemann sums of the smooth part.
    """
    decoder = samples.cell_overlaps(count)[:, :: samples.TABLE_STRIDE]
    smooth = samples.riemann_sums(count)
    name = f"RE{count}"
    return composite(name, "enhanced Riemann sums", smooth, decoder, threshold)
