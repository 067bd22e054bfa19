"""Options that were renamed in 0.2.0. The old names are errors that name the new ones."""

from __future__ import annotations

import click

from uplift.common.errors import OptionError

RENAMED = {
    "--8bit": "--encoded",
    "--as": "--store",
    "--at": "--wavelengths",
    "--constants": "--km-constants",
    "--drawn": "--samples",
    "--fill": "--fill-missing",
    "--incident": "--incidence",
    "--index": "--refractive-index",
    "--most": "--max-moments",
    "--own": "--atlas-materials",
    "--to": "--format",
    "--within": "--auto-tolerance",
}
"""New name by old name."""


def renamed_option(error: click.NoSuchOption) -> OptionError | None:
    """Return the error for an option that the command knows under a new name, or None."""
    new = RENAMED.get(error.option_name)
    if error.ctx is None or new not in {name for param in error.ctx.command.params for name in param.opts}:
        return None
    return OptionError(f"{error.option_name} was renamed", code="option-renamed", hint=f"use {new}")
