"""Measure, and write docs/representations.md with its pictures."""

from __future__ import annotations

import sys
import warnings
from typing import TYPE_CHECKING

import click
from uplift_cli.startup import one_thread

if TYPE_CHECKING:
    from uplift.lab.comparison.scene import Scene

OTHERS = ("LED-B3", "LED-RGB1", "HP1")


@click.command()
def main() -> None:
    """Measure everything anew: minutes."""
    one_thread()
    _publish()


def _publish() -> None:
    import uplift
    from benchmarks.page import write
    from benchmarks.representations import tables, thesis
    from benchmarks.representations.closed import both
    from benchmarks.representations.introduction import introduction
    from benchmarks.timing import ROOT
    from uplift.common.files import check_folder
    from uplift.lab.comparison.filters import tune
    from uplift.lab.comparison.measure import Comparison, compare
    from uplift.lab.comparison.pictures import DRAWN, write_picture
    from uplift.lab.comparison.scene import scene
    from uplift.scene.representations.registry import all_representations

    warnings.simplefilter("ignore", uplift.UpliftWarning)
    atlases = {path.stem: uplift.read_atlas(path) for path in sorted((ROOT / "atlases").glob("*.txt"))}
    asked, others = scene(atlases), scene(atlases, OTHERS)

    def compared(part: Scene, label: str) -> Comparison:
        made = all_representations(part.powers, part.surfaces)
        with click.progressbar(length=len(made), label=label, file=sys.stderr) as bar:
            return compare(part, made, progress=lambda done, total: bar.update(1))

    found, beyond = compared(asked, "representations"), compared(others, "under other lights")
    with click.progressbar(length=24, label="filters", file=sys.stderr) as bar:
        tuned = tune(asked, progress=lambda done, total: bar.update(1))
    readings = both(asked)
    folder = check_folder(ROOT / "docs" / "representations", (), force=True)
    for kind in DRAWN:
        write_picture(found, kind, folder / f"{kind}.png", force=True)
    printed, printed_filters = thesis.tables(), thesis.filters()
    sections = [
        tables.advice([found, beyond]),
        *(tables.ranked(found, name, printed) for name in found.sets),
        tables.closed(readings, printed),
        *(tables.filters(tuned, name, title, printed_filters) for name, title in found.sets.items()),
        *(tables.ranked(beyond, name, {}) for name in beyond.sets),
    ]
    print(write("representations", introduction(found, tuned, readings, printed), sections, found.facts))


if __name__ == "__main__":
    main()
