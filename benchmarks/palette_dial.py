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
from scipy.spatial.transform import Rotation

from benchmarks import DOCS
from benchmarks.browser import browser
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import encode
from uplift.extras.palette import design, read_palette, standard_model
from uplift.extras.palette.picture import cutaway
from uplift.extras.palette.relight_page import page, relighting
from uplift.samples import sample_path

FOLDER = DOCS / "palette-dial"
WINDOW = (1240, 1440)
"""Pixels of the window."""
BALL = 512
"""Pixels of the picture of a ball along each side."""
DENSITIES = {"haze": 0.15, "block": 0.45, "piston": 0.7, "valve": 0.95}
"""Density of each material of engine.toml; air has 0."""
OPACITIES = {"haze": 0.003, "block": 0.5, "piston": 0.5, "valve": 0.5}
"""Share of light that a voxel of a material absorbs."""
WIDTH = 0.11
"""Distance from the density of a material at which a voxel no longer belongs to it."""
BLUR = 0.7
"""Blur of the scanner in voxels."""
NOISE = 0.012
"""Standard deviation of its noise."""
EDGE = 0.05
"""Gradient per voxel at which half of a voxel counts as boundary, of no material."""
TURN = (35, -28)
"""Degrees about the vertical and the horizontal axis."""
LIGHT = np.array([-0.5, 0.6, 0.62])
AMBIENT = 0.25
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
    lit = np.concatenate(list(map(view.rgb, np.eye(len(view.lights)))), axis=1)
    row = encode(np.clip(1.5 * lit, 0, 1))
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


def scan(voxels: int = 160) -> Array:
    """Return the densities (n, n, n) over x right, y up, z to the viewer in [−1, 1]."""
    axis = (np.arange(voxels) + 0.5) * 2 / voxels - 1
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij", sparse=True)
    density = np.zeros((voxels,) * 3)
    density[(x / 0.98) ** 2 + (y / 0.85) ** 2 + (z / 0.72) ** 2 < 1] = DENSITIES["haze"]
    opened = (y > -0.05) & (z > 0.04)
    bores = [(x - at) ** 2 + z**2 for at in BORES]  # squared distances from their axes
    hollow = (np.minimum.reduce(bores) < 0.19**2) & (y > -0.3)
    block = (abs(x) < 0.74) & (abs(y) < 0.42) & (abs(z) < 0.36)
    density[block & ~hollow & ~opened] = DENSITIES["block"]
    for bore, height in zip(bores, (0.08, -0.16, 0.2), strict=True):
        head = (bore < 0.165**2) & (abs(y - height) < 0.11)
        rod = (bore < 0.06**2) & (y < height) & (y > -0.62)
        density[head | rod] = DENSITIES["piston"]
        disc = (bore < 0.14**2) & (abs(y - 0.45) < 0.03)
        stem = (bore < 0.045**2) & (y > 0.45) & (y < 0.72)
        density[disc | stem] = DENSITIES["valve"]
    noise = np.random.default_rng(0).normal(0, NOISE, density.shape)
    return np.asarray(gaussian_filter(density, BLUR) + noise, dtype=np.float32)


def cast(density: Array, side: int = 360) -> Array:
    """Cast parallel rays through densities (n, n, n): the materials' amounts (side,
    side, 4).
    """
    turned = _turn(density, side)
    smooth = gaussian_filter(turned, 0.01 * side)
    weights = np.zeros((side, side, len(DENSITIES)), dtype=np.float32)
    passed = np.ones((side, side))
    for depth in range(side - 2, 0, -1):
        slab = smooth[:, :, depth - 1 : depth + 2]
        shade, inside = _surface(slab, side / len(density))
        thickness = inside * len(density) / side
        opacities = _opacities(turned[:, :, depth]) * thickness[..., None]
        weights += (passed * shade)[..., None] * opacities
        passed *= 1 - np.minimum(opacities.sum(axis=-1), 1)
    return weights.transpose(1, 0, 2)[::-1]


def _opacities(layer: Array) -> Array:
    """Transfer function: opacity per voxel (side, side, 4) of densities."""
    distance = abs(layer[..., None] - np.float32([*DENSITIES.values()])) / WIDTH
    return np.float32([*OPACITIES.values()]) * np.sqrt(np.maximum(1 - distance, 0))


def _surface(slab: Array, magnification: float) -> tuple[Array, Array]:
    """Return the shading of the middle of three layers, and the share that is no
    boundary.
    """
    slopes = (*np.gradient(slab[:, :, 1]), (slab[:, :, 2] - slab[:, :, 0]) / 2)
    steep = np.sqrt(sum(slope**2 for slope in slopes)) + np.finfo(np.float32).tiny
    light = LIGHT / np.linalg.norm(LIGHT)
    facing = -sum(map(np.multiply, light, slopes)) / steep
    shade = AMBIENT + (1 - AMBIENT) * np.maximum(facing, 0)
    return shade, 1 / (1 + (steep * magnification / EDGE) ** 2)


def _turn(density: Array, side: int) -> Array:
    """Resample densities (n, n, n) to a grid (side, side, side) turned towards the
    viewer.
    """
    turn = Rotation.from_euler("YX", TURN, degrees=True).as_matrix()
    matrix = turn * (len(density) / side)
    middle = np.full(3, (side - 1) / 2)
    offset = (len(density) - 1) / 2 - matrix @ middle
    return affine_transform(density, matrix, offset, (side,) * 3, order=1)


if __name__ == "__main__":
    main()
