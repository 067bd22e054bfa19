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
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from uplift.common.arrays import Floats, Mask, StrPath, Values
from uplift.common.errors import ColourError, OptionError, TextureError
from uplift.common.files import file_digest
from uplift.common.text import pluralise
from uplift.cube.data import common_sensor
from uplift.extras.texture.channels import colour_channels, coloured_parts
from uplift.extras.texture.colours import Counts
from uplift.extras.texture.image import Image, Part, open_image
from uplift.extras.texture.uplifter import Converted, Converter, ConvertRows, Uplifter
from uplift.lattice.entry_boxes import OutsideBoxes
from uplift.lookup.refine import refine_to_rgb

ToWeights = Callable[[Values], Floats]
"""From numbers (…, 3) of a mask to weights (…, n)."""
MIN_WHITE = 0.5
"""Share of white that the largest weight of an integer mask has; smaller ones may be
numbers of too many cubes.
"""
HINT = (
    "paint a grey mask with the numbers of the cubes, or with weights of the second "
    "of two cubes up to white"
)

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
                (
                    f"a mask must have the size of its image, {window[0]} × "
                    f"{window[1]}, "
                    f"got {size[0]} × {size[1]}"
                ),
                hint="scale the mask",
            )
        colours = colour_channels(part)
        is_mask = len(part.channels) == 1 if colours is None else not colours.is_xyz
        if not is_mask:
            raise TextureError(
                f"no mask among the channels {', '.join(part.channels)}", hint=HINT
            )
        rgb = (0, 0, 0) if colours is None else colours.rgb
        to_weights = _interpret(image, part, rgb, cubes)
        yield lambda first, count: to_weights(image.rows(part, first, count)[..., rgb])


def _interpret(
    image: Image, part: Part, rgb: tuple[int, int, int], cubes: int
) -> ToWeights:
    """Return the function from the numbers (…, 3) of a mask to weights (…, n). Raises
    `TextureError` for others.
    """
    values = _survey(image, part, rgb)
    interpret = _grey_weights if values.is_grey else _colour_weights
    to_weights = interpret(values, cubes)
    if to_weights is None:
        kind = "grey" if values.is_grey else "coloured"
        raise _no_mask(cubes, f"{kind} values from {values.low:g} to {values.high:g}")
    return to_weights


class Survey(NamedTuple):
    """What the numbers of a mask have in common."""

    low: float
    high: float
    is_grey: bool
    has_black: bool
    max_code: int
    """Code of white; 0 for floats."""

    @property
    def white(self) -> int:
        """Value of white."""
        return self.max_code or 1

    @property
    def is_weight(self) -> bool:
        """Whether all numbers are from 0 to white."""
        return self.low >= 0 and self.high <= self.white


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


def _grey_weights(values: Survey, cubes: int) -> ToWeights | None:
    """Return the function for numbers of cubes, or for weights of the second of two;
    None if the values are neither.
    """
    if values.max_code and values.high < cubes:
        return lambda numbers: np.asarray(
            numbers[..., :1] == np.arange(cubes), dtype=np.float32
        )
    has_white = not values.max_code or values.high >= MIN_WHITE * values.white
    if cubes == 2 and values.is_weight and has_white:
        white = np.float32(values.white)
        return lambda numbers: _pair(
            np.asarray(numbers[..., 0] / white, dtype=np.float32)
        )
    return None


def _colour_weights(values: Survey, cubes: int) -> ToWeights | None:
    """Return the function for weights of three cubes, None if the values are others."""
    is_mask = cubes == 3 and values.is_weight and not values.has_black
    return _normalised if is_mask else None


def _no_mask(cubes: int, values: str) -> TextureError:
    meanings = {
        2: "0 and 1, or weights up to white",
        3: "0 to 2, or weights in R, G and B that are not all 0",
    }
    meaning = meanings.get(cubes, f"0 to {cubes - 1}")
    return TextureError(
        f"a mask of {pluralise(cubes, 'cube')} must hold {meaning}, got {values}",
        hint=HINT,
    )


def _pair(second: Floats) -> Floats:
    return np.stack([1 - second, second], axis=-1)


def _normalised(numbers: Values) -> Floats:
    weights = np.asarray(numbers, dtype=np.float32)
    return weights / weights.sum(axis=-1, keepdims=True)


@dataclass(frozen=True, eq=False)
class MaskedUplifter(Converter):
    """A converter of colours to the spectra of n cubes, chosen by an image, made by
    `prepare_masked`.
    """

    uplifters: tuple[Uplifter, ...]
    mask: Path

    @contextlib.contextmanager
    def opened(self, image: Image) -> Iterator[ConvertRows]:
        sizes = dict.fromkeys(
            (part.window.width, part.window.height) for part, _ in coloured_parts(image)
        )
        with (
            contextlib.ExitStack() as stack
        ):  # a mask that fits one size only is an error for the other
            weights, *_ = [
                stack.enter_context(open_mask(self.mask, len(self.uplifters), size))
                for size in sizes
            ]
            try:
                yield lambda part, first, rgb: self.mix(
                    rgb, weights(first - part.window.y, len(rgb))
                )
            except (
                ColourError,
                TextureError,
            ) as error:  # of the image, not of the mask
                error.path = error.path or image.path
                raise

    def convert(self, rgb: Floats) -> Converted:
        return self.uplifters[0].convert(rgb)

    @property
    def boxes(self) -> OutsideBoxes:
        boxes = [uplifter.boxes for uplifter in self.uplifters]
        return OutsideBoxes(
            np.concatenate([outside.rgb for outside in boxes]),
            np.concatenate([outside.half_width for outside in boxes]),
        )

    def mix(self, rgb: Floats, weights: Floats) -> Converted:
        """Uplift linear RGB (k, width, 3) of the decoder by the cubes, with weights (k,
        width, n) of sum 1.

        A colour in the box of an entry outside [0, 1] is answered so by the cube that
        has the entry, and mapped by the others. The colours of these answers are mixed
        likewise.
        """
        is_mixed: Mask = np.all(
            weights < (1 if self.uplifters[0].model else 0), axis=-1
        )
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
            requested, changed = uplifter.mapped(rgb[rows])
            (colours, found), counted = uplifter.convert(requested)
            counts += counted + replace(changed, pixels=0)
            kept = is_outside[rows]
            answered[rows & is_outside] += (
                weight[rows & is_outside][:, None] * colours[kept]
            )
            mixed = is_mixed[rows]
            shared = rows[is_mixed]
            values[rows & ~is_mixed] += (
                weight[rows & ~is_mixed][:, None] * found[~mixed]
            )
            if mixed.any():
                parts = uplifter.cube.data.model.to_storage(found[mixed].astype(float))
                moments[shared] += weight[is_mixed][shared][:, None] * parts
        if len(moments):
            data = self.uplifters[0].cube.data
            start = data.model.from_storage(moments)
            values[is_mixed] = refine_to_rgb(
                data, data.model, start, answered[is_mixed].astype(float)
            )
        return (answered, values), counts

    def multiply(
        self, values: tuple[Floats, ...], opacity: Floats
    ) -> tuple[Floats, ...]:
        return self.uplifters[0].multiply(values, opacity)


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
    common_sensor(each.cube.data for each in uplifters)
    is_model_stored = first.channels[0][:1].islower()
    models = {
        json.dumps(each.cube.data.model.describe(), sort_keys=True)
        for each in uplifters
    }
    if len({each.channels for each in uplifters}) > 1 or (
        is_model_stored and len(models) > 1
    ):
        raise OptionError(
            (
                "cubes of one texture must have the same wavelengths or, for moments "
                "and "
                "multipliers, the same model"
            ),
            hint=(
                "write spectra at given wavelengths, or build the cubes with the "
                "same options"
            ),
        )
    if first.errors:
        raise OptionError(
            "a texture of several cubes has no standard errors",
            hint="write one of each cube",
        )
    mask_digest = file_digest(mask, TextureError)
    digests = [each.header["uplift.cube"] for each in uplifters]
    description = json.loads(first.header["uplift.texture"]) | {
        "cubes": digests,
        "mask": mask_digest,
    }
    header = {
        **first.header,
        "uplift.cube": ", ".join(digests),
        "uplift.texture": json.dumps(description),
    }
    settings = {each.name: getattr(first, each.name) for each in fields(Converter)}
    return MaskedUplifter(
        **settings | {"header": header}, uplifters=tuple(uplifters), mask=mask
    )
