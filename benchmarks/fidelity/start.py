"""Cubes without an atlas: start of the fit, metric of its steps, and phase."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.fidelity.materials import SENSOR, errors, forward, large, materials
from uplift.common.arrays import Array
from uplift.fit.base import BRIGHTENING, GREY, smooth
from uplift.fit.solver import solve
from uplift.lab.study.held_out import spectrum_errors
from uplift.models import Model, Moments, Phase, Sigmoid
from uplift.models.minimum_norm import forward_map

NINE = Moments(9)
DARK = np.array(
    [
        (0.05, 0.001, 0.001),
        (0.02, 0.002, 0.002),
        (0.1, 0, 0),
        (0.2, 0.01, 0.01),
        (0.02, 0, 0.02),
        (0.1, 0.05, 0),
    ]
)
AT_760 = 76
"""Index of the sample at 760 nm."""


def measure() -> dict[str, Any]:
    """Compare starts, then metrics and phases."""
    names = tuple(dict.fromkeys(("rawtoaces", "cie2017", *large())))
    return {
        "colours": {name: len(materials(name).rgb) for name in names},
        "brightening": BRIGHTENING,
        "grey": GREY,
        "starts": starts(names),
        "metrics": [row for name in names for row in metrics(name)],
    }


def solved(model: Model, start: Array, rgb: Array, metric: Array | None = None) -> Array:
    """Return spectra (n, N) of linear RGB (n, 3) by minimum-norm steps from ``start`` (n, C)."""
    forward_rgb = forward_map(model, SENSOR.wavelengths, SENSOR.matrix, metric)
    solution = solve(model, forward_rgb, start, rgb, tolerance=1e-7, max_passes=24)
    return np.asarray(model.squash(solution.multipliers @ forward_rgb.basis.T))


def starts(names: tuple[str, ...]) -> list[dict[str, Any]]:
    """Return errors relative to the sigmoid: rms, mean ΔE00 over the lights, and the worst light."""
    sigmoid = {
        name: _means(solved(Sigmoid(), np.zeros((len(materials(name).rgb), 3)), materials(name).rgb), name)
        for name in names
    }
    rows = []
    for label, start in _variants().items():
        ratios = {}
        for name in names:
            rgb = materials(name).rgb
            ratio = _means(solved(NINE, start(rgb), rgb), name) / sigmoid[name]
            ratios[name] = [float(ratio[0]), float(ratio[1:].mean()), float(ratio[1:].max())]
        at_760 = float(solved(NINE, start(DARK), DARK)[:, AT_760].max())
        rows.append({"start": label, "at_760": at_760, "ratios": ratios})
    return rows


def _variants() -> dict[str, Callable[[Array], Array]]:
    variants: dict[str, Callable[[Array], Array]] = {"grey of ½": lambda rgb: np.zeros((len(rgb), 9))}
    for b, g in (
        (0, 0.5),
        (0, GREY),
        (0, 1),
        (0.35, GREY),
        (0.5, 0.35),
        (0.5, 0.5),
        (0.5, GREY),
        (0.5, 1),
        (0.7, GREY),
        (1, GREY),
    ):
        variants[f"b = {b:g}, g = {g:.2g}"] = smooth(NINE, forward(NINE), brightening=b, grey=g)
    return variants


def _means(spectra: Array, name: str) -> Array:
    return spectrum_errors(spectra, materials(name).measured).means()


def metrics(name: str) -> list[dict[str, Any]]:
    """Return the errors with other metrics and phases, each from smooth spectra."""
    some = materials(name)
    squared = 1 + np.arange(9.0) ** 2
    choices: list[tuple[str, Model, Array | None]] = [
        ("sigmoid", Sigmoid(), None),
        ("3 moments coefficients", Moments(3), None),
        ("9, M = I", NINE, np.eye(9)),
        ("9, M = diag(1 + j²), the default", NINE, None),
        ("9, M = diag(1 + j²)²", NINE, np.diag(1 / squared**2)),
        ("9, 360–830 nm", Moments(9, Phase(360, 830)), None),
        ("9, warp vision", Moments(9, Phase(warp="vision")), None),
        ("17", Moments(17), None),
    ]
    rows = []
    for label, model, metric in choices:
        start = smooth(model, forward_map(model, SENSOR.wavelengths, SENSOR.matrix, metric))(some.rgb)
        row = errors(solved(model, start, some.rgb, metric), some)
        rows.append({"atlas": name, "model": label, **row})
    return rows
