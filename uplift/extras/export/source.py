"""Sources of programs in ``source/``, and the notation in them.

``#include "NAME"`` stands for another file there, and ``up_`` and ``UP_`` for the name
of the program.
"""

import re
from importlib.resources import files
from typing import Any

INCLUDE = re.compile(r'^#include "(.+)"\n', re.MULTILINE)
CONDITION = re.compile(r"#if (?P<no>!?)(?P<name>\w+)$")
LOOP = re.compile(
    r"^(?P<indent> *)UP_UNROLL\n *for \(int (?P<name>\w+) = (?P<start>.+); \w+ < "
    r"(?P<stop>.+); \+\+\w+\) "
    r"(?P<body>\{\n(?:(?P=indent) .*\n)*(?P=indent)\}\n|[^{].*\n)",
    re.MULTILINE,
)
"""A loop to be written out: its statement is on the same line, or in braces."""
TERM = re.compile(r"(?P<sign>[+-]?) *(?P<word>\w+)(?: */ *(?P<divisor>\d+))?")
"""A term of the bound of a loop."""


def read_source(name: str) -> str:
    """Return a source with those that it includes."""
    path = files("uplift.extras.export") / "source" / name
    text = path.read_text(encoding="ascii")
    return INCLUDE.sub(lambda line: read_source(line[1]), text)


def name_program(text: str, stem: str) -> str:
    """Replace ``up_`` and ``UP_`` by the name of a file, as an identifier."""
    name = identifier(stem)
    text = re.sub(r"\bup_", f"{name}_", text)
    return re.sub(r"\bUP_", f"{name.upper()}_", text)


def identifier(stem: str) -> str:
    """Convert a file name to an identifier: 'macbeth-32' → 'macbeth_32', '32' →
    'cube_32'.
    """
    name = re.sub(r"\W+|__+", "_", stem, flags=re.ASCII)
    return name if re.match(r"[A-Za-z]", name) else f"cube_{name}".rstrip("_")


def comment(text: str) -> str:
    """Return text that cannot end a comment; names in a cube file are arbitrary."""
    ascii_text = text.encode("ascii", "replace").decode()
    return re.sub(r"[*$]", "", ascii_text).replace("\n", " ")


def literal(value: float) -> str:
    """Return an integer, or a number of single precision in nine digits."""
    if isinstance(value, int):
        return str(value)
    text = f"{value:.9g}"
    return f"{text}f" if {".", "e"} & set(text) else f"{text}.0f"


def select(text: str, constants: dict[str, Any]) -> str:
    """Keep the lines that ``#if NAME`` or ``#if !NAME`` of constants select; other
    conditions stay.
    """
    kept: list[str] = []
    open_ones: list[bool | None] = []  # of the conditions around a line; None stays
    for line in text.splitlines(keepends=True):
        condition = CONDITION.match(line)
        if condition and condition["name"] in constants:
            open_ones.append(
                bool(constants[condition["name"]]) != bool(condition["no"])
            )
            continue
        if line.startswith("#if"):
            open_ones.append(None)
        elif open_ones and open_ones[-1] is not None:
            if line.startswith("#else"):
                open_ones[-1] = not open_ones[-1]
                continue
            if line.startswith("#endif"):
                open_ones.pop()
                continue
        elif line.startswith("#endif"):
            open_ones.pop()
        if False not in open_ones:
            kept.append(line)
    return re.sub("\n{3,}", "\n\n", "".join(kept))


def unroll(text: str, constants: dict[str, Any]) -> str:
    """Write out loops marked by ``UP_UNROLL``, outer ones first: few compilers of
    shaders unroll, none all loops.
    """

    def copies(loop: re.Match[str]) -> str:
        start = _bound(loop["start"], constants)
        values = range(start, _bound(loop["stop"], constants))
        counter = re.compile(rf"\b{loop['name']}\b")
        bodies = (counter.sub(str(value), loop["body"]) for value in values)
        return unroll("".join(f"{loop['indent']}{body}" for body in bodies), constants)

    return LOOP.sub(copies, text)


def _bound(text: str, constants: dict[str, Any]) -> int:
    """Return the value of a sum of integers, constants and their quotients."""
    total = 0
    for sign, word, divisor in TERM.findall(text):
        value = constants[word] if word in constants else int(word)
        value //= int(divisor or 1)
        total += -value if sign == "-" else value
    return total
