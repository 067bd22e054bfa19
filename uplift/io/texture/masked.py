"""Several cubes in one texture, by a mask: two objects of the same RGB may have different spectra.

Spectra and moments of a mixture are those of its parts, weighted: moments are linear in the reflectance, so the mixture
of two reflectances of one colour has this colour, and stays in [0, 1]. Multipliers are mixed as moments.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np

from uplift.common.errors import OptionError
from uplift.io.texture.colours import Counts, Floats
from uplift.io.texture.converter import Converter
from uplift.io.texture.mask import Mask, open_mask
from uplift.io.texture.part_layout import colour_channels_by_part
from uplift.io.texture.source import Image, Part
from uplift.io.texture.uplifter import Uplifter
from uplift.lookup.common_sensor import common_sensor
from uplift.lookup.refine import refine_to_rgb


@dataclass(frozen=True, eq=False)
class MaskedUplifter(Converter):
    """A converter of colours to the spectra of several cubes, made by `prepare_masked`.

    Parameters
    ----------
    sensor, depth, encoding, out_of_gamut, channels, header, space
        As in `Converter`.
    uplifters : tuple of Uplifter
        The uplifters of n cubes.
    path : Path
        The mask.
    mask : Mask, optional
        The open mask, within `opened`.
    weights : ndarray of shape (k, width, n), optional
        Weights of the cubes, for `convert`.
    """

    uplifters: tuple[Uplifter, ...]
    path: Path
    mask: Mask | None = None
    weights: Floats | None = None

    @contextlib.contextmanager
    def opened(self, image: Image) -> Iterator[Converter]:
        """Open the mask for an image.

        Parameters
        ----------
        image : Image
            The image.

        Yields
        ------
        Converter
            The converter with the open mask.

        Raises
        ------
        TextureError
            As `open_mask`; or parts of the image differ in size (code ``mask-size``).
        """
        windows = [part.window for part, colours in colour_channels_by_part(image) if colours is not None]
        sizes = list(dict.fromkeys((window.width, window.height) for window in windows))
        with contextlib.ExitStack() as stack:
            masks = [stack.enter_context(open_mask(self.path, len(self.uplifters), size)) for size in sizes]
            yield replace(self, mask=masks[0])

    def at_rows(self, part: Part, first: int, count: int) -> Converter:
        """Return the converter of some rows.

        Parameters
        ----------
        part : Part
            Part of the image.
        first, count : int
            Number of the first row, in the window of the part, and number of rows.

        Returns
        -------
        Converter
            The converter with the weights of these rows.
        """
        assert self.mask is not None
        return replace(self, weights=self.mask.rows(first - part.window.y, count))

    def convert(self, rgb: Floats) -> tuple[tuple[Floats, ...], Counts]:
        """Uplift a block of colours.

        Parameters
        ----------
        rgb : ndarray of shape (k, width, 3)
            Linear RGB in [0, 1], float32, of the rows of the weights.

        Returns
        -------
        tuple of ndarray
            R, G, B (k, width, 3), and the numbers (k, width, N) of the pixel encoding.
        Counts
            Pixels close to unrealisable colours.
        """
        assert self.weights is not None
        first, weights = self.uplifters[0], self.weights
        is_mixed = weights.max(axis=-1) < 1 if not first.is_linear else np.zeros(rgb.shape[:2], dtype=bool)
        values = np.zeros((*rgb.shape[:2], len(self.channels)), dtype=np.float32)
        moments = np.zeros((np.count_nonzero(is_mixed), len(self.channels)))
        counts = Counts()
        for uplifter, weight in zip(self.uplifters, np.moveaxis(weights, -1, 0), strict=True):
            rows = weight > 0
            if not rows.any():
                continue
            (_, found), counted = uplifter.convert(rgb[rows])
            counts += counted
            mixed, shared = is_mixed[rows], rows[is_mixed]
            values[rows & ~is_mixed] += weight[rows & ~is_mixed][:, None] * found[~mixed]
            if mixed.any():
                parts = uplifter.cube.data.model.to_storage(found[mixed].astype(float))
                moments[shared] += weight[is_mixed][shared][:, None] * parts
        if len(moments):
            data = first.cube.data
            start = data.model.from_storage(moments)
            values[is_mixed] = refine_to_rgb(data, data.model, start, rgb[is_mixed].astype(float))
        return (rgb, values), counts

    def multiply(self, values: tuple[Floats, ...], opacity: Floats) -> tuple[Floats, ...]:
        """Multiply converted channels by alpha; see `Uplifter.multiply`.

        Parameters
        ----------
        values : tuple of ndarray
            What `convert` returns.
        opacity : ndarray of shape (..., 1)
            Alpha in [0, 1].

        Returns
        -------
        tuple of ndarray
            Arrays of the same shapes.
        """
        return self.uplifters[0].multiply(values, opacity)


def prepare_masked(uplifters: Sequence[Uplifter], mask: Path) -> MaskedUplifter:
    """Prepare several cubes for textures.

    Parameters
    ----------
    uplifters : sequence of Uplifter
        Uplifters of at least two cubes, with the same pixel encoding.
    mask : Path
        Image of which cube a pixel belongs to; see `uplift.io.texture.mask`.

    Returns
    -------
    MaskedUplifter
        The converter to pass to `convert`.

    Raises
    ------
    OptionError
        One cube only (code ``mask-without-cubes``), cubes of different spaces (``cubes-of-different-spaces``), or
        with different channels or, for moments and multipliers, models (``masked-cubes-differ``).
    TextureError
        The mask cannot be read.
    """
    if len(uplifters) < 2:
        raise OptionError(
            f"a mask chooses among at least two cubes, got {len(uplifters)}",
            code="mask-without-cubes",
            hint="name the cubes in the order of the numbers in the mask",
        )
    first = uplifters[0]
    common_sensor(each.cube for each in uplifters)
    is_model_stored = first.channels[0][:1].islower()
    models = {json.dumps(each.cube.data.model.describe(), sort_keys=True) for each in uplifters}
    if len({each.channels for each in uplifters}) > 1 or (is_model_stored and len(models) > 1):
        raise OptionError(
            "cubes of one texture must have the same wavelengths or, for moments and multipliers, the same model",
            code="masked-cubes-differ",
            hint="write spectra at given wavelengths, or build the cubes with the same options",
        )
    digests = [each.header["uplift.cube"] for each in uplifters]
    description = json.loads(first.header["uplift.texture"]) | {"cubes": digests, "mask": _digest(mask)}
    header = {**first.header, "uplift.cube": ", ".join(digests), "uplift.texture": json.dumps(description)}
    settings = {each.name: getattr(first, each.name) for each in fields(Converter)}
    return MaskedUplifter(**settings | {"header": header}, uplifters=tuple(uplifters), path=mask)


def _digest(path: Path) -> str:
    from uplift.common.errors import TextureError
    from uplift.common.files import check_regular

    check_regular(path, TextureError, hint="name an image")
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
