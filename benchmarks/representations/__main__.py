"""Comparison of spectral representations: ``make representations``.

Writes docs/data/representations.json and the pictures of docs/representations.
"""

from __future__ import annotations

import sys
import warnings
from typing import TYPE_CHECKING

import click
from uplift_cli.startup import use_one_blas_thread

if TYPE_CHECKING:
    from uplift.lab.comparison.measure import Comparison
    from uplift.lab.comparison.scene import Scene

OTHER_LIGHTS = ("LED-B3", "LED-RGB1", "HP1")


@click.command()
def main() -> None:
    """Measure, draw and store; takes minutes."""
    use_one_blas_thread()
    _measure()


def _measure() -> None:
    import uplift
    from benchmarks.record import ROOT, write
    from benchmarks.representations import closed, results, thesis
    from uplift.common.files import check_folder
    from uplift.lab.comparison.filters import tune_filters
    from uplift.lab.comparison.pictures import KINDS, write_picture
    from uplift.lab.comparison.scene import make_scene

    warnings.simplefilter("ignore", uplift.UpliftWarning)
    atlases = {path.stem: uplift.read_atlas(path) for path in sorted((ROOT / "atlases").glob("*.txt"))}
    default, others = make_scene(atlases), make_scene(atlases, OTHER_LIGHTS)
    main_comparison = _compare(default, "representations")
    other_comparison = _compare(others, "under other lights")
    with click.progressbar(length=24, label="filters", file=sys.stderr) as bar:
        tuned = tune_filters(default, progress=lambda done: bar.update(1))
    folder = check_folder(ROOT / "docs" / "representations", (), force=True)
    for kind in KINDS:
        write_picture(main_comparison, kind, folder / f"{kind}.png", force=True)
    printed = thesis.tables()
    write(
        "representations",
        "make representations",
        surfaces=len(default.names),
        titles=results.titles(main_comparison, other_comparison),
        advice=[row for one in (main_comparison, other_comparison) for row in results.advice(one)],
        ranking=[*results.ranking(main_comparison, printed), *results.ranking(other_comparison, {})],
        riemann=closed.measure(default, printed),
        filters=results.filters(tuned, thesis.filters()),
    )


def _compare(part: Scene, label: str) -> Comparison:
    from uplift.lab.comparison.measure import compare
    from uplift.scene.representations import all_representations

    representations = all_representations(part.powers, part.surfaces)
    with click.progressbar(length=len(representations), label=label, file=sys.stderr) as bar:
        return compare(part, representations, progress=lambda done: bar.update(1))


if __name__ == "__main__":
    main()
