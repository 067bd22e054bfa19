"""Pictures from files: an 8-bit image of labels, or a float image with a channel of weights per material."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import StrPath
from uplift.common.errors import OptionError, TextureError, unknown_name
from uplift.io.texture.channels import colour_channels
from uplift.io.texture.image import Part, Values, open_image

MAX_PIXELS = 1 << 20
"""Pixels that a page can light in real time."""
MAX_LISTED = 4
"""Unknown colours that an error lists."""

Weights = NDArray[np.float32]


def read_weights(path: StrPath, names: Sequence[str], labels: Mapping[str, str] | None = None) -> Weights:
    """Read the amount of each material in each pixel of an image.

    Float channels are the weights of the materials that they are named after. In an 8-bit image each colour is the
    label of a material, and alpha is its weight. Black that is not a label has weight 0.

    Parameters
    ----------
    path : path-like
        The image.
    names : sequence of str
        Names of the n materials.
    labels : mapping, optional
        Colours ``#rrggbb`` by name of the material. The default is the greys 1, 2, … in the order of the names.

    Returns
    -------
    ndarray, shape (H, W, n)
        Weights in single precision.

    Raises
    ------
    TextureError
        If the image cannot be read, is too large, or is neither an image of labels nor one of weights.
    OptionError, UnknownNameError
        If labels are invalid.
    """
    codes = _grey_codes(names) if labels is None else _parse_labels(names, labels)
    with open_image(path) as image:
        part = image.parts[0]
        width, height = part.window.width, part.window.height
        if width * height > MAX_PIXELS:
            raise TextureError(
                f"image must have at most {MAX_PIXELS:,} pixels, got {width} × {height}",
                code="image-too-large",
                path=path,
                hint="scale it down without interpolation",
            )
        values = np.concatenate([band for _, band in image.bands(part)])
    if part.max_code:
        return _weights_of_labels(path, part, values, codes, len(names))
    return _weights_of_channels(path, part, values, names)


def _grey_codes(names: Sequence[str]) -> dict[int, int]:
    """Index of the material by 24-bit colour: greys in order."""
    return {0x10101 * (row + 1): row for row in range(min(len(names), 255))}


def _parse_labels(names: Sequence[str], labels: Mapping[str, str]) -> dict[int, int]:
    """Index of the material by 24-bit colour."""
    codes: dict[int, int] = {}
    for name, label in labels.items():
        if name not in names:
            raise unknown_name(name, names, "material")
        if not re.fullmatch("#[0-9a-fA-F]{6}", label):
            text = f"label of '{name}' must be #rrggbb, got '{label}'"
            raise OptionError(text, code="invalid-colour", hint="write six hexadecimal digits")
        code = int(label[1:], 16)
        if code in codes:
            text = f"labels must be distinct, got '{label}' for two materials"
            raise OptionError(text, code="duplicate-label", hint="give each material its own colour")
        codes[code] = list(names).index(name)
    return codes


def _weights_of_labels(path: StrPath, part: Part, values: Values, codes: Mapping[int, int], count: int) -> Weights:
    channels = colour_channels(part)
    if channels is None or part.max_code != 255:
        text = "an image of labels must have 8-bit colours"
        raise TextureError(text, code="not-a-label-image", path=path, hint="convert it to an 8-bit PNG")
    red, green, blue = (values[..., channel].astype(np.int32) for channel in channels.rgb)
    pixels = (red << 16) | (green << 8) | blue
    alpha = values[..., part.channels.index("A")] / 255 if "A" in part.channels else np.ones(pixels.shape)
    alpha = np.where((pixels == 0) & (0 not in codes), 0, alpha)
    _check_labels(path, pixels[alpha > 0], codes)
    weights = np.zeros((*pixels.shape, count), dtype=np.float32)
    for code, row in codes.items():
        weights[..., row] = np.where(pixels == code, alpha, 0)
    return weights


def _check_labels(path: StrPath, pixels: NDArray[np.int32], codes: Mapping[int, int]) -> None:
    colours, counts = np.unique(pixels, return_counts=True)
    unknown = ~np.isin(colours, list(codes))
    if not unknown.any():
        return
    frequent = colours[unknown][counts[unknown].argsort()[::-1][:MAX_LISTED]]
    listed = ", ".join(f"#{code:06x}" for code in frequent)
    more = ", …" if unknown.sum() > MAX_LISTED else ""
    raise TextureError(
        f"every colour must be a label, got {counts[unknown].sum():,} pixels of {listed}{more}",
        code="unknown-label",
        path=path,
        hint="give each colour a label, and draw without antialiasing",
    )


def _weights_of_channels(path: StrPath, part: Part, values: Values, names: Sequence[str]) -> Weights:
    present = [row for row, name in enumerate(names) if name in part.channels]
    if not present:
        raise TextureError(
            f"an image of weights must have a channel named after a material ({', '.join(names)})",
            code="no-material-channels",
            path=path,
            hint="rename its channels, or use an 8-bit image of labels",
        )
    weights = np.zeros((*values.shape[:2], len(names)), dtype=np.float32)
    for row in present:
        weights[..., row] = values[..., part.channels.index(names[row])]
    if not (np.isfinite(weights).all() and weights.min() >= 0):
        text = "weights must be finite and not negative"
        raise TextureError(text, code="invalid-weights", path=path, hint="correct the image")
    return weights
