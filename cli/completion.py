"""Names that the shell completes: atlases, cubes, illuminants, observers and RGB spaces."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable

import click
from click.shell_completion import CompletionItem

FILE = "file"
"""Type of an item that makes the shell complete names of files."""


def complete_atlas(ctx: click.Context, param: click.Parameter, text: str) -> list[CompletionItem]:
    """Complete names of shipped atlases, and of files."""
    from uplift.atlas import shipped_atlases

    items = [CompletionItem(each.name, help=each.content) for each in shipped_atlases()]
    return [*_matching(items, text), CompletionItem(text, type=FILE)]


def complete_cube(ctx: click.Context, param: click.Parameter, text: str) -> list[CompletionItem]:
    """Complete names of cubes of the package, of cube files, and of folders."""
    from uplift.lookup.cube import PACKAGED

    return _named_files(PACKAGED, text)


def complete_lights(ctx: click.Context, param: click.Parameter, text: str) -> list[CompletionItem]:
    """Complete the name of the packaged emission table, and names of files and folders."""
    return _named_files(("emission",), text)


def _named_files(names: Iterable[str], text: str) -> list[CompletionItem]:
    paths = sorted(glob.glob(f"{glob.escape(text)}*"))
    folders = (f"{path}{os.sep}" for path in paths if os.path.isdir(path))
    files = (path for path in paths if path.endswith(".uplift"))
    return [*_matching(map(CompletionItem, names), text), *map(CompletionItem, (*folders, *files))]


def complete_illuminant(ctx: click.Context, param: click.Parameter, text: str) -> list[CompletionItem]:
    """Complete names of illuminants."""
    from uplift.colorimetry.observer import illuminant_names

    return _matching(map(CompletionItem, illuminant_names()), text)


def complete_observer(ctx: click.Context, param: click.Parameter, text: str) -> list[CompletionItem]:
    """Complete names of observers and cameras."""
    from uplift.colorimetry.observer import camera_names, observer_names

    return _matching(map(CompletionItem, (*observer_names(), *camera_names())), text)


def complete_space(ctx: click.Context, param: click.Parameter, text: str) -> list[CompletionItem]:
    """Complete names of RGB spaces."""
    from uplift.colorimetry.observer import space_names

    return _matching(map(CompletionItem, space_names()), text)


def _matching(items: Iterable[CompletionItem], text: str) -> list[CompletionItem]:
    return [item for item in items if item.value.lower().startswith(text.lower())]
