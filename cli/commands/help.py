"""``uplift help``: topics that concern several commands, from the documentation of the code."""

import inspect
import re
from collections.abc import Callable
from functools import partial

import click

from ..output.console import paragraph, print_fields, say

DEFAULT_LIGHTS = """
Without --light, 'relight', 'bounds' and 'advise' take A, FL11 and HP1, under which RGB goes wrong most. 'build' and
'diff' take the lights of ordinary scenes, D65, A, FL2, FL11 and LED-B3, and 'report' adds FL7, which builds do not use.
'compare' has a smooth set and a spiky one, 'wavelengths' the illuminant of sRGB, and 'query' none: errors cost time.
"""


@click.command("help")
@click.argument("topic", required=False)
def command(topic: str | None) -> None:
    """Explain a topic. Without TOPIC, list the topics. 'uplift COMMAND --help' explains a command.

    \b
    Examples:
      uplift help
      uplift help modes
    """
    if topic is None:
        print_fields({name: summary for name, (summary, _) in TOPICS.items()})
    elif topic not in TOPICS:
        raise click.UsageError(f"No such topic '{topic}'. 'uplift help' lists the topics.")
    else:
        for part in TOPICS[topic][1]().split("\n\n"):
            paragraph(" ".join(part.replace("`", "").split()))
            say()


def _modes() -> str:
    from uplift.lookup import Cube

    documentation = inspect.getdoc(Cube.reflectance) or ""
    found = re.search(r"^mode : .*\n((?: +.*\n)+)", documentation, re.MULTILINE)
    return inspect.cleandoc(found[1]) if found else ""


def _gamut() -> str:
    from uplift.colorimetry.gamut import MAPPINGS

    summaries = ((inspect.getdoc(mapping) or "").split("\n\n")[0] for mapping in MAPPINGS.values())
    return "\n\n".join(f"{name}: {summary}" for name, summary in zip(MAPPINGS, summaries, strict=True))


def _lights() -> str:
    from uplift.colorimetry import lights

    return f"{inspect.getdoc(lights)}\n\n{DEFAULT_LIGHTS}\n\n{_names('illuminant')}"


def _names(kind: str) -> str:
    from uplift.colorimetry.tables import names

    return f"Every {kind} of colour-science:\n\n" + ", ".join(names(kind))


def _exit_codes() -> str:
    from ..main import LazyGroup

    return inspect.getdoc(LazyGroup.main) or ""


TOPICS: dict[str, tuple[str, Callable[[], str]]] = {
    "exit-codes": ("what a script can test", _exit_codes),
    "gamut": ("colours outside [0, 1]: --out-of-gamut", _gamut),
    "lights": ("names of illuminants: --light, --illuminant", _lights),
    "modes": ("ways to interpolate a cube: query --mode", _modes),
    "observers": ("names of standard observers: --observer", partial(_names, "observer")),
    "spaces": ("names of RGB spaces: --space, --input-space", partial(_names, "RGB space")),
}
"""Summary and text by topic."""
