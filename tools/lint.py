"""Check prose and docstrings: banned words (tools/banned_words.txt) and numpydoc sections of the reference.

Examples
--------
    python tools/lint.py words                 # every file that git tracks
    python tools/lint.py words uplift/atlas    # one folder
    python tools/lint.py docstrings uplift.atlas
"""

from __future__ import annotations

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
"""numpydoc's codes: docstring, summary, parameters documented, none unknown, spacing, returns documented."""


DIALECT = {"told", "asked", "seen", "heard", "mended", "anew", "beside", "said"}
"""Words that no identifier contains."""


FILE_KEYS = {"mended", "told"}
"""Keys of stored files, which keep their names."""


def patterns() -> list[tuple[re.Pattern[str], str]]:
    """Return the banned expressions, each with the advice to show."""
    pairs = []
    for line in WORDS.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            expression, _, advice = line.partition("  ")
            pairs.append((re.compile(rf"\b(?:{expression})\b", re.IGNORECASE), advice.strip()))
    return pairs


def tracked(where: list[str]) -> list[Path]:
    """Return the Python and Markdown files that git tracks under ``where``."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *where],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()
    return [ROOT / name for name in listed if name.endswith((".py", ".md", ".j2")) and (ROOT / name).is_file()]


def prose(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the lines of prose of a file with their numbers: strings and comments of code, text of pages."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            kind = tokenize.tok_name[token.type]
            if kind == "NAME" and set(token.string.lower().strip("_").split("_")) & DIALECT:
                yield token.start[0], token.string.replace("_", " ")
            elif token.string.strip("\"'") in FILE_KEYS:
                continue
            elif kind in ("STRING", "COMMENT", "FSTRING_MIDDLE"):
                for offset, line in enumerate(token.string.splitlines()):
                    yield token.start[0] + offset, re.sub(r"\{[^{}]*\}|`[^`]*`", " ", line)
        return
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            yield number, re.sub(r"`[^`]*`|\]\([^)]*\)|\{[{%].*?[%}]\}", " ", line)


def check_words(where: list[str]) -> list[str]:
    """Return a line for every banned expression."""
    banned = patterns()
    skipped = {Path(__file__), WORDS}
    return [
        f"{path.relative_to(ROOT)}:{number}: '{match.group()}': {advice}"
        for path in tracked(where)
        if path not in skipped
        for number, line in prose(path)
        for pattern, advice in banned
        for match in pattern.finditer(line)
    ]


def public(package: str) -> Iterator[tuple[str, frozenset[str]]]:
    """Yield the dotted names of what a package exports and the public methods of its classes, with codes to check."""
    module = importlib.import_module(package)
    for name in getattr(module, "__all__", ()):
        found = getattr(module, name)
        if inspect.isfunction(found):
            yield f"{found.__module__}.{found.__qualname__}", REQUIRED
        elif inspect.isclass(found):
            own_constructor = "__init__" in vars(found) and not getattr(found, "_is_protocol", False)
            checks = REQUIRED if own_constructor else REQUIRED - {"PR01"}
            yield f"{found.__module__}.{found.__qualname__}", checks
            yield from public_methods(found)


def public_methods(found: type) -> Iterator[tuple[str, frozenset[str]]]:
    """Yield the dotted names of the public methods of a class, except those with an inherited docstring."""
    for key, value in vars(found).items():
        inherited = value.__doc__ is None and inspect.getdoc(getattr(found, key))
        is_method = inspect.isfunction(value) or isinstance(value, property | classmethod)
        if is_method and not key.startswith("_") and not inherited:
            yield f"{found.__module__}.{found.__qualname__}.{key}", REQUIRED


def check_docstrings(packages: list[str]) -> list[str]:
    """Return a line for every public name whose docstring misses a section."""
    from numpydoc.validate import validate

    return [
        f"{name}: {code} {text}"
        for package in packages
        for name, checks in dict.fromkeys(public(package))
        for code, text in validate(name)["errors"]
        if code in checks
    ]


def reference_modules(root: Path) -> list[str]:
    """Return the dotted names of the modules that the reference of the Python API shows."""
    page = (root / "docs" / "reference" / "python.md").read_text(encoding="utf-8")
    return re.findall(r"^\.\. automodule:: (\S+)$", page, re.MULTILINE)


def main(arguments: list[str]) -> int:
    """Run the checks named on the command line, all of them by default."""
    kind, rest = (arguments[0], arguments[1:]) if arguments else ("all", [])
    lines = []
    if kind in ("words", "all"):
        lines += check_words(rest or ["."])
    if kind in ("docstrings", "all"):
        lines += check_docstrings(rest or reference_modules(ROOT))
    print("\n".join(lines) if lines else "no findings")
    return bool(lines)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
