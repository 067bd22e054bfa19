"""One image: read, decoded, uplifted and written a band at a time, so that memory does not grow with it."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uplift import bulk
from uplift.cube import exr
from uplift.errors import OptionError, TextureError
from uplift.lattice import Status
from uplift.lookup import Cube
from uplift.texture.colours import Counts, Decoder, Floats, colour_channels, decoder
from uplift.texture.forms import Form, Sample, Spectrum
from uplift.texture.source import Image, Part, Values, opened
from uplift.texture.target import Layout, Writer, writing

BAND = 1 << 27
"""Bytes of a band that is written at once."""
LINES = 16
"""Rows that OpenEXR compresses together."""
SAME_PRIMARIES = 2e-3
"""x or y by which chromaticities may differ."""
KIND = {"uint8": "half", "uint16": "float"}
"""What holds the channels of other formats that pass through, exactly."""

Watch = Callable[[int, int], None]
"""Told rows done, and rows in all."""


@dataclass(frozen=True)
class Conversion:
    """What became of an image: how many of its pixels were what, what should be said of them, seconds it took."""

    source: Path
    target: Path
    counts: Counts
    remarks: tuple[str, ...]
    seconds: float


@dataclass(frozen=True, eq=False)
class Uplifter:
    """A cube made ready for textures of one form, as `prepare` made it; good for any number of images."""

    cube: Cube
    depth: str
    encoding: str
    channels: tuple[str, ...]
    header: Mapping[str, Any]
    sample: Sample
    misses: Sample | None

    def convert(
        self,
        source: str | os.PathLike[str],
        target: str | os.PathLike[str],
        *,
        force: bool = False,
        watch: Watch = lambda done, total: None,
    ) -> Conversion:
        """Write the texture of an image, atomically. Raises `TextureError`, `OutputError`."""
        begin = time.perf_counter()
        with opened(source) as image:
            plans = [_plan(self, image, part) for part in image.parts]
            if not any(plan.colours for plan in plans):
                names = ", ".join(dict.fromkeys(name for part in image.parts for name in part.channels))
                raise TextureError(
                    f"holds no colour: {names}", path=source, remedy="colour is in R, G and B, or in Y"
                )
            with writing(target, [plan.layout for plan in plans], force=force) as writer:
                counts = _write(self, image, plans, writer, watch)
        remarks = (*counts.remarks(), *_strange(self.cube, image))
        return Conversion(Path(source), Path(target), counts, remarks, time.perf_counter() - begin)


def prepare(
    cube: Cube,
    form: Form | None = None,
    *,
    depth: str | None = None,
    encoding: str = "auto",
    threads: int = 2,
) -> Uplifter:
    """A cube made ready for textures.

    Parameters
    ----------
    form : what textures hold: `Spectrum` (the default), `Moments` or `Multipliers`.
    depth : half or float; by default what the form is exact enough in.
    encoding : ``auto`` takes whole numbers for encoded and floats for linear; ``linear``; ``encoded``.
    threads : that share a band.

    Raises
    ------
    OptionError : a depth that the form does not have, moments of a cube that has none, unclear wavelengths.
    """
    form = Spectrum() if form is None else form
    depth = form.depths[0] if depth is None else depth
    if depth not in form.depths:
        raise OptionError(
            f"{form.name} are not exact enough as {depth}", remedy=f"use --depth {' or '.join(form.depths)}"
        )
    channels = form.channels(cube)
    beyond = (cube.data.status == Status.UNREALISABLE).any()
    misses = bulk.misses(cube, threads=threads) if beyond else None
    made = json.dumps({**form.describe(cube), "depth": depth, "encoding": encoding})
    header = {**exr.attributes(cube.data), "uplift.texture": made, **form.header()}
    return Uplifter(cube, depth, encoding, channels, header, form.sample(cube, threads), misses)


@dataclass(frozen=True, eq=False)
class _Plan:
    """A part, the channels of its colour, if it has one, those that pass through, and how it is written."""

    part: Part
    colours: tuple[int, int, int] | None
    rest: tuple[int, ...]
    decoder: Decoder
    layout: Layout


def _plan(uplifter: Uplifter, image: Image, part: Part) -> _Plan:
    colours = colour_channels(part)
    rest = tuple(index for index in range(len(part.channels)) if colours is None or index not in colours)
    names = tuple(part.channels[index] for index in rest)
    kinds = tuple(KIND.get(part.kinds[index], part.kinds[index]) for index in rest)
    if colours is not None:
        made = (*"RGB", *uplifter.channels)
        if taken := set(made) & set(names):
            problem = f"has a channel '{min(taken)}' already"
            raise TextureError(problem, path=image.path, remedy="leave it out: the texture would have two")
        names, kinds = (*made, *names), (*(uplifter.depth,) * len(made), *kinds)
    stamp = time.strftime("%Y:%m:%d %H:%M:%S", time.gmtime(image.path.stat().st_mtime))
    layout = Layout(part.name, part.window, names, kinds, uplifter.header, part.date or stamp)
    return _Plan(part, colours, rest, decoder(uplifter.cube, part, uplifter.encoding), layout)


def _strange(cube: Cube, image: Image) -> tuple[str, ...]:
    """A remark on an image that says it is of another space."""
    own = np.array(exr.chromaticities(cube.data.sensor))
    told = [part.chromaticities for part in image.parts if part.chromaticities is not None]
    if all(np.abs(own - other).max() < SAME_PRIMARIES for other in told):
        return ()
    return (f"the image names other primaries; its colours are taken for {cube.data.sensor.space}",)


def _write(uplifter: Uplifter, image: Image, plans: list[_Plan], writer: Writer, watch: Watch) -> Counts:
    counts, done = Counts(), 0
    total = sum(plan.part.window.height for plan in plans)
    for plan in plans:
        writer.part(plan.part.number)
        for first, band in _bands(image, plan):
            values, found = _made(uplifter, plan, band)
            writer.rows(first, values)
            counts, done = counts + found, done + len(band)
            watch(done, total)
    return counts


def _bands(image: Image, plan: _Plan) -> Iterator[tuple[int, Values]]:
    """Bands as they are read, cut so that what is made of them takes `BAND`."""
    row = plan.part.window.width * len(plan.layout.channels) * 4
    step = max(BAND // (row * LINES), 1) * LINES
    for first, band in image.bands(plan.part):
        for start in range(0, len(band), step):
            yield first + start, band[start : start + step]


def _made(uplifter: Uplifter, plan: _Plan, band: Values) -> tuple[Values, Counts]:
    """Channels (k, width, N) of the texture, and what was wrong with the colours."""
    through = band[..., plan.rest]
    if plan.part.codes:
        through = through / np.float32(plan.part.codes)
    if plan.colours is None:
        return through, Counts()
    rgb, counts = plan.decoder(band[..., plan.colours])
    made = [rgb, uplifter.sample(rgb), through]
    return np.concatenate(made, axis=-1), counts + _beyond(uplifter, rgb)


def _beyond(uplifter: Uplifter, rgb: Floats) -> Counts:
    """How many colours no reflectance has, so that their spectra have less chroma."""
    if uplifter.misses is None:
        return Counts()
    missed = uplifter.misses(rgb)[..., 0] > uplifter.cube.data.threshold
    return Counts(unrealisable=int(missed.sum()))
