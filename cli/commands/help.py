"""``uplift help``: the help of commands, and topics that concern several of them."""

from collections.abc import Callable, Iterable, Mapping

import click

from ..output.console import emit, paragraph, print_fields, say
from ..output.diagnostics import BAD_INPUT, EXIT_CODES, FAILED_CHECK, INTERNAL_ERROR
from ..replaced import current_words

EXIT_CODE_MEANINGS = {
    "0": "success, or help was shown",
    f"{FAILED_CHECK}": "a check failed, or the reader of the output closed the pipe",
    f"{BAD_INPUT}": (
        "bad input: a file, a value, an option, or an output that cannot be written"
    ),
    f"{INTERNAL_ERROR}": "an error of uplift itself: please report it",
    f"{EXIT_CODES['interrupted']}": "interrupted by Ctrl-C",
    "128 + N": "ended by signal N",
}
MODE_MEANINGS = {
    "spectra": "interpolate spectra, with exact colours",
    "moments": "interpolate coefficients, with nearly exact colours",
    "refined": "interpolate coefficients, and move them to the exact colour",
    "nearest": "the spectrum of the nearest node, of another colour",
}
GAMUT_MEANINGS = {
    "error": "refuse the colour",
    "clip": "clip each component, which changes chromaticity, hue and luminance",
    "scale": (
        "move towards white at constant luminance until no component is negative, "
        "then divide by the largest"
    ),
    "desaturate": "move towards white at constant luminance and dominant wavelength",
    "desaturate-oklab": (
        "move towards grey at constant lightness and hue of Oklab, which keeps the hue "
        "of reds and yellows better"
    ),
}
TEMPERATURES = """
Temperatures such as 3200K are names too. From 4000K to 25000K they are CIE daylight of
this nominal temperature, as D65 is 6500K; below, from 1000K, black bodies.
"""
DEFAULT_LIGHTS = """
Without --light, 'relight', 'advise' and 'lab bounds' take A, FL11 and HP1, under which
RGB goes wrong most. 'build' and 'lab diff' take the lights of ordinary scenes, D65, A,
FL2, FL11 and LED-B3, and 'report' adds FL7, which builds do not use. 'lab compare' has
a smooth set and a spiky one, 'lab wavelengths' the illuminant of sRGB, and 'query'
none: errors cost time.
"""
LAMP_FILES = """
The file of a measured lamp is a light as well: wavelengths in nm and powers of any unit
as CSV, SPD, CGATS, TM-27 (.spdx) or another format of 'uplift atlas', or JSON of
rawtoaces. 'lamps.csv:NAME' is one lamp of several. Photons, such as µmol/m²/s/nm, are
divided by the wavelength; a label or a line of the file states the unit.
"""
CAMERA_FILES = """
The file of a camera is used with --space camera: wavelengths in nm and sensitivities of
red, green and blue as .csv, .tsv or .txt, or .json of rawtoaces.
"""
OCIO_SPACES = """
Spaces of the configuration $OCIO, or else of OpenColorIO's built-in ACES studio
configuration, are valid too, and for --input-space x,y of red, green, blue and white.
"""
Part = str | Mapping[str, str]
"""A paragraph, or a table of names and their meanings."""


@click.command(
    "help",
    help="""Explain a topic or a command. Without either, list the topics.

    \b
    Examples:
      uplift help
      uplift help exit-codes
      uplift help query
      uplift help lights build
    """,
)
@click.argument("words", metavar="[TOPIC|COMMAND]", nargs=-1)
def command(words: tuple[str, ...]) -> None:
    if not words:
        print_fields({name: summary for name, (summary, _) in TOPICS.items()})
        say()
        paragraph(
            "'uplift help TOPIC' explains a topic, and 'uplift help COMMAND' a command."
        )
    elif words[0] in TOPICS and len(words) == 1:
        _, parts = TOPICS[words[0]]
        _print_parts(parts())
    else:
        emit(find_context(current_words(list(words))).get_help())


def find_context(names: list[str]) -> click.Context:
    """Return the context of a command by its name, or of a subcommand by two."""
    context = click.get_current_context().find_root()
    for name in names:
        group = context.command
        command = (
            group.get_command(context, name) if isinstance(group, click.Group) else None
        )
        if command is None:
            problem = f"'{' '.join(names)}' is neither a topic nor a command."
            raise click.UsageError(
                f"{problem} 'uplift help' lists the topics, and 'uplift' the commands."
            )
        context = click.Context(command, info_name=name, parent=context)
    return context


def _print_parts(parts: Iterable[Part]) -> None:
    """Print paragraphs and tables, with a blank line between them."""
    for number, content in enumerate(parts):
        if number:
            say()
        if isinstance(content, str):
            paragraph(" ".join(content.split()))
        else:
            print_fields(content)


def _illuminants() -> list[Part]:
    from uplift.colorimetry.illuminants import COMMON_NAMES
    from uplift.extras.colour.light_sets import DESCRIPTIONS

    words = ", ".join(
        f"{name} ({illuminant})" for name, illuminant in COMMON_NAMES.items()
    )
    return [
        DESCRIPTIONS,
        f"Other names: {words}. {TEMPERATURES}",
        LAMP_FILES,
        DEFAULT_LIGHTS,
        *_names("illuminant"),
    ]


def _observers() -> list[Part]:
    return [*_names("observer"), *_names("camera"), CAMERA_FILES]


def _spaces() -> list[Part]:
    from uplift.colorimetry.tables import SHORT_NAMES, names

    words = ", ".join(f"{name} ({space})" for name, space in SHORT_NAMES.items())
    listed = ", ".join(names("RGB space"))
    return [
        f"Short names: {words}.",
        "Names of colour-science, some of them from OpenColorIO:",
        listed,
        OCIO_SPACES,
    ]


def _names(kind: str) -> list[Part]:
    from uplift.colorimetry.tables import names

    return [f"Every {kind} of colour-science:", ", ".join(names(kind))]


TOPICS: dict[str, tuple[str, Callable[[], list[Part]]]] = {
    "exit-codes": ("what a script can test", lambda: [EXIT_CODE_MEANINGS]),
    "gamut": ("colours outside [0, 1]: --out-of-gamut", lambda: [GAMUT_MEANINGS]),
    "illuminants": ("names of lights: --light, --illuminant", _illuminants),
    "modes": ("ways to interpolate a cube: query --mode", lambda: [MODE_MEANINGS]),
    "observers": ("names of observers and cameras: --observer", _observers),
    "spaces": ("names of RGB spaces: --space, --input-space", _spaces),
}
"""Summary and parts by topic. No topic has the name of a command."""
