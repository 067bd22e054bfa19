"""How photographs fit each other: their exposures, noise and alignment, from samples of
their pixels.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import TextureError
from uplift.extras.photographs.answers import Photographs
from uplift.extras.photographs.photograph import Noise, Photograph, rounding_noise
from uplift.models.brightness import brightness

BLOCK = 8
"""Pixels along the sides of the blocks in which noise is estimated."""
LEVELS = 8
"""Ranges of brightness, of each of which the flattest blocks count."""
FLATTEST = 0.1
"""Share of the blocks of a range that are taken for flat."""
DARKEST = 0.02
"""Linear RGB below which pixels do not count for the exposure."""
GREY = 0.1
"""Difference of the components of greys, relative to the largest."""
LEAST_VARIANCE = 1e-12
"""Least variance of linear RGB that counts."""
MAX_SHIFT = 1.0
"""Pixels by which photographs may be shifted against each other."""
MIN_PEAK = 0.1
"""Least height of the peak of phase correlation, 1 for equal pictures, that counts."""
MIN_DETAIL = 1e-3
"""Least standard deviation of the brightness of a crop, relative to its mean."""


def estimate_exposure(
    photographs: Photographs, number: int, rgb: Array, others: Array, expected: Array
) -> tuple[float, float]:
    """Estimate how much brighter a further photograph is than the first lets expect,
    and the standard deviation that one material would give this factor.

    The photograph with this ``number`` has linear RGB (n, 3), NaN where unknown, where
    the first has ``rgb`` (n, 3), which let the spectra ``expected`` (n, N) expect.
    """
    matrix = photographs.further[number].matrix
    predicted = expected @ matrix.T
    bright = (predicted.min(axis=1) > DARKEST) & np.isfinite(others).all(axis=1)
    if not bright.any():
        return 1.0, 0.0
    total = predicted[bright].sum(axis=1)
    factor = float(np.median(others[bright].sum(axis=1) / total))
    # Materials of one colour differ in the sum by k √(1ᵀ A S Aᵀ 1).
    directions = photographs.metamers.components @ matrix.sum(axis=0)
    covariance = photographs.metamers.mean
    spread = np.sqrt(directions @ covariance @ directions)
    relative = brightness(rgb[bright])[:, 0] * spread / total
    return factor, float(np.median(relative))


def grey_balance(
    photograph: Photograph, rgb: Array, others: Array, expected: Array
) -> Array | None:
    """Compare greys of a further photograph with what the first lets expect: their
    ratios (3,), relative to green; None without greys.

    The first has linear RGB (n, 3), the further one ``others`` (n, 3), NaN where
    unknown, and the first lets spectra (n, N) expect.
    """
    spread = rgb.max(axis=1) - rgb.min(axis=1)
    is_grey = (spread < GREY * rgb.max(axis=1)) & (rgb.min(axis=1) > DARKEST)
    rows = is_grey & np.isfinite(others).all(axis=1)
    if not rows.any():
        return None
    predicted = expected[rows] @ photograph.matrix.T
    ratio = np.median(others[rows] / predicted, axis=0)
    return ratio / ratio[1]


def estimate_noise(bands: Sequence[Array], steps: int) -> Noise:
    """Estimate the noise of a photograph from its flat areas.

    Parameters
    ----------
    bands : sequence of ndarray, shape (height, width, 3)
        Some rows of linear RGB.
    steps : int
        Largest integer code of the file, whose rounding is noise; 0 for floats.

    Returns
    -------
    Noise
        Standard deviations.
    """
    rounding = rounding_noise(steps) if steps else Noise()
    blocks = [_block_noise(band).reshape(-1, 2) for band in bands]
    level, variance = np.concatenate([np.empty((0, 2)), *blocks]).T
    usable = np.isfinite(level) & np.isfinite(variance) & (level > 0) & (level < 0.9)
    level = level[usable]
    variance = variance[usable]
    if not len(level):
        return rounding
    edges = np.quantile(level, np.linspace(0, 1, LEVELS + 1))
    rows = []
    for low, high in pairwise(edges):
        members = np.flatnonzero((level >= low) & (level <= high))
        if not len(members):  # small pictures have fewer blocks than levels
            continue
        flat = members[variance[members] <= np.quantile(variance[members], FLATTEST)]
        rows.append((level[flat].mean(), variance[flat].mean()))
    noise = fit_noise(*np.array(rows).T)
    return Noise(*np.maximum(noise, rounding).tolist())


def _block_noise(band: Array) -> Array:
    """Mean and variance of the noise (…, 2) of the blocks of a band (height, width,
    3).
    """
    height = band.shape[0] // BLOCK
    width = band.shape[1] // BLOCK
    whole = band[: height * BLOCK, : width * BLOCK]
    blocks = whole.reshape(height, BLOCK, width, BLOCK, 3)
    # x₋₁ − 2 x₀ + x₁ of independent noise has six times its variance, and none of a
    # gradient.
    second = blocks[:, :, :, :-2] - 2 * blocks[:, :, :, 1:-1] + blocks[:, :, :, 2:]
    variance = (second**2).mean(axis=(1, 3)) / 6
    return np.stack([blocks.mean(axis=(1, 3)), variance], axis=-1)


def fit_noise(level: Array, variance: Array) -> Noise:
    """Fit σ² = floor² + share² x² to variances (n,) at values x (n,) of linear RGB;
    NaN does not count.
    """
    from scipy.optimize import nnls

    known = np.isfinite(level) & np.isfinite(variance)
    if not known.any():
        return Noise()
    # Variances are compared by their ratios.
    weight = 1 / np.maximum(variance[known], LEAST_VARIANCE)
    columns = np.stack([np.ones(known.sum()), level[known] ** 2], axis=1)
    goal = variance[known] * weight
    (floor, share), _ = nnls(columns * weight[:, None], goal)
    return Noise(float(np.sqrt(share)), float(np.sqrt(floor)))


def shift(first: Array, second: Array) -> tuple[float, float] | None:
    """Measure how far a crop (height, width) is shifted against another, in pixels down
    and to the right; None where the crops do not show it.

    Phase correlation: C. D. Kuglin and D. C. Hines 1975, "The phase correlation image
    alignment method". The peak is that of a parabola through three values.
    """
    if not all(_has_detail(crop) for crop in (first, second)):
        return None
    window = np.hanning(first.shape[0])[:, None] * np.hanning(first.shape[1])
    spectra = [np.fft.rfft2((crop - crop.mean()) * window) for crop in (first, second)]
    cross = np.conj(spectra[0]) * spectra[1]
    magnitude = np.abs(cross)
    phase = cross / np.maximum(magnitude, 1e-3 * magnitude.max())
    surface = np.fft.irfft2(phase, first.shape)
    peak = np.unravel_index(surface.argmax(), surface.shape)
    around = [surface[(peak[0] + step) % len(surface), peak[1]] for step in (-1, 0, 1)]
    across = [
        surface[peak[0], (peak[1] + step) % surface.shape[1]] for step in (-1, 0, 1)
    ]
    height = sum(around) + sum(across) - surface[peak]
    if height < MIN_PEAK:
        return None
    places = []
    for place, size, values in zip(peak, surface.shape, (around, across), strict=True):
        whole = (int(place) + size // 2) % size - size // 2
        places.append(whole + _vertex(*values))
    return places[0], places[1]


def _has_detail(crop: Array) -> bool:
    return bool(crop.std() > MIN_DETAIL * abs(crop.mean()))


def _vertex(before: float, at: float, after: float) -> float:
    """Place of the maximum of a parabola through three values, from the middle one."""
    bend = before - 2 * at + after
    return float(np.clip((before - after) / (2 * bend), -0.5, 0.5)) if bend < 0 else 0.0


def check_aligned(crops: Sequence[tuple[Array, Array]], name: str) -> float | None:
    """Check pairs of crops (height, width) of the brightness of two photographs, and
    return the shift in pixels; None where nothing shows it.

    Raises `TextureError` (``photographs-not-aligned``) for more than `MAX_SHIFT`.
    """
    shifts = [shift(*pair) for pair in crops]
    known = np.array([place for place in shifts if place is not None])
    if not len(known):
        return None
    down, right = np.median(known, axis=0)
    distances = np.hypot(*known.T)
    worst = float(np.median(distances))
    if worst > MAX_SHIFT:
        raise TextureError(
            f"the photograph {name} is shifted against the first by {right:+.1f} "
            f"pixels to the right and {down:+.1f} down",
            code="photographs-not-aligned",
            hint="align the photographs first, for example with align_image_stack of "
            "Hugin",
        )
    return worst
