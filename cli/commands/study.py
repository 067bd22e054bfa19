"""``uplift study``: measurements of models, solver and errors."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import format_value, parse_float, parse_whole

from ..inputs import DEFAULT_ATLASES, read_atlases
from ..options import (
    Whole,
    atlas_folders_option,
    atlas_option,
    coefficients_option,
    force_option,
    format_option,
    output_folder_option,
)
from ..output.console import json_text, make_table, print_csv, print_csv_text, print_json, say, show
from ..output.progress import progress_bar
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.lab.study.held_out import HoldoutSplit
    from uplift.lab.study.moments import MomentsStudy
    from uplift.lab.study.stability import RunResult

MOMENTS_FILES = ("moments.csv", "moments.png", "moments-patches.png", "moments-worst.png")
STABILITY_FILES = ("stability.csv", "stability.json", "stability.png")
SENSITIVITY_FILES = ("sensitivity.json", "sensitivity-steepness.png", "sensitivity-locality.png")
"""Files of --output; the last one is for cubes with an atlas."""
MACBETH = "macbeth"


@click.group("study")
def command() -> None:
    """Measure the accuracy of the models, the reliability of the solver, and the propagation of errors.

    \b
    Examples:
      uplift study moments
      uplift study moments --atlas paints.csv --output moments-paints --format json
      uplift study held-out --atlas paints.csv
      uplift study stability --quick
      uplift study sensitivity macbeth-32.uplift
    """


def _write(folder: str, writers: Mapping[str, Callable[..., object]], *, force: bool) -> None:
    """Write files into a folder, each by the function of its name."""
    for name, write in writers.items():
        write(Path(folder) / name, force=force)
    say(f"{Path(folder)}: {', '.join(writers)}", err=True)


@command.command("moments")
@atlas_option("Atlas", DEFAULT_ATLASES)
@click.option(
    "--max-moments",
    metavar="N",
    type=Whole(),
    default=15,
    show_default=True,
    help="Largest number of moments, up to 32.",
)
@output_folder_option
@format_option("table", "json", "csv")
@force_option
def moments(files: tuple[str, ...], max_moments: int, output: str | None, style: str, force: bool) -> None:
    """Reconstruct measured spectra from their moments and compare them with the measurements.

    Tests 0 to N moments of mirrored and unmirrored, warped and unwarped spectra, for all atlases together and for each
    (Tódová 2020, table 4.1 and appendix B.1). Errors are mean and largest ΔE76 under D65, ΔE00 under D65, A, FL2, FL7,
    FL11 and LED-B3, and the rms difference. The table shows ΔE76 of all atlases together; JSON and CSV have all errors.

    --output writes moments.csv and, as PNG, the errors over the number of floats (moments), the patches of the thesis
    or the first two entries (moments-patches), and the entries with the largest errors (moments-worst).

    \b
    Examples:
      uplift study moments
      uplift study moments --atlas macbeth --output moments --force
      uplift study moments --max-moments 8 --format json
    """
    from uplift.common.files import check_folder
    from uplift.lab.records import records_csv, write_csv
    from uplift.lab.study.moments import records, study_moments

    atlases = read_atlases(files)
    if output is not None:
        check_folder(output, MOMENTS_FILES, inputs=files, force=force)
    with progress_bar("reconstructions") as progress:
        study = study_moments(atlases, max_moments, progress)
    found = records(study)
    if output is not None:
        from uplift.lab.study.moments_plots import curves, plot_errors, plot_patches, plot_worst

        writers = (
            partial(write_csv, found),
            partial(plot_errors, {"all entries": curves(study)}),
            partial(plot_patches, study),
            partial(plot_worst, study),
        )
        _write(output, dict(zip(MOMENTS_FILES, writers, strict=True)), force=force)
    if style == "json":
        print_json(found)
    elif style == "csv":
        print_csv_text(records_csv(found))
    else:
        _print_moments(study)


def _print_moments(study: MomentsStudy) -> None:
    from uplift.lab.study.moments import TECHNIQUES

    caption = (
        f"mean / largest ΔE76 under D65 of {len(study.names)} entries; "
        "n moments take n + 1 floats mirrored, 2n + 1 unmirrored"
    )
    headings = ("moments", *(technique.label for technique in TECHNIQUES))
    table = make_table((), headings, caption=caption)
    for count in range(study.max_moments + 1):
        results = [study.result(technique, count) for technique in TECHNIQUES]
        table.add_row(str(count), *(f"{one.mean[0]:.2f} / {one.max[0]:6.2f}" for one in results))
    show(table)


@command.command("held-out")
@atlas_option("Atlas", DEFAULT_ATLASES)
@click.option("--splits", type=Whole(1, 1000), default=3, show_default=True, help="Number of splits of each atlas.")
@click.option("--dim", type=Whole(), default=32, show_default=True, help="Lattice nodes along each axis.")
@coefficients_option
@format_option("table", "json", "csv")
def held_out(files: tuple[str, ...], splits: int, dim: int, coefficients: int, style: str) -> None:
    """Build cubes from half of an atlas, query the colours of the other half, and compare with the measurements.

    Reports the rms difference of the spectra and mean ΔE00 under A, FL2, FL7, FL11, LED-B3, LED-RGB1 and HP1, compared
    with cubes of moments and of sigmoids that have no atlas, and the predicted and the actual standard errors.
    The prior does not know the families of its library that contain spectra of the atlas.

    Two plain baselines know the same half: a local-linear regression of reflectance on RGB, and the centroid of the
    colours that mixtures of the known materials have under a light (Zhang, Funt & Mirzaei 2016).

    \b
    Examples:
      uplift study held-out --atlas paints.csv
      uplift study held-out --atlas rawtoaces --coefficients 17 --splits 10
      uplift study held-out --format json
    """
    enable_jit_cache()
    from uplift.colorimetry.lights import HELD_OUT_LIGHTS
    from uplift.lab.study.held_out import holdout

    results: dict[str, tuple[HoldoutSplit, ...]] = {}
    for name, atlas in read_atlases(files).items():
        with progress_bar(name) as progress:
            results[name] = holdout(atlas, splits, progress, dim=dim, coefficients=coefficients)
    records = _held_out_records(results)
    if style == "json":
        print_json(records)
    elif style == "csv":
        header = ["atlas", "cube", "colours", "rms", *HELD_OUT_LIGHTS]
        print_csv(header, ([record[key] for key in header] for record in records))
    else:
        _print_held_out(records)


def _held_out_records(results: Mapping[str, Sequence[HoldoutSplit]]) -> list[dict[str, Any]]:
    import numpy as np

    from uplift.colorimetry.lights import HELD_OUT_LIGHTS
    from uplift.lab.study.held_out import pooled_calibration

    records: list[dict[str, Any]] = []
    for name, splits in results.items():
        for method in splits[0].errors:
            rms, *delta_e = np.mean([split.errors[method].means() for split in splits], axis=0).tolist()
            record = {"atlas": name, "cube": method, "colours": len(splits[0].actual)}
            record["rms"] = None if np.isnan(rms) else rms
            records.append(record | dict(zip(HELD_OUT_LIGHTS, delta_e, strict=True)))
        errors = pooled_calibration(splits)
        records[-len(splits[0].errors)]["standard_error"] = errors and errors.to_json()
    return records


def _print_held_out(records: Sequence[Mapping[str, Any]]) -> None:
    from uplift.colorimetry.lights import HELD_OUT_LIGHTS

    table = make_table(("atlas", "cube"), ("rms", *HELD_OUT_LIGHTS))
    standard_errors = []
    for record in records:
        rms = "" if record["rms"] is None else f"{record['rms']:.4f}"
        cells = [rms, *(f"{record[light]:.3f}" for light in HELD_OUT_LIGHTS)]
        table.add_row(record["atlas"], record["cube"], *cells)
        if record.get("standard_error"):
            standard_errors.append((record["atlas"], record["standard_error"]))
    show(table)
    for name, errors in standard_errors:
        say(
            f"{name}: predicted standard error ΔE00 {errors['stated']:.2f}, actual {errors['real']:.2f}; "
            f"{errors['within_error']:.0%} within it, {errors['within_bound']:.0%} within the error bound"
        )


def _list_of(kind: Callable[[str], Any]) -> Callable[..., tuple[Any, ...] | None]:
    """Return a callback that parses a list such as '4,8,16'."""

    def parse(context: click.Context, parameter: click.Parameter, text: str | None) -> tuple[Any, ...] | None:
        try:
            return None if text is None else tuple(kind(word.strip()) for word in text.split(","))
        except ValueError as error:
            raise click.BadParameter(f"{format_value(text)} is not a list of such values, as 4,8,16") from error

    return parse


@command.command("stability")
@click.option("--quick", is_flag=True, help="Small lattices and few values: some seconds per model.")
@click.option("--dims", callback=_list_of(parse_whole), metavar="N,…", help="Lattice nodes along each axis.")
@click.option(
    "--coefficients", callback=_list_of(parse_whole), metavar="N,…", help="Coefficients per spectrum, 3 to 17."
)
@click.option("--spaces", callback=_list_of(str), metavar="NAME,…", help="RGB spaces of colour-science.")
@click.option("--models", callback=_list_of(str), metavar="NAME,…", help="moments, sigmoid.")
@click.option("--thresholds", callback=_list_of(parse_float), metavar="X,…", help="Largest residuals, |linear RGB|.")
@atlas_option("Atlas in addition to the synthetic ones", MACBETH)
@click.option("--atlases", callback=_list_of(str), metavar="NAME,…", help="Atlases to use by name, or 'none'.")
@click.option("--samples", type=Whole(0, 100_000), help="Number of random settings in addition to the grids.")
@output_folder_option
@format_option("table", "json", "csv")
@force_option
def stability(quick: bool, files: tuple[str, ...], output: str | None, style: str, force: bool, **options: Any) -> None:
    """Build cubes over dims, coefficients, models, spaces, thresholds and atlases, and count unfitted nodes.

    Reports for each build the realisable and the unfitted nodes, rounds, improvement attempts, the largest residual and
    the time. The builds are a grid of each setting against models and coefficients, and a random sample of other
    combinations.

    Atlases are none, the ColorChecker, and three difficult synthetic ones: crowded, spiky and noisy. --output writes
    stability.csv, stability.json and the heat map stability.png.

    \b
    Examples:
      uplift study stability --quick
      uplift study stability --output out --force
      uplift study stability --thresholds 1e-4,1e-6 --dims 9 --format csv
    """
    enable_jit_cache()
    from uplift.common.files import check_folder, write_text
    from uplift.lab.records import records_csv, write_csv
    from uplift.lab.study.stability import (
        NO_ATLAS,
        QUICK_DESIGN,
        SYNTHETIC_ATLASES,
        DesignSpace,
        design,
        grids,
        study_stability,
    )

    atlases = read_atlases(files or (MACBETH,)) | {name: make() for name, make in SYNTHETIC_ATLASES.items()}
    given = {name: value for name, value in options.items() if value is not None}
    axes = replace(QUICK_DESIGN if quick else DesignSpace(), **({"atlases": (NO_ATLAS, *atlases)} | given))
    if output is not None:
        check_folder(output, STABILITY_FILES, inputs=files, force=force)
    with progress_bar("builds") as progress:
        runs = study_stability(design(axes), atlases, progress)
    records = [run.record() for run in runs]
    if output is not None:
        from uplift.lab.study.stability_plots import plot_map

        writers = (
            partial(write_csv, records),
            partial(write_text, json_text(records) + "\n"),
            partial(plot_map, grids(axes), {run.config: run for run in runs}),
        )
        _write(output, dict(zip(STABILITY_FILES, writers, strict=True)), force=force)
    if style == "json":
        print_json(records)
    elif style == "csv":
        print_csv_text(records_csv(records))
    else:
        _print_stability(runs)


def _print_stability(runs: Sequence[RunResult]) -> None:
    table = make_table(
        ("model", "dim", "space", "threshold", "atlas"),
        ("realisable", "unfitted", "rounds", "calls", "worst", "at", "s"),
    )
    for run in runs:
        setting = run.config
        names = (setting.model_label, str(setting.dim), setting.space)
        facts = (f"{run.realisable}", f"{run.unfitted}", f"{run.rounds}", f"{run.calls}", f"{run.worst:.1e}")
        where = f"{run.r:.3f} {run.g:.3f} {run.b:.3f}"
        table.add_row(
            *names,
            f"{setting.threshold:g}",
            setting.atlas,
            *facts,
            where,
            f"{run.seconds:.2f}",
            style="bold red" if run.unfitted else None,
        )
    show(table)
    failed = [run for run in runs if run.unfitted]
    say(
        f"{len(runs)} builds, {sum(run.realisable for run in runs)} realisable nodes: "
        f"{sum(run.unfitted for run in failed)} unfitted in {len(failed)} builds"
    )


@command.command("sensitivity")
@click.argument("cube", metavar="[CUBE]", required=False)
@atlas_folders_option
@click.option(
    "--entries", type=Whole(0), default=24, show_default=True, help="Number of atlas entries to change, one at a time."
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
    from uplift.common.files import check_folder, write_text
    from uplift.lab.study.sensitivity import study_sensitivity
    from uplift.lookup import load
    from uplift.pipeline.rebuild import recorded_atlas

    loaded = load(cube)
    atlas = recorded_atlas(loaded.data, cube, folders) if cube is not None and entries else None
    if output is not None:
        check_folder(output, SENSITIVITY_FILES if atlas else SENSITIVITY_FILES[:2], inputs=[cube], force=force)
    with progress_bar("builds") as progress:
        result = study_sensitivity(loaded, atlas, entries, progress)
    record = result.record()
    if output is not None:
        from uplift.lab.study.sensitivity_plots import plot_locality, plot_steepness

        writers = [
            partial(write_text, json_text(record) + "\n"),
            partial(plot_steepness, result.cube.data, result.lipschitz),
        ]
        if result.removed:
            writers.append(partial(plot_locality, result.removed))
        _write(output, dict(zip(SENSITIVITY_FILES, writers, strict=False)), force=force)
    if style == "json":
        print_json(record)
    else:
        _print_sensitivity(record)


def _print_sensitivity(record: Mapping[str, Any]) -> None:
    from uplift.colorimetry.lights import NARROW_BAND_LIGHT

    delta_e = f"ΔE {NARROW_BAND_LIGHT}"
    _table(("mode", "step"), ("rms", "max", "largest", delta_e, "max", "ΔE build", "max"), record["moves"])
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
        headings = ("changed", "RGB radius", "ab radius", delta_e, "max", "rms", "max")
        _table(("change",), headings, record["changes"])


def _table(texts: tuple[str, ...], numbers: tuple[str, ...], rows: Sequence[Mapping[str, Any]]) -> None:
    table = make_table(texts, numbers)
    for row in rows:
        cells = ("" if value is None else value for value in row.values())
        table.add_row(*(cell if isinstance(cell, str) else f"{cell:.2g}" for cell in cells))
    show(table)
