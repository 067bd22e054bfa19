"""Pictures as paintings: the share of each paint in every pixel, as layers.

The shares of all colours of a lattice are solved once, each from several starts, by
the steps of `recipes`; those of a pixel are interpolated, and R, G and B of the result
are the colours that these shares have.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from uplift.colorimetry import (
    Sensor,
    delta_e_2000,
    delta_e_2000_terms,
    observer,
    rgb_to_lab,
)
from uplift.colorimetry.gamut import check_method
from uplift.common.arrays import Array, Floats
from uplift.common.errors import OptionError
from uplift.common.text import listed
from uplift.extras.colour.spaces import ImageSpace
from uplift.extras.images import exr
from uplift.extras.paint.paints import Paints
from uplift.extras.paint.recipes import descend, shares_of
from uplift.extras.texture.colours import Counts, check_encoding
from uplift.extras.texture.uplifter import Converter

DIM = 17
"""Nodes of the lattice over each channel of encoded RGB."""
MAX_LAYERS = 8
WAVELENGTHS = (400.0, 700.0, 10.0)
"""Range and step in nm of the spectra of mixtures."""
STARTS = (-3.0, 1.0)
"""Logarithms of the ratio of a paint to the first, from which each solution starts."""
SPARSENESS = 0.05
"""Weight in units of ΔE00 of the spread of shares, which prefers few paints."""


@dataclass(frozen=True, eq=False)
class PaintLayers(Converter):
    """Converter of images to the shares of paints, made by `paint_layers`."""

    paints: Paints  # at the wavelengths of the sensor
    table: Array  # (DIM, DIM, DIM, P) shares of encoded RGB
    delta_e: Array
    """ΔE00 (DIM³,) between the colours of the lattice and those of their shares."""

    def convert(self, rgb: Floats) -> tuple[tuple[Floats, ...], Counts]:
        """Return the colours of the mixtures and their shares (…, P)."""
        shares = self.shares(rgb)
        mixed = self.sensor.rgb(self.paints.reflectance(shares))
        inside = np.clip(mixed, 0, 1).astype(np.float32)
        return (inside, shares.astype(np.float32)), Counts()

    def shares(self, rgb: Floats) -> Array:
        """Return the shares (…, P) of linear RGB (…, 3) in [0, 1]."""
        from scipy.interpolate import interpn

        axis = np.linspace(0, 1, DIM)
        decoding = self.sensor.decoding
        codes = np.interp(rgb, decoding, np.linspace(0, 1, len(decoding)))
        shares = interpn((axis,) * 3, self.table, codes.reshape(-1, 3))
        return np.asarray(shares).reshape(*rgb.shape[:-1], len(self.paints))


def paint_layers(
    paints: Paints,
    *,
    sensor: Sensor | None = None,
    encoding: str = "auto",
    out_of_gamut: str = "clip",
    space: ImageSpace | None = None,
) -> PaintLayers:
    """Prepare to convert pictures to layers of paint.

    Parameters
    ----------
    paints : Paints
        One to `MAX_LAYERS` paints.
    sensor : Sensor, optional
        RGB space and illuminant of the result, by default sRGB under D65.
    encoding : {"auto", "linear", "encoded"}
        Interpretation of the numbers in images.
    out_of_gamut : str
        Treatment of pixels outside [0, 1], one of
        `uplift.colorimetry.gamut.METHODS`.
    space : ImageSpace, optional
        RGB space of images, by default the one that each file states.

    Returns
    -------
    PaintLayers
        The converter to pass to `uplift.extras.texture.convert`.

    Raises
    ------
    OptionError
        There are more paints than layers, or two layers have the same name.
    """
    check_encoding(encoding)
    check_method(out_of_gamut)
    if len(paints) > MAX_LAYERS:
        raise OptionError(
            f"a picture has at most {MAX_LAYERS} layers of paint, got {len(paints)}",
            code="too-many-paints",
            hint="select some of the paints",
        )
    sensor = sensor or observer.sensor(wavelengths=WAVELENGTHS)
    sampled = paints.at(sensor.wavelengths)
    axis = np.linspace(0, 255, DIM)
    codes = np.array(list(product(axis, repeat=3)))
    shares, delta_e = _solve(sampled, sensor, sensor.decode(codes))
    return PaintLayers(
        sensor,
        "float",
        encoding,
        out_of_gamut,
        layer_names(paints.names),
        {
            "chromaticities": exr.chromaticities(sensor),
            "uplift.paints": json.dumps(list(paints.names)),
        },
        paints=sampled,
        table=shares.reshape(DIM, DIM, DIM, -1),
        delta_e=delta_e,
        space=space,
    )


def layer_names(names: Sequence[str]) -> tuple[str, ...]:
    """Return the names of channels; a full stop would begin a layer in a layer."""
    layers = tuple(f"{name.replace('.', '_')}.Y" for name in names)
    if len(set(layers)) < len(layers):
        raise OptionError(
            f"each layer must have its own name, got {listed(layers)}",
            hint="rename a paint in its file",
        )
    return layers


def _solve(paints: Paints, sensor: Sensor, rgb: Array) -> tuple[Array, Array]:
    """Return the shares (n, P) that come nearest to linear RGB (n, 3), and ΔE00."""
    goals = rgb_to_lab(sensor, rgb)
    count = len(paints)

    def residuals(ratios: Array) -> Array:
        shares = shares_of(ratios)
        mixed = rgb_to_lab(sensor, sensor.rgb(paints.reflectance(shares)))
        spread = SPARSENESS * np.sqrt(shares)
        return np.concatenate([delta_e_2000_terms(mixed, goals), spread], axis=1)

    starts = [np.zeros(count - 1)]
    for paint in range(count - 1):
        starts.append(np.where(np.arange(count - 1) == paint, *STARTS[::-1]))
    best = np.full(len(rgb), np.inf)
    shares = np.zeros((len(rgb), count))
    for start in starts:
        ratios, squares = descend(residuals, np.tile(start, (len(rgb), 1)))
        is_better = squares < best
        shares = np.where(is_better[:, None], shares_of(ratios), shares)
        best = np.minimum(best, squares)
    mixed = sensor.rgb(paints.reflectance(shares))
    return shares, delta_e_2000(rgb_to_lab(sensor, mixed), goals)
