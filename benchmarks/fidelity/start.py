"""Without an atlas: where a colour's fit starts, the metric it moves in, and the phase."""

from __future__ import annotations

import numpy as np

from benchmarks.fidelity.materials import HEAD, JUDGED_ON, SENSOR, ahead, large, materials, row
from benchmarks.page import table
from uplift.common.arrays import Array
from uplift.fit.smooth import BRIGHTENING, GREY, smooth
from uplift.fit.solve import solve
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
NINTIETH = 76
"""Sample of 760 nm."""


def sections() -> list[str]:
    names = dict.fromkeys(("rawtoaces", "cie2017", *large()))
    return [_starts(tuple(names)), *(_models(name) for name in names)]


def solved(model: Model, start: Array, rgb: Array, metric: Array | None = None) -> Array:
    """Spectra (n, N) of linear RGB (n, 3) by steps of least change from ``start`` (n, C)."""
    map_ahead = forward_map(model, SENSOR.wavelengths, SENSOR.matrix, metric)
    found = solve(model, map_ahead, start, rgb, tolerance=1e-7, passes=24)
    return np.asarray(model.squash(found.multipliers @ map_ahead.basis.T))


def _starts(names: tuple[str, ...]) -> str:
    sigmoid = {
        name: _means(solved(Sigmoid(), np.zeros((len(materials(name).rgb), 3)), materials(name).rgb), name)
        for name in names
    }
    rows = []
    for label, start in _variants().items():
        cells = [label, f"{solved(NINE, start(DARK), DARK)[:, NINTIETH].max():.2f}"]
        for name in names:
            ratio = (
                _means(solved(NINE, start(materials(name).rgb), materials(name).rgb), name) / sigmoid[name]
            )
            cells.append(f"{ratio[0]:.2f} / {ratio[1:].mean():.2f} / {ratio[1:].max():.2f}")
        rows.append(cells)
    return table(
        "Without an atlas: where a fit starts",
        "9 coefficients, steps of least change from each start. Per atlas, in shares of what the sigmoid makes of the "
        "same colours: rms / mean over the lights of ΔE00 / the worst light. *760 nm* is the highest reflectance there "
        "of six dark saturated colours. A colour is brightened by max(x)^b and started from a grey of the power g "
        f"of its mean; the default is b = {BRIGHTENING:g}, g = {GREY:.2g}. Chosen on rawtoaces.",
        ["start", "760 nm", *names],
        rows,
    )


def _variants() -> dict:
    found = {"grey of ½": lambda rgb: np.zeros((len(rgb), 9))}
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
        found[f"b = {b:g}, g = {g:.2g}"] = smooth(NINE, ahead(NINE), b, g)
    return found


def _means(answered: Array, name: str) -> Array:
    return spectrum_errors(answered, materials(name).measured).means()


def _models(name: str) -> str:
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
        rows.append(row(label, solved(model, start, some.rgb, metric), some))
    judged = ", which no choice was made on" if name in JUDGED_ON or name == "munsell" else ""
    return table(
        f"Without an atlas: metric and phase on {name}",
        f"{len(some.rgb)} colours{judged}: rms, and mean ΔE00 under each light.",
        ["model", *HEAD],
        rows,
    )
