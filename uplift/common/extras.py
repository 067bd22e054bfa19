"""Optional packages, imported where they are used."""

from __future__ import annotations

import importlib
from types import ModuleType

from uplift.common.errors import UpliftError

__all__ = ["import_extra"]


def import_extra(module: str, extra: str, purpose: str, error: type[UpliftError]) -> ModuleType:
    """Import a module of an optional package.

    Parameters
    ----------
    module : str
        The module.
    extra : str
        The extra of uplift that installs its package.
    purpose : str
        What needs it, as the beginning of a sentence.
    error : type of UpliftError
        The type of the error raised.

    Returns
    -------
    module

    Raises
    ------
    UpliftError
        The package is not installed (code ``extra-not-installed``).

    Examples
    --------
    >>> import_extra("math", "io", "sums", UpliftError).__name__
    'math'
    """
    try:
        return importlib.import_module(module)
    except ImportError as cause:
        name = module.partition(".")[0]
        raise error(
            f"{purpose} need the package of the module '{name}', which is not installed",
            code="extra-not-installed",
            hint=f"install it: pip install 'spectral-uplift[{extra}]'",
        ) from cause
