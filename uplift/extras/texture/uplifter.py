"""Converters, which `uplift.extras.texture.convert` applies to an image, and the
numbers of a pixel of a texture.
"""

import contextlib
import json
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from uplift import models
from uplift.colorimetry.gamut import check_method, map_to_gamut
from uplift.colorimetry.illuminants import Illuminant, Lamp
from uplift.colorimetry.observer import lights as find_lights
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Floats, Indices, Values
from uplift.common.errors import OptionError
from uplift.extras.colour.spaces import ImageSpace, find_space
from uplift.extras.images import exr
from uplift.extras.texture.channels import ColourChannels
from uplift.extras.texture.colours import Counts, Decoder, check_encoding, make_decoder
from uplift.extras.texture.image import Image, Part
from uplift.lattice.entry_boxes import BoxHits, OutsideBoxes
from uplift.lookup.blocks import as_wavelengths, blockwise
from uplift.lookup.cube import Cube
from uplift.lookup.errors_under_lights import LightErrors, light_errors
from uplift.lookup.interpolate import (
    extended_multipliers,
    is_inexact,
    refined_multipliers,
)
from uplift.lookup.refine import refine_to_rgb
from uplift.models.model import Model

Sampler = Callable[[Floats], Floats]
"""From linear RGB (…, 3) in [0, 1] to numbers (…, N)."""
SPECTRAL_LAYOUT = {"spectralLayoutVersion": "1.0"}
"""Attribute of files in the layout of Fichet et al. 2021."""
ReadColours = Callable[[Values], tuple[Floats, Counts]]
"""From the numbers of an image (…, 3) to linear RGB (…, 3), and counts of unusual
pixels.
"""
Converted = tuple[tuple[Floats, ...], Counts]
"""Arrays that make the channels (…, 3 + N) side by side, and pixels that the conversion
could not represent.
"""
ConvertRows = Callable[[Part, int, Floats], Converted]
"""Conversion of rows (k, width, 3) of a part, from the row of this number in its
window.
"""


@dataclass(frozen=True, eq=False)
class Converter(ABC):
    """Conversion of linear RGB of a sensor to the channels of an OpenEXR file.

    ``depth`` is the type of the channels, ``channels`` (N,) the names of those after R,
    G and B, ``header`` the attributes of every file, ``space`` the RGB space of
    images, None for the one that each file states, and ``paths`` further images that
    the conversion of an image reads.
    """

    sensor: Sensor
    depth: str
    encoding: str
    out_of_gamut: str
    channels: tuple[str, ...]
    header: Mapping[str, Any]
    space: ImageSpace | None = field(default=None, kw_only=True)
    paths: tuple[Path, ...] = field(default=(), kw_only=True)

    @abstractmethod
    def convert(self, rgb: Floats) -> Converted:
        """Arrays that make R, G, B and the channels (…, 3 + N) side by side, for linear
        RGB (…, 3) of `decoder`.
        """

    def multiply(
        self, values: tuple[Floats, ...], opacity: Floats
    ) -> tuple[Floats, ...]:
        """Multiply the arrays of `convert`, which are not changed, by alpha (…, 1)."""
        return tuple(array * opacity for array in values)

    def colour_channels(self, found: ColourChannels) -> ColourChannels:
        """How the colour channels that a part has are read: by default as they were
        found.
        """
        return found

    @property
    def boxes(self) -> OutsideBoxes | None:
        """Boxes outside [0, 1] whose colours are converted as they are, if there are
        any.
        """
        return None

    def decoder(self, part: Part) -> ReadColours:
        """Conversion of the numbers of a part to linear RGB, by default in [0, 1] or in
        `boxes`.
        """
        return make_decoder(
            self.sensor, part, self.encoding, self.out_of_gamut, self.space, self.boxes
        )

    def mapped(self, rgb: Values) -> tuple[Floats, Counts]:
        """Return linear RGB (…, 3) in [0, 1] or in `boxes`, as `decoder` does for
        parts, and the changed ones.
        """
        return Decoder(
            np.asarray, False, False, None, self.sensor, self.out_of_gamut, self.boxes
        )(rgb)

    def part_header(self, part: Part) -> Mapping[str, Any]:
        """Attributes of one part in addition to ``header``, by default none."""
        return {}

    def facts(self, image: Image) -> tuple[str, ...]:
        """State what was found out about an image, by default nothing."""
        return ()

    @contextlib.contextmanager
    def opened(self, image: Image) -> Iterator[ConvertRows]:
        """Yield the conversion of rows of an image: by default `convert`, wherever they
        are.
        """
        yield lambda part, first, rgb: self.convert(rgb)


@dataclass(frozen=True, eq=False)
class Pixels:
    """Numbers of a pixel encoding of a cube.

    ``channels`` (N,) are named, and described by ``details`` as JSON values.
    ``sample``, ``outside`` and ``model`` are those of `Uplifter`.
    """

    channels: tuple[str, ...]
    sample: Sampler
    outside: Floats | None
    model: Model | None = None
    details: Mapping[str, Any] = field(default_factory=dict)


class PixelEncoding(ABC):
    """The numbers of a pixel, the channels for them, and their description in the
    header.
    """

    name: ClassVar[str]
    """Name of the encoding."""
    depths: ClassVar[tuple[str, ...]]
    """Channel types that are precise enough, the default first."""
    header: ClassVar[dict[str, str]] = {}
    """Attributes that the layout requires."""

    @abstractmethod
    def pixels(self, cube: Cube, threads: int) -> Pixels:
        """The numbers for a cube. Raises `OptionError` if it has none of this kind."""


@dataclass(frozen=True)
class Spectrum(PixelEncoding):
    """Reflectance at wavelengths, a channel ``T.550,000000nm`` each.

    Parameters
    ----------
    wavelengths : tuple of float, optional
        Ascending wavelengths in nm, by default those of the cube's sensor.

    References
    ----------
    A. Fichet, R. Pacanowski, A. Wilkie, "An OpenEXR Layout for Spectral Images", JCGT
    10(3), 2021.
    """

    wavelengths: tuple[float, ...] | None = None
    name = "spectrum"
    depths = ("half", "float")
    header = SPECTRAL_LAYOUT

    def pixels(self, cube: Cube, threads: int) -> Pixels:
        from uplift.lookup import bulk

        at = as_wavelengths(self.wavelengths, cube.wavelengths)
        entries = cube.data.atlas.outside
        channels = spectral_channels("T", at)
        outside = None
        if entries is not None:
            rows = np.arange(len(entries.names))
            outside = entries.spectra.reflectance(rows, at).astype(np.float32)
        sample = bulk.spectra(cube, self.wavelengths, threads=threads)
        return Pixels(channels, sample, outside, details={"wavelengths": at.tolist()})


@dataclass(frozen=True)
class Moments(PixelEncoding):
    """Coefficients of a moments cube. They are linear in the spectrum, so textures can
    be filtered and mip-mapped.
    """

    name = "moments"
    depths = ("float", "half")

    def pixels(self, cube: Cube, threads: int) -> Pixels:
        from uplift.lookup import bulk

        model = cube.data.model
        entries = cube.data.atlas.outside
        if not isinstance(model, models.Moments):
            raise OptionError(
                f"moments need a moments cube, got a {model.name} cube",
                hint="write multipliers",
            )
        outside = None if entries is None else entries.coefficients.astype(np.float32)
        channels = tuple(f"moment.{index:02}" for index in range(model.count))
        return Pixels(channels, bulk.coefficients(cube, threads=threads), outside)


@dataclass(frozen=True)
class Multipliers(PixelEncoding):
    """Multipliers, from which spectra are evaluated at once. They are refined to the
    pixel's exact colour.

    Every model has them. They do not interpolate, so textures must not be filtered.

    Parameters
    ----------
    of_entries : bool
        As many as the spectra of entries have, instead of those of nodes.
    """

    of_entries: bool = False
    name = "multipliers"
    depths = ("float",)

    def pixels(self, cube: Cube, threads: int) -> Pixels:
        data = cube.data
        entries = cube.data.atlas.outside
        function = partial(refined_multipliers, data)
        model = data.model
        outside = None
        if self.of_entries:
            function = partial(extended_multipliers, data)
            model = data.atlas.spectra.model
        if entries is not None:
            numbers = (
                entries.spectra.multipliers
                if self.of_entries
                else data.model.from_storage(entries.coefficients)
            )
            outside = numbers.astype(np.float32)

        def sample(rgb: Floats) -> Floats:
            # images have few: a colour takes long, and has the same answer each time
            colours, rows = _different(rgb)
            floats = colours.astype(float)
            return blockwise(function, floats, model.count, np.float32, threads)[rows]

        channels = tuple(f"multiplier.{index:02}" for index in range(model.count))
        return Pixels(channels, sample, outside, model)


PIXEL_ENCODINGS: dict[str, Callable[[], PixelEncoding]] = {
    Spectrum.name: Spectrum,
    Moments.name: Moments,
    Multipliers.name: Multipliers,
}
"""Pixel encodings with their defaults, by name."""


def _different(rgb: Floats) -> tuple[Floats, Indices]:
    """Return the different colours (n, 3) of an image (…, 3), and the row (…) of each
    pixel among them.
    """
    flat = np.ascontiguousarray(rgb, dtype=np.float32).reshape(-1, 3)
    red, green, blue = flat.view(np.uint32).astype(np.uint64).T
    keys = (red << 32 | green) * np.uint64(0x9E3779B97F4A7C15) ^ blue
    _, first, rows = np.unique(keys, return_index=True, return_inverse=True)
    if (flat[first][rows] != flat).any():  # two colours have one key
        return flat, np.arange(len(flat)).reshape(rgb.shape[:-1])
    return flat[first], rows.reshape(rgb.shape[:-1])


def spectral_channels(quantity: str, wavelengths: Array) -> tuple[str, ...]:
    """Name the channels of ascending wavelengths (N,) in nm, such as
    ``T.550,000000nm``.

    The layout is that of Fichet et al. 2021: the quantity is T, reflectance, or S0,
    power that is not polarised. Raises `OptionError` for wavelengths that do not
    ascend.
    """
    names = tuple(
        f"{quantity}." + f"{wavelength:.6f}nm".replace(".", ",")
        for wavelength in wavelengths
    )
    if (np.diff(wavelengths) <= 0).any() or len(set(names)) < len(names):
        raise OptionError(
            "wavelengths of a spectral image must ascend in steps of at least 1e-6 nm",
            hint="sort them and remove duplicates",
        )
    return names


@dataclass(frozen=True, eq=False)
class Uplifter(Converter):
    """A converter of colours to spectra, made by `prepare`, for any number of images.

    ``sample`` maps linear RGB (…, 3) to the numbers (…, N) of a pixel, the multipliers
    of ``model``, or linear in the spectrum without one. ``outside`` are the numbers (O,
    N) of the entries outside the RGB space, if there are any. Pixels have a standard
    error for each of ``errors``.
    """

    cube: Cube
    sample: Sampler
    model: Model | None
    outside: Floats | None = None
    errors: tuple[LightErrors, ...] = ()

    @property
    def boxes(self) -> OutsideBoxes:
        return self.cube.data.outside_boxes

    def convert(self, rgb: Floats) -> Converted:
        values, counts = self._convert(rgb)
        if self.errors:
            values = (*values, self._standard_errors(rgb))
        return values, counts

    def _standard_errors(self, rgb: Floats) -> Floats:
        colours, rows = _different(np.clip(rgb, 0, 1))
        columns = [
            blockwise(estimate, colours.astype(float), 2, np.float32)[:, 0]
            for estimate in self.errors
        ]
        errors = np.stack(columns, axis=-1)[rows]
        hits = self.boxes.find(rgb.reshape(-1, 3))
        errors.reshape(-1, len(columns))[hits.rows] *= hits.lattice_weight[:, None]
        return errors

    def _convert(self, rgb: Floats) -> Converted:
        if self.outside is not None:
            hits = self.boxes.find(rgb.reshape(-1, 3))
            if hits.rows.size:
                return self._convert_outside(rgb, hits, self.outside)
        data = self.cube.data
        colours = rgb.reshape(-1, 3).astype(float)
        near = colours[is_inexact(data, colours)]
        off = data.solid.signed_distance(near) > data.threshold if near.size else near
        counts = Counts(unrealisable=int(np.count_nonzero(off)))
        return (rgb, self.sample(rgb)), counts

    def _convert_outside(
        self, rgb: Floats, hits: BoxHits, entries: Floats
    ) -> Converted:
        """Mix the answers to mapped colours with those of entries, as their colours: t
        · mapped + (1 − t) · entry.
        """
        colours = rgb.reshape(-1, 3).copy()
        requested = colours[hits.rows]
        is_mixed = hits.lattice_weight > 0
        weight = hits.lattice_weight[:, None]
        # With the method "error", only the core of a box is answered.
        map_to_gamut(requested[is_mixed], self.sensor, self.out_of_gamut)
        method = "clip" if self.out_of_gamut == "error" else self.out_of_gamut
        mapped = map_to_gamut(requested, self.sensor, method).rgb
        mixed = weight * mapped + (1 - weight) * self.boxes.rgb[hits.entry]
        colours[hits.rows] = mapped
        (_, values), counts = self._convert(colours.reshape(rgb.shape))
        numbers = values.reshape(len(colours), -1)
        mixture = weight * numbers[hits.rows] + (1 - weight) * entries[hits.entry]
        if self.model is not None:
            mixture = refine_to_rgb(self.cube.data, self.model, mixture, mixed)
        numbers[hits.rows] = mixture
        colours[hits.rows] = mixed
        change = np.abs(mixed - requested).max(where=is_mixed[:, None], initial=0)
        counts += Counts(outside=int(is_mixed.sum()), max_change=float(change))
        return (colours.reshape(rgb.shape), numbers.reshape(values.shape)), counts

    def multiply(
        self, values: tuple[Floats, ...], opacity: Floats
    ) -> tuple[Floats, ...]:
        rgb, numbers, *errors = super().multiply(values, opacity)
        return rgb, numbers if self.model is None else values[1], *errors


def prepare(
    cube: Cube,
    pixel_encoding: PixelEncoding | None = None,
    *,
    depth: str | None = None,
    encoding: str = "auto",
    out_of_gamut: str = "clip",
    space: str | None = None,
    errors: Sequence[Illuminant] = (),
    threads: int = 2,
) -> Uplifter:
    """Prepare a cube for textures.

    Parameters
    ----------
    cube : Cube
        The cube.
    pixel_encoding : PixelEncoding, optional
        `Spectrum` (the default), `Moments` or `Multipliers`.
    depth : {"half", "float"}, optional
        Type of the channels, by default the smallest that is precise enough.
    encoding : {"auto", "linear", "encoded"}
        Interpretation of the numbers in images; ``auto`` takes integers as encoded,
        floats as linear.
    out_of_gamut : str
        Gamut mapping for pixels outside [0, 1], one of
        `uplift.colorimetry.gamut.METHODS`. Pixels of the colour of an atlas entry
        outside the RGB space have its spectrum.
    space : str, optional
        RGB space of images, as for `uplift.extras.colour.spaces.find_space`, by default
        the one that each file states.
    errors : sequence of str
        Lights, as for `uplift.colorimetry.observer.light`, each with a channel of
        standard errors such as ``error.A``.
    threads : int
        Threads that share a band.

    Returns
    -------
    Uplifter
        The converter to pass to `convert`.

    Raises
    ------
    OptionError
        The depth is not precise enough, the cube has no moments or no standard errors,
        the wavelengths do not ascend, or the encoding or gamut mapping is unknown.
    UnknownNameError
        The RGB space or a light is unknown.
    """
    kind = Spectrum() if pixel_encoding is None else pixel_encoding
    depth = resolve_depth(depth, kind.depths, kind.name)
    check_encoding(encoding)
    check_method(out_of_gamut)
    pixels = kind.pixels(cube, threads)
    settings: dict[str, Any] = {
        "depth": depth,
        "encoding": encoding,
        "out_of_gamut": out_of_gamut,
    }
    settings |= {} if space is None else {"space": space}
    lights = find_lights(errors, cube.observer, cube.data.sensor.range)
    names = [light.name for light in lights]
    settings |= {"errors": names} if names else {}
    lamps = [asdict(lamp) for lamp in errors if isinstance(lamp, Lamp)]
    settings |= {"lamps": lamps} if lamps else {}
    description = json.dumps(
        {"as": kind.name, **pixels.details, **settings}, allow_nan=False
    )
    header = {**exr.attributes(cube.data), "uplift.texture": description, **kind.header}
    return Uplifter(
        cube.data.sensor,
        depth,
        encoding,
        out_of_gamut,
        (*pixels.channels, *map("error.{}".format, channel_names(names))),
        header,
        cube,
        sample=pixels.sample,
        model=pixels.model,
        outside=pixels.outside,
        errors=tuple(map(partial(light_errors, cube.data), lights)),
        space=None if space is None else find_space(space),
    )


def channel_names(lights: Sequence[str]) -> list[str]:
    """Return the names of lights as parts of the names of channels. Raises
    `OptionError` for two that become one name.

    >>> channel_names(["FL3.1", "my lamp"])
    ['FL3_1', 'my_lamp']
    """
    names = [re.sub(r"[^\w-]", "_", light) for light in lights]
    if len(set(names)) < len(names):
        problem = f"two lights have one name of a channel, got {', '.join(names)}"
        raise OptionError(problem, hint="rename one of the lamps")
    return names


def resolve_depth(depth: str | None, depths: tuple[str, ...], name: str) -> str:
    """Return the depth, by default the first of ``depths``. Raises `OptionError` for
    others.
    """
    if depth is not None and depth not in depths:
        raise OptionError(
            f"depth of {name} must be {' or '.join(depths)}, got '{depth}'",
            hint="others are imprecise",
        )
    return depth or depths[0]
