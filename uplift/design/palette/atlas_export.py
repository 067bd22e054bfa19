"""Designed materials as an atlas, so that they can constrain a cube like measured ones."""

from __future__ import annotations

import warnings

from uplift.atlas import Atlas, Entry, Header, write_atlas
from uplift.atlas.checks import HIGHEST, LOWEST
from uplift.common.arrays import StrPath
from uplift.common.errors import PaletteError, UpliftWarning
from uplift.design.palette.design import Design

CONTENT = "Reflectances designed by uplift palette"


def designed_atlas(design: Design) -> Atlas:
    """Convert the designed materials to an atlas.

    Parameters
    ----------
    design : Design
        The design.

    Returns
    -------
    Atlas
        Its designed materials.

    Warns
    -----
    UpliftWarning
        For each material outside the range of reflectances of an atlas, which is left out.
    """
    entries = []
    for material, values in zip(design.palette.materials, design.reflectances, strict=True):
        if not material.designed:
            continue
        if values.min() < LOWEST or values.max() > HIGHEST:
            text = (
                f"material '{material.name}' is left out of the atlas: reflectance must be in "
                f"[{LOWEST:g}, {HIGHEST:g}], got {values.min():.3g} to {values.max():.3g}"
            )
            warnings.warn(UpliftWarning(text, code="entry-left-out"), stacklevel=2)
            continue
        wavelengths = design.palette.sensor.wavelengths
        entries.append(Entry(material.name, wavelengths, values, description=_description(design, material.name)))
    return Atlas(tuple(entries))


def write_designed(design: Design, path: StrPath, *, force: bool = False) -> int:
    """Write the designed materials as an atlas file.

    Parameters
    ----------
    design : Design
        The design.
    path : path-like
        The file, in the format of `uplift.write_atlas`.
    force : bool
        Replace an existing file.

    Returns
    -------
    int
        Number of entries written.

    Raises
    ------
    PaletteError
        If no material can be written.
    OutputError
        If the file exists or cannot be written.

    Warns
    -----
    UpliftWarning
        As `designed_atlas`.
    """
    atlas = designed_atlas(design)
    if not atlas.entries:
        raise PaletteError(
            "no designed material has reflectances that an atlas can hold",
            code="no-designed-material",
            hint="design one with bounds within [0, 1]",
        )
    write_atlas(atlas, path, Header(content=CONTENT), force=force)
    return len(atlas)


def _description(design: Design, material: str) -> str:
    lights = [goal.light for goal in design.palette.goals if goal.material == material and goal.weight]
    return f"designed for its colours under {', '.join(lights)}" if lights else "designed"
