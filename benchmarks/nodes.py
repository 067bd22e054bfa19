"""Four nodes around a colour in place of eight, for docs/accuracy.md."""

from collections.abc import Callable

import numpy as np
from PIL import Image

import uplift
from benchmarks import DOCS, Row
from benchmarks.materials import MIXTURE, SENSOR, materials
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra, lab
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import to_display_codes
from uplift.lattice.lattice import CORNERS
from uplift.lookup.cube import Cube
from uplift.models.model import reflectance

LIGHTS = ("A", "FL2", "FL11", "LED-B3", "HP1")
RAMP_LIGHT = "HP1"
"""Few narrow lines: what spectra of one colour look most different under."""
COLOURS = 4000
CUBES = {"16³": 16, "32³": 32}
PATCH = (48, 96)
"""Height and width of each gradient of the picture in 8-bit codes."""
ZOOM = 4
GAP = 8
"""Pixels between the two gradients."""


def four(cube: Cube, rgb: Array) -> Array:
    """Spectra (n, N) of linear RGB (n, 3), as the project looks them up."""
    return cube.reflectance(rgb)


def eight(cube: Cube, rgb: Array) -> Array:
    """Spectra (n, N) by trilinear weights of the eight corners of cells."""
    data = cube.data
    low, fraction, hits = data.entry_boxes.locate(rgb)
    sides = np.where(CORNERS == 1, fraction[:, None], 1 - fraction[:, None])
    weights = sides.prod(axis=-1)
    at = data.sensor.wavelengths
    nodes = reflectance(data.model, data.points.coefficients, at)
    corners = nodes[data.lattice.cell_corners(low)]
    values = (weights[:, None] @ corners)[:, 0]
    return hits.mix(values, data.atlas.spectra.reflectance(hits.entry, at))


LOOKUPS: dict[str, Callable[[Cube, Array], Array]] = {"four": four, "eight": eight}


def measure_errors() -> list[Row]:
    """Mean ΔE00 of the materials of all shipped sets, which the cubes do not know."""
    known = materials(MIXTURE)
    rows = []
    for name, dim in CUBES.items():
        cube = uplift.build(dim=dim)
        for nodes, lookup in LOOKUPS.items():
            spectra = lookup(cube, known.rgb)
            errors = {
                light: delta_e_spectra(observer.light(light), spectra, known.measured)
                for light in LIGHTS
            }
            rows += [
                {
                    "cube": name,
                    "nodes": nodes,
                    "light": light,
                    "mean": float(each.mean()),
                }
                for light, each in errors.items()
            ]
    return rows


def measure_ramps() -> list[Row]:
    """Chroma that greys get under another light, and the steps of 8-bit codes."""
    light = observer.light(RAMP_LIGHT)
    greys = SENSOR.decode(np.repeat(np.arange(256.0)[:, None], 3, axis=1))
    codes = np.random.default_rng(0).integers(0, 255, (COLOURS, 3)).astype(float)
    step = np.eye(3)[np.arange(COLOURS) % 3]
    rows = []
    for name, dim in CUBES.items():
        cube = uplift.build(dim=dim)
        for nodes, lookup in LOOKUPS.items():
            xyz = lookup(cube, greys) @ light.xyz.T / light.white
            chroma = np.hypot(*lab(xyz, np.ones(3)).T[1:])
            before, after = (
                lookup(cube, SENSOR.decode(ends)) for ends in (codes, codes + step)
            )
            steps = delta_e_spectra(light, before, after)
            rows.append(
                {
                    "cube": name,
                    "nodes": nodes,
                    "grey_chroma": float(chroma.mean()),
                    "step_p95": float(np.quantile(steps, 0.95)),
                }
            )
    return rows


def draw_gradients() -> None:
    """Draw a gradient under the light of ramps by eight and by four nodes, without
    filtering at 400 %.
    """
    cube = uplift.load()
    light = observer.light(RAMP_LIGHT)
    height, width = PATCH
    down, across = np.meshgrid(np.arange(height), np.arange(width), indexing="ij")
    codes = np.stack([120 + across, 130 + down, 180 - across], axis=-1).reshape(-1, 3)
    rgb = SENSOR.decode(codes.astype(float))
    gradients = [
        _displayed(lookup(cube, rgb) @ light.xyz.T) for lookup in (eight, four)
    ]
    shown = [gradient.reshape(height, width, 3) for gradient in gradients]
    gap = np.full((height, GAP // ZOOM, 3), 255, np.uint8)
    picture = np.concatenate([shown[0], gap, shown[1]], axis=1)
    folder = DOCS / "accuracy"
    folder.mkdir(exist_ok=True)
    enlarged = picture.repeat(ZOOM, axis=0).repeat(ZOOM, axis=1)
    Image.fromarray(enlarged).save(folder / "nodes.png", optimize=True)


def _displayed(xyz: Array) -> Array:
    """8-bit sRGB (n, 3), with the white of the light as that of the display."""
    light = observer.light(RAMP_LIGHT)
    rgb = xyz / light.white * SENSOR.light.white @ SENSOR.xyz_to_rgb.T
    return to_display_codes(np.clip(rgb, 0, 1), SENSOR).astype(np.uint8)


QUESTIONS = {
    "errors": measure_errors,
    "ramps": measure_ramps,
    "picture": draw_gradients,
}
