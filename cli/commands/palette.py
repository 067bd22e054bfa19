"""``uplift lab palette``: design lights and materials for given colours."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.errors import OptionError
from uplift.common.text import pluralise

from .. import options
from ..output.console import has_colours, paragraph, print_json, say
from ..output.table import Table, swatch
from ..outputs import check_outputs

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from rich.text import Text

    from uplift.common.arrays import Array
    from uplift.extras.papers.palette.design import Design, Matrix
    from uplift.extras.papers.palette.palette import Palette, SpectrumSpec

LEGEND = "requested, obtained, factor model, ΔE00 of obtained/model; * designed"


@click.command(
    "palette",
    help="""Design the unknown spectra of a palette of lights and materials, and print
    the matrix of their colours.

    SPEC.toml lists lights and materials, given or to be designed, and the colours that
    materials must have. Several cells may share one colour that is free
    (docs/palette.md).

    A cell of the matrix shows the requested colour, the colour of the designed spectra
    and the colour of the factor model, with ΔE00 between the first and the second and
    between the second and the third. Goals that no spectra can meet are listed with the
    requirements to relax. JSON output has all spectra, and the factor model: its basis,
    the dual that encodes other reflectances, and light_dual for powers.

    \b
    Examples:
      uplift lab palette metamers.toml
      uplift lab palette metamers.toml --plot m.png --plot-spectra s.png
      uplift lab palette metamers.toml -o designed.txt
      uplift lab palette engine.toml --html engine.html
      uplift lab palette vanish.toml --format json > vanish.json
    """,
)
@click.argument("spec", metavar="SPEC.toml", type=click.Path())
@options.output(
    help="Write the designed materials as an atlas; CSV if FILE ends in .csv."
)
@options.plot("Plot the matrix of colours")
@options.plot(
    "Plot the spectra of lights and materials", "--plot-spectra", "spectra_path"
)
@options.page("Write a page that shows the materials under any mixture of the lights.")
@click.option(
    "--image",
    metavar="FILE",
    help="Picture for the page: an 8-bit image of labels, or EXR channels with the "
    "names of the materials.",
)
@options.repeatable(
    "--label",
    "labels",
    "Colour of a material in --image",
    "greys 1, 2, …",
    metavar="NAME=#RRGGBB",
)
@options.table_or_json
@options.force
def command(
    spec: str,
    output: str | None,
    plot_path: str | None,
    spectra_path: str | None,
    html: str | None,
    image: str | None,
    labels: Sequence[str],
    style: str,
    force: bool,
) -> None:
    from uplift.common.files import write_text
    from uplift.extras.papers.palette.design import design, matrix, write_designed
    from uplift.extras.papers.palette.factor import standard_model
    from uplift.extras.papers.palette.picture import cutaway
    from uplift.extras.papers.palette.plots import plot_matrix, plot_spectra
    from uplift.extras.papers.palette.relight_page import page, relighting
    from uplift.extras.papers.palette.spec import read_palette
    from uplift.extras.papers.palette.unmet import unmet_goals

    palette = read_palette(spec)
    check_outputs(output, plot_path, spectra_path, html, inputs=palette.sources)
    picture = _read_picture(palette, html, image, labels)
    solution = design(palette, standard_model(palette.sensor, palette.count))
    colours = matrix(solution)
    unmet = [str(goal) for goal in unmet_goals(solution)]
    result = _result(solution, colours, unmet)
    if style == "json":
        print_json(result)
    else:
        _print_matrix(result)
    if output is not None:
        count = write_designed(solution, output, force=force)
        say(f"{output}: {pluralise(count, 'designed material')}", err=True)
    if plot_path is not None:
        plot_matrix(solution, colours, plot_path, force=force)
        say(f"{plot_path}: matrix of colours", err=True)
    if spectra_path is not None:
        plot_spectra(solution, spectra_path, force=force)
        say(f"{spectra_path}: spectra", err=True)
    if html is not None:
        weights = cutaway(len(palette.materials)) if picture is None else picture
        write_text(
            page(relighting(Path(spec).stem, solution, weights)), html, force=force
        )
        say(f"{html}: relighting page", err=True)


def _read_picture(
    palette: Palette, html: str | None, image: str | None, labels: Sequence[str]
) -> NDArray[np.float32] | None:
    """Read the share of each material in a pixel; None without an image."""
    if image is None and labels:
        raise click.UsageError(
            "--label requires --image, the image that has these colours."
        )
    if image is None:
        return None
    if html is None:
        raise click.UsageError("--image requires --html, the page to write.")
    from uplift.extras.papers.palette.picture import read_weights

    colours: dict[str, str] = {}
    for label in labels:
        name, sign, colour = label.partition("=")
        if not sign or name in colours:
            raise OptionError(
                f"labels must be NAME=#rrggbb, one per material, got '{label}'"
            )
        colours[name] = colour
    names = [material.name for material in palette.materials]
    return read_weights(image, names, colours or None)


def _result(design: Design, colours: Matrix, unmet: Sequence[str]) -> dict[str, Any]:
    """Return a design as JSON values."""
    palette = design.palette
    model = design.model
    cells = []
    for row, material in enumerate(palette.materials):
        for column, light in enumerate(palette.lights):
            at = row, column
            has_goal = not math.isnan(colours.delta_e[at])
            cell = {
                "material": material.name,
                "light": light.name,
                "wanted": colours.target[at].tolist() if has_goal else None,
                "obtained": colours.obtained[at].tolist(),
                "factor": colours.factor[at].tolist(),
                "missed": float(colours.delta_e[at]) if has_goal else None,
                "model_error": float(colours.model_error[at]),
            }
            cells.append(cell)
    return {
        "wavelengths": palette.sensor.wavelengths.tolist(),
        "coefficients": model.count,
        "lights": _parts(palette.lights, design.powers, model.light),
        "materials": _parts(palette.materials, design.reflectances, model.reflectance),
        "free": {name: rgb.tolist() for name, rgb in design.free.items()},
        "colours": cells,
        "basis": model.basis.T.tolist(),
        "dual": model.projection.tolist(),
        "light_dual": model.light_projection.tolist(),
        "to_rgb": model.matrix.tolist(),
        "missed": unmet,
    }


def _parts(
    specs: Sequence[SpectrumSpec],
    spectra: Iterable[Array],
    coefficients: Callable[[Array], Array],
) -> list[dict[str, object]]:
    return [
        {
            "name": spec.name,
            "designed": spec.designed,
            "samples": samples.tolist(),
            "coefficients": coefficients(samples).tolist(),
        }
        for spec, samples in zip(specs, spectra, strict=True)
    ]


def _print_matrix(result: dict[str, Any]) -> None:
    """Print the colours of the materials in rows, by lights in columns."""
    rows: dict[str, dict[str, Any]] = {}
    for material in result["materials"]:
        title = material["name"] + "*" * material["designed"]
        rows[material["name"]] = {"material": title}
    for cell in result["colours"]:
        rows[cell["material"]][f"light {cell['light']}"] = cell
    headings = {"material": "material"}
    formats = {}
    for light in result["lights"]:
        key = f"light {light['name']}"
        headings[key] = light["name"] + "*" * light["designed"]
        formats[key] = _cell
    Table(list(rows.values()), headings, formats=formats).print_text()
    say()
    paragraph(LEGEND)
    for goal in result["missed"]:
        paragraph(f"not met: {goal}")
    if not result["missed"]:
        say("all goals are met")


def _cell(colour: dict[str, Any]) -> Text:
    import numpy as np
    from rich.text import Text

    from uplift.extras.colour.srgb import hex_codes

    shown = [colour[kind] for kind in ("wanted", "obtained", "factor") if colour[kind]]
    parts = []
    for code in hex_codes(np.array(shown)):
        parts.append(swatch(code, "" if has_colours() else code))
    missed = "–" if colour["missed"] is None else f"{colour['missed']:.2f}"
    return Text(" ").join([*parts, Text(f"{missed}/{colour['model_error']:.2f}")])
