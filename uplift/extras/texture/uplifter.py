"""Images uplifted by a cube."""

import json
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.illuminants import Illuminant, Lamp
from uplift.colorimetry.observer import lights as find_lights
from uplift.common.arrays import Floats
from uplift.extras.images import exr
from uplift.extras.images.channels import channel_names
from uplift.extras.images.converter import (
    Band,
    Converted,
    Converter,
    ImageConverter,
    resolve_depth,
)
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import Image
from uplift.extras.images.reader import SurfaceReader, outside_counts
from uplift.extras.texture.encodings import (
    PixelEncoding,
    Pixels,
    Spectrum,
    different_colours,
)
from uplift.lattice.entry_boxes import BoxHits
from uplift.lookup.blocks import blockwise
from uplift.lookup.cube import Cube
from uplift.lookup.errors_under_lights import LightErrors, light_errors
from uplift.lookup.interpolate import is_inexact
from uplift.lookup.refine import refine_to_rgb

UNREALISABLE = "pixels-unrealisable"
LESS_CHROMA = "of unrealisable colours: their spectra have less chroma"


@dataclass(frozen=True, eq=False, kw_only=True)
class Uplifter(Converter):
    """A converter of colours to the ``pixels`` of a cube, made by `prepare`, for any
    number of images. Pixels have a standard error for each of ``errors``.
    """

    reader: SurfaceReader
    cube: Cube
    pixels: Pixels
    errors: tuple[LightErrors, ...] = ()

    def open(
        self, image: Image, also: Sequence[Path] = ()
    ) -> AbstractContextManager[ImageConverter]:
        """Open what converts any image."""
        return nullcontext(ImageConverter(self.rows))

    def rows(self, band: Band) -> Converted:
        """Convert a band."""
        rgb, numbers, counts = self.numbers(band.rgb)
        values = [band.weighted(rgb), self.pixels.weighted(numbers, band)]
        if self.errors:
            values.append(band.weighted(self._standard_errors(band.rgb)))
        return tuple(values), counts

    def numbers(self, rgb: Floats) -> tuple[Floats, Floats, Counts]:
        """Return the colours (…, 3) that pixels get, and their numbers (…, N), for
        linear RGB (…, 3) of the reader; and counts of pixels that miss their colours.
        """
        if self.pixels.outside is not None:
            hits = self.cube.data.outside_boxes.find(rgb.reshape(-1, 3))
            if hits.rows.size:
                return self._outside_numbers(rgb, hits, self.pixels.outside)
        return self._inside_numbers(rgb)

    def _standard_errors(self, rgb: Floats) -> Floats:
        colours, rows = different_colours(np.clip(rgb, 0, 1))
        columns = [
            blockwise(estimate, colours.astype(float), 2, np.float32)[:, 0]
            for estimate in self.errors
        ]
        errors = np.stack(columns, axis=-1)[rows]
        hits = self.cube.data.outside_boxes.find(rgb.reshape(-1, 3))
        errors.reshape(-1, len(columns))[hits.rows] *= hits.lattice_weight[:, None]
        return errors

    def _inside_numbers(self, rgb: Floats) -> tuple[Floats, Floats, Counts]:
        data = self.cube.data
        colours = rgb.reshape(-1, 3).astype(float)
        near = colours[is_inexact(data, colours)]
        off = data.solid.signed_distance(near) > data.threshold if near.size else near
        counts = Counts.of(UNREALISABLE, int(np.count_nonzero(off)), LESS_CHROMA)
        return rgb, self.pixels.sample(rgb), counts

    def _outside_numbers(
        self, rgb: Floats, hits: BoxHits, entries: Floats
    ) -> tuple[Floats, Floats, Counts]:
        """Mix the answers to mapped colours with those of entries, as their colours: t
        · mapped + (1 − t) · entry.
        """
        data = self.cube.data
        colours = rgb.reshape(-1, 3).copy()
        requested = colours[hits.rows]
        is_mixed = hits.lattice_weight > 0
        weight = hits.lattice_weight[:, None]
        # With the method "error", only the core of a box is answered.
        method = self.reader.out_of_gamut
        map_to_gamut(requested[is_mixed], data.sensor, method)
        inside = "clip" if method == "error" else method
        mapped = map_to_gamut(requested, data.sensor, inside).rgb
        mixed = weight * mapped + (1 - weight) * data.outside_boxes.rgb[hits.entry]
        colours[hits.rows] = mapped
        _, values, counts = self._inside_numbers(colours.reshape(rgb.shape))
        numbers = values.reshape(len(colours), -1)
        mixture = weight * numbers[hits.rows] + (1 - weight) * entries[hits.entry]
        if self.pixels.model is not None:
            mixture = refine_to_rgb(data, self.pixels.model, mixture, mixed)
        numbers[hits.rows] = mixture
        colours[hits.rows] = mixed
        change = np.abs(mixed - requested).max(where=is_mixed[:, None], initial=0)
        counts += outside_counts(is_mixed.sum(), method, float(change))
        return colours.reshape(rgb.shape), numbers.reshape(values.shape), counts


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
    data = cube.data
    reader = SurfaceReader(
        sensor=data.sensor,
        encoding=encoding,
        space=space,
        out_of_gamut=out_of_gamut,
        boxes=data.outside_boxes,
    )
    depth = resolve_depth(depth, kind.depths, kind.name)
    pixels = kind.pixels(cube, threads)
    lights = find_lights(errors, cube.observer, data.sensor.range)
    names = [light.name for light in lights]
    lamps = [asdict(lamp) for lamp in errors if isinstance(lamp, Lamp)]
    settings: dict[str, Any] = {
        "as": kind.name,
        **pixels.details,
        "depth": depth,
        **reader.settings,
    }
    settings |= {"errors": names} if names else {}
    settings |= {"lamps": lamps} if lamps else {}
    return Uplifter(
        reader=reader,
        depth=depth,
        channels=(*pixels.channels, *map("error.{}".format, channel_names(names))),
        header={
            **exr.attributes(data),
            "uplift.texture": json.dumps(settings, allow_nan=False),
            **kind.header,
        },
        cube=cube,
        pixels=pixels,
        errors=tuple(map(partial(light_errors, data), lights)),
    )
