"""Warps for comparison: densities over wavelength, after the colour-matching functions and fitted."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from unittest import mock

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import minimize

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_1976, lab
from uplift.common.arrays import Array
from uplift.lab.study.moments import fine_grid
from uplift.lab.study.technique import TECHNIQUES
from uplift.models import phase

Warp = Callable[[Array], Array]
FITTED_MOMENTS = 2
KNOTS = np.linspace(observer.START, observer.END, 14)
BOUNDS = (-7.0, 1.0)
"""Logarithms of the density at the knots."""
TRIES = 1000


@contextlib.contextmanager
def replaced_warp(warp: Warp) -> Iterator[None]:
    """Use another warp in the warped techniques."""
    with mock.patch.dict(phase.WARPS, vision=warp):
        yield


def candidates(measured: Array) -> dict[str, Warp]:
    """Return the default warp, two after the colour-matching functions, one fitted to reflectances (E, 401)."""
    sensor = observer.sensor()
    sensitivity = sensor.cmfs.sum(axis=1)
    return {
        "vision, ours": phase.WARPS["vision"],
        "x̄ + ȳ + z̄": from_density(sensitivity),
        "(x̄ + ȳ + z̄) · D65": from_density(sensitivity * sensor.power),
        "fitted": fitted(measured, sensitivity * sensor.power),
    }


def from_density(density: Array) -> Warp:
    """Return the warp with slope ``density`` (81,) on the observer's wavelengths, kept above zero."""
    grid = observer.grid()
    density = density / density.max() + 1e-6
    total = np.concatenate([[0], np.cumsum((density[1:] + density[:-1]) / 2)])
    return lambda wavelengths: np.interp(wavelengths, grid, total)


def fitted(measured: Array, density: Array) -> Warp:
    """Minimise mean ΔE76 under D65 at `FITTED_MOMENTS` + 1 floats, starting from ``density`` (81,)."""
    light, technique = observer.light("D65"), TECHNIQUES[0]
    original = lab(measured[:, :: len(measured[0]) // 80] @ light.xyz.T, light.white)

    def warp(knots: Array) -> Warp:
        return from_density(np.exp(PchipInterpolator(KNOTS, knots)(observer.grid())))

    def error(knots: Array) -> float:
        with replaced_warp(warp(knots)):
            moments = technique.moments(measured, fine_grid(), FITTED_MOMENTS)
            spectra = technique.reconstruct(moments, observer.grid())
        return float(delta_e_1976(lab(spectra @ light.xyz.T, light.white), original).mean())

    start = np.log(np.interp(KNOTS, observer.grid(), density / density.max() + 3e-3))
    best = minimize(error, start, method="Powell", bounds=[BOUNDS] * len(KNOTS), options={"maxfev": TRIES})
    return warp(best.x)
