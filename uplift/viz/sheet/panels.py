"""What a sheet shows: one colour per lattice point, and the key to read it by.

The palettes hold up under colour-vision deficiencies: a ramp of one hue, dark to light, against orange; and
for the status tones that stay 16 ΔE00 apart for protanopes, deuteranopes and tritanopes (Machado et al. 2009),
with the many regular points receding.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.srgb import decode
from uplift.common.arrays import Array, Mask
from uplift.cube.data import CubeData

BACKGROUND = 0.03
"""Linear grey, dark enough for the colours to glow and light enough for black to show; absent points have it too."""
DECADES = 3
"""Of the fitting distance, below the threshold, that the ramp spans."""


def _linear(*codes: str) -> Array:
    """(k, 3) linear RGB of hexadecimal sRGB codes."""
    return decode(np.array([list(bytes.fromhex(code)) for code in codes]) / 255)


RAMP = _linear("0b1d51", "20509a", "3f8fc5", "8fc7e0", "e6f4f7")
LOUD = _linear("ff5a00")
STATUS = _linear("f0e442", "9bd4f5", "53708a", "00a878", "ff5a00", "6a1b4d")
"""Of every `Status` but absent, in its order; what is unfitted is as loud as a distance over the threshold."""


@dataclass(frozen=True, eq=False)
class Key:
    """A swatch of linear RGB (k, 3), a ramp if k > 1, and what it means."""

    colours: Array
    text: str


@dataclass(frozen=True, eq=False)
class Panel:
    """A quantity: its title, linear RGB (n, 3) per lattice point, and its keys."""

    title: str
    colours: NDArray[np.floating]
    keys: tuple[Key, ...]


def panels(data: CubeData) -> tuple[Panel, ...]:
    """Lattice RGB, fitting distance, status; where the cube has them, standard error and round."""
    shown = [_colour(data), _distance(data), _status(data)]
    if data.points.standard_error is not None:
        shown.append(_error(data.points.standard_error, data.error_illuminant))
    if data.points.round is not None:
        shown.append(_round(data.points.round, data.points.round[data.points.present] < 0))
    return tuple(replace(panel, colours=_present(data, panel.colours)) for panel in shown)


def _present(data: CubeData, colours: NDArray[np.floating]) -> NDArray[np.floating]:
    return np.where(data.points.present[:, None], colours, colours.dtype.type(BACKGROUND))


def _colour(data: CubeData) -> Panel:
    ramps = np.linspace(0, 1, 64)[:, None, None] * np.eye(3)
    ways = ("red rises to the right", "green rises upwards", "blue rises from tile to tile")
    keys = tuple(Key(ramps[:, i], way) for i, way in enumerate(ways))
    return Panel("Lattice RGB", data.points.rgb, keys)


def _distance(data: CubeData) -> Panel:
    within = np.clip(data.points.distance / data.threshold, 10.0**-DECADES, 1)
    over = data.points.distance > data.threshold
    low, high = data.threshold / 10**DECADES, data.threshold
    keys = (
        Key(_ramp(np.linspace(0, 1, 64)), f"{low:g} or less to {high:g}, logarithmic"),
        Key(LOUD, f"over the threshold: {_points(over)}; largest distance {data.points.distance.max():.2g}"),
    )
    return Panel("Fitting distance", _loud_where(over, 1 + np.log10(within) / DECADES), keys)


def _status(data: CubeData) -> Panel:
    counts = data.points.counts().items()
    keys = (
        Key(colour[None], f"{label}: {count:,}")
        for colour, (label, count) in zip(STATUS, counts, strict=False)
    )
    return Panel("Status", np.append(STATUS, STATUS[:1], axis=0)[data.points.status], tuple(keys))


def _error(errors: NDArray[np.float32], light: str) -> Panel:
    key = Key(_ramp(np.linspace(0, 1, 64)), f"0 to {errors.max():.2g} ΔE00 under {light}")
    return Panel("Standard error", _ramp(errors / errors.max()), (key,))


def _round(rounds: NDArray[np.int16], never: Mask) -> Panel:
    none, last = rounds < 0, max(int(rounds.max()), 0)
    keys = (
        Key(_ramp(np.linspace(0, 1, 64)), f"0 to {last}"),
        Key(LOUD, f"fitted in no round: {_points(never)}"),
    )
    return Panel("Round", _loud_where(none, rounds / max(last, 1)), keys)


def _points(mask: Mask) -> str:
    count = int(mask.sum())
    return f"{count:,} point{'' if count == 1 else 's'}"


def _loud_where(mask: Mask, share: Array) -> Array:
    return np.where(mask[:, None], LOUD, _ramp(share))


def _ramp(share: Array) -> Array:
    """Linear RGB (n, 3) for shares (n,) of the way from dark, 0, to light, 1."""
    anchors = np.linspace(0, 1, len(RAMP))
    return np.stack([np.interp(share, anchors, column) for column in RAMP.T], axis=-1)
