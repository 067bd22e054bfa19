"""Designed materials as an atlas, so that they can constrain a cube like measured ones."""

from __future__ import annotations

import os
import warnings

from uplift.atlas import Atlas, Entry, Header, write_atlas
from uplift.atlas.checks import HIGHEST, LOWEST
from uplift.common.errors import PaletteError, UpliftWarning
from uplift.common.files import check_output
from uplift.design.palette.design import Design

CONTENT = "Reflectances designed by uplift palette"


def designed_atlas(found: Design) -> Atlas:
    """The designed materials. An `UpliftWarning` names those that no atlas holds: far below 0, or above 1."""
    entries = []
    for part, row in zip(found.palette.materials, found.reflectances, strict=True):
        if not part.designed:
            continue
        if row.min() < LOWEST or row.max() > HIGHEST:
            reach = f"{row.min():.3g} to {row.max():.3g}"
            told = f"material '{part.name}' is left out of the atlas: {reach} is no reflectance"
            warnings.warn(told, UpliftWarning, stacklevel=2)
            continue
        wavelengths = found.palette.sensor.wavelengths
        entries.append(Entry(part.name, wavelengths, row, description=_description(found, part.name)))
    return Atlas(tuple(entries))


def write_designed(found: Design, path: str | os.PathLike[str], *, force: bool = False) -> int:
    """Write them as `uplift.write_atlas` does, and say how many. Raises `OutputError`, `PaletteError`."""
    atlas = designed_atlas(found)
    if not atlas.entries:
        raise PaletteError(
            "no designed material that an atlas can hold", hint="design one with bounds within [0, 1]"
        )
    write_atlas(atlas, check_output(path, force=force), Header(content=CONTENT))
    return len(atlas)


def _description(found: Design, material: str) -> str:
    """What it was designed for."""
    lights = [wish.light for wish in found.palette.goals if wish.material == material and wish.weight]
    return f"designed for its colours under {', '.join(lights)}" if lights else "designed"
