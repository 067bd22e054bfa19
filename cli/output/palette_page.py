"""Relighting page of ``uplift palette``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from uplift.common.errors import OptionError

from .console import say

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from uplift.design.palette import Design, Palette


def read_picture(
    palette: Palette, html: str | None, image: str | None, labels: tuple[str, ...]
) -> NDArray[np.float32] | None:
    """Read how much of each material a pixel shows; None if the page draws its own picture."""
    if image is None and labels:
        raise OptionError(
            "--label requires --image",
            code="label-without-image",
            hint="give the image that has these colours",
        )
    if image is None:
        return None
    if html is None:
        raise OptionError("--image requires --html", code="image-without-page", hint="give the page to write")
    from uplift.design.palette.picture import read_weights

    return read_weights(image, [part.name for part in palette.materials], _parse_labels(labels))


def _parse_labels(labels: tuple[str, ...]) -> dict[str, str] | None:
    """Return colours by material, or None without labels."""
    colours: dict[str, str] = {}
    for label in labels:
        name, sign, colour = label.partition("=")
        if not sign:
            raise OptionError(f"label must be NAME=#rrggbb, got '{label}'", code="invalid-label", hint="add a colour")
        if name in colours:
            raise OptionError(
                f"label '{name}' has two colours", code="repeated-label", hint="give one colour per material"
            )
        colours[name] = colour
    return colours or None


def write_page(design: Design, spec: str, picture: NDArray[np.float32] | None, path: str, *, force: bool) -> None:
    """Write the page, titled with the stem of the spec's file name."""
    from uplift.common.files import write_text
    from uplift.design.palette.picture import cutaway
    from uplift.design.palette.relight_page import page, relighting

    weights = cutaway(len(design.palette.materials)) if picture is None else picture
    write_text(page(relighting(Path(spec).stem, design, weights)), path, force=force)
    say(f"{path}: relighting page", err=True)
