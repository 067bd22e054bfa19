"""Raw values of cameras to XYZ on held-out patches, by cubes and by matrices, for
docs/guides/cameras.md.
"""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import chain, product, starmap

import numpy as np
from scipy.optimize import least_squares

from benchmarks import Row
from benchmarks.materials import spectra
from uplift.colorimetry import Light, Sensor, lab, observer, solid, tables
from uplift.colorimetry.camera import CAMERA
from uplift.common.arrays import Array
from uplift.lab.look_alikes import families_like
from uplift.lab.method import PreparedMap
from uplift.lab.methods.cubes import cube
from uplift.lab.runner import Prepare, Task, divided, measure, spectra_of
from uplift.lab.study.held_out import HALF, NO_ATLAS
from uplift.lattice import Lattice, axis_nodes

ATLAS = "macbeth"
LIGHTS = ("D65", "A")
SPLITS = 5
DIM = 32
CHOSEN_AS = {"cube without an atlas": NO_ATLAS, "cube": HALF, "cube, refined": HALF}
"""Methods that depend on choices of the design, by their names there."""
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


def known(task: Task) -> Array:
    """Return the known reflectances."""
    return task.known_spectra


def known_and_library(task: Task) -> Array:
    """Return the known reflectances and those that the prior of the cubes knows."""
    return np.concatenate([task.known_spectra, task.library])


def prepare_matrix(
    task: Task, fit: Fit, training: Callable[[Task], Array]
) -> PreparedMap:
    """Fit a matrix to reflectances."""
    measured = training(task)

    def colours(raw: Array, light: Light) -> Array:
        matrix = fit(task.sensor.rgb(measured), measured @ light.xyz.T / light.white)
        return raw @ matrix.T

    return PreparedMap(colours)


def methods(sensor: Sensor) -> dict[str, Prepare]:
    """Return the methods for a camera under a light."""
    of_camera = partial(
        cube,
        dim=DIM,
        space=CAMERA,
        observer=sensor.space,
        illuminant=sensor.illuminant,
    )
    matrix = partial(partial, prepare_matrix)
    return {
        "matrix, XYZ": matrix(fit=xyz_matrix, training=known),
        "matrix, L*a*b*": matrix(fit=lab_matrix, training=known),
        "matrix, L*a*b*, with the library": matrix(
            fit=lab_matrix, training=known_and_library
        ),
        "cube without an atlas": of_camera(),
        "cube": of_camera(atlas=True),
        "cube, refined": of_camera(atlas=True, mode="refined"),
    }


def compare(camera: str, illuminant: str) -> Iterator[Row]:
    """Compare the methods on the held-out halves of all splits."""
    atlas = spectra(ATLAS)
    sensor = observer.sensor(CAMERA, illuminant, camera)
    left_out = families_like(spectra_of(atlas, sensor))
    halves = list(divided(atlas, left_out, sensor, seeds=SPLITS))[::2]
    light = {illuminant: sensor.light}
    return measure(methods(sensor), halves, light, camera=camera)


def realisable_share(sensor: Sensor, dim: int = DIM) -> float:
    """Return the share of the nodes of a lattice of raw values that are realisable."""
    nodes = Lattice(axis_nodes("srgb", dim)).points
    return solid(sensor.matrix).contains(nodes).mean()


def realisable() -> list[Row]:
    """Return the share of raw values that are realisable, by camera and light."""
    return [
        {
            "camera": camera,
            "light": light,
            "share": realisable_share(observer.sensor(CAMERA, light, camera)),
        }
        for camera, light in CASES
    ]


def errors() -> list[Row]:
    """Return the errors of all cameras and lights."""
    return list(chain.from_iterable(starmap(compare, CASES)))


CASES = list(product(tables.names("camera"), LIGHTS))
QUESTIONS = {"realisable": realisable, "errors": errors}
