"""A coat over a painting: every pixel uplifted, painted over in the spectrum, and seen again as RGB.

Images are read and written a band of rows at a time, as textures are; other channels pass through.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from uplift import bulk
from uplift.cube import exr
from uplift.lookup import Cube
from uplift.lookup.blocks import blockwise
from uplift.mixing.coats import Coat
from uplift.sensor import Array
from uplift.texture import Counts, Uplifter
from uplift.texture.colours import Floats, check_encoding
from uplift.texture.plan import Plan, plans
from uplift.texture.source import Values, opened
from uplift.texture.target import writing

Watch = Callable[[int, int], None]
"""Told rows done, and rows in all."""


@dataclass(frozen=True, eq=False)
class Brush:
    """A cube and a coat at the cube's wavelengths, made ready for any number of images; ``ready`` makes it."""

    uplifter: Uplifter
    coat: Coat
    threads: int

    def over(self, rgb: Floats) -> Floats:
        """Linear RGB (…, 3) of what linear RGB (…, 3) in [0, 1] become under the coat; may leave [0, 1]."""
        return blockwise(partial(_painted, self), rgb.astype(float), 3, np.float32, self.threads)


def ready(
    cube: Cube,
    coat: Coat,
    recipe: Mapping[str, Any] | None = None,
    *,
    encoding: str = "auto",
    threads: int = 2,
) -> Brush:
    """A brush; ``recipe``, JSON values, is what the header will say of the coat. Raises `OptionError`."""
    check_encoding(encoding)
    header = {
        "chromaticities": exr.chromaticities(cube.data.sensor),
        "uplift.mix": json.dumps(dict(recipe or {})),
    }
    sample = bulk.spectra(cube, threads=1)
    return Brush(Uplifter(cube, "float", encoding, (), header, sample, None), coat, threads)


def paint_over(
    brush: Brush,
    source: str | os.PathLike[str],
    target: str | os.PathLike[str],
    *,
    seen: Callable[[Values], Values] = lambda rgb: rgb,
    force: bool = False,
    watch: Watch = lambda done, total: None,
) -> Counts:
    """Write a painted image as OpenEXR, atomically, and tell what was wrong with the pixels of the first.

    ``seen`` is what becomes of the linear RGB (…, 3) of painted pixels before they are written. Raises
    `TextureError`, `OutputError`, and `ColourError` for colours that a cube of a scene has no points for.
    """
    with opened(source) as image:
        planned = plans(brush.uplifter, image)
        total = sum(plan.part.window.height for plan in planned)
        counts, done = Counts(), 0
        with writing(target, [plan.layout for plan in planned], force=force) as writer:
            for plan in planned:
                writer.part(plan.part.number)
                for first, band in image.bands(plan.part):
                    values, found = _band(brush, plan, band, seen)
                    writer.rows(first, values)
                    counts, done = counts + found, done + len(band)
                    watch(done, total)
    return counts


def _band(brush: Brush, plan: Plan, band: Values, seen: Callable[[Values], Values]) -> tuple[Values, Counts]:
    rest = band[..., plan.rest]
    if plan.part.codes:
        rest = rest / np.float32(plan.part.codes)
    if plan.colours is None:
        return rest, Counts()
    rgb, counts = plan.decoder(band[..., plan.colours])
    return np.concatenate([seen(brush.over(rgb)), rest], axis=-1), counts


def _painted(brush: Brush, rgb: Array) -> Array:
    return brush.uplifter.cube.data.sensor.rgb(brush.coat.over(brush.uplifter.sample(rgb.astype(np.float32))))
