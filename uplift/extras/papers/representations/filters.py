"""Point sampling after a low-pass filter (PF), which is a sampling-rate conversion by
L/M.

Kment 2011, section 4.4 (conversion), section 4.5, eq. 4.13–4.19 (filters), and section
6.3. The 81 samples of the 5 nm table are upsampled L times with zeros, filtered, and
every M-th sample is kept. L/M = (n − 1)/80, so that the ends remain those of point
sampling. Values outside 380–780 nm count as 0 (section 6.1).

Choices that the text leaves open: ``extent``, an odd number, is the number of table
samples that a filter covers. x runs from −1 to 1 across it, −2 to 2 for Mitchell, at
any extent. Lanczos is the windowed sinc of Pharr & Humphreys 2004, cited in the text: τ
cycles of sinc under the main lobe of another.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.extras.papers.representations import samples
from uplift.extras.papers.representations.samples import Representation

MITCHELL = (-0.4, 1.0)
"""Parameters B and C of the best Mitchell filter in table A.2."""
FILTER_SPACINGS = 4
"""Width of that filter in spacings of its 16 points, which is the usual width of cubic
filters.
"""
EXTENTS = range(3, 22, 2)
"""Extents tried in the thesis."""


@dataclass(frozen=True)
class FilterKind:
    """A family of filters: its curve over x from −1 to 1 with the parameters, and the
    values that a search tries.
    """

    curve: Callable[..., Array]
    choices: Mapping[str, Sequence[float]]


@dataclass(frozen=True)
class Filter:
    """A filter: the name of its kind in `KINDS`, its extent in samples of the table,
    and the parameters of the kind.
    """

    kind: str
    extent: int
    parameters: tuple[float, ...] = ()

    @property
    def name(self) -> str:
        """Kind, extent and parameters, such as ``gaussian(7, α=0.5)``."""
        named = zip(KINDS[self.kind].choices, self.parameters, strict=True)
        parameters = [f"{key}={value:g}" for key, value in named]
        return f"{self.kind}({', '.join([str(self.extent), *parameters])})"

    def taps(self, upsampling: int) -> Array:
        """Compute an odd number of taps with sum 1, ``upsampling`` per sample of the
        table.
        """
        x = np.linspace(-1, 1, 2 * (self.extent * upsampling // 2) + 3)[1:-1]
        taps = KINDS[self.kind].curve(x, *self.parameters)
        return taps / taps.sum()


def resampling_matrix(low_pass: Filter, count: int) -> Array:
    """Matrix (count, 81) that maps the 5 nm table to ``count`` filtered samples."""
    size = len(observer.grid())
    rate = Fraction(count - 1, size - 1)
    taps = low_pass.taps(rate.numerator)
    # Sample i is at L i, and result j at M j, of the upsampled table; the taps are
    # centred there.
    offsets = (
        rate.denominator * np.arange(count)[:, None]
        - rate.numerator * np.arange(size)
        + len(taps) // 2
    )
    inside = (offsets >= 0) & (offsets < len(taps))
    return np.where(inside, rate.numerator * taps[np.where(inside, offsets, 0)], 0)


def _mitchell(x: Array, b: float, c: float) -> Array:
    x = 2 * np.abs(x)
    near = (12 - 9 * b - 6 * c) * x**3 + (-18 + 12 * b + 6 * c) * x**2 + 6 - 2 * b
    far = (
        (-b - 6 * c) * x**3
        + (6 * b + 30 * c) * x**2
        + (-12 * b - 48 * c) * x
        + 8 * b
        + 24 * c
    )
    return np.where(x < 1, near, far) / 6


_TAU = np.round(np.arange(0.05, 3.001, 0.05), 2).tolist()
_ALPHA = [0.05, *np.round(np.arange(0.1, 3.01, 0.1), 1).tolist()]
_CUBIC = np.round(np.arange(-3, 3.01, 0.2), 1).tolist()

KINDS: dict[str, FilterKind] = {
    "box": FilterKind(np.ones_like, {}),
    "tent": FilterKind(lambda x: 1 - np.abs(x), {}),
    "welch": FilterKind(lambda x: 1 - x**2, {}),
    "gaussian": FilterKind(
        lambda x, a: np.exp(-4 * a * x**2) - np.exp(-4 * a), {"α": _ALPHA}
    ),
    "mitchell": FilterKind(_mitchell, {"b": _CUBIC, "c": _CUBIC}),
    "lanczos": FilterKind(
        lambda x, cycles: np.sinc(cycles * x) * np.sinc(x), {"τ": _TAU}
    ),
    "hann": FilterKind(lambda x: 0.5 + 0.5 * np.cos(np.pi * x), {}),
    "hamming": FilterKind(lambda x: 0.54 + 0.46 * np.cos(np.pi * x), {}),
}
"""Kinds by name, in the order of tables A.1 and A.2."""


def filtered_point_samples(count: int, low_pass: Filter) -> Representation:
    """Representation by ``count`` samples of spectra that pass through a filter."""
    encoder = np.zeros((len(samples.wavelengths()), count))
    encoder[:: samples.TABLE_STRIDE] = resampling_matrix(low_pass, count).T
    hats = samples.hat_functions(samples.sample_points(count))
    name = f"PS{count} {low_pass.name}"
    return samples.linear(
        name, "point sampling, filtered", encoder, hats @ samples.xyz_weights(), hats
    )


def mitchell_point_samples(count: int) -> Representation:
    """Representation with the best Mitchell filter of table A.2, `FILTER_SPACINGS` wide
    for any count.
    """
    spacing = (len(observer.grid()) - 1) / (count - 1)
    extent = 2 * round((FILTER_SPACINGS * spacing - 1) / 2) + 1
    low_pass = Filter("mitchell", extent, MITCHELL)
    return replace(filtered_point_samples(count, low_pass), name=f"PF{count}")
