"""Pictures of the relighting viewer in Chromium, for docs/palette.md, and a scan to
relight.

``python -m benchmarks.palette_dial engine.exr`` writes the weights of a synthetic
computer tomogram of an engine, for ``uplift palette engine.toml --html engine.html
--image engine.exr``.

After Bergner, Möller & Drew 2004, 5.1, whose scan of an engine is not free. The scan
has the densities of its parts, blurred and noisy as a scanner's. A transfer function
assigns each density to a material of engine.toml, and rays accumulate the materials
from the eye on, as a volume renderer does. The picture is without light.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenEXR
from matplotlib.image import imsave
from scipy.ndimage import affine_transform, gaussian_filter

from benchmarks import DOCS
from benchmarks.browser import browser
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import encode
from uplift.extras.palette import design, read_palette, standard_model
from uplift.extras.palette.picture import cutaway
from uplift.extras.palette.relight_page import page, relighting
from uplift.samples import sample_path

FOLDER = DOCS / "palette-dial"
WINDOW, BALL = (1240, 1440), 512
"""Pixels of the window, and of the picture of a ball along each side."""
VOXELS, SIDE = 160, 360
"""Voxels of the scan and pixels of its image along each side."""
DENSITIES = {"haze": 0.15, "block": 0.45, "piston": 0.7, "valve": 0.95}
"""Density of each material of engine.toml; air has 0."""
OPACITIES = {"haze": 0.003, "block": 0.5, "piston": 0.5, "valve": 0.5}
"""Share of light that a voxel of a material absorbs."""
WIDTH = 0.11
"""Distance from the density of a material at which a voxel no longer belongs to it."""
BLUR, NOISE = 0.7, 0.012
"""Blur in voxels and standard deviation of the noise of the scanner."""
EDGE = 0.05
"""Gradient per voxel at which half of a voxel counts as boundary, whose density is that
of no material.
"""
SMOOTHING = 0.01
"""Blur of the normals, in widths of the scan."""
YAW, PITCH = np.radians([-35, 28])
LIGHT = np.array([-0.5, 0.6, 0.62])
AMBIENT = 0.25
EXPOSURE = 1.5
BORES = (-0.48, 0.0, 0.48)


def main() -> None:
    """Write the weights of the scan, or the pictures of the page."""
    weights = cast(scan())
    if len(sys.argv) > 1:
        write_weights(weights, Path(sys.argv[1]))
        return
    palette = read_palette(sample_path("engine.toml"))
    designed = design(palette, standard_model(palette.sensor, palette.count))
    order = [list(DENSITIES).index(material.name) for material in palette.materials]
    view = relighting("engine", designed, weights[..., order])
    lights = np.eye(len(view.lights))
    row = np.concatenate(
        [encode(np.clip(EXPOSURE * view.rgb(one), 0, 1)) for one in lights], axis=1
    )
    imsave(FOLDER / "scan.jpg", row, pil_kwargs={"quality": 88})
    ball = relighting("engine", designed, cutaway(len(palette.materials), BALL))
    with tempfile.TemporaryDirectory() as folder, browser() as tab:
        path = Path(folder) / "page.html"
        path.write_text(page(ball), encoding="utf-8")
        tab.window(*WINDOW)
        tab.open(path)

        def press(key: str) -> None:
            event = f"new KeyboardEvent('keydown', {{key: '{key}'}})"
            tab.evaluate(f"document.getElementById('dial').dispatchEvent({event})")

        for number, name in enumerate(ball.lights, start=1):
            press(str(number))
            tab.canvas("picture")
            (FOLDER / f"{name}.jpg").write_bytes(tab.screenshot(".view", scale=0.5))
        press("2")
        for _ in range(15):
            press("ArrowLeft")
        tab.canvas("picture")
        (FOLDER / "page.jpg").write_bytes(tab.screenshot())


def write_weights(weights: Array, path: Path) -> None:
    """Write an OpenEXR file with a channel for each material."""
    channels = {
        name: np.ascontiguousarray(weights[..., row])
        for row, name in enumerate(DENSITIES)
    }
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, channels).write(str(path))


def scan(voxels: int = VOXELS) -> Array:
    """Return the densities (n, n, n) over x right, y up and z to the viewer, from −1 to
    1.
    """
    axis = (np.arange(voxels) + 0.5) * 2 / voxels - 1
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij", sparse=True)
    density = np.zeros((voxels,) * 3)
    density[(x / 0.98) ** 2 + (y / 0.85) ** 2 + (z / 0.72) ** 2 < 1] = DENSITIES["haze"]
    opened = (y > -0.05) & (z > 0.04)
    bores = [(x - at) ** 2 + z**2 for at in BORES]
    hollow = np.logical_or.reduce([(one < 0.19**2) & (y > -0.3) for one in bores])
    density[(abs(x) < 0.74) & (abs(y) < 0.42) & (abs(z) < 0.36) & ~hollow & ~opened] = (
        DENSITIES["block"]
    )
    for one, height in zip(bores, (0.08, -0.16, 0.2), strict=True):
        head = (one < 0.165**2) & (abs(y - height) < 0.11)
        rod = (one < 0.06**2) & (y < height) & (y > -0.62)
        density[head | rod] = DENSITIES["piston"]
        disc = (one < 0.14**2) & (abs(y - 0.45) < 0.03)
        stem = (one < 0.045**2) & (y > 0.45) & (y < 0.72)
        density[disc | stem] = DENSITIES["valve"]
    noise = np.random.default_rng(0).normal(0, NOISE, density.shape)
    return np.asarray(gaussian_filter(density, BLUR) + noise, dtype=np.float32)


def cast(density: Array, side: int = SIDE) -> Array:
    """Cast parallel rays through densities (n, n, n); return the amount (side, side, 4)
    of each material.
    """
    turned = _turn(density, side)
    smooth = gaussian_filter(turned, SMOOTHING * side)
    weights = np.zeros((side, side, len(DENSITIES)), dtype=np.float32)
    passed = np.ones((side, side))
    for depth in range(side - 2, 0, -1):
        shade, inside = _surface(
            smooth[:, :, depth - 1 : depth + 2], side / len(density)
        )
        opacities = (
            _opacities(turned[:, :, depth]) * (inside * len(density) / side)[..., None]
        )
        weights += (passed * shade)[..., None] * opacities
        passed *= 1 - np.minimum(opacities.sum(axis=-1), 1)
    return np.asarray(weights.transpose(1, 0, 2)[::-1])


def _opacities(layer: Array) -> Array:
    """Transfer function: opacity (side, side, 4) per voxel of each material, of
    densities (side, side).
    """
    return np.stack(
        [
            OPACITIES[name] * np.sqrt(np.maximum(1 - abs(layer - level) / WIDTH, 0))
            for name, level in DENSITIES.items()
        ],
        axis=-1,
    )


def _surface(slab: Array, magnification: float) -> tuple[Array, Array]:
    """Return the shading, and how little a boundary each sample of the middle of three
    layers is.
    """
    slopes = (*np.gradient(slab[:, :, 1]), (slab[:, :, 2] - slab[:, :, 0]) / 2)
    steep = np.sqrt(sum(slope**2 for slope in slopes)) + np.finfo(np.float32).tiny
    light = LIGHT / np.linalg.norm(LIGHT)
    facing = (
        -sum(part * slope for part, slope in zip(light, slopes, strict=True)) / steep
    )
    return AMBIENT + (1 - AMBIENT) * np.maximum(facing, 0), 1 / (
        1 + (steep * magnification / EDGE) ** 2
    )


def _turn(density: Array, side: int) -> Array:
    """Resample densities (n, n, n) to a grid (side, side, side) turned towards the
    viewer.
    """
    (a, b), (c, d) = (np.cos(YAW), np.sin(YAW)), (np.cos(PITCH), np.sin(PITCH))
    yaw = np.array([[a, 0, b], [0, 1, 0], [-b, 0, a]])
    pitch = np.array([[1, 0, 0], [0, c, -d], [0, d, c]])
    matrix = (pitch @ yaw).T * (len(density) / side)
    middle = (np.array([side] * 3) - 1) / 2
    offset = (len(density) - 1) / 2 - matrix @ middle
    return np.asarray(affine_transform(density, matrix, offset, (side,) * 3, order=1))


if __name__ == "__main__":
    main()
