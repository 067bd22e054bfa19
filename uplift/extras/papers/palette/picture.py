"""Pictures of materials: amounts of each in each pixel, from a file or of an opened
ball.

The ball has the materials as layers, above a bead of each. The first material is a
translucent skin around the others. Layers of equal colour merge until a light separates
them: none has an outline or a highlight.
"""

import re
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, StrPath, Values
from uplift.common.errors import OptionError, TextureError, unknown_name
from uplift.common.text import pluralise
from uplift.extras.images.channels import colour_channels
from uplift.extras.images.image import Part, open_image

Weights = NDArray[np.float32]

MAX_PIXELS = 1 << 20  # pixels that a page can light in real time
MAX_LISTED = 4  # unknown colours that an error lists
SIZE = 512  # pixels along each side
SKIN = 0.93  # radius of the layers below the skin, relative to the skin
CORE = 1.6  # thickness of the innermost layer in layers
DEPTH = 0.13  # optical depth of the skin at normal incidence
BALL = (0.0, 0.2)  # centre of the ball in a square of ±1
RADIUS = 0.74  # of the ball
# Height of the row of beads, largest radius, width of the row, and largest distance
# between beads.
BEADS = -0.79
BEAD = 0.135
SPAN = 1.76
STEP = 0.42
AMBIENT = 0.22
# Directions of two lights (x right, y up, z to the viewer), and their strengths.
KEY = (np.array([-0.55, 0.57, 0.61]), 0.68)
FILL = (np.array([0.75, 0.05, 0.66]), 0.22)
YAW, PITCH = np.radians(
    [40, 27]
)  # rotation of the removed octant x, y, z > 0 towards the viewer
# width of the darkening along inner edges of the cut, relative to the radius
CORNER = 0.16
OFFSETS = (-0.25, 0.25)  # subpixel positions, four samples per pixel


def cutaway(count: int, size: int = SIZE) -> Weights:
    """Render the opened ball of ``count`` materials: amounts (size, size, count) in [0,
    1].
    """
    weights = np.zeros((size, size, count), dtype=np.float32)
    steps = (np.arange(size) + 0.5) * 2 / size - 1
    for dx in OFFSETS:
        for dy in OFFSETS:
            _add_samples(weights, steps + dx * 2 / size, -steps - dy * 2 / size)
    return weights / np.float32(len(OFFSETS) ** 2)


def _add_samples(weights: Weights, x: Array, y: Array) -> None:
    count = weights.shape[2]
    first = min(1, count - 1)  # the skin, if there is more than one material
    if first:
        rows, columns, points = _intersect_sphere(x, y, BALL, RADIUS)
        weights[rows, columns, 0] += _opacity(points[:, 2]) * _shade(points)
    step = min(SPAN / count, STEP)
    for number in range(count):
        centre = (step * (number - (count - 1) / 2), BEADS)
        rows, columns, points = _intersect_sphere(x, y, centre, min(BEAD, STEP * step))
        weights[rows, columns, number] += _shade(points)
    # All other materials from the outside in, attenuated by the skin.
    rows, columns, points = _intersect_sphere(x, y, BALL, RADIUS * SKIN)
    met, points, normals, is_cut = _intersect_opened(points)
    depth = (1 - np.linalg.norm(points, axis=1)) * (count - first - 1 + CORE)
    layer = np.clip(np.floor(depth + 1e-9).astype(int), 0, count - first - 1)
    # Darker where walls of the cut meet: 1 is the wall itself.
    dark = np.exp(-np.maximum(points, 0) / CORNER).sum(axis=1) - 1
    shade = _shade(normals) * np.where(is_cut, 1 - 0.3 * np.clip(dark, 0, 2), 1)
    if first:
        dx = x[columns[met]] - BALL[0]
        dy = y[rows[met]] - BALL[1]
        shade *= 1 - _opacity(np.sqrt(RADIUS**2 - dx**2 - dy**2) / RADIUS)
    weights[rows[met], columns[met], first + layer] += shade


def _opacity(cosine: Array) -> Array:
    """Return the opacity of the skin at the cosine of an angle of incidence."""
    return 1 - np.exp(-DEPTH / np.maximum(cosine, 0.12))


def _intersect_sphere(
    x: Array, y: Array, centre: tuple[float, float], radius: float
) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """Return rows and columns (k,) of the samples on a sphere, and its normals (k, 3)
    there.
    """
    dx = (x - centre[0]) / radius
    dy = (y - centre[1]) / radius
    square = 1 - dx**2 - dy[:, None] ** 2
    rows, columns = np.nonzero(square > 0)
    normals = [dx[columns], dy[rows], np.sqrt(square[rows, columns])]
    return rows, columns, np.stack(normals, axis=1)


def _intersect_opened(
    points: Array,
) -> tuple[NDArray[np.bool_], Array, Array, NDArray[np.bool_]]:
    """Intersect the sphere without its octant. Rays that enter there reach a wall, or
    leave it (mask False).

    For the other rays, return positions in radii from the centre, normals, and whether
    they lie on the cut.
    """
    axes = cut_axes()
    rotated = points @ axes
    direction = axes[2]
    cut = np.asarray((rotated > 0).all(axis=1))
    steps = rotated / direction
    wall_point = rotated - steps.min(axis=1, keepdims=True) * direction
    met = ~cut | ((wall_point**2).sum(axis=1) < 1)
    normals = np.where(cut[:, None], axes[:, steps.argmin(axis=1)].T, points)
    return met, np.where(cut[:, None], wall_point, rotated)[met], normals[met], cut[met]


def cut_axes() -> Array:
    """Return the rotation (3, 3) whose rows are right, up and to the viewer in the axes
    of the cut.
    """
    a = np.cos(YAW)
    b = np.sin(YAW)
    c = np.cos(PITCH)
    d = np.sin(PITCH)
    return np.array([[a, 0, -b], [-d * b, c, -d * a], [c * b, d, c * a]])


def _shade(normals: Array) -> Array:
    """Return the brightness of a matt surface, at most 1."""
    key, fill = (
        power * np.maximum(normals @ (direction / np.linalg.norm(direction)), 0)
        for direction, power in (KEY, FILL)
    )
    return np.minimum(AMBIENT + key + fill, 1)


def read_weights(
    path: StrPath, names: Sequence[str], labels: Mapping[str, str] | None = None
) -> Weights:
    """Read the amounts (H, W, n) of n materials in each pixel of an image.

    Float channels are weights by name. In an 8-bit image each colour is a label of a
    material, by default the greys 1, 2, …, and alpha is its weight. Black that is not a
    label has weight 0.
    """
    greys = {0x10101 * (row + 1): row for row in range(min(len(names), 255))}
    codes = greys if labels is None else _parse_labels(names, labels)
    with open_image(path) as image:
        part = image.parts[0]
        width = part.window.width
        height = part.window.height
        if width * height > MAX_PIXELS:
            problem = (
                f"image must have at most {MAX_PIXELS:,} pixels, got {width} × {height}"
            )
            raise TextureError(problem, hint="scale it down without interpolation")
        values = np.concatenate([band for _, band in image.bands(part)])
        if part.max_code:
            return _weights_of_labels(part, values, codes, len(names))
        return _weights_of_channels(part, values, names)


def _parse_labels(names: Sequence[str], labels: Mapping[str, str]) -> dict[int, int]:
    """Return the index of the material by 24-bit colour."""
    codes = dict[int, int]()
    for name, label in labels.items():
        if name not in names:
            raise unknown_name(name, names, "material")
        if not re.fullmatch("#[0-9a-fA-F]{6}", label):
            text = f"label of '{name}' must be #rrggbb, got '{label}'"
            raise OptionError(text, hint="write six hexadecimal digits")
        code = int(label[1:], 16)
        if code in codes:
            text = f"labels must be distinct, got '{label}' for two materials"
            raise OptionError(text, hint="give each material its own colour")
        codes[code] = list(names).index(name)
    return codes


def _weights_of_labels(
    part: Part, values: Values, codes: Mapping[int, int], count: int
) -> Weights:
    channels = colour_channels(part)
    if channels is None or part.max_code != 255:
        raise TextureError(
            "an image of labels must have 8-bit colours",
            hint="convert it to an 8-bit PNG",
        )
    red, green, blue = (
        values[..., channel].astype(np.int32) for channel in channels.rgb
    )
    pixels = (red << 16) | (green << 8) | blue
    alpha = (
        values[..., part.channels.index("A")] / 255
        if "A" in part.channels
        else np.ones(pixels.shape)
    )
    alpha = np.where((pixels == 0) & (0 not in codes), 0, alpha)
    colours, counts = np.unique(pixels[alpha > 0], return_counts=True)
    unknown = ~np.isin(colours, list(codes))
    if unknown.any():
        frequent = colours[unknown][counts[unknown].argsort()[::-1][:MAX_LISTED]]
        listed = ", ".join(f"#{code:06x}" for code in frequent)
        more = ", …" if unknown.sum() > MAX_LISTED else ""
        raise TextureError(
            "every colour must be a label, got "
            f"{pluralise(counts[unknown].sum(), 'pixel')} of {listed}{more}",
            hint="give each colour a label, and draw without antialiasing",
        )
    weights = np.zeros((*pixels.shape, count), dtype=np.float32)
    for code, row in codes.items():
        weights[..., row] = np.where(pixels == code, alpha, 0)
    return weights


def _weights_of_channels(part: Part, values: Values, names: Sequence[str]) -> Weights:
    present = [row for row, name in enumerate(names) if name in part.channels]
    if not present:
        raise TextureError(
            "an image of weights must have a channel named after a material "
            f"({', '.join(names)})",
            hint="rename its channels, or use an 8-bit image of labels",
        )
    weights = np.zeros((*values.shape[:2], len(names)), dtype=np.float32)
    for row in present:
        weights[..., row] = values[..., part.channels.index(names[row])]
    if not (np.isfinite(weights).all() and weights.min() >= 0):
        raise TextureError(
            "weights must be finite and not negative", hint="correct the image"
        )
    return weights
