"""A coat over a painting: every pixel uplifted, painted over in the spectrum, and seen again as RGB.

Images are read and written a band of rows at a time, as textures are; other channels pass through.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import check_method, map_to_gamut
from uplift.common.arrays import Array
from uplift.common.errors import ColourError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.design.mixing.coats import Coat
from uplift.io.slices import exr
from uplift.io.texture import Counts, Uplifter
from uplift.io.texture.colours import PAST_TENSE, Floats, check_encoding
from uplift.io.texture.part_layout import PartLayout, part_layouts
from uplift.io.texture.source import Image, Values, open_image
from uplift.io.texture.writer import Writer, open_writer
from uplift.lookup import Cube, bulk
from uplift.lookup.blocks import blockwise


@dataclass(frozen=True, eq=False)
class Brush:
    """A cube and a coat at the cube's wavelengths, made ready for any number of images; ``ready`` makes it."""

    uplifter: Uplifter
    coat: Coat
    threads: int

    def over(self, rgb: Floats) -> Floats:
        """Linear RGB (…, 3) of what linear RGB (…, 3) in [0, 1] become under the coat; may leave [0, 1]."""
        return blockwise(partial(_painted, self), rgb.astype(float), 3, np.float32, self.threads)


@dataclass(frozen=True)
class Painted:
    """What the image's pixels were, how many were ``moved`` inside once painted, and what should be said."""

    counts: Counts
    moved: int
    remarks: tuple[str, ...] = ()


def ready(
    cube: Cube,
    coat: Coat,
    recipe: Mapping[str, Any] | None = None,
    *,
    encoding: str = "auto",
    out_of_gamut: str = "scale",
    threads: int = 2,
) -> Brush:
    """A brush; ``recipe``, JSON values, is what the header will say of the coat.

    ``out_of_gamut``, one of `uplift.colorimetry.gamut.METHODS`, is for pixels outside [0, 1] before and after painting.
    Raises `OptionError`.
    """
    check_encoding(encoding)
    check_method(out_of_gamut)
    header = {
        "chromaticities": exr.chromaticities(cube.data.sensor),
        "uplift.mix": json.dumps(dict(recipe or {})),
    }
    sample = bulk.spectra(cube, threads=1)
    return Brush(Uplifter(cube, "float", encoding, out_of_gamut, (), header, sample, None), coat, threads)


def paint_over(
    brush: Brush,
    source: str | os.PathLike[str],
    target: str | os.PathLike[str],
    *,
    force: bool = False,
    progress: ProgressCallback = ignore_progress,
) -> Painted:
    """Write a painted image as OpenEXR, atomically.

    Raises `TextureError`, `OutputError`, `OptionError` for encoded floats that should be moved, and `ColourError` for
    colours that a cube of a scene has no points for, or that lie outside [0, 1] where that is an error.
    """
    with open_image(source) as image:
        planned = part_layouts(brush.uplifter, image)
        try:
            with open_writer(target, [plan.layout for plan in planned], force=force) as writer:
                found = _write(brush, image, planned, writer, progress)
        except ColourError as error:
            raise ColourError(error.problem, path=source, hint=error.hint) from error
        way = brush.uplifter.out_of_gamut
        remarks = [*found.counts.remarks(way), *image.remarks(brush.uplifter.cube.data.sensor)]
    if found.moved:
        remarks.append(f"{found.moved:,} painted pixels lie outside [0, 1]: {PAST_TENSE[way]}")
    return replace(found, remarks=tuple(remarks))


def _write(
    brush: Brush, image: Image, planned: list[PartLayout], writer: Writer, progress: ProgressCallback
) -> Painted:
    counts, moved, done = Counts(), 0, 0
    total = sum(plan.part.window.height for plan in planned)
    for plan in planned:
        writer.part(plan.part.number)
        for first, band in image.bands(plan.part):
            values, found = _band(brush, plan, band)
            writer.rows(first, values)
            counts, moved, done = counts + found.counts, moved + found.moved, done + len(band)
            progress(Progress("rows", done, total))
    return Painted(counts, moved)


def _band(brush: Brush, plan: PartLayout, band: Values) -> tuple[Values, Painted]:
    rest = band[..., plan.rest]
    if plan.part.codes:
        rest = rest / np.float32(plan.part.codes)
    if plan.colours is None:
        return rest, Painted(Counts(), 0)
    rgb, counts = plan.decoder(band[..., plan.colours])
    uplifter = brush.uplifter
    seen = map_to_gamut(brush.over(rgb), uplifter.cube.data.sensor, uplifter.out_of_gamut)
    return np.concatenate([seen.rgb, rest], axis=-1), Painted(counts, seen.count)


def _painted(brush: Brush, rgb: Array) -> Array:
    spectra = brush.uplifter.sample(rgb.astype(np.float32))
    return brush.uplifter.cube.data.sensor.rgb(brush.coat.over(spectra))
