"""Pictures of one's own: an image of labels, or weights as a renderer writes them, a channel a material."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from uplift.common.errors import OptionError, TextureError, unknown_name
from uplift.io.texture.colours import colour_channels
from uplift.io.texture.source import Part, Values, open_image

MOST = 1 << 20
"""Pixels that a page can light in real time."""

Weights = NDArray[np.float32]


def read_weights(
    path: str | os.PathLike[str], names: Sequence[str], labels: Mapping[str, str] | None = None
) -> Weights:
    """(H, W, n) how much of each of the materials ``names`` a pixel shows, read from an image.

    Where its channels are floats, they are the weights, and are called like the materials. Any other image is 8-bit:
    its colours, as ``labels`` (material: ``#rrggbb``) tells them, are the materials, and alpha is their weight. Without
    ``labels`` greys of 1, 2, … are the materials in their order. Black that is no label shows nothing.

    Raises `TextureError` for an image that is neither, `OptionError` and `UnknownNameError` for labels.
    """
    codes = _numbered(names) if labels is None else _told(names, labels)
    with open_image(path) as image:
        part = image.parts[0]
        width, height = part.window.width, part.window.height
        if width * height > MOST:
            hint = f"scale it, without smoothing, to at most {MOST:,} pixels"
            raise TextureError(f"is too large: {width} × {height}", path=path, hint=hint)
        values = np.concatenate([band for _, band in image.bands(part)])
    try:
        return _labelled(part, values, codes, len(names)) if part.max_code else _channels(part, values, names)
    except TextureError as error:
        raise TextureError(error.problem, path=path, hint=error.hint) from error


def _numbered(names: Sequence[str]) -> dict[int, int]:
    """Row of the material by 24-bit colour: the greys in order."""
    return {0x10101 * (row + 1): row for row in range(min(len(names), 255))}


def _told(names: Sequence[str], labels: Mapping[str, str]) -> dict[int, int]:
    """The same from labels."""
    codes: dict[int, int] = {}
    for name, label in labels.items():
        if name not in names:
            raise unknown_name(name, names, "material")
        if not re.fullmatch("#[0-9a-fA-F]{6}", label):
            raise OptionError(f"'{label}' is no colour of '{name}'", hint="write it as #rrggbb")
        code = int(label[1:], 16)
        if code in codes:
            raise OptionError(f"'{label}' stands for two materials", hint="give each a colour of its own")
        codes[code] = list(names).index(name)
    return codes


def _labelled(part: Part, values: Values, codes: Mapping[int, int], count: int) -> Weights:
    places = colour_channels(part)
    if places is None or part.max_code != 255:
        raise TextureError("holds no 8-bit colours", hint="make it an 8-bit PNG of labels")
    red, green, blue = (values[..., place].astype(np.int32) for place in places)
    found = (red << 16) | (green << 8) | blue
    alpha = values[..., part.channels.index("A")] / 255 if "A" in part.channels else np.ones(found.shape)
    alpha = np.where((found == 0) & (0 not in codes), 0, alpha)
    _check_known(found[alpha > 0], codes)
    shown = np.zeros((*found.shape, count), dtype=np.float32)
    for code, row in codes.items():
        shown[..., row] = np.where(found == code, alpha, 0)
    return shown


def _check_known(found: NDArray[np.int32], codes: Mapping[int, int]) -> None:
    kinds, counts = np.unique(found, return_counts=True)
    strange = ~np.isin(kinds, list(codes))
    if strange.any():
        often = kinds[strange][counts[strange].argsort()[::-1][:4]]
        listed = ", ".join(f"#{code:06x}" for code in often)
        raise TextureError(
            f"{counts[strange].sum():,} pixels have no material: {listed}{', …' if strange.sum() > 4 else ''}",
            hint="give each colour to a material with a label, and draw without smoothed edges",
        )


def _channels(part: Part, values: Values, names: Sequence[str]) -> Weights:
    missing = [name for name in names if name not in part.channels]
    if len(missing) == len(names):
        hint = f"call its channels like the materials ({', '.join(names)}), or use an 8-bit image of labels"
        raise TextureError("has no channel called like a material", hint=hint)
    shown = np.zeros((*values.shape[:2], len(names)), dtype=np.float32)
    for row, name in enumerate(names):
        if name not in missing:
            shown[..., row] = values[..., part.channels.index(name)]
    if not (np.isfinite(shown).all() and shown.min() >= 0):
        raise TextureError(
            "holds weights that are negative or not finite", hint="mend them: weights are from 0"
        )
    return shown
