"""Version of uplift: that of a release, or on the way to one, which moves with every
commit.
"""

import functools
import re
from pathlib import Path

VERSION = "0.3.0rc1.dev"
"""Version of this source. After ``.dev`` follows the number of commits; a release has
no such suffix.
"""
UNKNOWN = "0"
"""In place of the number of commits, where neither git nor a distribution has it."""
DISTRIBUTION = "spectral-uplift"
"""Name on a package index, which has another project `uplift`."""
ROOT = Path(__file__).parents[2]
"""Folder of a clone or a source distribution, or that of installed packages."""


@functools.cache
def version() -> str:
    """Return the version: in a clone that of its commit, in a distribution that of its
    build.

    `pyproject.toml` calls this for a build. It is not computed on import, as git takes
    some milliseconds.
    """
    if not VERSION.endswith(".dev"):
        return VERSION
    if (ROOT / ".git").exists():
        return VERSION + _count_commits()
    if (ROOT / "PKG-INFO").is_file():
        stated = re.search(
            "^Version: (.+)$",
            (ROOT / "PKG-INFO").read_text(encoding="utf-8"),
            re.MULTILINE,
        )
        return stated[1] if stated else VERSION + UNKNOWN
    if (ROOT / "pyproject.toml").is_file():
        return VERSION + UNKNOWN
    from importlib import metadata

    try:
        return metadata.version(DISTRIBUTION)
    except metadata.PackageNotFoundError:
        return VERSION + UNKNOWN


def _count_commits() -> str:
    """Count the commits of the clone. A shallow one does not have them all."""
    import subprocess

    def git(*arguments: str) -> str:
        command = ["git", f"--git-dir={ROOT / '.git'}", *arguments]
        return subprocess.run(
            command, capture_output=True, text=True, check=True
        ).stdout.strip()

    try:
        is_shallow = git("rev-parse", "--is-shallow-repository") == "true"
        return UNKNOWN if is_shallow else git("rev-list", "--count", "HEAD")
    except (OSError, subprocess.CalledProcessError):
        return UNKNOWN


def is_older(first: str, second: str) -> bool:
    """Return whether a version comes before another; False where that is unknown.

    >>> known = ("0.2.0", "0.3.0.dev7", "0.3.0rc1", "0.3.0rc2.dev0")
    >>> [is_older(version, "0.3.0rc2.dev12") for version in known]
    [True, True, True, False]
    """
    return _order(first) < _order(second)


def _order(version: str) -> tuple[float, ...]:
    """Return numbers in the order of versions: commits before candidates, and both
    before their release. NaN is neither below nor above.
    """
    match = re.fullmatch(
        r"([0-9]{1,9})\.([0-9]{1,9})\.([0-9]{1,9})"
        r"(?:rc([0-9]{1,9}))?(?:\.dev([0-9]{1,9}))?",
        version,
    )
    if match is None:
        return (float("nan"),)
    *release, candidate, commits = match.groups()
    first = "0" if commits else "inf"
    last = "nan" if commits == UNKNOWN else commits or "inf"
    return *map(float, release), float(candidate or first), float(last)


def outdated_package() -> str:
    """State which of the required packages is older than required; empty if none is."""
    from importlib import metadata

    for requirement in metadata.requires(DISTRIBUTION) or ():
        name, _, least = requirement.partition(">=")
        is_optional = ";" in requirement
        if not is_optional and _numbers(metadata.version(name)) < _numbers(least):
            return f"{name} must be {least} or later, got {metadata.version(name)}"
    return ""


def _numbers(version: str) -> list[int]:
    return list(map(int, re.findall(r"\d+", version)))
