"""``uplift palette``: design lights and materials for given colours."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from uplift.common.errors import OptionError

from ..options import force_option, format_option, plot_option
from ..output.console import has_colours, make_table, paragraph, print_json, say, show

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from rich.text import Text

    from uplift.common.arrays import Array
    from uplift.design.palette.design import Design, Matrix, UnmetGoal
    from uplift.design.palette.palette import Palette, SpectrumSpec

LEGEND = "requested, obtained, factor model; ΔE00 of the obtained colour, of the model. * designed"


@click.command("palette")
@click.argument("spec", metavar="SPEC.toml", type=click.Path())
@click.option(
    "-o", "--output", metavar="FILE", help="Write the designed materials as an atlas; CSV if FILE ends in .csv."
)
@plot_option("Plot the matrix of colours")
@plot_option("Plot the spectra of lights and materials", "--plot-spectra", "spectra_path")
@click.option("--html", metavar="HTML", help="Write a page that shows the materials under any mixture of the lights.")
@click.option(
    "--image",
    metavar="FILE",
    help="Picture for the page: an 8-bit image of labels, or EXR channels with the names of the materials.",
)
@click.option(
    "--label",
    "labels",
    multiple=True,
    metavar="NAME=#RRGGBB",
    help="Colour of a material in --image; repeatable. [default: greys 1, 2, …]",
)
@format_option("table", "json")
@force_option
def command(
    spec: str,
    output: str | None,
    plot_path: str | None,
    spectra_path: str | None,
    html: str | None,
    image: str | None,
    labels: tuple[str, ...],
    style: str,
    force: bool,
) -> None:
    """Design the unknown spectra of a palette of lights and materials, and print the matrix of their colours.

    SPEC.toml lists lights and materials, given or to be designed, and the colours that materials must have.
    Several cells may share one colour that is free (docs/palette.md).

    A cell of the matrix shows the requested colour, the colour of the designed spectra and the colour of the factor
    model, with ΔE00 between the first and the second and between the second and the third. Goals that no spectra can
    meet are listed with the requirements to relax. JSON output has all spectra.

    \b
    Examples:
      uplift palette metamers.toml
      uplift palette metamers.toml --plot matrix.png --plot-spectra spectra.png
      uplift palette metamers.toml -o designed.txt
      uplift palette engine.toml --html engine.html
      uplift palette vanish.toml --format json > vanish.json
    """
    from uplift.common.files import check_outputs
    from uplift.design.palette import design, matrix, read_palette, standard_model, unmet_goals, write_designed
    from uplift.design.palette.plots import plot_matrix, plot_spectra

    palette = read_palette(spec)
    check_outputs((output, plot_path, spectra_path, html), inputs=(*palette.sources, image), force=force)
    picture = _read_picture(palette, html, image, labels)
    solution = design(palette, standard_model(palette.sensor, palette.count))
    PRINTERS[style](solution, matrix(solution), unmet_goals(solution))
    if output is not None:
        count = write_designed(solution, output, force=force)
        say(f"{output}: {count} designed materials", err=True)
    if plot_path is not None:
        plot_matrix(solution, matrix(solution), plot_path, force=force)
        say(f"{plot_path}: matrix of colours", err=True)
    if spectra_path is not None:
        plot_spectra(solution, spectra_path, force=force)
        say(f"{spectra_path}: spectra", err=True)
    if html is not None:
        _write_page(solution, Path(spec).stem, picture, html, force=force)
        say(f"{html}: relighting page", err=True)


def _read_picture(
    palette: Palette, html: str | None, image: str | None, labels: tuple[str, ...]
) -> NDArray[np.float32] | None:
    """Read how much of each material a pixel shows; None if the page draws its own picture."""
    if image is None and labels:
        raise click.UsageError("--label requires --image, the image that has these colours.")
    if image is None:
        return None
    if html is None:
        raise click.UsageError("--image requires --html, the page to write.")
    from uplift.design.palette.picture import read_weights

    colours: dict[str, str] = {}
    for label in labels:
        name, sign, colour = label.partition("=")
        if not sign or name in colours:
            raise OptionError(f"labels must be NAME=#rrggbb, one per material, got '{label}'")
        colours[name] = colour
    return read_weights(image, [part.name for part in palette.materials], colours or None)


def _write_page(design: Design, title: str, picture: NDArray[np.float32] | None, path: str, *, force: bool) -> None:
    from uplift.common.files import write_text
    from uplift.design.palette.picture import cutaway
    from uplift.design.palette.relight_page import page, relighting

    weights = cutaway(len(design.palette.materials)) if picture is None else picture
    write_text(page(relighting(title, design, weights)), path, force=force)


def _print_table(design: Design, colours: Matrix, unmet: Sequence[UnmetGoal]) -> None:
    coloured = has_colours()
    table = make_table(("material",))
    for light in design.palette.lights:
        table.add_column(_name(light))
    for row, material in enumerate(design.palette.materials):
        cells = (_cell(colours, (row, column), coloured) for column in range(len(design.palette.lights)))
        table.add_row(_name(material), *cells)
    show(table)
    say()
    paragraph(LEGEND)
    for goal in unmet:
        paragraph(f"not met: {goal}")
    if not unmet:
        say("all goals are met")


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
