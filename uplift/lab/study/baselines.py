"""Plain predictors of held-out materials from measured ones, without a spectrum model.

`local_linear`     reflectance regressed on RGB, with weights that fall with the distance of colours
`mismatch_centroid`  colours under other lights, from the mixtures of measured reflectances that have the colour
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, product
from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, Delaunay, QhullError
from scipy.spatial.distance import cdist

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.lights import SCENE_LIGHTS
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, Indices
from uplift.cube import CubeData
from uplift.lookup.refine import with_colours

BANDWIDTHS = (7.0, 10.0, 14.0, 20.0, 28.0, 40.0, 80.0, 1e4)
"""Standard deviations of the Gaussian weights, in CIE L*a*b*; the last one weighs all materials alike."""
RIDGES = (1e-6, 1e-4, 1e-3, 1e-2, 1e-1, 1e3)
"""Weights of small slopes, relative to the sum of the weights; with the last one, predictions are weighted means."""
LOWEST = 1e-4
"""Least distance of predicted reflectances from 0 and 1 before they move to their colours."""
NEIGHBOURS = 14
"""Nearest measurements that metamers are mixed from."""
FLAT = 1e-12
"""Least volume of a tetrahedron of colours whose mixtures are determined."""


def local_linear(data: CubeData, known: Array, rgb: Array) -> Array:
    """Predict reflectances by a local-linear regression on RGB, and move them to their colours.

    Bandwidth and ridge have the least mean leave-one-out ΔE00 of the known materials under the lights of a build.

    Shapes: ``known`` (E, N), ``rgb`` (n, 3); result (n, N).

    Cleveland & Devlin 1988, "Locally weighted regression", JASA 83(403).
    """
    colours = np.clip(data.sensor.rgb(known), 0, 1)
    smoothing = _best_smoothing(data, known, colours)
    return _exact(data, _regress(data.sensor, colours, known, rgb, smoothing), rgb)


class Smoothing(NamedTuple):
    """Bandwidth, in CIE L*a*b*, and ridge of a local-linear regression."""

    width: float
    ridge: float


def _best_smoothing(data: CubeData, known: Array, colours: Array) -> Smoothing:
    lights = [observer.light(name, data.sensor.observer, *data.sensor.range) for name in SCENE_LIGHTS]

    def error(smoothing: Smoothing) -> float:
        left_out = _regress(data.sensor, colours, known, colours, smoothing, leave_out=True)
        spectra = _exact(data, left_out, colours)
        return float(np.mean([delta_e_spectra(light, spectra, known) for light in lights]))

    return min((Smoothing(*each) for each in product(BANDWIDTHS, RIDGES)), key=error)


def _exact(data: CubeData, spectra: Array, rgb: Array) -> Array:
    """Move predictions (n, N), which may leave [0, 1], to linear RGB (n, 3)."""
    possible = np.clip(spectra, LOWEST, 1 - LOWEST)
    return with_colours(data, possible, possible, rgb, data.sensor.wavelengths)


def _regress(
    sensor: Sensor, colours: Array, known: Array, rgb: Array, smoothing: Smoothing, leave_out: bool = False
) -> Array:
    """Local-linear predictions (n, N) at linear RGB (n, 3); ``leave_out`` gives no weight to a query's own row."""
    squares = cdist(rgb_to_lab(sensor, rgb), rgb_to_lab(sensor, colours), "sqeuclidean")
    if leave_out:
        np.fill_diagonal(squares, np.inf)
    squares -= squares.min(axis=1, keepdims=True)  # far queries keep the weight of the nearest colour
    weights = np.exp(-squares / (2 * smoothing.width**2))
    weights /= weights.sum(axis=1, keepdims=True)
    offsets = colours[None] - rgb[:, None]
    terms = np.concatenate([np.ones((*offsets.shape[:2], 1)), offsets], axis=2)
    weighted = weights[:, :, None] * terms
    matrix = weighted.mT @ terms + smoothing.ridge * np.diag([0.0, 1, 1, 1])
    first = np.linalg.solve(matrix, np.broadcast_to(np.eye(4)[:, :1], (len(rgb), 4, 1)))
    return np.asarray((weighted @ first)[:, :, 0] @ known)


def mismatch_centroids(sensor: Sensor, known: Array, rgb: Array, lights: Sequence[Light]) -> Array:
    """Predict colours under other lights by the centroids of measured metamer mismatch bodies.

    The body of a colour holds the colours, under another light, of all metamers of known materials. Sets of some
    hundred measurements have hardly any metamers, so metamers are mixtures: of the nearest measurements, black and
    white. The corners of a body are mixtures of four of them.

    Shapes: ``known`` (E, N), ``rgb`` (n, 3); result (n, L, 3).

    Zhang, Funt & Mirzaei 2016, "Metamer mismatching in practice versus theory", JOSA A 33(3), A238–A247.
    """
    distance = cdist(rgb_to_lab(sensor, rgb), rgb_to_lab(sensor, sensor.rgb(known)))
    nearest = np.argsort(distance, axis=1, kind="stable")[:, :NEIGHBOURS]
    ends = np.stack([np.zeros(known.shape[1]), np.ones(known.shape[1])])
    found = []
    for colour, rows in zip(rgb, nearest, strict=True):
        pool = np.concatenate([known[rows], ends])
        corners, weights = _mixtures(sensor.rgb(pool), colour)
        relit = np.stack([pool @ light.xyz.T for light in lights])
        bodies = np.einsum("vk,lvkc->lvc", weights, relit[:, corners])
        found.append([centroid(body) if len(body) else np.full(3, np.nan) for body in bodies])
    return np.array(found).reshape(len(rgb), len(lights), 3)


def _mixtures(colours: Array, rgb: Array) -> tuple[Indices, Array]:
    """Rows (V, 4) of linear RGB (P, 3), and the weights (V, 4) of their mixtures that have linear RGB (3,)."""
    corners = np.array(list(combinations(range(len(colours)), 4)))
    matrix = np.pad(colours[corners].mT, ((0, 0), (0, 1), (0, 0)), constant_values=1.0)
    corners, matrix = (array[np.abs(np.linalg.det(matrix)) > FLAT] for array in (corners, matrix))
    weights = np.linalg.solve(matrix, np.broadcast_to(np.append(rgb, 1.0)[:, None], (len(matrix), 4, 1)))[..., 0]
    possible = (weights >= 0).all(axis=1)
    return corners[possible], weights[possible]


def centroid(points: Array) -> Array:
    """Compute the centroid (3,) of the convex hull of points (n, 3); their mean if the hull is flat."""
    try:
        hull = points[ConvexHull(points).vertices]
        tetrahedra = hull[Delaunay(hull).simplices]
    except QhullError:
        return np.asarray(points.mean(axis=0))
    volumes = np.abs(np.linalg.det(tetrahedra[:, 1:] - tetrahedra[:, :1]))
    return np.asarray(volumes @ tetrahedra.mean(axis=1) / volumes.sum())
