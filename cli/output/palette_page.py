"""The light dial of ``uplift palette``: its options, the picture, the page."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from uplift.design.palette import Design, Palette


def page_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """--html, --image, --label."""
    html = click.option(
        "--html", metavar="HTML", help="Write a page that mixes the lights on a picture of the materials."
    )
    image = click.option(
        "--image",
        metavar="FILE",
        help="The page's picture: an 8-bit image of labels, or EXR channels called like the materials.",
    )
    label = click.option(
        "--label",
        "labels",
        multiple=True,
        metavar="NAME=#RRGGBB",
        help="Colour that stands for a material in --image; may be repeated. [default: greys of 1, 2, …]",
    )
    return html(image(label(function)))


def read_picture(
    palette: Palette, html: str | None, image: str | None, labels: tuple[str, ...]
) -> NDArray[np.float32] | None:
    """How much of each material a pixel shows; None where the page draws its own. Asked before long work."""
    from uplift.common.errors import OptionError
    from uplift.design.palette.relight_viewer.picture_file import read_weights

    if image is None and labels:
        raise OptionError("--label without --image", hint="name the image that has these colours")
    if image is not None and html is None:
        raise OptionError("--image without --html", hint="name the page that shall show it")
    if image is None:
        return None
    return read_weights(image, [part.name for part in palette.materials], _told(labels))


def _told(labels: tuple[str, ...]) -> dict[str, str] | None:
    """Colour by material."""
    from uplift.common.errors import OptionError

    told: dict[str, str] = {}
    for label in labels:
        name, sign, colour = label.partition("=")
        if not sign:
            raise OptionError(f"label '{label}' has no colour", hint="write it as NAME=#rrggbb")
        if name in told:
            raise OptionError(f"two colours for '{name}'", hint="give one")
        told[name] = colour
    return told or None


def write_page(
    found: Design, spec: str, picture: NDArray[np.float32] | None, path: str, *, force: bool
) -> None:
    """Write the page, called like the spec."""
    from uplift.common.files import write_text
    from uplift.design.palette.relight_viewer.cutaway import cutaway
    from uplift.design.palette.relight_viewer.page import page
    from uplift.design.palette.relight_viewer.relighting import relighting

    weights = cutaway(len(found.palette.materials)) if picture is None else picture
    write_text(page(relighting(Path(spec).stem, found, weights)), path, force=force)
    click.echo(f"{path}: light dial", err=True)
