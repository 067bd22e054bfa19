"""Print the tests of what changed since the branch left main, for `make check`: changed
files of tests, and the folders of tests that mirror changed folders of code.
"""

import subprocess
from pathlib import Path


def _git(*arguments: str) -> list[str]:
    return subprocess.check_output(["git", *arguments], text=True).split()


def _tests(path: Path) -> Path:
    """Return the tests of a file of the repository."""
    match path.parts:
        case ["tests", *_]:
            return path if path.name.startswith("test_") else path.parent
        case ["uplift", *room, _]:
            return Path("tests", *room)
    return Path("tests", path.parent)


def main() -> None:
    """Print them."""
    (start,) = _git("merge-base", "HEAD", "main")
    changed = _git("diff", "--name-only", start)
    changed += _git("ls-files", "--others", "--exclude-standard")
    mirrored = {_tests(Path(name)) for name in changed}
    print(*sorted(path for path in mirrored if path.exists() and path != Path("tests")))


if __name__ == "__main__":
    main()
