"""Options that state the surface of a binder."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import options

if TYPE_CHECKING:
    from uplift.extras.paint.optics import Surface

SURFACE = ("refractive_index", "surface_reflectance", "internal_reflectance")


def surface_options(note: str) -> options.Decorator:
    """``--refractive-index``, and Saunderson's reflectances in its place."""
    index = options.number(
        "--refractive-index",
        metavar="N",
        help=f"Refractive index of the binder, 1.5 for oil; {note}.",
    )
    outside = options.number(
        "--surface-reflectance",
        metavar="K1",
        help="Saunderson's reflectance of the surface for light from air. [default: by "
        "--refractive-index]",
    )
    inside = options.number(
        "--internal-reflectance",
        metavar="K2",
        help="Saunderson's reflectance of the surface for diffuse light from within. "
        "[default: by --refractive-index]",
    )
    return options.stacked(index, outside, inside)


def stated_surface(
    refractive_index: float | None,
    surface_reflectance: float | None,
    internal_reflectance: float | None,
) -> Surface | None:
    """Return the surface that options state, None if they do not."""
    from uplift.extras.paint.optics import Surface

    stated = (refractive_index, surface_reflectance, internal_reflectance)
    if all(value is None for value in stated):
        return None
    by_index = Surface.of_index(1.0 if refractive_index is None else refractive_index)
    return Surface(
        by_index.outside if surface_reflectance is None else surface_reflectance,
        by_index.inside if internal_reflectance is None else internal_reflectance,
    )
