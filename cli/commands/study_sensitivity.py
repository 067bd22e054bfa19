"""``uplift study sensitivity``: sensitivity of spectra to colours and measurements."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..options import Whole, atlas_folders_option, force_option, format_option, output_folder_option
from ..output.console import json_text, make_table, print_json, say, show
from ..output.progress import progress_bar
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.lab.study.sensitivity import Sensitivity

RESULTS, STEEPNESS, LOCALITY = FILES = (
    "sensitivity.json",
    "sensitivity-steepness.png",
    "sensitivity-locality.png",
)


@click.command("sensitivity")
@click.argument("cube", metavar="[CUBE]", required=False)
@atlas_folders_option
@click.option(
    "--entries",
    type=Whole(0),
    default=24,
    show_default=True,
    help="Number of atlas entries to change, one at a time.",
)
@output_folder_option
@format_option("table", "json")
@force_option
def sensitivity(
    cube: str | None, folders: tuple[str, ...], entries: int, output: str | None, style: str, force: bool
) -> None:
    """Perturb queried colours and the measurements of a cube, and report the change of its spectra.

    Colours are perturbed by an 8-bit code, a 10-bit code and float rounding. The Lipschitz constant of mode 'spectra'
    is computed for every cell. The cube is rebuilt with noise on its atlas, with one entry reversed, and with one entry
    left out. CUBE defaults to the packaged cube, which has no atlas.

    --output writes sensitivity.json and, as PNG, the steepness of the cube and the distance to which an entry affects
    it.

    \b
    Examples:
      uplift study sensitivity
      uplift study sensitivity macbeth-32.uplift --output out --force
      uplift study sensitivity --entries 4 --format json
    """
    enable_jit_cache()
    from uplift.common.files import check_folder
    from uplift.lab.study.sensitivity import study_sensitivity
    from uplift.lookup import load
    from uplift.pipeline.rebuild import recorded_atlas

    loaded = load(cube)
    atlas = recorded_atlas(loaded.data, cube, folders) if cube is not None and entries else None
    if output is not None:
        check_folder(output, FILES if atlas else FILES[:2], inputs=[cube], force=force)
    with progress_bar("builds") as progress:
        result = study_sensitivity(loaded, atlas, entries, progress)
    if output is not None:
        _write(result, Path(output), force=force)
    PRINTERS[style](result)


def _write(result: Sensitivity, folder: Path, *, force: bool) -> None:
    from uplift.common.files import write_text
    from uplift.lab.study.sensitivity_plots import plot_locality, plot_steepness

    written = [RESULTS, STEEPNESS]
    write_text(json_text(result.record()) + "\n", folder / RESULTS, force=force)
    plot_steepness(result.cube.data, result.lipschitz, folder / STEEPNESS, force=force)
    if result.removed:
        plot_locality(result.removed, folder / LOCALITY, force=force)
        written.append(LOCALITY)
    say(f"{folder}: {', '.join(written)}", err=True)


def _print_json(result: Sensitivity) -> None:
    print_json(result.record())


def _print_table(result: Sensitivity) -> None:
    from uplift.colorimetry.lights import NARROW_BAND_LIGHT

    record, delta_e = result.record(), f"ΔE {NARROW_BAND_LIGHT}"
    _table(
        ("mode", "step"),
        ("rms", "max", "largest", delta_e, "max", "ΔE build", "max"),
        [tuple(move.values()) for move in record["moves"]],
    )
    steep = record["lipschitz"]
    where = ", ".join(f"{value:.4f}" for value in steep["steepest_cell"])
    say(
        f"Lipschitz constant {steep['largest']:.3g} rms per unit of linear RGB (median of the cells "
        f"{steep['median_cell']:.2g}), {steep['largest_per_code']:.2g} per 8-bit code; steepest cell at {where}, "
        f"steepest wavelength {steep['steepest_wavelength']:g} nm"
    )
    if steep["moved_cells"]:
        say(
            f"in {steep['moved_cells']} cells, which have corners without their own colours, answers are moved to "
            "exact colours: there the constants are those of the mixtures before"
        )
    if record["changes"]:
        _table(
            ("change",),
            ("changed", "RGB radius", "ab radius", delta_e, "max", "rms", "max"),
            [tuple(change.values()) for change in record["changes"]],
        )


def _table(texts: tuple[str, ...], numbers: tuple[str, ...], rows: list[tuple[Any, ...]]) -> None:
    table = make_table(texts, numbers)
    for row in rows:
        table.add_row(*map(_cell, row))
    show(table)


def _cell(value: Any) -> str:
    if value is None:
        return ""
    return value if isinstance(value, str) else f"{value:.2g}"


PRINTERS: dict[str, Callable[[Sensitivity], None]] = {"table": _print_table, "json": _print_json}
