"""Panels of contact sheets: a colour for each node by a quantity, and its legend.

The palettes are suitable for colour-vision deficiencies: a ramp of one hue, dark to
light, and orange as highlight. Status colours differ by at least 16 ΔE00 for
protanopes, deuteranopes and tritanopes (Machado et al. 2009), and the frequent regular
nodes are inconspicuous.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Mask
from uplift.common.text import pluralise
from uplift.cube import CubeData
from uplift.extras.colour.srgb import decode

# Linear grey, on which both bright colours and black are visible. Absent nodes have
# this colour.
BACKGROUND = 0.03
DECADES = 3  # decades of fitting distance below the threshold that the ramp spans
KEY_STEPS = np.linspace(0, 1, 64)  # positions along a ramp in a legend


def _linear(*codes: str) -> Array:
    """Return linear RGB (k, 3) of hexadecimal sRGB codes."""
    return decode(np.array([list(bytes.fromhex(code)) for code in codes]) / 255)


RAMP = _linear("0b1d51", "20509a", "3f8fc5", "8fc7e0", "e6f4f7")
HIGHLIGHT = _linear("ff5a00")
# Colours of every `Status` but absent, in its order. Unfitted nodes have the highlight
# colour.
STATUS = _linear("f0e442", "9bd4f5", "53708a", "00a878", "ff5a00", "6a1b4d")


@dataclass(frozen=True, eq=False)
class Key:
    """A swatch of linear RGB (k, 3), a ramp if k > 1, and its meaning."""

    colours: Array
    text: str


@dataclass(frozen=True, eq=False)
class Panel:
    """A quantity: its title, linear RGB (n, 3) of the nodes, and its legend."""

    title: str
    colours: NDArray[np.floating]
    keys: tuple[Key, ...]


def panels(data: CubeData) -> tuple[Panel, ...]:
    """Return panels of lattice RGB, fitting distance and status, and of standard error
    and round if available.
    """
    quantities = [_rgb_panel(data), _distance_panel(data), _status_panel(data)]
    if data.points.standard_error is not None:
        quantities.append(
            _error_panel(data.points.standard_error, data.error_illuminant)
        )
    if data.points.round is not None:
        quantities.append(
            _round_panel(data.points.round, data.points.round[data.points.present] < 0)
        )
    present = data.points.present[:, None]

    def on_background(panel: Panel) -> Panel:
        background = panel.colours.dtype.type(BACKGROUND)
        return replace(panel, colours=np.where(present, panel.colours, background))

    return tuple(map(on_background, quantities))


def _rgb_panel(data: CubeData) -> Panel:
    ramps = KEY_STEPS[:, None, None] * np.eye(3)
    directions = (
        "red rises to the right",
        "green rises upwards",
        "blue rises from tile to tile",
    )
    keys = tuple(Key(ramps[:, i], direction) for i, direction in enumerate(directions))
    return Panel("Lattice RGB", data.points.rgb, keys)


def _distance_panel(data: CubeData) -> Panel:
    within = np.clip(data.points.distance / data.threshold, 10.0**-DECADES, 1)
    over = data.points.distance > data.threshold
    low = data.threshold / 10**DECADES
    high = data.threshold
    exceeding = (
        f"over the threshold: {_count(over)}; largest distance "
        f"{data.points.distance.max():.2g}"
    )
    keys = (
        Key(_ramp(KEY_STEPS), f"{low:g} or less to {high:g}, logarithmic"),
        Key(HIGHLIGHT, exceeding),
    )
    return Panel(
        "Fitting distance", _highlight_where(over, 1 + np.log10(within) / DECADES), keys
    )


def _status_panel(data: CubeData) -> Panel:
    counts = data.points.counts().items()
    keys = (
        Key(colour[None], f"{label}: {count:,}")
        for colour, (label, count) in zip(STATUS, counts, strict=False)
    )
    return Panel(
        "Status", np.append(STATUS, STATUS[:1], axis=0)[data.points.status], tuple(keys)
    )


def _error_panel(errors: NDArray[np.float32], light: str) -> Panel:
    key = Key(_ramp(KEY_STEPS), f"0 to {errors.max():.2g} ΔE00 under {light}")
    return Panel("Standard error", _ramp(errors / errors.max()), (key,))


def _round_panel(rounds: NDArray[np.int16], not_fitted: Mask) -> Panel:
    none = rounds < 0
    last = max(int(rounds.max()), 0)
    keys = (
        Key(_ramp(KEY_STEPS), f"0 to {last}"),
        Key(HIGHLIGHT, f"fitted in no round: {_count(not_fitted)}"),
    )
    return Panel("Round", _highlight_where(none, rounds / max(last, 1)), keys)


def _count(mask: Mask) -> str:
    return pluralise(int(mask.sum()), "node")


def _highlight_where(mask: Mask, position: Array) -> Array:
    return np.where(mask[:, None], HIGHLIGHT, _ramp(position))


def _ramp(position: Array) -> Array:
    """Return linear RGB (n, 3) for positions (n,) from dark, 0, to light, 1."""
    anchors = np.linspace(0, 1, len(RAMP))
    return np.stack(
        [np.interp(position, anchors, column) for column in RAMP.T], axis=-1
    )
