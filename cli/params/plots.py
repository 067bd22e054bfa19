"""Options for plots, whose file name decides the format."""

from __future__ import annotations

import click

from .options import Decorator


def plot_option(option: str, name: str, help: str) -> Decorator:
    """An option for the file of a plot, as ``name``. A suffix other than .png, .svg and .pdf is refused at once."""
    return click.option(option, name, metavar="FILE", callback=_check, help=f"{help}, as .png, .svg or .pdf.")


def _check(ctx: click.Context, param: click.Parameter, value: str | None) -> str | None:
    if value is not None:
        from uplift.viz.figure import check_suffix

        check_suffix(value)
    return value
