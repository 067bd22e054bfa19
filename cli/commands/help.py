"""``uplift help``: topics that concern several commands, from the documentation of the code."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable

import click

from ..output.console import emit, paragraph, say

SHELLS = {
    "bash": ("~/.bashrc", 'eval "$(_UPLIFT_COMPLETE=bash_source uplift)"'),
    "zsh": ("~/.zshrc", 'eval "$(_UPLIFT_COMPLETE=zsh_source uplift)"'),
    "fish": ("~/.config/fish/completions/uplift.fish", "_UPLIFT_COMPLETE=fish_source uplift | source"),
}
"""File to edit and line to add, by shell."""


@click.command("help")
@click.argument("topic", required=False)
@click.pass_context
def command(ctx: click.Context, topic: str | None) -> None:
    """Explain a topic, or a command. Without TOPIC, list the topics.

    \b
    Examples:
      uplift help
      uplift help modes
      uplift help query
    """
    if topic is None:
        _list_topics()
    elif topic in TOPICS:
        TOPICS[topic][1]()
    else:
        _show_command(ctx, topic)


def _list_topics() -> None:
    width = max(map(len, TOPICS))
    for name, (summary, _) in TOPICS.items():
        say(f"{name:<{width}}  {summary}")
    say()
    paragraph("'uplift help TOPIC' explains one of them, 'uplift help COMMAND' a command.")


def _show_command(ctx: click.Context, name: str) -> None:
    group = ctx.find_root().command
    assert isinstance(group, click.Group)
    found = group.get_command(ctx, name)
    if found is None:
        import difflib

        names = [*TOPICS, *group.list_commands(ctx)]
        near = difflib.get_close_matches(name, names, n=1)
        suggestion = f" Did you mean '{near[0]}'?" if near else ""
        raise click.UsageError(f"No such topic '{name}'.{suggestion}", ctx)
    with found.make_context(name, ["--help"], parent=ctx.parent, resilient_parsing=True) as context:
        emit(found.get_help(context))


def _print_modes() -> None:
    from uplift.lookup import Cube

    _print_documentation(_parameter(Cube.reflectance, "mode"))


def _print_gamut() -> None:
    from uplift.colorimetry.gamut import MAPPINGS

    for name, mapping in MAPPINGS.items():
        _print_documentation(f"{name}: {inspect.getdoc(mapping)}".split("\n\n")[0])


def _print_illuminants() -> None:
    from uplift.colorimetry import lights
    from uplift.colorimetry.observer import illuminant_names

    _print_documentation(inspect.getdoc(lights) or "")
    paragraph(", ".join(illuminant_names()))


def _print_spaces() -> None:
    from uplift.colorimetry.observer import space_names

    say("RGB spaces of colour-science:")
    say()
    paragraph(", ".join(space_names()))


def _print_observers() -> None:
    from uplift.colorimetry.observer import observer_names

    say("Standard observers of colour-science:")
    say()
    paragraph(", ".join(observer_names()))


def _print_atlases() -> None:
    from .atlas import print_shipped

    print_shipped("table")


def _print_exit_codes() -> None:
    from ..main import LazyGroup

    _print_documentation(inspect.getdoc(LazyGroup.main) or "")


def _print_completion() -> None:
    paragraph(
        "The shell completes commands, options and their values, and the names of atlases, cubes, illuminants, "
        "observers and RGB spaces."
    )
    for shell, (file, line) in SHELLS.items():
        say()
        say(f"{shell}: add to {file}")
        say(f"  {line}")


def _print_documentation(text: str) -> None:
    """Print paragraphs without the marks of reStructuredText."""
    for part in text.split("\n\n"):
        paragraph(" ".join(part.replace("``", "").replace("`", "").split()))
        say()


def _parameter(function: Callable[..., object], name: str) -> str:
    """Return the description of a parameter in a docstring."""
    text = inspect.getdoc(function) or ""
    found = re.search(rf"^{name} : .*\n((?: +.*\n)+)", text, re.MULTILINE)
    return inspect.cleandoc(found[1]) if found else ""


TOPICS: dict[str, tuple[str, Callable[[], None]]] = {
    "atlases": ("measured spectra that are installed with uplift", _print_atlases),
    "completion": ("names and options completed by bash, zsh and fish", _print_completion),
    "exit-codes": ("what a script can test", _print_exit_codes),
    "gamut": ("colours outside [0, 1]: --out-of-gamut", _print_gamut),
    "illuminants": ("names of illuminants: --light, --illuminant", _print_illuminants),
    "modes": ("ways to interpolate a cube: query --mode", _print_modes),
    "observers": ("names of standard observers: --observer", _print_observers),
    "spaces": ("names of RGB spaces: --space, --input-space", _print_spaces),
}
"""Summary and printer by topic."""
