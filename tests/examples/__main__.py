"""Run all examples in full: ``make examples``. Exits with 1 if one fails."""

from __future__ import annotations

import tempfile
from pathlib import Path

from tests.examples.collect import ELSEWHERE, examples
from tests.examples.installed import build_wheel, run_lines, unpack


def main() -> None:
    """Run the examples in an empty folder and print those that fail."""
    lines = [example.line for example in examples() if example.line not in ELSEWHERE]
    with tempfile.TemporaryDirectory() as name:
        folder, package = Path(name) / "empty", Path(name) / "package"
        folder.mkdir()
        outcomes = run_lines(lines, unpack(build_wheel(Path(name)), package), folder)
    failures = [outcome for outcome in outcomes if outcome["code"]]
    for outcome in failures:
        print(f"{outcome['line']}\n{outcome['stderr']}")
    print(f"{len(outcomes) - len(failures)} of {len(outcomes)} examples run")
    raise SystemExit(bool(failures))


if __name__ == "__main__":
    main()
