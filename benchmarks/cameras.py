"""Raw values of cameras to XYZ on held-out patches, by cubes and by matrices, for
docs/guides/cameras.md.
"""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import product

import numpy as np
from scipy.optimize import least_squares

from benchmarks import Row
from benchmarks.materials import spectra
from uplift.colorimetry import observer, tables
from uplift.colorimetry.camera import CAMERA
from uplift.colorimetry.delta_e import lab
from uplift.colorimetry.object_colours import solid
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array
from uplift.lab.look_alikes import families_like
from uplift.lab.method import PreparedMap
from uplift.lab.methods.cubes import cube
from uplift.lab.runner import Prepare, Task, divided, measure, spectra_of
from uplift.lattice.lattice import Lattice, axis_nodes

ATLAS = "macbeth"
LIGHTS = ("D65", "A")
SPLITS = 5
DIM = 32
WHITE = np.ones(3)
Fit = Callable[[Array, Array], Array]
"""From raw values (n, 3) and XYZ (n, 3), relative to white, to a matrix (3, 3)."""


def xyz_matrix(raw: Array, xyz: Array) -> Array:
    """Fit the matrix from raw values to XYZ by least squares of XYZ."""
    return np.linalg.lstsq(raw, xyz, rcond=None)[0].T


def lab_matrix(raw: Array, xyz: Array) -> Array:
    """Fit the matrix from raw values to XYZ by least squares of L*a*b*, which keeps
    white.

    RAW to ACES 1.0 (Dyer et al. 2017) fits its matrices so, with six free numbers.
    """
    expected = lab(xyz, WHITE)

    def matrix(free: Array) -> Array:
        first = free.reshape(3, 2)
        return np.column_stack([first, WHITE - first.sum(axis=1)])

    def residuals(free: Array) -> Array:
        return (lab(raw @ matrix(free).T, WHITE) - expected).ravel()

    start = xyz_matrix(raw, xyz)
    return matrix(least_squares(residuals, start[:, :2].ravel()).x)


def map_by(fit: Fit, task: Task, measured: Array) -> PreparedMap:
    """Map raw values by a matrix that is fitted to reflectances (k, N)."""
    raw = task.sensor.rgb(measured)

    def colours(queried: Array, light: Light) -> Array:
        return queried @ fit(raw, measured @ light.xyz.T / light.white).T

    return PreparedMap(colours)


def with_library(task: Task) -> Array:
    """Return the known reflectances, and those that the prior of the cubes knows."""
    return np.concatenate([task.known_spectra, task.library])


def methods(sensor: Sensor) -> dict[str, Prepare]:
    """Return the methods for a camera under a light."""
    names = {"observer": sensor.space, "illuminant": sensor.illuminant}
    of_camera = partial(cube, dim=DIM, space=CAMERA, **names)
    return {
        "matrix, XYZ": lambda task: map_by(xyz_matrix, task, task.known_spectra),
        "matrix, L*a*b*": lambda task: map_by(lab_matrix, task, task.known_spectra),
        "matrix, L*a*b*, with the library": lambda task: map_by(
            lab_matrix, task, with_library(task)
        ),
        "cube without an atlas": of_camera(),
        "cube": of_camera(atlas=True),
        "cube, refined": of_camera(atlas=True, mode="refined"),
    }


def errors() -> Iterator[Row]:
    """Compare the methods on the held-out halves of all splits."""
    atlas = spectra(ATLAS)
    for camera, sensor in SENSORS:
        left_out = families_like(spectra_of(atlas, sensor))
        halves = list(divided(atlas, left_out, sensor, seeds=SPLITS))[::2]
        light = {sensor.illuminant: sensor.light}
        yield from measure(methods(sensor), halves, light, camera=camera)


def realisable() -> Iterator[Row]:
    """Yield the share of a lattice of raw values that is realisable, by camera."""
    nodes = Lattice(axis_nodes("srgb", DIM)).points
    for camera, sensor in SENSORS:
        share = solid(sensor.matrix).contains(nodes).mean()
        yield {"camera": camera, "light": sensor.illuminant, "share": share}


SENSORS = [
    (camera, observer.sensor(CAMERA, light, camera))
    for camera, light in product(tables.names("camera"), LIGHTS)
]
QUESTIONS = {"realisable": realisable, "errors": errors}
