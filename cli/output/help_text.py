"""Help texts that fit narrow windows: examples on several lines, and a narrow column of options."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

import click

PROGRAM = "uplift "
OPTIONS_SHARE = 0.3
"""Share of the width that the column of options may take; longer options have a line of their own."""
_WORD = re.compile(r"(?:[^\s\"']|\"[^\"]*\"|'[^']*')+")


class HelpFormatter(click.HelpFormatter):
    """click's formatter, but nothing is wider than the window."""

    def write_text(self, text: str) -> None:
        """Write paragraphs, examples folded as a shell reads them."""
        width = self.width - self.current_indent
        super().write_text("\n".join(line for each in text.splitlines() for line in fold_example(each, width)))

    def write_dl(self, rows: Iterable[tuple[str, str]], col_max: int = 30, col_spacing: int = 2) -> None:
        """Write terms and their descriptions."""
        width = self.width - self.current_indent
        folded = [(fold_choices(term, width), description) for term, description in rows]
        super().write_dl(folded, min(col_max, int(OPTIONS_SHARE * self.width)), col_spacing)


def fold_example(line: str, width: int) -> Iterator[str]:
    """Yield the lines of an example, which end in a backslash but for the last; options stay with their values."""
    indent = line[: len(line) - len(line.lstrip())]
    if len(line) <= width or not line.lstrip().startswith(PROGRAM):
        yield line
        return
    row = ""
    for group in _groups(_WORD.findall(line)):
        longer = f"{row} {group}" if row.strip() else f"{row}{group}"
        if row.strip() and len(indent) + len(longer) + 2 > width:
            yield f"{indent}{row} \\"
            longer = f"  {group}"
        row = longer
    yield f"{indent}{row}"


def fold_choices(term: str, width: int) -> str:
    """Break the choices of an option, ``--name [a|b|c]``, where they exceed the width."""
    rows = [""]
    for part in re.split(r"(?<=\|)", term):
        if len(rows[-1] + part) > width:
            rows.append(" " * (term.find("[") + 1))
        rows[-1] += part
    return "\n".join(rows)


def _groups(words: list[str]) -> Iterator[str]:
    """Yield words, an option with the value that follows it, and ``>`` with its file."""
    words = list(reversed(words))
    while words:
        word = words.pop()
        if words and (word.startswith("-") or word in "|>") and not words[-1].startswith("-"):
            word = f"{word} {words.pop()}"
        yield word
