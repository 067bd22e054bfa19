"""Answers to colours: a row of plain values for each, which is printed as JSON, as a
line of CSV or text, or in full.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain, repeat
from math import isnan
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from uplift.common.text import printable

from .answers import (
    as_lists,
    format_rgb,
    hex_codes,
    patch,
    print_spectrum,
    without_rounding,
)
from .console import EscapedOutput, emit, has_colours, print_csv, say
from .table import print_json_rows

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.extras.colour.query import QueryBlock
    from uplift.lookup.cube import Cube

    from ..queries import Answers

Row = Mapping[str, Any]
NO_ERROR = "unknown; a cube that is built again states it"
"""In place of an error, for cubes without left-out materials."""
FAMILIES = "among materials of unknown families"
"""What the errors of a cube hold for that are learnt from families, and not from an
atlas.
"""
LARGEST = 1e30
"""Limit of requested colours: ΔE00 of larger ones overflows."""


def answer_rows(answers: Answers, block: QueryBlock) -> list[dict[str, Any]]:
    """Return the answers of a block as plain values for JSON."""
    from uplift.extras.colour.coordinates import coordinates
    from uplift.extras.colour.srgb import hex_codes as srgb_codes

    count = len(block)
    label = attrgetter("label")
    lights = {}
    for lit, display in zip(answers.lights, answers.displays, strict=True):
        xyz = block.light_xyz[lit.name]
        rgb = (display.xyz_to_rgb @ xyz[..., None])[..., 0]
        shown = {"srgb": as_lists(rgb), "hex": srgb_codes(rgb), "xyz": as_lists(xyz)}
        lights[lit.name] = _rows(shown, count)
    errors = {}
    for light, values in block.light_errors.items():
        if not isnan(values[0, 0]):
            errors[light] = values
    round_trip = {
        "rgb": as_lists(block.round_trip),
        "delta_e_2000": block.delta_e_2000.tolist(),
    }
    columns: dict[str, Iterable[Any]] = {
        "cube": repeat(answers.origin),
        "rgb": as_lists(block.rgb),
        "requested_rgb": as_lists(block.requested_rgb),
        "wavelengths": repeat(block.wavelengths.tolist()),
        "reflectance": as_lists(block.reflectance),
        "xyz": as_lists(block.xyz),
        **coordinates(answers.cube, block.rgb),
        "round_trip": _rows(round_trip, count),
        "cell": block.cell.tolist(),
        "status": [list(map(label, statuses)) for statuses in block.statuses],
        "realisable": block.realisable.tolist(),
        "entry": block.entry,
        "standard_error": _known(block.errors[:, 0]),
        "error_bound": _known(block.errors[:, 1]),
        "reference": repeat(answers.cube.data.error_illuminant),
        "standard_errors": _rows(_column(errors, 0), count),
        "error_bounds": _rows(_column(errors, 1), count),
        "lights": _rows(lights, count),
        "unlike_atlas": block.unlike_atlas.tolist(),
    }
    if answers.further is not None:
        names = (photo.light for photo in answers.further.photographs.further)
        colours = answers.further.others.reshape(-1, 3).tolist()
        columns["also"] = repeat(dict(zip(names, colours, strict=True)))
        columns["contradicts"] = repeat(answers.further.contradicts(block.rgb))
    return _rows(columns, count)


def _rows(columns: Mapping[str, Iterable[Any]], count: int) -> list[dict[str, Any]]:
    """Return the rows of columns, of which there may be none."""
    rows = zip(range(count), *columns.values(), strict=False)
    return [dict(zip(columns, cells, strict=True)) for _, *cells in rows]


def _known(values: Array) -> list[float | None]:
    """Return numbers (n,), None for NaN."""
    return [None if isnan(value) else value for value in values.tolist()]


def _column(errors: Mapping[str, Array], index: int) -> dict[str, list[float | None]]:
    return {light: _known(values[:, index]) for light, values in errors.items()}


def print_answers(
    answers: Answers, blocks: Iterable[QueryBlock], style: str, *, details: bool
) -> None:
    """Print each block before the next one is computed."""
    if style == "json":
        rows = chain.from_iterable(answer_rows(answers, block) for block in blocks)
        print_json_rows(rows, single=answers.single)
    elif style == "csv":
        _print_csv(answers, blocks)
    elif answers.single:
        (block,) = blocks
        _print_one(answers, block, details=details)
    else:
        _print_lines(answers, blocks)


def _print_csv(answers: Answers, blocks: Iterable[QueryBlock]) -> None:
    """Print CSV. The spectra of a block are formatted at once, which is many times
    faster than cell by cell.
    """
    from uplift.extras.files.csv import csv_text
    from uplift.extras.files.numbers import number_rows

    lights = [light.name for light in answers.lights]
    known = lights if answers.cube.data.points.standard_error is not None else []
    wavelengths = answers.wavelengths
    if wavelengths is None:
        wavelengths = answers.cube.wavelengths
    names = [*"rgb", "delta_e_2000", "standard_error", "error_bound"]
    for light in known:
        names += [f"standard_error_{light}", f"error_bound_{light}"]
    names += [f"hex_{light}" for light in lights]
    print_csv([[*names, "entry", *map("{:g}".format, wavelengths)]])
    output = EscapedOutput()
    for block in blocks:
        spectra = number_rows(without_rounding(block.reflectance))
        for row, spectrum in zip(answer_rows(answers, block), spectra, strict=True):
            cells = [*row["rgb"], row["round_trip"]["delta_e_2000"]]
            cells += [row["standard_error"], row["error_bound"]]
            for light in known:
                errors = row["standard_errors"], row["error_bounds"]
                cells += [values.get(light) for values in errors]
            cells += [lit["hex"] for lit in row["lights"].values()]
            text = csv_text([*cells, row["entry"]], [])
            output.write(f"{text[:-1]},{spectrum}\n")


def _print_lines(answers: Answers, blocks: Iterable[QueryBlock]) -> None:
    """Print a line for each answer."""
    cube = answers.cube
    indent = " " * 5 * has_colours()
    for number, block in enumerate(blocks):
        rows = answer_rows(answers, block)
        names = [] if isnan(block.errors[:, 0].max()) else list(_errors(rows[0]))
        if number == 0:
            middle = "  ".join(map("± {}".format, names)) or f"{'spectrum':<16}"
            say(f"cube     {answers.title}")
            say(
                f"{indent}hex      {'linear RGB':<17}  {'ΔE00':<7}  {middle}  atlas "
                "entry"
            )
        for line in _lines(cube, block, rows, names):
            emit(line)


def _lines(
    cube: Cube, block: QueryBlock, rows: Iterable[Row], names: Iterable[str]
) -> Iterator[str]:
    from uplift.extras.colour.sparkline import sparklines

    spectra = sparklines(block.reflectance, 16)
    codes = hex_codes(cube, block.rgb)
    for row, code, spectrum in zip(rows, codes, spectra, strict=True):
        swatch = f"{patch(cube, row['rgb'], 3)}  " * has_colours()
        rgb = " ".join(map("{:.3f}".format, row["rgb"]))
        delta_e = row["round_trip"]["delta_e_2000"]
        remark = printable(row["entry"] or "")
        middle = spectrum
        if names:
            errors = _errors(row)
            middle = "  ".join(
                f"{errors[name][0]:{len(name) + 2}.2f}" for name in names
            )
            if not remark and row["unlike_atlas"] and cube.data.families is None:
                remark = "unlike the atlas"
        yield f"{swatch}{code}  {rgb}  {delta_e:<7.2g}  {middle}  {remark}".rstrip()


def _errors(row: Row) -> dict[str, tuple[float, float]]:
    """Return standard error and error bound by light, that of the cube first; empty if
    they are unknown.
    """
    if row["standard_error"] is None:
        return {}
    errors = {row["reference"]: (row["standard_error"], row["error_bound"])}
    for light, error in row["standard_errors"].items():
        errors.setdefault(light, (error, row["error_bounds"][light]))
    return errors


def _print_one(answers: Answers, block: QueryBlock, *, details: bool) -> None:
    """Print the spectrum of one answer, its entry, its expected error, and what is
    unusual; or all with ``details``.
    """
    cube = answers.cube
    data = cube.data
    (row,) = answer_rows(answers, block)
    (code,) = hex_codes(cube, block.rgb)
    fields = _requested(cube, block)
    fields["linear RGB"] = f"{format_rgb(row['rgb'])}  {code}"
    if details:
        fields |= _details(answers, row)
    if "also" in row:
        fields["also under"] = _colours(row["also"])
        if row["contradicts"]:
            names = ", ".join(row["also"])
            fields["also under"] = f"{names}: contradicts the colour, and is not used"
    if not row["realisable"]:
        fields["realisable"] = (
            "no: the spectrum has less chroma, because no reflectance has this colour"
        )
    if row["lights"]:
        fields["sRGB under"] = ", ".join(
            f"{name}: {lit['hex']} ({format_rgb(lit['srgb'])})"
            for name, lit in row["lights"].items()
        )
    entry = row["entry"]
    is_look = entry in data.atlas.names[data.atlas.measured_count :]
    fields["look" if is_look else "atlas entry"] = entry or "none"
    if not entry and row["unlike_atlas"] and data.families is None:
        fields["atlas entry"] = "none, and none is near: unlike the atlas"
    errors = [
        f"ΔE00 {error:.2g} under {name} (95 %: {bound:.2g})"
        for name, (error, bound) in _errors(row).items()
    ]
    if data.families is not None:
        errors.append(FAMILIES)
    fields["expected error"] = ", ".join(errors) or NO_ERROR
    print_spectrum(
        fields,
        block.wavelengths,
        block.reflectance[0],
        complete=answers.wavelengths is not None,
        patches={"linear RGB": patch(cube, block.rgb[0])},
    )


def _requested(cube: Cube, block: QueryBlock) -> dict[str, str]:
    """Describe a colour before gamut mapping; empty for one that was not mapped."""
    from uplift.colorimetry.delta_e import delta_e_rgb
    from uplift.colorimetry.sensor import SLACK

    requested = block.requested_rgb[0]
    rgb = block.rgb[0]
    if (abs(requested - rgb) <= 2 * SLACK).all():
        return {}
    limited = requested.clip(-LARGEST, LARGEST)
    moved = float(delta_e_rgb(cube.data.sensor, limited, rgb))
    text = f"{format_rgb(requested)}  outside [0, 1], mapped by ΔE00 {moved:.2g}"
    return {"requested": text}


def _details(answers: Answers, row: Row) -> dict[str, str]:
    from uplift.extras.colour.coordinates import describe

    data = answers.cube.data
    round_trip = row["round_trip"]
    fields = {
        **describe(row),
        "cube": answers.title,
        "cell": (
            f"{tuple(row['cell'])} of {data.lattice.dim - 1}³, "
            f"{', '.join(row['status'])}"
        ),
        "round trip": (
            f"{format_rgb(round_trip['rgb'])}  ΔE00 {round_trip['delta_e_2000']:.2g} "
            f"({data.sensor.illuminant})"
        ),
    }
    if data.sensor.sensitivities is not None:
        fields["XYZ"] = format_rgb(row["xyz"])
    return fields


def _colours(colours: Mapping[str, Iterable[float]]) -> str:
    return ", ".join(f"{name}: {format_rgb(rgb)}" for name, rgb in colours.items())
