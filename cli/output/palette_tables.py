"""A palette's matrix for terminals and for programs."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import click

from .console import console, json_text

if TYPE_CHECKING:
    from rich.table import Table
    from rich.text import Text

    from uplift.common.arrays import Array
    from uplift.design.palette import Design, Matrix, UnmetGoal
    from uplift.design.palette.palette import SpectrumSpec


KEY = "wanted, obtained, by the factor model; ΔE00 from wanted to obtained, of the model. * designed"


def _print_table(found: Design, colours: Matrix, missed: Sequence[UnmetGoal]) -> None:
    out = console()
    out.print(_table(found, colours, coloured=out.color_system is not None))
    out.print(KEY, markup=False)
    for miss in missed:
        click.echo(f"missed: {miss}")
    if not missed:
        click.echo("all wishes are fulfilled")


def _table(found: Design, colours: Matrix, *, coloured: bool) -> Table:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD)
    table.add_column("")
    for light in found.palette.lights:
        table.add_column(_name(light), no_wrap=True)
    for row, material in enumerate(found.palette.materials):
        cells = (_cell(colours, (row, column), coloured) for column in range(len(found.palette.lights)))
        table.add_row(Text(_name(material)), *cells)
    return table


def _name(part: SpectrumSpec) -> str:
    return f"{part.name}*" if part.designed else part.name


def _cell(colours: Matrix, at: tuple[int, int], coloured: bool) -> Text:
    from rich.text import Text

    from uplift.colorimetry.srgb import hex_codes

    wished = not math.isnan(colours.delta_e[at])
    shown = [colours.target[at]] * wished + [colours.obtained[at], colours.factor[at]]
    text = Text()
    for rgb in shown:
        (code,) = hex_codes(rgb[None])
        text.append("    " if coloured else code, style=f"on {code}" if coloured else "")
        text.append(" ")
    missed = f"{colours.delta_e[at]:.2f}" if wished else "–"
    return text.append(f" {missed}, {colours.model_error[at]:.2f}")


def _print_json(found: Design, colours: Matrix, missed: Sequence[UnmetGoal]) -> None:
    palette = found.palette
    answer = {
        "wavelengths": palette.sensor.wavelengths.tolist(),
        "coefficients": found.model.count,
        "lights": [
            _part(part, samples, found.model.light(samples))
            for part, samples in zip(palette.lights, found.powers, strict=True)
        ],
        "materials": [
            _part(part, samples, found.model.reflectance(samples))
            for part, samples in zip(palette.materials, found.reflectances, strict=True)
        ],
        "free": {name: rgb.tolist() for name, rgb in found.free.items()},
        "colours": [
            _colour(colours, (row, column), material.name, light.name)
            for row, material in enumerate(palette.materials)
            for column, light in enumerate(palette.lights)
        ],
        "to_rgb": found.model.matrix.tolist(),
        "missed": [str(miss) for miss in missed],
    }
    click.echo(json_text(answer))


def _part(part: SpectrumSpec, samples: Array, coefficients: Array) -> dict[str, object]:
    return {
        "name": part.name,
        "designed": part.designed,
        "samples": samples.tolist(),
        "coefficients": coefficients.tolist(),
    }


def _colour(colours: Matrix, at: tuple[int, int], material: str, light: str) -> dict[str, object]:
    wished = not math.isnan(colours.delta_e[at])
    return {
        "material": material,
        "light": light,
        "wanted": colours.target[at].tolist() if wished else None,
        "obtained": colours.obtained[at].tolist(),
        "factor": colours.factor[at].tolist(),
        "missed": float(colours.delta_e[at]) if wished else None,
        "model_error": float(colours.model_error[at]),
    }


PRINTERS: dict[str, Callable[[Design, Matrix, Sequence[UnmetGoal]], None]] = {
    "table": _print_table,
    "json": _print_json,
}
