"""Invented paints, and samples of them as if measured."""

from itertools import product

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.extras.paint.optics import Surface
from uplift.extras.paint.paint_samples import MeasuredSpectra, PaintSamples
from uplift.extras.paint.paints import Paints
from uplift.extras.paint.pigments import Pigment

WAVELENGTHS = np.arange(400.0, 701, 20)
NAMES = ("white", "yellow", "red", "blue")
OIL = Surface(0.04, 0.6)
SPREAD = (0.002, 0.005)
"""Standard deviation of a careful measurement: of all values, and relative to them."""
FILMS = tuple((paint, 0.5, ground) for paint, ground in product(range(3), (0.0, 0.9)))
"""Films of the first three samples of `plan`, on a black and a light ground."""


def invented(wavelengths=WAVELENGTHS, names=NAMES):
    """Return paints with smooth K and S: a white one, and others that absorb."""
    nm = wavelengths
    absorption = {
        "white": 0.001 + 0.6 / (1 + np.exp((nm - 410) / 6)),
        "yellow": 0.002 + 1.5 / (1 + np.exp((nm - 500) / 9)),
        "red": 0.003 + 1.2 / (1 + np.exp((nm - 590) / 9)),
        "blue": 0.05 + 2.0 * np.exp(-(((nm - 620) / 70) ** 2)),
    }
    scattering = {
        "white": 1.2 - 0.0006 * (nm - 400),
        "yellow": 0.5 - 0.0003 * (nm - 400),
        "red": 0.25 + 0.0003 * (nm - 400),
        "blue": 0.12 - 0.0001 * (nm - 400),
    }
    pigments = Pigment(
        np.stack([absorption[name] for name in names]),
        np.stack([scattering[name] for name in names]),
    )
    return Paints(tuple(names), nm, pigments, OIL)


def plan(paints):
    """Return shares (n, P): each paint alone, tints 1:4 and 1:20 with the first, and
    mixtures of two of the others.
    """
    count = len(paints)
    rows = list(np.eye(count))
    for paint in range(1, count):
        for parts in (4, 20):
            row = np.zeros(count)
            row[[0, paint]] = parts, 1
            rows.append(row / row.sum())
    for paint in range(1, count - 1):
        row = np.zeros(count)
        row[[paint, paint + 1]] = 0.75, 0.25
        rows.append(row)
    return np.array(rows)


def measured(paints, shares, noise=0.0, films=(), seed=1):
    """Return samples of mixtures, with ``noise`` times the errors of `SPREAD`.

    ``films`` are tuples of a row of ``shares``, a thickness and a grey ground, which
    follow the opaque samples.
    """
    every = np.concatenate([shares, shares[[row for row, _, _ in films]]])
    thickness = np.concatenate([np.full(len(shares), np.inf), [x for _, x, _ in films]])
    greys = np.concatenate([np.ones(len(shares)), [ground for _, _, ground in films]])
    grounds = greys[:, None] * np.ones(len(paints.wavelengths))
    spectra = [
        paints.reflectance(row, None if np.isinf(x) else x, ground)
        for row, x, ground in zip(every, thickness, grounds, strict=True)
    ]
    exact = np.array(spectra)
    spread = noise * np.hypot(SPREAD[0], SPREAD[1] * exact)
    values = exact + spread * np.random.default_rng(seed).normal(size=exact.shape)
    return PaintSamples(
        tuple(f"sample {row}" for row in range(len(every))),
        paints.names,
        every,
        thickness,
        grounds,
        paints.wavelengths,
        MeasuredSpectra(np.clip(values, 0, 1)),
    )


def mixture_errors(fitted, paints, count=200):
    """ΔE00 (count,) of random opaque mixtures between fitted paints and true ones."""
    shares = np.full(len(paints), 0.5)
    parts = np.random.default_rng(6).dirichlet(shares, count)
    pair = (fitted.reflectance(parts), paints.reflectance(parts))
    return delta_e_spectra(paints.light("D65"), *pair)
