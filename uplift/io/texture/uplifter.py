"""A cube made ready for textures of one form."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from uplift.colorimetry.gamut import check_method
from uplift.common.errors import OptionError
from uplift.io.slices import exr
from uplift.io.texture.colours import check_encoding
from uplift.io.texture.pixel_encoding import PixelEncoding, Sample, Spectrum
from uplift.lattice import Status
from uplift.lookup import Cube, bulk


@dataclass(frozen=True, eq=False)
class Uplifter:
    """Good for any number of images; ``prepare`` makes it.

    Parameters
    ----------
    depth, encoding, out_of_gamut : as `prepare` takes them.
    channels : names (N,) of what a pixel holds.
    header : attributes of every texture, which tell what evaluates it.
    sample : from linear RGB to what a pixel holds.
    misses : by how much spectra miss their colours at the most; None for a cube without unrealisable points.
    """

    cube: Cube
    depth: str
    encoding: str
    out_of_gamut: str
    channels: tuple[str, ...]
    header: Mapping[str, Any]
    sample: Sample
    misses: Sample | None


def prepare(
    cube: Cube,
    form: PixelEncoding | None = None,
    *,
    depth: str | None = None,
    encoding: str = "auto",
    out_of_gamut: str = "clip",
    threads: int = 2,
) -> Uplifter:
    """A cube made ready for textures.

    Parameters
    ----------
    form : what textures hold: `Spectrum` (the default), `Moments` or `Multipliers`.
    depth : half or float; by default what the form is exact enough in.
    encoding : ``auto`` takes whole numbers for encoded and floats for linear; ``linear``; ``encoded``.
    out_of_gamut : what becomes of pixels outside [0, 1]: one of `uplift.colorimetry.gamut.METHODS`.
    threads : that share a band.

    Raises
    ------
    OptionError : a depth that the form does not have, moments of a cube that has none, unclear wavelengths,
        an unknown encoding or way out of gamut.
    """
    form = Spectrum() if form is None else form
    depth = form.depths[0] if depth is None else depth
    if depth not in form.depths:
        problem = f"{form.name} are not exact enough as {depth}"
        raise OptionError(problem, hint=f"use {' or '.join(form.depths)}")
    check_encoding(encoding)
    check_method(out_of_gamut)
    channels = form.channels(cube)
    asked = {"depth": depth, "encoding": encoding, "out_of_gamut": out_of_gamut}
    made = json.dumps({**form.describe(cube), **asked})
    header = {**exr.attributes(cube.data), "uplift.texture": made, **form.header()}
    beyond = (cube.data.points.status == Status.UNREALISABLE).any()
    misses = bulk.max_rgb_error(cube, threads=threads) if beyond else None
    sample = form.sample(cube, threads)
    return Uplifter(cube, depth, encoding, out_of_gamut, channels, header, sample, misses)
