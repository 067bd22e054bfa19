"""``uplift.h``: a header in C that reads cube files when a program runs.

It is composed of the source of exported programs (`program`), once for each of a few
numbers of coefficients, and of the reader of files in ``source/runtime/``.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import chain
from pathlib import Path
from string import Template
from typing import Any

from uplift.common.arrays import StrPath
from uplift.common.files import write_text
from uplift.cube.file import FEATURES, VERSION
from uplift.cube.schema import ARRAYS
from uplift.extras.export.program import LANGUAGES, read_calls
from uplift.extras.export.program_table import MOVED_PLACE, MOVES, TEXEL
from uplift.extras.export.source import (
    literal,
    name_program,
    read_source,
    select,
    unroll,
)
from uplift.models.moments import MAX_COUNT, WARPS

HEADER = "uplift.h"
SAMPLES = 512
"""Most wavelengths of a sensor for which colours are moved."""
COUNTS = (5, 9, MAX_COUNT)
"""Numbers of moments for which the lookup is compiled, so that its loops are."""


OWN = re.compile(r"^UP_(?:FUNCTION|EXPANDED|SELDOM) \w+ up_(\w+)\(", re.MULTILINE)
"""A function that is defined for every kernel."""


@dataclass(frozen=True)
class Kernel:
    """A lookup that is compiled, for spectra of up to ``count`` coefficients; fewer are
    filled up with zeros.
    """

    count: int
    is_sigmoid: bool = False

    @property
    def name(self) -> str:
        return "uplift_sigmoid" if self.is_sigmoid else f"uplift_moments_{self.count}"

    @property
    def constants(self) -> dict[str, int]:
        """The constants of programs on which its code depends."""
        return {
            "UP_COUNT": self.count,
            "UP_ENTRY_COUNT": self.count if self.is_sigmoid else MAX_COUNT,
            "UP_STRIDE": self.count // TEXEL * TEXEL + TEXEL,
            "UP_SIGMOIDS": int(self.is_sigmoid),
            "UP_SPECTRA": 1,
            "UP_INEXACT": 1,
        }


KERNELS = (Kernel(3, is_sigmoid=True), *map(Kernel, COUNTS))
READ = (
    "nodes",
    "points",
    "coefficients",
    "distance",
    "standard_error",
    "atlas.rgb",
    "atlas.reach",
    "atlas.error",
    "atlas.coefficients",
    "atlas.entry_coefficients",
    "sensor.wavelengths",
    "sensor.cmfs",
    "sensor.power",
    "sensor.xyz_to_rgb",
    "sensor.sensitivities",
)
"""Arrays of a cube file that lookups need."""
FIELDS = (
    "DIM",
    "ENTRIES",
    "CELLS",
    "BINS",
    "LISTS",
    "BOXES",
    "PULL",
    "SCALES",
    "LUMINANCE",
    "FACETS",
    "FACET_COUNT",
    "SAMPLES",
    "FIRST",
    "STEP",
    "MARGIN",
    "START",
    "END",
    "LOW",
    "SCALE",
)
"""Constants of programs that are those of an open cube."""
TYPES = ("float64", "float32", "uint8", "int32", "int16", "uint32")
"""Types of arrays, in the order of the reader."""
LARGEST_PRIME = 311
"""The last of 64, one for each step of SHA-256."""
PER_LINE = 8
NUMBERS_OF_WARP = 6


def export(_: None, path: Path, style: str, *, force: bool) -> str:
    """Write the header."""
    return write_header(path, force=force)


def write_header(path: StrPath, *, force: bool = False) -> str:
    """Write ``uplift.h``, the reader of cube files for programs in C and C++."""
    text = compose_header()
    write_text(text, Path(path), force=force)
    return f"reads cube files in C and C++, {len(text) / 1e3:.0f} kB"


def compose_header() -> str:
    """Compose the header of its parts, with the lookups of all kernels."""
    words = {
        "format": VERSION,
        "samples": SAMPLES,
        "count": MAX_COUNT,
        "width": LANGUAGES["c"].width,
        "place": MOVED_PLACE,
        "definitions": "\n".join(
            f"#define UP_{name} {literal(value)}" for name, value in MOVES.items()
        ),
        "fields": "\n".join(
            f"#define UP_{name} cube->{name.lower()}" for name in FIELDS
        ),
        "lookups": _location() + "".join(map(_lookup, KERNELS)),
        "choices": ",".join(map(_choice, KERNELS)),
    }
    text = Template(read_source("runtime/uplift.h")).substitute(words | _reader_words())
    return name_program(text, "uplift")


def _reader_words() -> dict[str, Any]:
    """Return the words of the reader that follow from the format and the models."""
    primes = list(filter(_is_prime, range(2, LARGEST_PRIME + 1)))
    warps = []
    for name, terms in WARPS.items():
        numbers = list(chain(*terms))
        numbers += [0.0] * (NUMBERS_OF_WARP - len(numbers))
        warps.append(f'{{"{name}", {{{", ".join(map(repr, numbers))}}}}}')
    return {
        "constants": _hash_words(primes, 3),
        "start": _hash_words(primes[:8], 2),
        "features": ", ".join(f'"{feature}"' for feature in FEATURES),
        "arrays": ",\n    ".join(map(_array_word, READ)),
        "schema": ",".join(map(_schema_row, READ)),
        "warps": ", ".join(warps),
    }


def _array_word(name: str) -> str:
    return f"UPLIFT_{name.upper().replace('.', '_')}"


def _schema_row(name: str) -> str:
    """Return the row of an array in the schema of the reader."""
    stored = ARRAYS[name]
    types = sum(1 << TYPES.index(kind) for kind in stored.types)
    feature = FEATURES.index(stored.feature) + 1 if stored.feature else 0
    low, high = map(repr, (stored.low, stored.high))
    return f'\n    {{"{name}", "{stored.shape}", {types}, {low}, {high}, {feature}}}'


def _choice(kernel: Kernel) -> str:
    """Return the row of a kernel in the list from which one is chosen."""
    kinds = f"{kernel.count}, {int(kernel.is_sigmoid)}"
    return f"\n        {{{kinds}, {kernel.name}_reflectances_n}}"


def _location() -> str:
    """Return the source that finds the nodes of a colour, which all kernels share."""
    text = read_source("locate.c")
    return text.replace("UP_STRIDE", "cube->stride").replace("UP_COUNT", "cube->tag")


def _lookup(kernel: Kernel) -> str:
    """Return the lookup of exported programs with the constants of a kernel, in whose
    name its functions begin.
    """
    _, calls = read_calls("cube", ".c")
    text = select(read_source("cube.c") + calls, kernel.constants)
    text = unroll(text, kernel.constants)
    for name, value in kernel.constants.items():
        text = re.sub(rf"\b{name}\b", str(value), text)
    own = "|".join(OWN.findall(text))
    return re.sub(rf"\bup_({own})\b", rf"{kernel.name}_\1", text)


def _hash_words(primes: Sequence[int], degree: int) -> str:
    """Format the first 32 bits of the fractions of roots, the constants of SHA-256
    (FIPS 180-4, 4.2.2, 5.3.3), a few on a line.
    """
    roots = [Decimal(prime) ** (1 / Decimal(degree)) for prime in primes]
    texts = [f"0x{int(root % 1 * 2**32):08x}" for root in roots]
    rows = [texts[first : first + PER_LINE] for first in range(0, len(texts), PER_LINE)]
    return ",\n".join("    " + ", ".join(row) for row in rows)


def _is_prime(number: int) -> bool:
    return all(number % divisor for divisor in range(2, number))
