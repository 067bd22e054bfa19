"""Optional packages, imported where they are used."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from uplift.common.errors import UpliftError

__all__ = ["needs_extra"]


@contextlib.contextmanager
def needs_extra(extra: str, purpose: str, error: type[UpliftError]) -> Iterator[None]:
    """Import an optional package in the block, with an error that names the extra of uplift that installs it.

    Parameters
    ----------
    extra : str
        The extra.
    purpose : str
        What needs the package, as the beginning of a sentence.
    error : type of UpliftError
        The type of the error raised.

    Raises
    ------
    UpliftError
        The package is not installed (code ``extra-not-installed``).

    Examples
    --------
    >>> with needs_extra("io", "sums", UpliftError):
    ...     import math
    """
    try:
        yield
    except ImportError as cause:
        name = (cause.name or "").partition(".")[0]
        raise error(
            f"{purpose} need the module '{name}', which is not installed",
            code="extra-not-installed",
            hint=f"install it: pip install 'spectral-uplift[{extra}]'",
        ) from cause
