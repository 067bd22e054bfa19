"""The answer to one colour as names and values."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .answers import coordinates, describe_coordinates, format_rgb, hex_code

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.extras.colour.query import QueryResult
    from uplift.extras.photographs.colour import PhotographedColour
    from uplift.lookup.cube import Cube

    from ..queries import Answers

NO_ERROR = "unknown; a cube that is built again states it"
"""In place of an error, for cubes without left-out materials."""
FAMILIES = "among materials of unknown families"
"""What the errors of a cube hold for that are learnt from families, and not from an
atlas.
"""
LARGEST = 1e30
"""Limit of requested colours: ΔE00 of larger ones overflows."""


def answer_fields(answers: Answers, result: QueryResult) -> dict[str, str]:
    """Return an answer and its errors by the names of the rows of a table."""
    from uplift.colorimetry.delta_e import delta_e_rgb
    from uplift.colorimetry.sensor import SLACK

    cube = answers.cube
    data = cube.data
    atlas = cube.data.atlas
    rgb = result.rgb
    fields = {}
    if (abs(result.requested_rgb - rgb) > 2 * SLACK).any():
        moved = float(
            delta_e_rgb(data.sensor, result.requested_rgb.clip(-LARGEST, LARGEST), rgb)
        )
        fields["requested"] = (
            f"{format_rgb(result.requested_rgb)}  outside [0, 1], mapped by ΔE00 "
            f"{moved:.2g}"
        )
    fields["linear RGB"] = f"{format_rgb(rgb)}  {hex_code(cube, rgb)}"
    fields |= describe_coordinates(coordinates(cube, rgb))
    fields["cube"] = answers.title
    fields["cell"] = (
        f"{result.cell} of {data.lattice.dim - 1}³, "
        f"{', '.join(s.label for s in result.statuses)}"
    )
    round_trip = (
        f"{format_rgb(result.round_trip)}  ΔE00 {result.delta_e_2000:.2g} "
        f"({data.sensor.illuminant})"
    )
    fields["round trip"] = round_trip
    if answers.further is not None:
        fields["also under"] = _describe_further(answers.further, result.rgb)
    if data.sensor.sensitivities is not None:
        fields["XYZ"] = format_rgb(result.xyz)
    if not result.realisable:
        fields["realisable"] = (
            "no: the spectrum has less chroma, because no reflectance has this colour"
        )
    if result.light_xyz:
        relit = answers.light_colours(result).items()
        fields["sRGB under"] = ", ".join(
            f"{name}: {code} ({format_rgb(lit)})" for name, ([lit], [code]) in relit
        )
    if result.entry is None:
        is_far = result.unlike_atlas and data.families is None
        fields["atlas entry"] = (
            "none, and none is near: unlike the atlas" if is_far else "none"
        )
    else:
        is_look = result.entry in atlas.names[atlas.measured_count :]
        fields["look" if is_look else "atlas entry"] = result.entry
    errors = (
        f"ΔE00 {error:.2g} under {name} (95 %: {bound:.2g})"
        for name, error, bound in _errors(cube, result)
    )
    stated = [*errors, *([FAMILIES] if data.families is not None else [])]
    fields["expected error"] = ", ".join(stated) or NO_ERROR
    return fields


def _describe_further(further: PhotographedColour, rgb: Array) -> str:
    """Describe a colour (3,) under other lights."""
    names = [photograph.light for photograph in further.photographs.further]
    if further.contradicts(rgb[None]):
        return f"{', '.join(names)}: contradicts the colour, and is not used"
    parts = [
        f"{name}: {format_rgb(values)}"
        for name, values in zip(names, further.others.reshape(-1, 3), strict=True)
    ]
    return ", ".join(parts)


def _errors(cube: Cube, result: QueryResult) -> list[tuple[str, float, float]]:
    """Return light, standard error and error bound, that of the cube first; empty if
    they are unknown.
    """
    if result.standard_error is None or result.error_bound is None:
        return []
    reference = cube.data.error_illuminant
    others = [
        (name, x, result.error_bounds[name])
        for name, x in result.standard_errors.items()
        if name != reference
    ]
    return [(reference, result.standard_error, result.error_bound), *others]
