"""Options of the sensor that defines RGB: space, illuminant and observer."""

import click

from . import options
from .option_types import OBSERVER, SPACE


def space(camera: str = "") -> options.Decorator:
    """``--space``: the space of what is built or listed."""
    text = (
        "RGB space by its name in colour-science or OpenColorIO, such as "
        f"ACEScg{camera}."
    )
    return click.option("--space", default="sRGB", type=SPACE, help=text)


def observer(camera: str = "") -> options.Decorator:
    """``--observer``."""
    default = "CIE 1931 2 Degree Standard Observer"
    text = f"Standard observer{camera}."
    metavar = "NAME|FILE" if camera else "NAME"
    return click.option(
        "--observer",
        metavar=metavar,
        default=default,
        type=OBSERVER,
        help=text,
    )


sensor = options.stacked(
    space("; or camera: raw values"),
    click.option(
        "--illuminant",
        metavar="NAME|FILE",
        type=options.LIGHT,
        default="D65",
        help="Illuminant under which RGB are defined; a cube needs a name, other "
        "commands read the file of a lamp.",
    ),
    observer(
        ", or with --space camera a camera: name or FILE of sensitivities (CSV, or "
        "JSON of rawtoaces)"
    ),
)
"""``space``, ``illuminant`` and ``observer``, for `uplift.colorimetry.observer.sensor`.
"""
