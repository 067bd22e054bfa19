"""Matrix of ``uplift palette`` as table or JSON."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from .console import has_colours, make_table, paragraph, print_json, say, show

if TYPE_CHECKING:
    from rich.text import Text

    from uplift.common.arrays import Array
    from uplift.design.palette import Design, Matrix, UnmetGoal
    from uplift.design.palette.palette import SpectrumSpec

    from .tables import SafeTable


LEGEND = "requested, obtained, factor model; ΔE00 of the obtained colour, of the model. * designed"


def _print_table(design: Design, colours: Matrix, unmet: Sequence[UnmetGoal]) -> None:
    show(_table(design, colours, coloured=has_colours()))
    say()
    paragraph(LEGEND)
    for goal in unmet:
        paragraph(f"not met: {goal}")
    if not unmet:
        say("all goals are met")


def _table(design: Design, colours: Matrix, *, coloured: bool) -> SafeTable:
    table = make_table()
    table.add_column("material", no_wrap=True)
    for light in design.palette.lights:
        table.add_column(_name(light), no_wrap=True)
    for row, material in enumerate(design.palette.materials):
        cells = (_cell(colours, (row, column), coloured) for column in range(len(design.palette.lights)))
        table.add_row(_name(material), *cells)
    return table


def _name(part: SpectrumSpec) -> str:
    return f"{part.name}*" if part.designed else part.name


def _cell(colours: Matrix, at: tuple[int, int], coloured: bool) -> Text:
    from rich.text import Text

    from uplift.colorimetry.srgb import hex_codes

    has_goal = not math.isnan(colours.delta_e[at])
    triples = [colours.target[at]] * has_goal + [colours.obtained[at], colours.factor[at]]
    text = Text()
    for rgb in triples:
        (code,) = hex_codes(rgb[None])
        text.append("    " if coloured else code, style=f"on {code}" if coloured else "")
        text.append(" ")
    error = f"{colours.delta_e[at]:.2f}" if has_goal else "–"
    return text.append(f" {error}, {colours.model_error[at]:.2f}")


def _print_json(design: Design, colours: Matrix, unmet: Sequence[UnmetGoal]) -> None:
    palette = design.palette
    fields = {
        "wavelengths": palette.sensor.wavelengths.tolist(),
        "coefficients": design.model.count,
        "lights": [
            _part(part, samples, design.model.light(samples))
            for part, samples in zip(palette.lights, design.powers, strict=True)
        ],
        "materials": [
            _part(part, samples, design.model.reflectance(samples))
            for part, samples in zip(palette.materials, design.reflectances, strict=True)
        ],
        "free": {name: rgb.tolist() for name, rgb in design.free.items()},
        "colours": [
            _colour(colours, (row, column), material.name, light.name)
            for row, material in enumerate(palette.materials)
            for column, light in enumerate(palette.lights)
        ],
        "to_rgb": design.model.matrix.tolist(),
        "missed": [str(goal) for goal in unmet],
    }
    print_json(fields)


def _part(part: SpectrumSpec, samples: Array, coefficients: Array) -> dict[str, object]:
    return {
        "name": part.name,
        "designed": part.designed,
        "samples": samples.tolist(),
        "coefficients": coefficients.tolist(),
    }


def _colour(colours: Matrix, at: tuple[int, int], material: str, light: str) -> dict[str, object]:
    has_goal = not math.isnan(colours.delta_e[at])
    return {
        "material": material,
        "light": light,
        "wanted": colours.target[at].tolist() if has_goal else None,
        "obtained": colours.obtained[at].tolist(),
        "factor": colours.factor[at].tolist(),
        "missed": float(colours.delta_e[at]) if has_goal else None,
        "model_error": float(colours.model_error[at]),
    }


PRINTERS: dict[str, Callable[[Design, Matrix, Sequence[UnmetGoal]], None]] = {
    "table": _print_table,
    "json": _print_json,
}
