"""``uplift.h``: a header in C that reads cube files when a program runs.

It is composed of the source of exported programs (`program`), included once for each
number of coefficients, and of the reader of files in ``source/runtime/``. The composed
file is part of the package: programs copy it.
"""

import re
from collections.abc import Iterable, Iterator
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

from uplift.common.arrays import StrPath
from uplift.common.files import write_text
from uplift.cube.file import FEATURES, VERSION
from uplift.extras.export.program import LANGUAGES, literal, read_source
from uplift.extras.export.program_table import MOVES
from uplift.models.moments import MAX_COUNT, WARPS

HEADER = "uplift.h"
SAMPLES = 512
"""Most wavelengths of a sensor for which colours are moved."""
KERNELS = {
    "sigmoid": (3, 1),
    "moments_5": (5, 0),
    "moments_9": (9, 0),
    "moments_13": (13, 0),
    "moments_17": (MAX_COUNT, 0),
}
"""Numbers of coefficients, and whether they are of sigmoids, of which the lookup is
compiled. Spectra of fewer coefficients are filled up with zeros.
"""
STEPS = {"exact": (0, 4), "moved": (1, 9)}
"""Whether answers may be moved to their colours, and the numbers of a place."""
READER = ("file.c", "content.c", "table.c", "build.c")
"""Parts of the reader in reading order."""
ROUNDS = 64
"""Steps of SHA-256 for a block."""
PER_LINE = 8
NUMBERS_OF_WARP = 6
SKIPPED = "#ifdef UP_VEC4"
"""Begins a part of the source for shaders."""

def write_header(path: StrPath, *, force: bool = False) -> None:
    """Write ``uplift.h``, the reader of cube files for programs in C and C++."""
    write_text(shipped_header(), Path(path), force=force)


def shipped_header() -> str:
    """Return the header that is in the package."""
    file = files("uplift.extras.export") / HEADER
    return file.read_text(encoding="ascii")


def compose_header() -> str:
    """Compose the header of its parts."""
    reader = "".join(read_source(f"runtime/{name}") for name in READER)
    text = (
        read_source("runtime/head.h")
        + Template(reader).substitute(_reader_words())
        + "\n"
        + read_source("loops.c")
        + read_source("host.c")
        + _kernel_macros()
        + "".join(_inclusions())
        + Template(read_source("runtime/calls.c")).substitute(_call_words())
        + "\n#ifdef UP_KERNEL\n\n"
        + _kernel()
        + "#endif\n"
    )
    text = re.sub(r"\bUP_", "UPLIFT_", text)
    return Template(text).substitute(_head_words())


def _head_words() -> dict[str, Any]:
    return {
        "format": VERSION,
        "samples": SAMPLES,
        "count": MAX_COUNT,
        "width": LANGUAGES["c"].width,
    }


def _reader_words() -> dict[str, Any]:
    """Return the words of the reader that follow from the format and the models."""
    primes = _primes(ROUNDS)
    warps = []
    for name, terms in WARPS.items():
        numbers = [number for term in terms for number in term]
        numbers += [0.0] * (NUMBERS_OF_WARP - len(numbers))
        warps.append(f'{{"{name}", {{{", ".join(map(repr, numbers))}}}}}')
    return {
        "constants": _words_of_hash(_root_fraction(prime, 3) for prime in primes),
        "start": _words_of_hash(_root_fraction(prime, 2) for prime in primes[:8]),
        "features": ", ".join(f'"{feature}"' for feature in FEATURES),
        "warps": ", ".join(warps),
    }


def _call_words() -> dict[str, Any]:
    kernels = []
    for name, (count, _) in KERNELS.items():
        functions = [f"&uplift_{name}_{step}_functions" for step in STEPS]
        kernels.append(f"\n        {{{count}, {', '.join(functions)}}}")
    return {"kernels": ",".join(kernels), "samples": SAMPLES}


def _kernel_macros() -> str:
    constants = "\n".join(
        f"#define UP_{name} {literal(value)}" for name, value in MOVES.items()
    )
    return Template(read_source("runtime/kernel_macros.h")).substitute(
        constants=constants
    )


def _inclusions() -> Iterator[str]:
    """Yield the lines by which the header includes itself for each kernel."""
    for name, (count, is_sigmoid) in KERNELS.items():
        for step, (is_inexact, place) in STEPS.items():
            constants = {
                "KERNEL": f"uplift_{name}_{step}",
                "COUNT": count,
                "STRIDE": count // 4 * 4 + 4,
                "SIGMOIDS": is_sigmoid,
                "INEXACT": is_inexact,
                "PLACE": place,
            }
            lines = [f"#define UP_{key} {value}" for key, value in constants.items()]
            yield "\n".join(["", *lines, "#include UPLIFT_FILE", ""])


def _kernel() -> str:
    """Return the lookup of exported programs, whose functions have the name of the
    kernel.
    """
    lookup = read_source("cube.c").partition("${macros}\n")[2]
    before, _, shaders = lookup.partition(SKIPPED)
    after = shaders.partition("#endif\n")[2]
    calls = read_source("cube_calls.c").partition(" */\n")[2]
    calls = calls.rpartition("#if defined(__clang__)")[0]
    text = (before + after).replace("${calls}", calls)
    text = text.replace("up_number", "uplift_number")
    text = re.sub(r"\bup_(\w+)", r"UP_NAME(\1)", text)
    return text + read_source("runtime/kernel_end.c")


def _words_of_hash(words: Iterable[int]) -> str:
    """Format the constants of SHA-256, a few on a line."""
    texts = [f"0x{word:08x}" for word in words]
    rows = [
        texts[first : first + PER_LINE] for first in range(0, len(texts), PER_LINE)
    ]
    return ",\n".join("    " + ", ".join(row) for row in rows)


def _primes(count: int) -> list[int]:
    primes: list[int] = []
    number = 2
    while len(primes) < count:
        if all(number % prime for prime in primes):
            primes.append(number)
        number += 1
    return primes


def _root_fraction(number: int, degree: int) -> int:
    """Return the first 32 bits of the fraction of a root (FIPS 180-4, 4.2.2, 5.3.3)."""
    scaled = number << 32 * degree
    root = round(number ** (1 / degree) * 2**32)
    while root**degree > scaled:
        root -= 1
    while (root + 1) ** degree <= scaled:
        root += 1
    return root % 2**32
