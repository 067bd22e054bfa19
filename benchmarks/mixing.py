"""Mixing, shown and measured: ``make mixing`` → docs/mixing.md and its pictures."""

from __future__ import annotations

from uplift_cli.startup import keep_compiled, one_thread

from benchmarks.mixing_words import INTRODUCTION
from benchmarks.timing import ROOT


def main() -> None:
    """Measure, draw, and write the page."""
    keep_compiled()
    one_thread()
    import uplift
    from benchmarks import mixing_pictures, mixing_tables, mixing_times
    from benchmarks.page import write

    cube = uplift.load(ROOT / "cubes" / "moments-16-macbeth.uplift")
    mixing_pictures.draw(cube, ROOT / "docs" / "mixing")
    sections = [
        mixing_tables.criteria(cube),
        mixing_tables.gradings(cube),
        mixing_tables.surfaces(),
        mixing_times.mixtures(cube),
        mixing_times.images(cube),
    ]
    print(write("mixing", INTRODUCTION, sections))


if __name__ == "__main__":
    main()
