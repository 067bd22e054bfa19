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

import numpy as np

from uplift.common.arrays import Floats, Mask, StrPath, Values
from uplift.common.errors import ColourError, OptionError, TextureError
from uplift.common.files import file_digest
from uplift.common.text import pluralise
from uplift.cube import common_sensor
from uplift.extras.texture.channels import colour_channels, coloured_parts
from uplift.extras.texture.colours import Counts
from uplift.extras.texture.image import Image, Part, open_image
from uplift.extras.texture.uplifter import Converted, Converter, ConvertRows, Uplifter
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
                f"a mask must have the size of its image, {window[0]} × {window[1]}, "
                f"got {size[0]} × {size[1]}",
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
) -> Callable[[Values], Floats]:
    """Return the function from the numbers (…, 3) of a mask to weights (…, n). Raises
    `TextureError` for others.
    """
    low, high, is_grey, is_coloured = _measure(image, part, rgb)
    white = max(part.max_code, 1)
    least = MIN_WHITE * part.max_code  # 0 of numbers that are not integer
    is_weight = min(low, white - high) >= 0
    if is_grey and high < cubes and part.max_code:
        return lambda numbers: np.asarray(
            numbers[..., :1] == np.arange(cubes), dtype=np.float32
        )
    if is_grey and is_weight and cubes == 2 and high >= least:
        return lambda numbers: _pair(
            np.asarray(numbers[..., 0] / np.float32(white), dtype=np.float32)
        )
    if is_coloured and is_weight and cubes == 3:
        return _normalised
    kind = "grey" if is_grey else "coloured"
    raise _no_mask(cubes, f"{kind} values from {low:g} to {high:g}")


def _measure(
    image: Image, part: Part, rgb: tuple[int, int, int]
) -> tuple[float, float, bool, bool]:
    """Return the range of the numbers, whether all are grey, or coloured and none 0."""
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
    return low, high, is_grey, not (is_grey or has_black)


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
        with contextlib.ExitStack() as stack:
            # a mask that fits one size only is an error for the other
            weights, *_ = [
                stack.enter_context(open_mask(self.mask, len(self.uplifters), size))
                for size in sizes
            ]
            try:
                yield lambda part, first, rgb: self.mix(
                    rgb, weights(first - part.window.y, len(rgb))
                )
            except (ColourError, TextureError) as error:
                # of the image, not of the mask
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
            (colours, uplifted), counted = uplifter.convert(requested)
            counts += counted + replace(changed, pixels=0)
            share = weight[rows][:, None]
            outside = is_outside[rows]
            answered[rows & is_outside] += share[outside] * colours[outside]
            mixed = is_mixed[rows]
            values[rows & ~is_mixed] += share[~mixed] * uplifted[~mixed]
            if mixed.any():
                model = uplifter.cube.data.model
                stored = model.to_storage(uplifted[mixed].astype(float))
                moments[rows[is_mixed]] += share[mixed] * stored
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
    common_sensor(uplifter.cube.data for uplifter in uplifters)
    is_model_stored = first.channels[0][:1].islower()
    models = [uplifter.cube.data.model.describe() for uplifter in uplifters]
    is_alike = all(uplifter.channels == first.channels for uplifter in uplifters)
    if not is_alike or (is_model_stored and models != models[:1] * len(models)):
        raise OptionError(
            "cubes of one texture must have the same wavelengths or, for moments and "
            "multipliers, the same model",
            hint="write spectra at given wavelengths, or build the cubes with the same "
            "options",
        )
    if first.errors:
        raise OptionError(
            "a texture of several cubes has no standard errors",
            hint="write one of each cube",
        )
    digests = [uplifter.header["uplift.cube"] for uplifter in uplifters]
    description = {
        **json.loads(first.header["uplift.texture"]),
        "cubes": digests,
        "mask": file_digest(mask, TextureError),
    }
    settings = {field.name: getattr(first, field.name) for field in fields(Converter)}
    settings["header"] = {
        **first.header,
        "uplift.cube": ", ".join(digests),
        "uplift.texture": json.dumps(description),
    }
    return MaskedUplifter(**settings, uplifters=tuple(uplifters), mask=mask)
