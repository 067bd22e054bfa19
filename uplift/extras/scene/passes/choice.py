"""Choice of the bands of passes for materials and lights, and the errors on materials
that the choice does not use.
"""

from collections.abc import Sequence

import numpy as np

from uplift.colorimetry import observer, tables
from uplift.colorimetry.illuminants import Illuminant
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.machine import single_threaded_blas
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.extras.scene.passes.bands import CHANNELS, MAX_PASSES, MAX_WIDTH, Bands
from uplift.extras.scene.passes.decoding import Grams, light_projection
from uplift.extras.scene.passes.light_paths import LightPaths, draw_paths
from uplift.extras.scene.passes.materials import Materials
from uplift.extras.scene.passes.passes import (
    Passes,
    PassesLight,
    power_digest,
    scaled_power,
)
from uplift.extras.scene.passes.search import FLOOR, Search, band_powers

TRAINING_PATHS = 300
"""Paths of each number of bounces that bands are chosen by."""
DIRECT_PATHS = 120
"""Paths without a surface among them, which keep white neutral."""
JUDGING_PATHS = 400
"""Paths of each number of bounces over held-out materials."""
TRAINING_SEED = 1
JUDGING_SEED = 2
FINAL_ROUNDS = 80
"""Rounds of the fit of the chosen bands."""


@single_threaded_blas()
def choose(
    materials: Materials,
    lights: Sequence[Illuminant],
    count: int = 2,
    *,
    width: int | None = None,
    progress: ProgressCallback = ignore_progress,
) -> Passes:
    """Choose the bands of passes for materials and lights.

    Parameters
    ----------
    materials : Materials
        Materials of the scene, or those of the library.
    lights : sequence of str or Lamp
        At least one light. They may be mixed in a scene.
    count : int
        Number of passes, 1 to 4.
    width : int, optional
        Standard deviation of the bands in nm; 0 for points. By default it is searched.
    progress : callable
        Receives a `Progress` of stage ``starts``.

    Returns
    -------
    Passes
        The same on every machine, up to rounding.

    Raises
    ------
    OptionError
        A value is out of range, ``lights`` is empty, or two lights have one name.
    UnknownNameError
        A light is unknown.
    """
    if not 1 <= count <= MAX_PASSES:
        raise OptionError(f"count must be in [1, {MAX_PASSES}], got {count}")
    if width is not None and not 0 <= width <= MAX_WIDTH:
        raise OptionError(f"width must be in [0, {MAX_WIDTH:g}], got {width}")
    paths = training_paths(materials, lights)
    bands = Search(paths, width).best(CHANNELS * count, progress).bands
    return _fit(bands, paths, materials, lights)


@single_threaded_blas()
def fit_bands(
    bands: Bands, materials: Materials, lights: Sequence[Illuminant]
) -> Passes:
    """Fit the matrices and the numbers of lights to given bands.

    Parameters
    ----------
    bands : Bands
        Bands of one to four passes.
    materials : Materials
        Materials of the scene, or those of the library.
    lights : sequence of str or Lamp
        At least one light.

    Returns
    -------
    Passes

    Raises
    ------
    OptionError
        ``lights`` is empty, or two lights have one name.
    UnknownNameError
        A light is unknown.
    """
    return _fit(bands, training_paths(materials, lights), materials, lights)


def training_paths(materials: Materials, lights: Sequence[Illuminant]) -> LightPaths:
    """Draw the paths that bands and matrices are fitted to."""
    if not lights:
        raise OptionError(
            "lights must not be empty", hint="name at least one, such as D65"
        )
    observer.check_distinct(lights)
    powers = [scaled_power(light) for light in dict.fromkeys(lights)]
    return draw_paths(
        materials.training,
        np.stack(powers),
        TRAINING_PATHS,
        TRAINING_SEED,
        direct=DIRECT_PATHS,
    )


def judging_paths(materials: Materials, lights: Sequence[Illuminant]) -> LightPaths:
    """Draw the paths over held-out materials that judge passes."""
    powers = np.stack([scaled_power(light) for light in dict.fromkeys(lights)])
    return draw_paths(materials.held_out, powers, JUDGING_PATHS, JUDGING_SEED)


def _fit(
    bands: Bands,
    paths: LightPaths,
    materials: Materials,
    lights: Sequence[Illuminant],
) -> Passes:
    """Fit matrices and numbers over paths, and judge them over held-out materials."""
    start = band_powers(bands, paths.powers)
    numbers = paths.numbers(bands.weights)
    grams = Grams.of(paths, numbers)
    to_xyz, light_numbers, _ = grams.alternate(start, FLOOR * start, FINAL_ROUNDS)
    projection = light_projection(paths, numbers, to_xyz)
    # D diag(c) and l / c decode alike: c makes the numbers of equal energy ones.
    luminance = observer.matching_functions()[:, 1]
    equal_energy = np.full(len(luminance), 1 / luminance.sum())
    scale = projection @ equal_energy
    scale = np.where(scale > 0, scale, 1.0)
    to_xyz = to_xyz * scale
    light_numbers = light_numbers / scale
    projection = projection / scale[:, None]
    own = grams.decodings(light_numbers)
    judged = judging_paths(materials, lights)
    errors, own_errors = (
        judged.by_bounce(judged.decoding_errors(bands.weights, light_numbers, matrix))
        for matrix in (to_xyz, own)
    )
    described = []
    for row, light in enumerate(dict.fromkeys(lights)):
        described.append(
            PassesLight(
                name=tables.stated_name("illuminant", light),
                digest=power_digest(paths.powers[row]),
                numbers=light_numbers[row],
                to_xyz=own[row],
                errors=errors[row],
                own_errors=own_errors[row],
            )
        )
    origin = {
        **materials.origin,
        "training": len(materials.training),
        "held-out": len(materials.held_out),
    }
    return Passes(bands, to_xyz, tuple(described), projection, origin)


def path_errors(
    passes: Passes, materials: Materials, lights: Sequence[Illuminant]
) -> Array:
    """Compute the errors of the shared matrix on the paths that judge passes.

    Parameters
    ----------
    passes : Passes
        Passes that are fitted to the lights.
    materials : Materials
        Materials of the scene, or those of the library.
    lights : sequence of str or Lamp
        L lights of the passes, in their order.

    Returns
    -------
    ndarray, shape (L, n)
        ΔE00 of one to four bounces over held-out materials.
    """
    judged = judging_paths(materials, lights)
    numbers = np.stack([light.numbers for light in passes.lights])
    return judged.decoding_errors(passes.bands.weights, numbers, passes.to_xyz)


def rgb_errors(materials: Materials, lights: Sequence[Illuminant]) -> Array:
    """Compute the errors of plain RGB rendering on the paths that judge passes.

    Surfaces are linear sRGB under D65, limited to [0, 1], lights the linear sRGB of
    their colour.

    Parameters
    ----------
    materials : Materials
        Materials of the scene, or those of the library.
    lights : sequence of str or Lamp
        L lights.

    Returns
    -------
    ndarray, shape (L, 4)
        Mean ΔE00 of one to four bounces.
    """
    judged = judging_paths(materials, lights)
    screen = observer.sensor()
    reflected = judged.numbers(screen.matrix)
    light_rgb = judged.whites @ screen.xyz_to_rgb.T
    lit = reflected * light_rgb
    return judged.by_bounce(judged.errors(lit @ screen.rgb_to_xyz.T))
