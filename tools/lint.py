"""Check prose and docstrings: banned words (tools/banned_words.txt) and numpydoc
sections of the reference.
"""

import importlib
import inspect
import io
import re
import subprocess
import sys
import tokenize
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
WORDS = ROOT / "tools" / "banned_words.txt"
REQUIRED = frozenset({"GL08", "SS01", "PR01", "PR02", "PR10", "RT01"})
"""numpydoc's codes: docstring, summary, parameters documented, none unknown, spacing,
returns documented.
"""
DIALECT = {"told", "asked", "seen", "heard", "mended", "anew", "beside", "said"}
"""Words that no identifier contains."""
FILE_KEYS = {"mended", "told"}
"""Keys of stored files, which keep their names."""


def tracked() -> list[Path]:
    """Return the Python and Markdown files and templates that git does not ignore."""
    command = [
        "git",
        "ls-files",
        "--cached",
        "--others",
        "--exclude-standard",
        "*.py",
        "*.md",
        "*.j2",
    ]
    listed = subprocess.run(
        command, cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.split()
    return [ROOT / name for name in listed if (ROOT / name).is_file()]


def prose(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the lines of prose of a file with their numbers: strings, comments and
    names of code, text of pages.
    """
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            kind = tokenize.tok_name[token.type]
            if (
                kind == "NAME"
                and set(token.string.lower().strip("_").split("_")) & DIALECT
            ):
                yield token.start[0], token.string.replace("_", " ")
            elif (
                kind in ("STRING", "COMMENT", "FSTRING_MIDDLE")
                and token.string.strip("\"'") not in FILE_KEYS
            ):
                for offset, line in enumerate(token.string.splitlines()):
                    yield (
                        token.start[0] + offset,
                        re.sub(r"\{[^{}]*\}|``[^`]*``|`[^`]*`", " ", line),
                    )
        return
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            yield number, re.sub(r"`[^`]*`|\]\([^)]*\)|\{[{%].*?[%}]\}", " ", line)


def check_words() -> list[str]:
    """Return a line for every banned expression."""
    patterns = {}
    for line in WORDS.read_text(encoding="utf-8").splitlines():
        expression, _, advice = line.partition("  ")
        if expression and not expression.startswith("#"):
            pattern = re.compile(rf"\b(?:{expression})\b", re.IGNORECASE)
            patterns[pattern] = advice.strip()
    findings = []
    for path in tracked():
        if path == Path(__file__):
            continue
        for number, line in prose(path):
            place = f"{path.relative_to(ROOT)}:{number}"
            for pattern, advice in patterns.items():
                for match in pattern.finditer(line):
                    findings.append(f"{place}: '{match.group()}': {advice}")
    return findings


def documented(package: str) -> Iterator[tuple[str, frozenset[str]]]:
    """Yield the dotted names of what a package exports and the public methods of its
    classes, with codes to check.

    Methods with an inherited docstring are left out.
    """
    module = importlib.import_module(package)
    for exported in getattr(module, "__all__", ()):
        value = getattr(module, exported)
        if inspect.isfunction(value):
            yield dotted_name(value), REQUIRED
        elif inspect.isclass(value):
            is_protocol = getattr(value, "_is_protocol", False)
            constructed = "__init__" in vars(value) and not is_protocol
            yield dotted_name(value), REQUIRED if constructed else REQUIRED - {"PR01"}
            for method in public_methods(value):
                yield f"{dotted_name(value)}.{method}", REQUIRED


def dotted_name(value: Any) -> str:
    """Return module and name of a function or class."""
    return f"{value.__module__}.{value.__qualname__}"


def public_methods(cls: type) -> Iterator[str]:
    """Yield the public methods of a class that have their own docstrings, or none."""
    for name, value in vars(cls).items():
        if inspect.isfunction(value) or isinstance(value, property | classmethod):
            inherited = value.__doc__ is None and inspect.getdoc(getattr(cls, name))
            if not name.startswith("_") and not inherited:
                yield name


def check_docstrings() -> list[str]:
    """Return a line for every name in the reference of the Python API whose docstring
    misses a section.
    """
    from numpydoc.validate import validate

    page = (ROOT / "docs" / "reference" / "python.md").read_text(encoding="utf-8")
    packages = re.findall(r"^\.\. automodule:: (\S+)$", page, re.MULTILINE)
    names = dict.fromkeys(chain.from_iterable(map(documented, packages)))
    findings = []
    for name, checks in names:
        for code, text in validate(name)["errors"]:
            if code in checks:
                findings.append(f"{name}: {code} {text}")
    return findings


if __name__ == "__main__":
    lines = check_words() + check_docstrings()
    print("\n".join(lines) or "no findings")
    sys.exit(bool(lines))
