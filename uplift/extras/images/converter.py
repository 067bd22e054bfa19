"""What leads from the colours of images to the channels of OpenEXR files."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from uplift.common.arrays import Floats
from uplift.common.errors import OptionError
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import Image, Part
from uplift.extras.images.reader import Reader


@dataclass(frozen=True, eq=False)
class Band:
    """Rows of a part to convert: linear RGB (k, width, 3) from row ``first``, counted
    from 0, and the alpha (k, width, 1) that multiplies them in the file, if any.
    """

    part: Part
    first: int
    rgb: Floats
    opacity: Floats | None = None

    def weighted(self, values: Floats) -> Floats:
        """Multiply values (k, width, N) by alpha."""
        return values if self.opacity is None else values * self.opacity


Converted = tuple[tuple[Floats, ...], Counts]
"""Arrays (k, width, …) that make R, G, B and the channels side by side, multiplied by
alpha where they are linear in the colour; and counts of changed pixels.
"""


def no_attributes(part: Part) -> Mapping[str, Any]:
    """A part has no attributes but those of all files."""
    return {}


@dataclass(frozen=True, eq=False)
class ImageConverter:
    """The conversion of one image, or of all images alike.

    ``rows`` converts bands, ``header`` are the attributes of a part next to those of
    the `Converter`, and ``facts`` sentences about the image, such as its exposure.
    """

    rows: Callable[[Band], Converted]
    header: Callable[[Part], Mapping[str, Any]] = no_attributes
    facts: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False, kw_only=True)
class Converter(ABC):
    """How images become OpenEXR files: ``reader`` reads their colours, ``depth`` is the
    type of R, G, B and the further ``channels``, ``header`` the attributes of each
    file.
    """

    reader: Reader
    depth: str
    channels: tuple[str, ...] = ()
    header: Mapping[str, Any]

    @abstractmethod
    def open(
        self, image: Image, also: Sequence[Path] = ()
    ) -> AbstractContextManager[ImageConverter]:
        """Open what converts an image, with further photographs of the same thing."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RowConverter(Converter):
    """A converter of rows, whichever image they are of."""

    to_rows: ImageConverter

    def open(
        self, image: Image, also: Sequence[Path] = ()
    ) -> AbstractContextManager[ImageConverter]:
        """Open what converts any image."""
        return nullcontext(self.to_rows)


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
