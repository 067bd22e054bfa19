"""Build options and their validation."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT, SCENE_LIGHTS
from uplift.common.errors import OptionError, unknown_name
from uplift.models import Model, Moments, Phase, Sigmoid

AUTO: Literal["auto"] = "auto"
AXES = ("srgb", "linear")
ModelName = Literal["moments", "sigmoid"]
MODELS: tuple[ModelName, ...] = ("moments", "sigmoid")
MAX_THRESHOLD = 0.1
PROCESS_BYTES = 500_000_000
"""Memory of a build without its lattice."""

RENAMED = {"within": "auto_tolerance"}
"""Options by the names that earlier versions recorded in cubes."""


@dataclass(frozen=True)
class Options:
    """Options of `uplift.build`, recorded in the cube so that the build can be repeated.

    The parameters are those of `uplift.build`.

    Raises
    ------
    OptionError
        A value outside its range.
    UnknownNameError
        An unknown model or axis.
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
    auto_tolerance: float = 0.5
    debug: bool = False

    def __post_init__(self) -> None:
        _check_dim(self.dim)
        self.spectrum_model()
        if self.axis not in AXES:
            raise unknown_name(str(self.axis), AXES, "axis spacing")
        if not self.lights:
            raise OptionError("lights must name at least one illuminant, got none", code="no-lights")
        if not 0 < self.threshold <= MAX_THRESHOLD:
            raise OptionError(
                f"threshold must be in (0, {MAX_THRESHOLD}], got {self.threshold:g}",
                code="threshold-out-of-range",
                hint="use 1e-6 to 0.1",
            )
        if not 0 <= self.auto_tolerance < np.inf:
            raise OptionError(
                f"auto_tolerance must be a finite ΔE00 of 0 or more, got {self.auto_tolerance:g}",
                code="auto-tolerance-out-of-range",
            )

    def spectrum_model(self) -> Model:
        """Create the spectrum model that the options describe.

        Returns
        -------
        Model
            `Moments` or `Sigmoid` over the wavelengths of every sensor.
        """
        if self.model == Moments.name:
            return Moments(self.coefficients, Phase(observer.START, observer.END, self.warp))
        if self.model == Sigmoid.name:
            return Sigmoid(observer.START, observer.END)
        raise unknown_name(str(self.model), MODELS, "model")


def recorded_options(options: dict[str, Any]) -> dict[str, Any]:
    """Return options read from a cube under their present names."""
    current = {RENAMED.get(name, name): value for name, value in options.items()}
    return current | {"lights": tuple(options["lights"])}


def _check_dim(dim: object) -> None:
    if dim == AUTO:
        return
    if not isinstance(dim, int):
        raise OptionError(f"dim must be a whole number or 'auto', got {dim!r}", code="dim-not-a-number")
    if dim < 2:
        raise OptionError(
            f"dim must be at least 2, got {dim}", code="dim-too-small", hint="use dim=2 or more"
        )


def check_memory(options: Options) -> None:
    """Raise `OptionError` (``dim-too-large``) if the lattice does not fit into the memory of this machine."""
    if not isinstance(options.dim, int):
        return
    dim, coefficients = options.dim, options.spectrum_model().count
    need, have = PROCESS_BYTES + dim**3 * _point_bytes(coefficients), _memory()
    if need > have:
        largest = int(max((have - PROCESS_BYTES) / _point_bytes(coefficients), 8) ** (1 / 3))
        raise OptionError(
            f"dim {dim} needs about {_gigabytes(need)} of memory, this machine has {_gigabytes(have)}",
            code="dim-too-large",
            hint=f"use dim={largest} or less",
        )


def _point_bytes(coefficients: int) -> int:
    """Peak memory of a lattice point: multipliers, and coefficients in single precision, and the other arrays."""
    return 16 * coefficients + 60


def _gigabytes(count: int) -> str:
    return f"{min(count, 10**300) / 1e9:.3g} GB"  # a float overflows for absurd values of dim


def _memory() -> int:
    """Bytes of memory in this machine; practically infinite where the system does not report it."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return 1 << 62
