"""Page that mixes the lights of a palette on a picture of its materials in real time
(sections 2.2.2 and 5.1).
"""

import base64
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.text import pluralise
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.pages.html import render, resource
from uplift.extras.papers.palette.design import Design, matrix

MAX_MATERIALS = 255  # materials that 8-bit labels distinguish, as 0 means none
DISPLAY_EXPONENT = 1 / 2.2  # approximate transfer function of displays
MAX_STOPS = 3  # range of the exposure in both directions, in powers of two


@dataclass(frozen=True, eq=False)
class Relighting:
    """A picture of n materials rendered without light, which is applied last, and L
    lights for it.
    """

    title: str
    # (H, W, n) amount of each material in each pixel, including shading; 0 or more
    weights: NDArray[np.float32]
    materials: tuple[str, ...]
    material_coefficients: Array  # (n, m) of the factor model
    # (n, L, 3) linear sRGB of the materials under each light, by full spectra
    colours: Array
    lights: tuple[str, ...]
    light_coefficients: Array  # (L, m) of the factor model
    power: Array  # (L, N) spectral powers; a flat power of 1 has luminance 1
    white: Array  # (L, 3) linear sRGB of the perfect reflector, by full spectra
    to_rgb: Array  # (3, m) from coefficients to linear sRGB
    wavelengths: Array  # (N,) in nm

    @property
    def pixels(self) -> NDArray[np.float32]:
        """Coefficients of the pixels, (H, W, m)."""
        return self.weights @ self.material_coefficients.astype(np.float32)

    @property
    def labels(self) -> NDArray[np.uint8]:
        """Predominant material of each pixel (H, W), counted from 1; 0 for none."""
        labels = 1 + self.weights.argmax(axis=-1)
        return (labels * self.weights.any(axis=-1)).astype(np.uint8)

    @property
    def start_light(self) -> int:
        """Light that the page starts with: the one under which the materials look most
        different.
        """
        colours = self.colours.clip(0, 1) ** DISPLAY_EXPONENT
        distances = np.linalg.norm(colours - colours.mean(axis=0), axis=-1)
        return int(distances.mean(axis=0).argmax())

    def rgb(self, mix: ArrayLike) -> Array:
        """Light the picture by weights (L,) of the lights: linear sRGB (H, W, 3), not
        clipped.
        """
        light = np.asarray(mix, dtype=float) @ self.light_coefficients
        return self.pixels @ (self.to_rgb * light).T


def relighting(title: str, design: Design, weights: NDArray[np.float32]) -> Relighting:
    """Prepare a picture, weights (H, W, n), of a palette's materials to be lit by its
    lights.
    """
    palette = design.palette
    model = design.model
    colours = matrix(design)
    if len(palette.materials) > MAX_MATERIALS:
        raise OptionError(
            f"a picture must have at most {MAX_MATERIALS} materials, got "
            f"{len(palette.materials)}"
        )
    return Relighting(
        title=title,
        weights=weights,
        materials=tuple(material.name for material in palette.materials),
        material_coefficients=model.reflectance(design.reflectances),
        colours=colours.obtained,
        lights=tuple(light.name for light in palette.lights),
        light_coefficients=model.light(design.powers),
        power=design.powers,
        white=colours.whites,
        to_rgb=model.matrix,
        wavelengths=model.wavelengths,
    )


def page(view: Relighting) -> str:
    """Render the page of a relighting. Equal values give equal text."""
    height, width = view.weights.shape[:2]
    modelled = (
        view.material_coefficients[:, None] * view.light_coefficients @ view.to_rgb.T
    )
    # for every material under every light the colours by full spectra and by the factor
    # model
    patches = [
        list(zip(hex_codes(full), hex_codes(factor), strict=True))
        for full, factor in zip(view.colours, modelled, strict=True)
    ]
    return render(
        "extras/papers/palette/templates/relight_page.html.j2",
        title=view.title,
        lead=f"{pluralise(len(view.materials), 'material')} under any mix of "
        f"{pluralise(len(view.lights), 'light')}: "
        "move the dial to relight the picture.",
        width=width,
        height=height,
        coefficients=view.to_rgb.shape[1],
        lights=view.lights,
        materials=view.materials,
        max_stops=MAX_STOPS,
        whites=hex_codes(view.white),
        rows=list(zip(view.materials, patches, strict=True)),
        numbers=_numbers(view),
        # Half precision, whose error is a twentieth of an 8-bit code.
        pixels=pack(view.pixels.astype("<f2")),
        labels=pack(view.labels),
        script=resource(
            "extras/pages/draw.js", "extras/papers/palette/relight_page.js"
        ),
    )


def _numbers(view: Relighting) -> dict[str, Any]:
    return {
        "start": view.start_light,
        "lights": view.lights,
        "materials": view.materials,
        "wavelengths": view.wavelengths.tolist(),
        "power": view.power.tolist(),
        "white": view.white.tolist(),
        "light": view.light_coefficients.tolist(),
        "material": view.material_coefficients.tolist(),
        "colours": view.colours.tolist(),
        "toRgb": view.to_rgb.tolist(),
    }


def pack(values: NDArray[Any]) -> str:
    """Deflate an array byte plane by byte plane, which makes half-precision numbers a
    third smaller, as base64.
    """
    planes = np.frombuffer(values.tobytes(), np.uint8).reshape(-1, values.itemsize)
    return base64.b64encode(zlib.compress(planes.T.tobytes(), 9)).decode("ascii")
