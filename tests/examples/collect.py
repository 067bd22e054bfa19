"""Examples: lines that begin with ``uplift`` in the code blocks of pages and in help texts, in reading order."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import click
from uplift_cli.main import COMMANDS, main

from tests.conftest import ROOT

BLOCKS = re.compile(r"^```(\S*)[^\n]*\n(.*?)^```", re.DOTALL | re.MULTILINE)
SHELLS = ("", "console", "bash", "sh")
FIRST = ("README.md", "docs/commands.md")
"""Pages that are read first. The others are in alphabetical order, after the help texts."""
TUTORIAL = "docs/tutorial.md"
"""The page whose commands and Python tests/test_tutorial.py runs together, in a separate folder."""
ELSEWHERE = {
    "uplift texture 'shot.*.exr' -o sequence --cube macbeth-32.uplift --scheduler tcp://10.0.0.5:8786",
    "uplift texture 'shot.*.exr' -o uplifted --scheduler tcp://10.0.0.5:8786",
    "uplift texture shot.*.exr -o uplifted --scheduler tcp://10.0.0.5:8786",
}
"""Examples that need a Dask cluster at that address."""


@dataclass(frozen=True)
class Example:
    """A command line and where it is written."""

    source: str
    line: str


def examples() -> list[Example]:
    """Return every example once, where it is first written."""
    found: dict[str, Example] = {}
    for example in _all_examples():
        found.setdefault(example.line, example)
    return list(found.values())


def _all_examples() -> Iterator[Example]:
    pages = {path.relative_to(ROOT).as_posix(): path for path in ROOT.glob("docs/**/*.md")}
    pages["README.md"] = ROOT / "README.md"
    del pages[TUTORIAL]
    for name in FIRST:
        yield from page_examples(name, pages.pop(name).read_text(encoding="utf-8"))
    yield from help_examples()
    for name, path in sorted(pages.items()):
        yield from page_examples(name, path.read_text(encoding="utf-8"))


def page_examples(name: str, text: str) -> Iterator[Example]:
    """Yield the examples of a page."""
    for language, block in BLOCKS.findall(text):
        lines = block if language in SHELLS else ""
        for line in lines.replace("\\\n", " ").splitlines():
            if match := re.match(r"(?:\$ )?((?:uplift|mkdir -p) .*)", line):
                yield Example(name, " ".join(match[1].partition("    #")[0].split()))


def help_examples() -> Iterator[Example]:
    """Yield the examples of the help of every command and subcommand."""
    with click.Context(main, **main.context_settings) as context:
        for name in COMMANDS:
            command = main.get_command(context, name)
            assert command is not None
            children = {f"{name} {key}": child for key, child in getattr(command, "commands", {}).items()}
            for path, each in {name: command, **children}.items():
                for line in (each.help or "").splitlines():
                    if line.strip().startswith("uplift "):
                        yield Example(f"uplift {path} --help", line.strip())
