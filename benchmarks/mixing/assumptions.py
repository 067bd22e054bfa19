"""Assumed scattering compared: errors of mixtures whose paints are known by their RGB alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from scipy.optimize import least_squares, minimize

from benchmarks.mixing.paints import BLUES, Mixtures, acrylics, codes, published, three_bands
from benchmarks.mixing.pictures import colour
from uplift.colorimetry.delta_e import delta_e_rgb, rgb_to_lab
from uplift.common.arrays import Array
from uplift.design.mixing import pigments
from uplift.design.mixing.criteria import SHARES
from uplift.design.mixing.pigments import (
    CONSTANT,
    SQUARE_ROOT,
    PowerOfReflectance,
    Scattering,
    dispersive,
)
from uplift.lookup import Cube

FOLDS = 5
ARTISTS = ("#002185", "#fcd200")
"""Cobalt blue and Hansa yellow, as Mixbox's table has them."""
GREEN_MARGIN = 0.01
"""Excess of G over R and B, in linear RGB, that counts as green."""
LARGEST_FACTOR = 10.0
"""Weight of the logarithm of a tinting strength against a difference of L*a*b* in the fit of `_known_strengths`."""


def compare(smooth: Cube, atlas: Cube) -> dict[str, Any]:
    """Compare rules for S on the measured sets and on published mixtures, uplifted by ``smooth``.

    ``atlas`` is the cube that uplifts the ColorChecker's blue and yellow.
    """
    sets = _sets(smooth)
    rows = [
        {
            "rule": title,
            **{name: _errors(smooth, one, rule) for name, one in sets.items()},
            "artists": _greens(smooth, np.array([smooth.decode(codes(text)) for text in ARTISTS]), rule),
            "patches": _greens(atlas, np.array([colour(atlas, "blue"), colour(atlas, "yellow")]), rule),
        }
        for title, rule in _rules(smooth).items()
    ]
    paints = sets["acrylics"]
    limits = {
        title: _known_strengths(smooth, paints, rule)
        for title, rule in (("root", SQUARE_ROOT), ("dispersive", dispersive(smooth.data.sensor)))
    }
    counts = {name: len(one.pairs) for name, one in sets.items()}
    return {
        "scatterings": rows,
        "set_sizes": counts,
        "known_strengths": limits,
        "left_out": _left_out(smooth, paints),
    }


def _sets(cube: Cube) -> dict[str, Mixtures]:
    return {
        "acrylics": acrylics(),
        "blues": acrylics(BLUES, "yellow"),
        "watercolours": three_bands("curtis1997"),
        "photographed": three_bands("lindemeier2020"),
        "mixbox": published("mixbox", cube),
    }


def _rules(cube: Cube) -> dict[str, Scattering | None]:
    """Return the rules by title; None averages RGB."""
    best = dispersive(cube.data.sensor)
    return {
        "mean of linear RGB": None,
        "1": CONSTANT,
        "R^½": SQUARE_ROOT,
        "R^¾": PowerOfReflectance(0.75),
        "R^0.9": PowerOfReflectance(0.9),
        "Y^½": replace(best, exponent=0.5, weight=0.0),
        "Y^¾": replace(best, weight=0.0),
        "Y": replace(best, exponent=1.0, weight=0.0),
        "Y^½ exp(h / 4)": replace(best, exponent=0.5),
        "Y^¾ exp(h / 4)": best,
        "Y exp(h / 4)": replace(best, exponent=1.0),
    }


def mix(cube: Cube, mixtures: Mixtures, rule: Scattering | None) -> Array:
    """Return the colours (n, 3) of mixtures from the colours of their paints, in linear RGB in [0, 1]."""
    if rule is None:
        return np.asarray((mixtures.shares[:, None] @ mixtures.components)[:, 0])
    spectra = pigments.from_opaque(cube.reflectance(mixtures.paints), rule)
    return _mix(cube, mixtures, spectra)


def _mix(cube: Cube, mixtures: Mixtures, paints: pigments.Pigment) -> Array:
    pairs = pigments.Pigment(paints.absorption[mixtures.pairs], paints.scattering[mixtures.pairs])
    found = pairs.mix(mixtures.shares).opaque_reflectance()
    return np.clip(cube.data.sensor.rgb(found), 0, 1)


def _errors(cube: Cube, mixtures: Mixtures, rule: Scattering | None) -> dict[str, float]:
    found = mix(cube, mixtures, rule)
    difference = delta_e_rgb(cube.data.sensor, mixtures.expected, found)
    return {
        "delta_e": float(difference.mean()),
        "rms": float(np.sqrt(np.mean((found - mixtures.expected) ** 2))),
    }


def _greens(cube: Cube, pair: Array, rule: Scattering | None) -> list[dict[str, Any]]:
    """Mix a blue and a yellow at 1:3, 1:1 and 3:1."""
    one = Mixtures(pair, np.array([[0, 1]] * 3), SHARES[::-1], np.zeros((3, 3)))
    return [
        {"green": bool(g > max(r, b) + GREEN_MARGIN), "code": _hex(cube, np.array([r, g, b]))}
        for r, g, b in mix(cube, one, rule)
    ]


def _hex(cube: Cube, rgb: Array) -> str:
    return "#" + "".join(f"{round(code):02x}" for code in cube.encode(rgb).tolist())


def _known_strengths(cube: Cube, mixtures: Mixtures, rule: Scattering) -> dict[str, float]:
    """Fit a tinting strength to each paint, a factor of its K and S: the error that no rule for colours goes below."""
    spectra = pigments.from_opaque(cube.reflectance(mixtures.paints), rule)
    expected = rgb_to_lab(cube.data.sensor, mixtures.expected)

    def scaled(logarithms: Array) -> Array:
        factors = np.exp(logarithms)[:, None]
        paints = pigments.Pigment(spectra.absorption * factors, spectra.scattering * factors)
        return _mix(cube, mixtures, paints)

    def residuals(logarithms: Array) -> Array:
        difference = rgb_to_lab(cube.data.sensor, scaled(logarithms)) - expected
        return np.concatenate([difference.ravel() / LARGEST_FACTOR, logarithms / LARGEST_FACTOR])

    fitted = least_squares(residuals, np.zeros(len(mixtures.paints)), max_nfev=15).x
    factors = np.exp(fitted - np.median(fitted))
    error = delta_e_rgb(cube.data.sensor, mixtures.expected, scaled(fitted)).mean()
    return {"delta_e": float(error), "smallest": float(factors.min()), "largest": float(factors.max())}


def _left_out(cube: Cube, mixtures: Mixtures) -> float:
    """Return the mean ΔE00 of mixtures with paints that the exponent of Y and the weight of h were not fitted to."""
    errors = []
    for fold in range(FOLDS):
        held = (mixtures.pairs % FOLDS == fold).any(axis=1)
        fitted = minimize(
            partial(_mean_error, cube, _subset(mixtures, ~held)),
            [0.5, 0.25],
            method="Nelder-Mead",
            options={"maxfev": 60, "initial_simplex": [[0.5, 0.25], [0.7, 0.25], [0.5, 0.4]]},
        )
        test = _subset(mixtures, held)
        rule = _fitted_rule(cube, fitted.x)
        errors.append(delta_e_rgb(cube.data.sensor, test.expected, mix(cube, test, rule)))
    return float(np.concatenate(errors).mean())


def _mean_error(cube: Cube, mixtures: Mixtures, parameters: Array) -> float:
    return _errors(cube, mixtures, _fitted_rule(cube, parameters))["delta_e"]


def _fitted_rule(cube: Cube, parameters: Array) -> Callable[[Array], Array]:
    return replace(dispersive(cube.data.sensor), exponent=parameters[0], weight=parameters[1])


def _subset(mixtures: Mixtures, kept: Array) -> Mixtures:
    return Mixtures(mixtures.paints, mixtures.pairs[kept], mixtures.shares[kept], mixtures.expected[kept])
