"""Mean of metamers made of measured spectra, in place of the spectrum of a colour.

Zhang, Funt & Mirzaei 2016, "Metamer mismatching in practice versus theory", JOSA A
33(3), predict a colour under a second light by the centroid of the empirical mismatch
body: of the colours of all known reflectances with the colour under the first light.
They know 25 million spectra. Of hundreds none has a given colour, but mixtures have.
The mixtures of the nearest spectra, black and white that have the colour fill a
polytope. Its vertices mix four spectra each, and their mean stands for the centroid:
on unseen materials it is better than the centroid of the hull of their colours.
"""

from functools import partial
from itertools import combinations

import numpy as np
from scipy.optimize import nnls
from scipy.spatial.distance import cdist

from uplift.colorimetry.delta_e import lab
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, Indices
from uplift.lab.method import Method, PreparedMethod, interpolated, ours
from uplift.lab.methods.local_linear import LOWEST, with_least_change
from uplift.lab.runner import KNOWN, Known, Task

NEAREST = 20
"""Measured spectra that are mixed, the nearest in CIE L*a*b*: of 12 to 28, a compromise
between small and large sets.
"""
MIXED = 4
"""Spectra of a vertex: as many as three responses and the sum of the weights fix."""
SINGULAR = 1e-12
"""Determinant below which four colours do not determine weights."""
SLACK = 1e-9
"""Negative weight that counts as rounding."""


def metamer_mean(sensor: Sensor, known: Array, rgb: Array) -> Array:
    """Predict reflectances (n, N) of linear RGB (n, 3) from known ones (E, N).

    A colour that no mixture has takes the mixture of all known spectra that is nearest
    to it in XYZ, moved to its colour.
    """
    light = sensor.light
    xyz = sensor.xyz(rgb)
    ends = np.stack([np.zeros(known.shape[1]), np.ones(known.shape[1])])
    locations = lab(known @ light.xyz.T, light.white)
    distances = cdist(lab(xyz, light.white), locations)
    nearest = np.argsort(distances, axis=1)[:, :NEAREST]
    groups = np.array(list(combinations(range(nearest.shape[1] + len(ends)), MIXED)))
    predicted = []
    for colour, rows in zip(xyz, nearest, strict=True):
        spectra = np.concatenate([known[rows], ends])
        vertices = metamers(light, spectra, groups, colour)
        if not len(vertices):
            every = np.concatenate([known, ends])
            vertices = nearest_mixture(light, every, colour)[None]
        predicted.append(vertices.mean(axis=0))
    clipped = np.clip(np.stack(predicted), LOWEST, 1 - LOWEST)
    return with_least_change(sensor, clipped, rgb)


def metamers(light: Light, spectra: Array, groups: Indices, xyz: Array) -> Array:
    """Mixtures (k, N) of groups (G, 4) of spectra (K, N) that have XYZ (3,)."""
    responses = _responses(light, spectra)[groups].mT
    solvable = np.abs(np.linalg.det(responses)) > SINGULAR
    goal = np.append(xyz, 1.0)[:, None]
    solved = responses[solvable]
    weights = np.linalg.solve(solved, np.broadcast_to(goal, (len(solved), MIXED, 1)))
    inside = (weights >= -SLACK).all(axis=(1, 2))
    chosen = spectra[groups[solvable][inside]]
    return (weights[inside] * chosen).sum(axis=1)


def nearest_mixture(light: Light, spectra: Array, xyz: Array) -> Array:
    """Mixture (N,) of spectra (K, N) that is nearest to XYZ (3,)."""
    weights, _ = nnls(_responses(light, spectra).T, np.append(xyz, 1.0))
    return weights @ spectra


def _responses(light: Light, spectra: Array) -> Array:
    """XYZ of spectra (K, N), and the 1 that sums their weights: (K, 4)."""
    return np.column_stack([spectra @ light.xyz.T, np.ones(len(spectra))])


def prepare(task: Task, known: Known = KNOWN) -> PreparedMethod:
    """Mix metamers from the known spectra of a task."""
    spectra = known(task)
    mean = partial(metamer_mean, task.sensor, spectra)
    return interpolated(mean, task, spectra.nbytes)


METHODS = (
    Method(
        method="metamer-mean",
        title="Mean of metamers",
        source=(
            "after Zhang, Funt & Mirzaei, Metamer mismatching in practice versus "
            "theory, JOSA A 33(3), 2016"
        ),
        prepare=prepare,
        reference_sensor=ours,
        note="measured spectra as those of cubes with an atlas, mixed for each colour",
    ),
)
