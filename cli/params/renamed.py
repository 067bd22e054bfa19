"""Options that were renamed: the old name is an error whose hint has the new one."""

from __future__ import annotations

import click

from uplift.common.errors import OptionError

RENAMED = {
    ("build", "--within"): "--auto-tolerance",
    ("chart", "--own"): "--atlas-materials",
    ("export", "--fill"): "--fill-missing",
    ("export", "--to"): "--format",
    ("mix", "--constants"): "--scattering",
    ("mix", "--incident"): "--incidence",
    ("mix", "--index"): "--refractive-index",
    ("mix", "--km-constants"): "--scattering",
    ("moments", "--most"): "--max-moments",
    ("query", "--8bit"): "--encoded",
    ("query", "--fill"): "--fill-missing",
    ("query", "--primaries"): "--space",
    ("stability", "--drawn"): "--samples",
    ("texture", "--as"): "--store",
    ("texture", "--fill"): "--fill-missing",
    ("wavelengths", "--at"): "--wavelengths",
}
"""New name by command and old name."""


def renamed_option(error: click.NoSuchOption) -> OptionError | None:
    """Return the error for an option that was renamed, or None for an unknown option."""
    old = error.option_name
    new = RENAMED.get((error.ctx.info_name or "", old)) if error.ctx else None
    if new is None:
        return None
    return OptionError(f"{old} was renamed", code="option-renamed", hint=f"use {new}")
