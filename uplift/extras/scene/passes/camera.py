"""Raw values of a camera from passes: a matrix fitted to products of reflectances."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.camera import CAMERA, Camera
from uplift.colorimetry.illuminants import Illuminant
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.extras.scene.passes.choice import judging_paths, training_paths
from uplift.extras.scene.passes.light_paths import LightPaths
from uplift.extras.scene.passes.materials import Materials
from uplift.extras.scene.passes.passes import Passes, PassesCamera

LEAST = 1e-3
"""Raw value, where white under D65 has 1, that is added to those that errors are
relative to.
"""


def with_camera(
    passes: Passes,
    materials: Materials,
    lights: Sequence[Illuminant],
    camera: str | Camera,
) -> Passes:
    """Add a matrix to the raw values of a camera.

    Parameters
    ----------
    passes : Passes
        Passes of ``materials`` and ``lights``, by `choose` or `fit_bands`.
    materials : Materials
        Materials of the scene, or those of the library.
    lights : sequence of str or Lamp
        The lights of the passes, in their order.
    camera : str or Camera
        Camera, as for `uplift.colorimetry.observer.find_camera`.

    Returns
    -------
    Passes
        The same passes with the camera, whose matrix serves all lights.

    Raises
    ------
    OptionError
        The lights are not those of the passes.
    UnknownNameError
        The camera is unknown.
    """
    if len(dict.fromkeys(lights)) != len(passes.lights):
        raise OptionError("lights must be those of the passes")
    sensor = observer.sensor(CAMERA, observer=camera)
    # White under D65, of Y = 1, has raw values of 1.
    power = sensor.power / (sensor.power @ observer.matching_functions()[:, 1])
    weights = sensor.matrix / power
    trained = training_paths(materials, lights)
    numbers, raw = _numbers_and_raw(passes, trained, weights)
    scale = 1 / (np.abs(raw) + LEAST)
    rows = []
    for channel in range(3):
        weighted = numbers * scale[:, channel, None]
        rows.append(np.linalg.lstsq(weighted, raw[:, channel] * scale[:, channel])[0])
    matrix = np.stack(rows)
    numbers, raw = _numbers_and_raw(passes, judging_paths(materials, lights), weights)
    error = np.abs(numbers @ matrix.T - raw) / (np.abs(raw) + LEAST)
    described = PassesCamera(sensor.space, matrix, float(error.mean()))
    return replace(passes, camera=described)


def _numbers_and_raw(
    passes: Passes, paths: LightPaths, weights: Array
) -> tuple[Array, Array]:
    """Numbers (n, K) of all paths under all lights, and their raw values (n, 3)."""
    light_numbers = np.stack([light.numbers for light in passes.lights])
    numbers = paths.numbers(passes.bands.weights) * light_numbers[:, None]
    spectra = paths.powers[:, None] * paths.reflected
    raw = spectra @ weights.T
    return numbers.reshape(-1, numbers.shape[-1]), raw.reshape(-1, 3)
