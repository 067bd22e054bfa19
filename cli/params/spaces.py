"""RGB spaces of input, imported when one is named: their tables take a second to load."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.colorimetry.spaces import ImageSpace


def resolve_space(text: str | None) -> ImageSpace | None:
    """Return the space of a name or of chromaticities, None for None. Raises `UnknownNameError` and `OptionError`."""
    if text is None:
        return None
    from uplift.colorimetry.spaces import find_space

    return find_space(text)
