"""Options that several commands share.

Commands import this module and write ``@options.cube``. The classes of commands, the
types of values and the names that a shell completes are listed here, too.
"""

from collections.abc import Callable
from functools import partial, reduce
from typing import Any

import click
from click.core import ParameterSource

from .command import Command as Command
from .command import Group as Group
from .option_types import ATLAS as ATLAS
from .option_types import CUBE as CUBE
from .option_types import FIGURE_PAGE as FIGURE_PAGE
from .option_types import INPUT_SPACE as INPUT_SPACE
from .option_types import LIGHT as LIGHT
from .option_types import NUMBER as NUMBER
from .option_types import OUTPUT, PLOT, WAVELENGTHS
from .option_types import PAGE as PAGE
from .option_types import SPACE as SPACE
from .option_types import WHOLE as WHOLE
from .option_types import WHOLE_OR_AUTO as WHOLE_OR_AUTO
from .option_types import Checked as Checked
from .option_types import OutputFile as OutputFile
from .option_types import Parsed as Parsed
from .option_types import Whole as Whole

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
OUTPUT_FORMAT = "uplift.output-format"
"""Key of the context's ``meta`` under which ``--format`` is kept."""


def given() -> dict[str, str]:
    """Return the options of the command line by the names of their parameters."""
    context = click.get_current_context()
    options = {}
    for parameter in context.command.params:
        name = str(parameter.name)
        if context.get_parameter_source(name) is ParameterSource.COMMANDLINE:
            options[name] = parameter.opts[-1]
    return options


def exclude(option: str, *names: str) -> None:
    """Raise a usage error if an option is given with one of these parameters."""
    others = given()
    for name in names:
        if name in others:
            raise click.UsageError(f"{option} excludes {others[name]}.")


flag = partial(click.option, is_flag=True)
number = partial(click.option, type=NUMBER)
whole = partial(click.option, type=WHOLE)


def stacked(*decorators: Decorator) -> Decorator:
    """Combine decorators, the first one outermost."""
    return lambda function: reduce(
        lambda inner, decorate: decorate(inner), reversed(decorators), function
    )


def repeatable(
    option: str,
    name: str,
    help: str,
    default: str = "",
    *,
    examples: str = "",
    **settings: Any,
) -> Decorator:
    """An option that may be given several times, as the tuple ``name``."""
    text = f"{help}{examples}; repeatable." + (
        f" [default: {default}]" if default else ""
    )
    return click.option(option, name, multiple=True, help=text, **settings)


atlas = partial(repeatable, "--atlas", "files", metavar="FILE", type=ATLAS)
LAMPS = ", such as led, 3200K or FL11, or the file of a measured lamp"
named_lights = partial(repeatable, metavar="NAME|FILE", type=LIGHT)
light = partial(named_lights, "--light", "lights", examples=LAMPS)
"""Why its defaults differ is in `uplift help illuminants`."""
tolerance = partial(number, "--tolerance", metavar="ΔE00")
output = partial(click.option, "-o", "--output", metavar="FILE", type=OUTPUT)
OF_PACKAGE = (
    ", or ACEScg for the packaged ACEScg cube{}. [default: the packaged sRGB cube]"
)
"""Help of ``--cube`` where a packaged cube will do."""


def cube(
    help: str = OF_PACKAGE.format(""), name: str = "cube_path", **settings: Any
) -> Decorator:
    """``--cube``, as ``cube_path``."""
    return click.option(
        "--cube",
        name,
        metavar="FILE",
        type=CUBE,
        help=f"Cube file{help}",
        **settings,
    )


def choice(
    option: str,
    *choices: str,
    name: str | None = None,
    default: str | None = None,
    **settings: Any,
) -> Decorator:
    """An option with one of some values; without a ``default``, the first one is."""
    return click.option(
        *filter(None, (option, name)),
        type=click.Choice(choices),
        default=default or choices[0],
        **settings,
    )


encoding = choice(
    "--encoding",
    *("auto", "linear", "encoded"),
    help="Encoding of images. auto: whole numbers have the transfer function of the "
    "cube's space, floats are linear.",
)


def input_space(
    subject: str, default: str = "as the file states", name: str = "input_space"
) -> Decorator:
    """``--input-space``: text for `uplift.colorimetry.spaces.find_space`."""
    return click.option(
        "--input-space",
        name,
        metavar="NAME",
        type=INPUT_SPACE,
        help=f"RGB space of {subject}: a name of OpenColorIO or colour-science such as "
        "ACEScg or lin_rec2020, or x,y "
        f"of red, green, blue and white. [default: {default}]",
    )


PIXELS = "clip", "as images often have a few, which are counted"
"""Default of ``--out-of-gamut`` of images, and the reason."""


def out_of_gamut(
    default: str, why: str, subject: str = "colours", name: str = "method"
) -> Decorator:
    """``--out-of-gamut``: names of `uplift.colorimetry.gamut.METHODS`, which is not
    imported here.
    """
    methods = ("error", "clip", "scale", "desaturate", "desaturate-oklab")
    text = (
        f"Treatment of {subject} outside [0, 1]; 'uplift help gamut' describes it. "
        f"[default: {default}, {why}]"
    )
    return choice(
        "--out-of-gamut",
        *methods,
        name=name,
        default=default,
        help=text,
        show_default=False,
    )


def pixels() -> Decorator:
    """``--encoding``, ``--input-space`` and ``--out-of-gamut`` of images, as
    `uplift.extras.texture` names them.
    """
    return stacked(
        encoding,
        input_space("the images", name="space"),
        out_of_gamut(*PIXELS, "pixels", "out_of_gamut"),
    )


def _remember_format(ctx: click.Context, param: click.Parameter, value: str) -> str:
    """Keep the format where the main command finds it if it has an error to report."""
    ctx.meta[OUTPUT_FORMAT] = value
    return value


def output_format(*choices: str) -> Decorator:
    """``--format`` as ``style``; the first choice is the default."""
    return click.option(
        "--format",
        "style",
        type=click.Choice(choices),
        default=choices[0],
        is_eager=True,
        callback=_remember_format,
        help="Output format.",
    )


table_or_json = output_format("table", "json")
table_json_or_csv = output_format("table", "json", "csv")


def plot(help: str, option: str = "--plot", name: str = "plot_path") -> Decorator:
    """An option for the file of a plot, as ``name``. A suffix other than .png, .svg and
    .pdf is an error at once.

    At the end of a command it needs no FILE.
    """
    default = f"{name.removesuffix('_path')}.png"
    text = f"{help}, as .png, .svg or .pdf. [default of FILE: {default}]"
    return click.option(
        option,
        name,
        metavar="[FILE]",
        type=PLOT,
        is_flag=False,
        flag_value=default,
        help=text,
    )


def page(help: str) -> Decorator:
    """``--html``. A suffix other than .html is an error at once."""
    return click.option("--html", metavar="FILE", type=PAGE, help=help)


def wavelengths(help: str) -> Decorator:
    """``--wavelengths`` as an array in nm, or None; `uplift_cli.inputs.check_range`
    checks their range.
    """
    text = f"Wavelengths in nm as START:END:STEP or a list such as 450,550,650{help}"
    return click.option("--wavelengths", metavar="NM", type=WAVELENGTHS, help=text)


cube_argument = click.argument("cube", metavar="CUBE", type=CUBE)
# names of uplift.atlas.measurements.MEASURED, which is not imported here
scale = choice(
    "--scale",
    *("auto", "percent", "fraction"),
    help="Scale of measured values. auto: as the atlas file states, or else by its "
    "values.",
)
missing = choice(  # names of uplift.atlas.measurements.MISSING
    "--missing",
    *("refuse", "interpolate", "skip"),
    help="What becomes of an entry that lacks a value within 380-780 nm.",
)
coefficients = click.option(
    "--coefficients",
    type=WHOLE,
    default=9,
    metavar="N",
    help="Coefficients per spectrum, 3 to 17.",
)
output_wavelengths = wavelengths(". [default: those of the cube or table]")
depth = click.option(
    "--depth",
    type=click.Choice(("half", "float")),
    help="16 or 32 bits per channel. [default: half for reflectances, else float]",
)


def adapt(default: str = "adapt") -> Decorator:
    """``--adapt`` and ``--no-adapt``; ``default`` names what applies without them."""
    text = f"Show the white of a light as white, or tinted. [default: {default}]"
    return click.option("--adapt/--no-adapt", default=None, help=text)


table = click.option(
    "--table",
    type=click.Choice(("header", "file")),
    help="Where the numbers of a program are. [default: header for C, else file]",
)


fill = flag(
    "--fill-missing",
    help="Take colours that a cube built with --scene lacks from the packaged cube.",
)
atlas_folders = repeatable(
    "--atlas-dir",
    "folders",
    "Folder to search for atlases",
    metavar="DIR",
    type=click.Path(exists=True, file_okay=False),
)
force = flag("--force", help="Replace existing files.")
quiet = flag("-q", "--quiet", help="Print only warnings and errors.")
