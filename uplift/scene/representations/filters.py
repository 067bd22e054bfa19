"""Low-pass filters for sampling-rate conversion by L/M: what a spectrum goes through before it is point sampled.

Kment 2011, 4.4 (the conversion) and 4.5 (the filters, eq. 4.13–4.19). The 81 samples of the 5 nm table are taken L
times as dense with zeros between, filtered, and every M-th is kept: L/M = (n − 1)/80, so that the ends stay where
point sampling has them. What lies outside 380–780 nm counts as 0 (6.1).

Where the text leaves a choice open: ``extent``, an odd number, is the samples of the table that a filter reaches
over; x runs from −1 to 1 across it, −2 to 2 for Mitchell, whatever the extent. Lanczos is the windowed sinc of Pharr
& Humphreys 2004, which the text cites: τ cycles of sinc under the main lobe of another.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

import numpy as np
from scipy.signal import resample_poly, windows

from uplift.colorimetry import observer
from uplift.common.arrays import Array

EXTENTS = range(3, 22, 2)
"""As the thesis has tried them."""
FINE_STRIDE, COARSE_STRIDE = 1, 5
"""Of the choices for a parameter a search tries every so many."""


@dataclass(frozen=True)
class FilterKind:
    """A family of filters: ``window`` takes an odd number of taps and the parameters, whose ``choices`` are tried."""

    title: str
    window: Callable[..., Array]
    choices: Mapping[str, Sequence[float]]


@dataclass(frozen=True)
class Filter:
    """A filter with its parameters: a ``kind`` of `KINDS`, the samples it reaches over, and what the kind asks for."""

    kind: str
    extent: int
    parameters: tuple[float, ...] = ()

    @property
    def name(self) -> str:
        named = zip(KINDS[self.kind].choices, self.parameters, strict=True)
        return f"{self.kind}({', '.join([str(self.extent), *(f'{key}={value:g}' for key, value in named)])})"

    def taps(self, up: int) -> Array:
        """An odd number of taps that sum to 1, ``up`` to a sample of the table."""
        taps = KINDS[self.kind].window(2 * (self.extent * up // 2) + 1, *self.parameters)
        return np.asarray(taps / taps.sum())


def conversion(low_pass: Filter, count: int) -> Array:
    """(count, 81) what takes the 5 nm table to ``count`` samples."""
    size = len(observer.grid())
    rate = Fraction(count - 1, size - 1)
    taps = low_pass.taps(rate.numerator)
    return np.asarray(resample_poly(np.eye(size), rate.numerator, rate.denominator, axis=0, window=taps))


def candidates(kind: str, every: int = FINE_STRIDE) -> list[Filter]:
    """The filters of a kind that a search tries: of each parameter every so many of the choices."""
    choices = [values[::every] for values in KINDS[kind].choices.values()]
    return [Filter(kind, extent, values) for extent in EXTENTS[::every] for values in product(*choices)]


def _inside(window: Callable[..., Array], taps: int, *parameters: float) -> Array:
    """A window of scipy without the zeros at its ends, which would make the filter narrower than its extent."""
    return np.asarray(window(taps + 2, *parameters)[1:-1])


def _x(taps: int) -> Array:
    return np.linspace(-1, 1, taps + 2)[1:-1]


def _welch(taps: int) -> Array:
    return 1 - _x(taps) ** 2


def _gaussian(taps: int, alpha: float) -> Array:
    return np.exp(-alpha * (2 * _x(taps)) ** 2) - np.exp(-4 * alpha)


def _mitchell(taps: int, b: float, c: float) -> Array:
    x = 2 * np.abs(_x(taps))
    near = (12 - 9 * b - 6 * c) * x**3 + (-18 + 12 * b + 6 * c) * x**2 + 6 - 2 * b
    far = (-b - 6 * c) * x**3 + (6 * b + 30 * c) * x**2 + (-12 * b - 48 * c) * x + 8 * b + 24 * c
    return np.where(x < 1, near, far) / 6


def _lanczos(taps: int, tau: float) -> Array:
    return np.sinc(tau * _x(taps)) * _inside(windows.lanczos, taps)


_TAU = np.round(np.arange(0.05, 3.001, 0.05), 2).tolist()
_ALPHA = [0.05, *np.round(np.arange(0.1, 3.01, 0.1), 1).tolist()]
_CUBIC = np.round(np.arange(-3, 3.01, 0.2), 1).tolist()

KINDS: dict[str, FilterKind] = {
    "box": FilterKind("box", windows.boxcar, {}),
    "tent": FilterKind("tent", windows.triang, {}),
    "welch": FilterKind("Welch", _welch, {}),
    "gaussian": FilterKind("Gaussian", _gaussian, {"α": _ALPHA}),
    "mitchell": FilterKind("Mitchell", _mitchell, {"b": _CUBIC, "c": _CUBIC}),
    "lanczos": FilterKind("Lanczos", _lanczos, {"τ": _TAU}),
    "hann": FilterKind("Hann", functools.partial(_inside, windows.hann), {}),
    "hamming": FilterKind("Hamming", functools.partial(_inside, windows.hamming), {}),
}
"""In the order of tables A.1 and A.2."""
