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
from pathlib import Path

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
    """Return the Python and Markdown files and the templates that git tracks, or would
    if they were added.
    """
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
    lines = []
    for path in tracked():
        for number, line in prose(path) if path != Path(__file__) else ():
            place = f"{path.relative_to(ROOT)}:{number}"
            for pattern, advice in patterns.items():
                words = [match.group() for match in pattern.finditer(line)]
                lines += [f"{place}: '{word}': {advice}" for word in words]
    return lines


def documented(package: str, members: str) -> Iterator[tuple[str, frozenset[str]]]:
    """Yield the dotted names of what a page lists of a package, by default all that it
    exports, and the public methods of its classes, with codes to check.

    Methods with an inherited docstring are left out.
    """
    module = importlib.import_module(package)
    names = members.split(", ") if members else getattr(module, "__all__", ())
    for item in (getattr(module, name) for name in names):
        if inspect.isfunction(item):
            yield f"{item.__module__}.{item.__qualname__}", REQUIRED
        elif inspect.isclass(item):
            yield from _documented_class(item)


def _documented_class(item: type) -> Iterator[tuple[str, frozenset[str]]]:
    name = f"{item.__module__}.{item.__qualname__}"
    is_made = "__init__" in vars(item) and not getattr(item, "_is_protocol", False)
    yield name, REQUIRED if is_made else REQUIRED - {"PR01"}
    for key, value in vars(item).items():
        is_method = inspect.isfunction(value) or isinstance(
            value, property | classmethod
        )
        if not is_method or key.startswith("_"):
            continue
        if value.__doc__ is not None or not inspect.getdoc(getattr(item, key, None)):
            yield f"{name}.{key}", REQUIRED


def check_docstrings() -> list[str]:
    """Return a line for every name in the reference of the Python API whose docstring
    misses a section.
    """
    from numpydoc.validate import validate

    page = (ROOT / "docs" / "reference" / "python.md").read_text(encoding="utf-8")
    packages = re.findall(
        r"^\.\. automodule:: (\S+)(?:\n   :members: (.+))?$", page, re.MULTILINE
    )
    lines = []
    for package, members in packages:
        for name, checks in dict.fromkeys(documented(package, members)):
            errors = [error for error in validate(name)["errors"] if error[0] in checks]
            lines += [f"{name}: {code} {text}" for code, text in errors]
    return lines


if __name__ == "__main__":
    lines = check_words() + check_docstrings()
    print("\n".join(lines) or "no findings")
    sys.exit(bool(lines))
