"""Names that a shell completes."""

from collections.abc import Callable
from importlib import import_module

import click
from click.shell_completion import CompletionItem


def completion(
    *sources: str, files: bool = False
) -> Callable[..., list[CompletionItem]]:
    """Complete names, and the names of ``files``.

    Sources are tuples or functions of the library with their arguments: 'module:name',
    'module:name:argument'.
    """

    def complete(
        ctx: click.Context, param: click.Parameter, text: str
    ) -> list[CompletionItem]:
        # first: bash drops the items before it
        items = [CompletionItem(text, type="file")] * files
        for source in sources:
            module, attribute, *arguments = source.split(":")
            values = getattr(import_module(f"uplift.{module}"), attribute)
            if callable(values):
                values = values(*arguments)
            for value in values:
                name = getattr(value, "name", value)
                if name.lower().startswith(text.lower()):
                    items.append(CompletionItem(name))
        return items

    return complete


complete_atlas = completion("atlas:shipped_atlases", files=True)
complete_cube = completion("lookup.cube:PACKAGED", files=True)
complete_light = completion(
    "colorimetry.illuminants:COMMON_NAMES",
    "colorimetry.tables:names:illuminant",
    files=True,
)
complete_observer = completion(
    "colorimetry.tables:names:observer", "colorimetry.tables:names:camera", files=True
)
complete_space = completion("colorimetry.tables:names:RGB space")
