"""``uplift.h``: a header in C that reads cube files when a program runs.

It is composed of the source of exported programs (`program`), included once for each
number of coefficients, and of the reader of files in ``source/runtime/``.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from itertools import chain, product
from pathlib import Path
from string import Template
from typing import Any

from uplift.common.arrays import StrPath
from uplift.common.files import write_text
from uplift.cube.file import FEATURES, VERSION
from uplift.cube.schema import ARRAYS
from uplift.extras.export.program import LANGUAGES, read_calls
from uplift.extras.export.program_table import MOVES, TEXEL
from uplift.extras.export.source import literal, read_source
from uplift.models.moments import MAX_COUNT, WARPS

HEADER = "uplift.h"
SAMPLES = 512
"""Most wavelengths of a sensor for which colours are moved."""
COUNTS = (5, 9, MAX_COUNT)
"""Numbers of moments for which the lookup is compiled."""
WARPED_COUNTS = (5, MAX_COUNT)
"""The same for phases that are not linear, where the basis takes most of the time."""
SPARSE_COUNTS = (3, 9, MAX_COUNT)


@dataclass(frozen=True)
class Kernel:
    """A lookup that is compiled, for spectra of up to ``count`` coefficients; fewer are
    filled up with zeros.
    """

    count: int
    is_sigmoid: bool
    is_warped: bool
    is_inexact: bool
    """Whether answers may be moved to their colours."""
    is_sparse: bool = False
    """Whether nodes may be absent, so that their rows must be found."""

    @property
    def name(self) -> str:
        words = ["uplift", "sigmoid" if self.is_sigmoid else f"moments_{self.count}"]
        words += ["warped"] * self.is_warped
        words += ["moved"] * self.is_inexact
        words += ["sparse"] * self.is_sparse
        return "_".join(words)

    @property
    def constants(self) -> dict[str, Any]:
        """The constants of programs on which its code depends."""
        return {
            "KERNEL": self.name,
            "COUNT": self.count,
            "ENTRY_COUNT": self.count if self.is_sigmoid else MAX_COUNT,
            "STRIDE": self.count // TEXEL * TEXEL + TEXEL,
            "SIGMOIDS": int(self.is_sigmoid),
            "WARPED": int(self.is_warped),
            "INEXACT": int(self.is_inexact),
            "PLACE": 9 if self.is_inexact else 4,
            "ROW_OF(index)": "uplift_row(cube, index)" if self.is_sparse else "(index)",
        }


PLAIN = [(count, False) for count in COUNTS]
WARPED = [(count, True) for count in WARPED_COUNTS]
MOMENTS = [
    Kernel(count, is_sigmoid=False, is_warped=is_warped, is_inexact=is_inexact)
    for (count, is_warped), is_inexact in product(PLAIN + WARPED, (False, True))
]
SIGMOIDS = [
    Kernel(3, is_sigmoid=True, is_warped=False, is_inexact=is_inexact)
    for is_inexact in (False, True)
]
SPARSE = [
    replace(kernel, is_sparse=True)
    for kernel in SIGMOIDS + MOMENTS
    if kernel.is_inexact and kernel.count in SPARSE_COUNTS
]
"""Those of cubes of a scene need not be as fast, and also answer exact cells: they are
enough for every cube.
"""
KERNELS = SIGMOIDS + MOMENTS + SPARSE
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
    "NODES",
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


def compose_header(kernels: Sequence[Kernel] = KERNELS) -> str:
    """Compose the header of its parts, with the lookups of some kernels."""
    words = {
        "format": VERSION,
        "samples": SAMPLES,
        "count": MAX_COUNT,
        "width": LANGUAGES["c"].width,
        "definitions": "\n".join(
            f"#define UP_{name} {literal(value)}" for name, value in MOVES.items()
        ),
        "fields": "\n".join(
            f"#define UP_{name} cube->{name.lower()}" for name in FIELDS
        ),
        "inclusions": "\n".join(map(_inclusion, kernels)),
        "kernels": ",".join(map(_kernel_row, kernels)),
        "kernel": _kernel(),
    }
    text = Template(read_source("runtime/uplift.h")).substitute(words | _reader_words())
    return re.sub(r"\bUP_", "UPLIFT_", text)


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


def _kernel_row(kernel: Kernel) -> str:
    """Return the row of a kernel in the list from which one is chosen."""
    kinds = (
        kernel.is_sigmoid,
        kernel.is_warped,
        kernel.is_inexact,
        kernel.is_sparse,
    )
    text = ", ".join(map(str, [kernel.count, *map(int, kinds)]))
    return f"\n        {{{text}, &{kernel.name}_functions}}"


def _inclusion(kernel: Kernel) -> str:
    """Return the lines by which the header includes itself for a kernel."""
    lines = [f"#define UP_{key} {value}" for key, value in kernel.constants.items()]
    return "\n".join(["", *lines, "#include UPLIFT_FILE"])


def _kernel() -> str:
    """Return the lookup of exported programs, whose functions have the name of the
    kernel.
    """
    _, calls = read_calls("cube", ".c")
    text = (read_source("cube.c") + calls).replace("up_number", "uplift_number")
    return re.sub(r"\bup_(\w+)", r"UP_NAME(\1)", text)


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
