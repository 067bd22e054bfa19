"""What a build can be told, and what it refuses."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Literal

from uplift.colorimetry import observer
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT, SCENE_LIGHTS
from uplift.common.errors import OptionError, unknown_name
from uplift.models import Model, Moments, Phase, Sigmoid

AUTO: Literal["auto"] = "auto"
AXES = ("srgb", "linear")
MODELS = (Moments.name, Sigmoid.name)


@dataclass(frozen=True)
class Options:
    """What a build can be told; recorded in the cube, so that it can be made again.

    ``coefficients`` counts moments + 1 (3 to 17; the sigmoid has 3); ``lights`` are those that the atlas
    entries' colours should hold under; ``threshold`` is the largest |linear RGB| a lattice point may miss
    its target by. ``dim`` "auto" stands for the smallest dim, and its axis, whose lattice keeps every atlas entry
    ``within`` so many ΔE00 under the lights.
    """

    dim: int | Literal["auto"] = 32
    model: str = "moments"
    coefficients: int = 9
    warp: str = "none"
    axis: str = "srgb"
    space: str = "sRGB"
    illuminant: str = DEFAULT_ILLUMINANT
    observer: str = observer.DEFAULT_OBSERVER
    lights: tuple[str, ...] = SCENE_LIGHTS
    threshold: float = 1e-4
    within: float = 0.5
    debug: bool = False

    def spectrum_model(self) -> Model:
        """Raises `OptionError`."""
        if self.model == Moments.name:
            return Moments(self.coefficients, Phase(observer.START, observer.END, self.warp))
        if self.model == Sigmoid.name:
            return Sigmoid(observer.START, observer.END)
        raise unknown_name(self.model, MODELS, "model")


PROCESS = 500_000_000
"""Bytes that a build takes beside its lattice."""


def check_size(options: Options) -> None:
    """Raises `OptionError` for a lattice too small to be one, or too large for this machine's memory."""
    if not isinstance(options.dim, int):
        raise OptionError(f"'{options.dim}' is no dim", hint="use a number, or auto")
    if options.dim < 2:
        raise OptionError(f"a lattice of dim {options.dim} has no cells", hint="use --dim 2 or more")
    if not 0 < options.threshold <= 0.1:
        raise OptionError(f"a threshold of {options.threshold:g} makes no sense", hint="use 1e-6 to 0.1")
    count = options.spectrum_model().count
    need, have = PROCESS + options.dim**3 * _point(count), _memory()
    if need > have:
        largest = int(max((have - PROCESS) / _point(count), 8) ** (1 / 3))
        raise OptionError(
            f"dim {options.dim} needs about {_gigabytes(need)} of memory, this machine has {_gigabytes(have)}",
            hint=f"use --dim {largest} or less",
        )


def _point(count: int) -> int:
    """Bytes of a lattice point: multipliers, and coefficients in single precision, the rest; or these and a file."""
    return 16 * count + 60


def _gigabytes(count: int) -> str:
    return f"{min(count, 10**300) / 1e9:.3g} GB"  # no float holds every dim that can be typed


def _memory() -> int:
    """Bytes of memory in this machine; where it does not tell, as if there were no end to it."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return 1 << 62
