"""Hints in terms of command-line options, by error code.

The library names parameters of Python in its hints. Where an option of the command line does the same, the table below
has the hint to show in place of the library's.
"""

from __future__ import annotations

from uplift.common.errors import Diagnostic

HINTS = {
    "codes-out-of-range": "leave out --encoded for linear floats",
    "encoded-floats-not-mapped": "use --out-of-gamut clip, or --encoding linear",
    "file-exists": "use --force to replace it, or give another name",
    "invalid-primaries": "give --primaries as x,y of red, green, blue and white, or the name of an RGB space",
    "no-moments": "use --store multipliers, or a cube of moments",
    "rgb-out-of-gamut": "map it inside with --out-of-gamut, or use --encoded for 8-bit codes",
    "unknown-gamut-mapping": "use --out-of-gamut with error, clip, scale, desaturate or desaturate-oklab",
}
"""Hint by code of an error or a warning."""


def hint_for(diagnostic: Diagnostic) -> str:
    """Return the hint of the command line for an error or warning, or else the library's own."""
    return HINTS.get(diagnostic.code, diagnostic.hint)


def describe(diagnostic: Diagnostic) -> str:
    """Return one line: location, problem and hint."""
    text = f"{diagnostic.where}: {diagnostic.problem}" if diagnostic.where else diagnostic.problem
    hint = hint_for(diagnostic)
    return f"{text}; {hint}" if hint else text
