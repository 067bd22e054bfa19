"""Masks: images of which cube a pixel belongs to (docs/looks.md).

A grey mask holds the numbers of the cubes, 0 for the first; or, for two cubes, weights:
black is the first, white the second, and grey mixes. A coloured mask holds the weights
of three cubes in R, G and B.

Spectra and moments of a mixture of cubes are those of its parts, weighted: moments are
linear in the reflectance, so the mixture of two reflectances of one colour has this
colour, and stays in [0, 1]. Multipliers are mixed as moments.
"""

import contextlib
import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from uplift.common.arrays import Floats, Mask, StrPath, Values
from uplift.common.errors import OptionError, TextureError
from uplift.common.files import file_digest
from uplift.common.text import pluralise
from uplift.cube.data import common_sensor
from uplift.extras.images.channels import colour_channels, coloured_parts
from uplift.extras.images.converter import (
    Band,
    Converted,
    Converter,
    ImageConverter,
)
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import Image, Part, errors_at, open_image
from uplift.extras.texture.uplifter import Uplifter
from uplift.lattice.entry_boxes import OutsideBoxes
from uplift.lookup.refine import refine_to_rgb

MIN_WHITE = 0.5
"""Share of white that the largest weight of an integer mask has; smaller ones may be
numbers of too many cubes.
"""
HINT = (
    "paint a grey mask with the numbers of the cubes, or with weights of the second "
    "of two cubes up to white"
)
MEANINGS = {
    2: "0 and 1, or weights up to white",
    3: "0 to 2, or weights in R, G and B that are not all 0",
}
"""What masks of two and of three cubes hold."""
ToWeights = Callable[[Values], Floats]
"""From numbers (…, 3) of a mask to weights (…, n)."""
ReadWeights = Callable[[int, int], Floats]
"""From the first row, counted from 0, and the number of rows k to weights (k, width, n)
of n cubes, of sum 1.
"""


@contextlib.contextmanager
def open_mask(
    path: StrPath, cubes: int, window: tuple[int, int]
) -> Iterator[ReadWeights]:
    """Open a mask of at least two cubes, for an image of this width and height.

    Its rows are read once to find out what its numbers are. Raises `TextureError` for a
    file that cannot be read or has another size, and for numbers that are neither
    numbers of the cubes nor weights.
    """
    with open_image(path) as image:
        part = image.parts[0]
        size = part.window.width, part.window.height
        if size != window:
            raise TextureError(
                "a mask must have the size of its image, "
                f"{window[0]} × {window[1]}, got {size[0]} × {size[1]}",
                hint="scale the mask",
            )
        colours = colour_channels(part)
        is_mask = len(part.channels) == 1 if colours is None else not colours.is_xyz
        if not is_mask:
            raise TextureError(
                f"no mask among the channels {', '.join(part.channels)}", hint=HINT
            )
        rgb = (0, 0, 0) if colours is None else colours.rgb
        to_weights = _to_weights(_survey(image, part, rgb), cubes)
        yield lambda first, count: to_weights(image.rows(part, first, count)[..., rgb])


class Survey(NamedTuple):
    """What the numbers of a mask have in common; ``max_code`` is 0 for floats."""

    low: float
    high: float
    is_grey: bool
    has_black: bool
    max_code: int


def _survey(image: Image, part: Part, rgb: tuple[int, int, int]) -> Survey:
    low = np.inf
    high = -np.inf
    is_grey = True
    has_black = False
    for _, band in image.bands(part):
        colours = band[..., rgb]
        low = min(low, np.min(colours))  # NaN remains NaN
        high = max(high, np.max(colours))
        is_grey &= bool((colours == colours[..., :1]).all())
        has_black |= bool((colours == 0).all(axis=-1).any())
    return Survey(low, high, is_grey, has_black, part.max_code)


def _to_weights(values: Survey, cubes: int) -> ToWeights:
    """Return the function from the numbers of a mask to weights: numbers of cubes, or
    weights of the second of two or of all three. Raises `TextureError` for others.
    """
    white = values.max_code or 1
    is_weight = values.low >= 0 and values.high <= white
    if values.is_grey:
        if values.max_code and values.high < cubes:
            return lambda numbers: np.asarray(
                numbers[..., :1] == np.arange(cubes), dtype=np.float32
            )
        has_white = not values.max_code or values.high >= MIN_WHITE * white
        if cubes == 2 and is_weight and has_white:
            return lambda numbers: _pair(numbers[..., 0] / np.float32(white))
    elif cubes == 3 and is_weight and not values.has_black:
        return _normalised
    kind = "grey" if values.is_grey else "coloured"
    raise TextureError(
        f"a mask of {pluralise(cubes, 'cube')} must hold "
        f"{MEANINGS.get(cubes, f'0 to {cubes - 1}')}, got {kind} values from "
        f"{values.low:g} to {values.high:g}",
        hint=HINT,
    )


def _pair(weight: Values) -> Floats:
    second = np.asarray(weight, dtype=np.float32)
    return np.stack([1 - second, second], axis=-1)


def _normalised(numbers: Values) -> Floats:
    weights = np.asarray(numbers, dtype=np.float32)
    return weights / weights.sum(axis=-1, keepdims=True)


@dataclass(frozen=True, eq=False, kw_only=True)
class MaskedUplifter(Converter):
    """A converter of colours to the spectra of n cubes, chosen by an image, made by
    `prepare_masked`.
    """

    uplifters: tuple[Uplifter, ...]
    mask: Path

    @contextlib.contextmanager
    def open(self, image: Image, also: Sequence[Path] = ()) -> Iterator[ImageConverter]:
        """Open the mask for an image."""
        sizes = dict.fromkeys(
            (part.window.width, part.window.height) for part, _ in coloured_parts(image)
        )
        with contextlib.ExitStack() as stack:
            # A mask that fits one size only is an error for the other.
            weights, *_ = [
                stack.enter_context(open_mask(self.mask, len(self.uplifters), size))
                for size in sizes
            ]
            stack.enter_context(errors_at(image.path))  # they are not of the mask
            yield ImageConverter(
                lambda band: self.rows(band, weights(band.first, len(band.rgb)))
            )

    def rows(self, band: Band, weights: Floats) -> Converted:
        """Convert a band by the cubes, with weights (k, width, n) of sum 1.

        A colour in the box of an entry outside [0, 1] is answered so by the cube that
        has the entry, and mapped by the others. The colours of these answers are mixed
        likewise.
        """
        rgb = band.rgb
        pixels = self.uplifters[0].pixels
        is_mixed: Mask = np.all(weights < (1 if pixels.model else 0), axis=-1)
        is_outside: Mask = np.any((rgb < 0) | (rgb > 1), axis=-1)
        answered = np.where(is_outside[..., None], 0, rgb)
        values = np.zeros((*rgb.shape[:2], len(self.channels)), dtype=np.float32)
        moments = np.zeros((np.count_nonzero(is_mixed), len(self.channels)))
        counts = Counts()
        for uplifter, weight in zip(
            self.uplifters, np.moveaxis(weights, -1, 0), strict=True
        ):
            rows = weight > 0
            if not rows.any():
                continue
            requested, changed = uplifter.reader.mapped(rgb[rows])
            colours, numbers, missed = uplifter.numbers(requested)
            counts += missed + replace(changed, pixels=0)
            outside = rows & is_outside
            answered[outside] += weight[outside][:, None] * colours[is_outside[rows]]
            mixed = is_mixed[rows]
            plain = rows & ~is_mixed
            values[plain] += weight[plain][:, None] * numbers[~mixed]
            if mixed.any():
                shared = rows[is_mixed]
                model = uplifter.cube.data.model
                parts = model.to_storage(numbers[mixed].astype(float))
                moments[shared] += weight[is_mixed][shared][:, None] * parts
        if len(moments):
            data = self.uplifters[0].cube.data
            start = data.model.from_storage(moments)
            values[is_mixed] = refine_to_rgb(
                data, data.model, start, answered[is_mixed].astype(float)
            )
        return (band.weighted(answered), pixels.weighted(values, band)), counts


def prepare_masked(uplifters: Sequence[Uplifter], mask: Path) -> MaskedUplifter:
    """Prepare several cubes for textures.

    Parameters
    ----------
    uplifters : sequence of Uplifter
        Uplifters of at least two cubes, with the same pixel encoding.
    mask : Path
        Image of which cube a pixel belongs to; see `uplift.extras.texture.mask`.

    Returns
    -------
    MaskedUplifter
        The converter to pass to `convert`.

    Raises
    ------
    OptionError
        One cube only, standard errors, cubes of different spaces, or with different
        channels or, for moments and multipliers, models.
    TextureError
        The mask cannot be read.
    """
    if len(uplifters) < 2:
        raise OptionError(
            f"a mask chooses among at least two cubes, got {len(uplifters)}",
            hint="name the cubes in the order of the numbers in the mask",
        )
    first = uplifters[0]
    common_sensor(uplifter.cube.data for uplifter in uplifters)
    if len(set(map(_kind_of_numbers, uplifters))) > 1:
        raise OptionError(
            "cubes of one texture must have the same wavelengths or, for moments and "
            "multipliers, the same model",
            hint="write spectra at given wavelengths, or build the cubes with the "
            "same options",
        )
    if first.errors:
        raise OptionError(
            "a texture of several cubes has no standard errors",
            hint="write one of each cube",
        )
    boxes = [uplifter.cube.data.outside_boxes for uplifter in uplifters]
    all_boxes = OutsideBoxes(
        np.concatenate([outside.rgb for outside in boxes]),
        np.concatenate([outside.half_width for outside in boxes]),
    )
    digests = [uplifter.header["uplift.cube"] for uplifter in uplifters]
    description = json.loads(first.header["uplift.texture"]) | {
        "cubes": digests,
        "mask": file_digest(mask, TextureError),
    }
    return MaskedUplifter(
        reader=replace(first.reader, boxes=all_boxes),
        depth=first.depth,
        channels=first.channels,
        header={
            **first.header,
            "uplift.cube": ", ".join(digests),
            "uplift.texture": json.dumps(description),
        },
        uplifters=tuple(uplifters),
        mask=mask,
    )


def _kind_of_numbers(uplifter: Uplifter) -> tuple[object, ...]:
    """Return what the numbers of cubes of one texture have in common: their channels
    and, unless they are spectra, their model.
    """
    is_model_stored = uplifter.channels[0][:1].islower()
    model = uplifter.cube.data.model.describe() if is_model_stored else {}
    return uplifter.channels, json.dumps(model, sort_keys=True)
