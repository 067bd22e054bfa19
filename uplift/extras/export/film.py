"""A cube as the table that film simulations read: a spectrum for every chromaticity.

spektrafilm, and programs after it, turn RGB into the exposure of the layers of a film
by a float16 array of shape (size, size, 81): spectra from 380 to 780 nm at 5 nm of
lights with X + Y + Z = 1 under the CIE 1931 observer, where the equal-energy light of
power 1 has Y = 1. Row i and column j, as fractions of size − 1, are the square
coordinates ((1 − x)², y / (1 − x)) of the chromaticity (x, y). A pixel has the spectrum
of its chromaticity times its X + Y + Z. The table has kind ``irradiance``, light that
reaches the film, or ``reflectance``, which readers multiply by a light of their own. A
TOML file next to it has the kind, the sizes and the illuminant of the chromaticities.

Readers adapt XYZ to the light of the film. Adapted colours are not those that
reflectances have under this light, so spectra are stored with the sum that makes the
product for a pixel the lit reflectance of the cube; it is near 1.

A chromaticity has reflectances from black to the brightest that is possible; the table
keeps one of them. Beyond the gamut of the cube, light at its edge is mixed with light
of a narrow band, and beyond such bands there is light of the band alone.

spektrafilm, `spectral_upsampling.py`: the layout of the table, and how RGB become a
chromaticity and a factor. Li et al. 2017, "Comprehensive color solutions: CAM16, CAT16,
and CAM16-UCS": the adaptation of RGB to the light, as in spektrafilm.
"""

from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.object_colours import solid
from uplift.colorimetry.observer import (
    DEFAULT_OBSERVER,
    END,
    START,
    STEP,
    grid,
    illuminant_spd,
    matching_functions,
)
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import OptionError
from uplift.common.files import atomic_write, write_text
from uplift.extras.colour.dominant import crossing
from uplift.extras.colour.srgb import decode
from uplift.extras.export.grid_table import check_res, grid_nodes
from uplift.extras.export.outputs import output_files
from uplift.extras.export.source import read_source
from uplift.extras.files.outputs import check_outputs
from uplift.lookup.cube import Cube

SIZE = 192
MAX_SIZE = 1024
SHARE = 0.4
"""Luminance of a stored reflectance, as a fraction of the largest of its chromaticity.
"""
MIDGRAY = 0.184
"""Reflectance that readers expose as medium grey."""
MARGIN = 1e-3
"""Smallest component of RGB inside the gamut of the cube, relative to that of white."""
LAYERS = np.array([450.0, 550.0, 640.0])
"""Peaks in nm of the sensitivity of layers, for the stated error."""
LAYER_WIDTH = 30.0
"""Their standard deviation in nm."""
SAMPLES = 4096
"""Random colours of the stated error, even in codes."""
SEED = 7
REACH = 10.0
"""Factor that takes RGB of a unit sum of XYZ out of the solid of reflectances."""
TINY = 1e-12
BAND = 10.0
"""Standard deviation of the narrow bands in nm."""
WEAKEST = 0.05
"""Bands at the ends of the spectrum are left out where the eye has less than this
fraction of its largest response.
"""
CAT16 = np.array(
    [
        [0.401288, 0.650173, -0.051461],
        [-0.250268, 1.204414, 0.045854],
        [-0.002079, 0.048952, 0.953127],
    ]
)


@dataclass(frozen=True)
class FilmTable:
    """How well a written table stands for the cube."""

    inside: float
    """Fraction of its points, of those that lights have, within the gamut of the cube.
    """
    stops: float
    """Mean error of exposure of random colours, from the table instead of the cube, in
    powers of 2.
    """


def export(cube: Cube, path: Path, style: str, **settings: Any) -> str:
    """Write spectra of chromaticities."""
    film = write_film(cube, path, **settings)
    return (
        f"{film.inside:.0%} of the chromaticities from the cube, mean error of "
        f"exposure {film.stops:.2g} stops"
    )


def write_film(
    cube: Cube,
    path: StrPath,
    *,
    light: Illuminant | None = None,
    res: int = SIZE,
    force: bool = False,
) -> FilmTable:
    """Write a cube as a film table of chromaticities, .npy, and the TOML file that
    describes it.

    ``light``, for the kind ``irradiance`` in place of ``reflectance``, is that of the
    cube. ``res`` are rows and columns, 2 to 1024. Raises `OptionError`, also for an
    observer other than CIE 1931, and `ColourError` for a camera.
    """
    sensor = cube.data.sensor
    sensor.require_xyz()
    if sensor.observer != DEFAULT_OBSERVER:
        raise OptionError(
            f"a film table needs the {DEFAULT_OBSERVER}, got a cube of "
            f"{sensor.observer}"
        )
    check_res(res, SIZE, MAX_SIZE)
    files = output_files(path, "film")
    check_outputs(files, force=force)
    scene = _scene(sensor, light)
    unit = _chromaticities(res)
    spectra, inside = _spectra(cube, scene, unit)
    kind = "irradiance" if light else "reflectance"
    stored = spectra if light else spectra / scene.power
    table = stored.reshape(res, res, -1).astype("<f2")
    described = _description(Path(path), scene.name, kind, res)
    with atomic_write(path, force=force) as temporary, temporary.open("wb") as file:
        np.save(file, table, allow_pickle=False)
        write_text(described, files[1], force=force)
    return FilmTable(inside, _stops(cube, scene, spectra.reshape(res, res, -1)))


@dataclass(frozen=True, eq=False)
class Scene:
    """Light that reaches the film."""

    name: str
    xyz: Array
    """(N, 3): XYZ of a power (N,) is power @ xyz."""
    power: Array
    """(N,) power with Y = 1."""
    white: Array
    """XYZ of the power, (3,)."""
    xyz_to_rgb: Array
    """Matrix to the RGB space of the cube."""


def _scene(sensor: Sensor, light: Illuminant | None) -> Scene:
    given = light or sensor.illuminant
    cmfs = matching_functions(DEFAULT_OBSERVER)
    xyz = cmfs / cmfs[:, 1].sum()
    power = illuminant_spd(given)
    power = power / (power @ xyz[:, 1])
    # The reader's RGB are adapted to the light by CAT16; the cube's have the white of
    # its illuminant.
    cones = CAT16 @ np.stack([power @ xyz, sensor.light.white], axis=1)
    adapt = np.linalg.solve(CAT16, (cones[:, 1] / cones[:, 0])[:, None] * CAT16)
    return Scene(str(given), xyz, power, power @ xyz, sensor.xyz_to_rgb @ adapt)


def _chromaticities(size: int) -> Array:
    """Return XYZ (size², 3) with X + Y + Z = 1 of the table's points, row by row."""
    first, second = grid_nodes(np.linspace(0, 1, size), 2).T
    # the inverse of ((1 − x)², y / (1 − x))
    x = 1 - np.sqrt(first)
    y = second * np.sqrt(first)
    return np.stack([x, y, 1 - x - y], axis=-1)


def _spectra(cube: Cube, scene: Scene, unit: Array) -> tuple[Array, float]:
    """Return spectra (n, N) of lights with the unit XYZ (n, 3), and the fraction of
    real ones that the cube answers.
    """
    white = scene.white / scene.white.sum()
    # white + f (c − white) leaves the gamut of the cube at f = inside, and that of
    # lights of narrow bands at f = real.
    start = scene.xyz_to_rgb @ white
    change = (unit - white) @ scene.xyz_to_rgb.T
    room = np.divide(
        (1 - MARGIN) * start,
        -change,
        out=np.full_like(change, np.inf),
        where=change < 0,
    )
    inside = room.min(axis=1)
    real, outer = _outer_lights(scene.xyz, white, unit - white)
    edge = np.minimum(np.minimum(inside, real), 1)
    rgb = start + edge[:, None] * change
    # The brightest reflectance of a direction r is t r, on the surface of the solid;
    # steps of 15 nm are enough for t.
    coarse = np.add.reduceat(
        cube.data.sensor.matrix, range(0, len(cube.data.sensor.wavelengths), 3), axis=1
    )
    brightest = REACH * solid(coarse).ray_fraction(np.zeros_like(rgb), REACH * rgb)
    rgb *= np.minimum(SHARE * brightest, 1 / rgb.max(axis=1))[:, None]
    lights = cube.reflectance(rgb, grid()) * scene.power / _reader_sum(scene, rgb)
    beyond = np.flatnonzero(edge < 1)
    far = np.maximum(real[beyond], edge[beyond] + TINY)
    mixed = ((np.minimum(1, far) - edge[beyond]) / (far - edge[beyond]))[:, None]
    lights[beyond] += mixed * (outer[beyond] - lights[beyond])
    return lights, float((inside >= 1)[real >= 1].mean())


def _outer_lights(xyz: Array, white: Array, change: Array) -> tuple[Array, Array]:
    """Return where rays from white in unit XYZ (n, 3) reach lights of narrow bands, as
    a fraction, and those lights.

    Shapes: ``xyz`` (N, 3) → (n,), (n, N). The lights are mixtures of two neighbouring
    bands, or of both ends: purples.
    """
    bands = np.exp(-0.5 * ((grid()[:, None] - grid()) / BAND) ** 2)
    sums = (bands @ xyz).sum(axis=1)
    bands = _unit_sum(bands[sums >= WEAKEST * sums.max()], xyz)
    ring = np.concatenate([bands, bands[:1]])
    edge, fraction, reach = crossing((ring @ xyz - white)[:, :2], change[:, :2])
    share = fraction[:, None]
    return reach, (1 - share) * ring[edge] + share * ring[edge + 1]


def _reader_sum(scene: Scene, rgb: Array) -> Array:
    """X + Y + Z (n, 1) that readers multiply the spectra of RGB (n, 3) by."""
    xyz = np.linalg.solve(scene.xyz_to_rgb, rgb.T).T
    return np.asarray(xyz.sum(axis=1, keepdims=True))


def _unit_sum(power: Array, xyz: Array) -> Array:
    """Scale powers (n, N) to X + Y + Z = 1."""
    return power / (power @ xyz).sum(axis=1, keepdims=True)


def _stops(cube: Cube, scene: Scene, table: Array) -> float:
    """Mean |log₂| of the ratio of exposures by the table, as readers interpolate it,
    and by the cube.
    """
    from scipy.interpolate import interpn

    rgb = decode(np.random.default_rng(SEED).random((SAMPLES, 3)))
    rgb = rgb[solid(cube.data.sensor.matrix).contains(rgb)]
    power = cube.reflectance(rgb, grid()) * scene.power
    xyz = np.linalg.solve(scene.xyz_to_rgb, rgb.T).T
    x, y, _ = (xyz / xyz.sum(axis=1, keepdims=True)).T
    layers = np.exp(-0.5 * ((grid()[:, None] - LAYERS) / LAYER_WIDTH) ** 2)
    axis = np.linspace(0, 1, len(table))
    places = np.clip([(1 - x) ** 2, y / (1 - x)], 0, 1).T
    exposure = interpn((axis, axis), table @ layers, places)
    ratio = xyz.sum(axis=1, keepdims=True) * exposure / (power @ layers)
    return float(np.abs(np.log2(ratio)).mean())


def _description(path: Path, light: str, kind: str, size: int) -> str:
    """Return the text of the TOML file; lights have no section of their reflectance."""
    text = Template(read_source("film.toml")).substitute(
        stem=path.stem,
        file=path.name,
        kind=kind,
        light=light,
        observer=DEFAULT_OBSERVER,
        size=size,
        bands=len(grid()),
        start=START,
        end=END,
        step=STEP,
        midgray=MIDGRAY,
    )
    return text if kind == "reflectance" else text.partition("\n[reflectance]")[0]
