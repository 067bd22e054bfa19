"""``uplift lab study``: measurements of models, solver and errors."""

from collections.abc import Mapping, Sequence
from functools import partial
from itertools import product
from typing import Any

import click

from uplift.common.text import pluralise

from .. import options
from ..inputs import DEFAULT_ATLASES, atlas_files, read_atlases
from ..output.console import say
from ..output.progress import progress_bar
from ..output.table import Table, print_result
from ..outputs import check_folder, write_files
from ..startup import enable_jit_cache

MOMENTS_PLOTS = ("moments.png", "moments-patches.png", "moments-worst.png")
STABILITY_PLOTS = ("stability.png",)
SENSITIVITY_PLOTS = ("sensitivity-locality.png",)
"""Files of --output."""
MACBETH = "macbeth"
Row = Mapping[str, Any]


HEADINGS = {
    "rms_mean": "mean rms",
    "rms_most": "max rms",
    "largest": "max ΔR",
    "light_mean": "ΔE00 FL11",
    "light_most": "max FL11",
    "own_mean": "ΔE00 build light",
    "own_most": "max build light",
    "rgb_radius": "RGB radius",
    "lab_radius": "ΔE*ab radius",
    "delta_e_mean": "ΔE00 FL11",
    "delta_e_most": "max FL11",
}
"""Columns of the sensitivity study by the keys of its records."""


@click.group(
    "study",
    cls=options.Group,
    help="""Measure the accuracy of the models, the reliability of the solver, and the
    propagation of errors.

    \b
    Examples:
      uplift lab study moments
      uplift lab study moments --atlas paints.csv -o moments-paints --format json
      uplift lab study held-out --atlas paints.csv
      uplift lab study stability --quick
      uplift lab study sensitivity macbeth-32.uplift
    """,
)
def command() -> None:
    """Hold the subcommands."""


def _table(rows: Sequence[Row], *hidden: str, title: str = "") -> Table:
    """Return rows as a table, without some columns in text."""
    columns = [key for key in rows[0] if key not in hidden]
    headings = {key: HEADINGS.get(key, key) for key in columns}
    return Table(rows, headings, title, ".3g")


@command.command(
    "moments",
    help="""Reconstruct measured spectra from their moments and compare them with the
    measurements.

    Tests 0 to 15 moments of mirrored and unmirrored, warped and unwarped spectra, for
    all atlases together and for each (Tódová 2020, table 4.1 and appendix B.1). Errors
    are mean and largest ΔE76 under D65, ΔE00 under D65, A, FL2, FL7, FL11 and LED-B3,
    and the rms difference. The table shows mean / largest ΔE76 of all atlases together;
    JSON and CSV have all errors. n moments take n + 1 floats mirrored, 2n + 1
    unmirrored.

    --output writes, as PNG, the errors over the number of floats (moments), the patches
    of the thesis or the first two entries (moments-patches), and the entries with the
    largest errors (moments-worst).

    \b
    Examples:
      uplift lab study moments
      uplift lab study moments --atlas macbeth --output moments --force
      uplift lab study moments --format json
    """,
)
@options.atlas("Atlas", DEFAULT_ATLASES)
@options.output(help="Folder for plots.", metavar="DIR")
@options.table_json_or_csv
@options.force
def moments(files: Sequence[str], output: str | None, style: str, force: bool) -> None:
    from uplift.lab.study.moments import study_moments

    atlases = read_atlases(files)
    check_folder(output, MOMENTS_PLOTS, inputs=atlas_files(files))
    with progress_bar("reconstructions") as progress:
        study = study_moments(atlases, progress=progress)
    rows = study.rows()
    if output is not None:
        from uplift.lab.study.plots import plot_errors, plot_patches, plot_worst

        write_files(
            output,
            MOMENTS_PLOTS,
            partial(plot_errors, {"all entries": rows}),
            partial(plot_patches, study),
            partial(plot_worst, study),
        )
    if style != "table":
        print_result(style, rows, Table(rows))
        return
    errors: dict[int, dict[str, Any]] = {}
    cases = product(study.techniques, range(study.errors.shape[1]))
    # The rows of all atlases together come first.
    for (technique, count), row in zip(cases, rows, strict=False):
        mean, largest = row["delta_e_76_D65_mean"], row["delta_e_76_D65_max"]
        cell = f"{mean:.2f} / {largest:6.2f}"
        errors.setdefault(count, {"moments": count})[technique.label] = cell
    _table(list(errors.values()), title="mean / largest ΔE76 under D65").print_text()


@command.command(
    "held-out",
    help="""Build cubes from half of an atlas, query the colours of the other half, and
    compare with the measurements.

    Reports the rms difference of the spectra and mean ΔE00 under A, FL2, FL7, FL11,
    LED-B3, LED-RGB1 and HP1, compared with cubes of moments and of sigmoids that have
    no atlas, and the predicted and the actual standard errors. The prior does not know
    the families of its library that contain spectra of the atlas, or look-alikes of a
    quarter of them.

    A plain baseline knows the same half: a local-linear regression of reflectance on
    RGB. Other methods know the library, as the prior does: a 3 × 3 matrix and root
    polynomials, which give colours only, a local-linear regression, the mean of
    metamers, and the reconstruction of Burns 2019.

    \b
    Examples:
      uplift lab study held-out --atlas paints.csv
      uplift lab study held-out --atlas rawtoaces --coefficients 17
      uplift lab study held-out --format json
    """,
)
@options.atlas("Atlas", DEFAULT_ATLASES)
@options.whole("--dim", default=32, help="Lattice nodes along each axis.")
@options.coefficients
@options.table_json_or_csv
def held_out(files: Sequence[str], dim: int, coefficients: int, style: str) -> None:
    enable_jit_cache()
    from uplift.lab.study.held_out import holdout

    records: list[dict[str, Any]] = []
    for name, atlas in read_atlases(files).items():
        with progress_bar(name) as progress:
            study = holdout(atlas, progress, dim=dim, coefficients=coefficients)
        records += [{"atlas": name, **record} for record in study]
    rows = []
    for record in records:
        rows.append({key: record[key] for key in record if key != "standard_error"})
    print_result(style, records, _table(rows))
    for record in records if style == "table" else ():
        if errors := record.get("standard_error"):
            shares = (
                f"{errors['within_error']:.0%} within it, "
                f"{errors['within_bound']:.0%} within the error bound"
            )
            means = (
                f"predicted standard error ΔE00 {errors['stated']:.2f}, actual "
                f"{errors['real']:.2f}"
            )
            say(f"{record['atlas']}: {means}; {shares}")


@command.command(
    "stability",
    help="""Build cubes over dims, coefficients, models, spaces, thresholds and atlases,
    and count unfitted nodes.

    Reports for each build the realisable and the unfitted nodes, rounds, improvement
    attempts, the largest residual and the time. The builds are a grid of each setting
    against models and coefficients, and a random sample of other combinations;
    `uplift.lab.study.stability` takes other ones.

    Atlases are none, the ColorChecker, and three difficult synthetic ones: crowded,
    spiky and noisy. --output writes the largest residual of each build, as PNG.

    \b
    Examples:
      uplift lab study stability --quick --output out --force
      uplift lab study stability --atlas paints.csv --format json
    """,
)
@options.flag("--quick", help="Small lattices and few values: some seconds per model.")
@options.atlas("Atlas in addition to the synthetic ones", MACBETH)
@options.output(help="Folder for plots.", metavar="DIR")
@options.table_json_or_csv
@options.force
def stability(
    quick: bool, files: Sequence[str], output: str | None, style: str, force: bool
) -> None:
    enable_jit_cache()
    from uplift.lab.study.stability import (
        DESIGN,
        QUICK_DESIGN,
        study_stability,
        synthetic_atlases,
    )

    atlases = read_atlases(files or (MACBETH,)) | synthetic_atlases()
    design = (QUICK_DESIGN if quick else DESIGN).with_atlases(atlases)
    check_folder(output, STABILITY_PLOTS, inputs=atlas_files(files))
    with progress_bar("builds") as progress:
        rows = study_stability(design.configs(), atlases, progress)
    if output is not None:
        from uplift.lab.study.plots import plot_map

        write_files(output, STABILITY_PLOTS, partial(plot_map, rows))
    print_result(style, rows, _table(rows, "success", "points", "stand_ins"))
    if style == "table":
        failed = [row["unfitted"] for row in rows if row["unfitted"]]
        nodes = sum(row["realisable"] for row in rows)
        builds = pluralise(len(rows), "build")
        missed = pluralise(len(failed), "build")
        say(
            f"{builds}, {pluralise(nodes, 'realisable node')}: {sum(failed)} unfitted "
            f"in {missed}"
        )


@command.command(
    "sensitivity",
    help="""Perturb queried colours and the measurements of a cube, and report the
    change of its spectra.

    Colours are perturbed by an 8-bit code, a 10-bit code and float rounding. The cube
    is rebuilt with noise on its atlas, with one entry reversed, and with one entry left
    out. CUBE defaults to the packaged cube, which has no atlas. ΔE00 are under FL11
    and, for colours, under the illuminant of the cube.

    jump is the change that remains when steps are halved repeatedly: rounding, unless
    answers are discontinuous, as those of Otsu 2018 are. --method adds such published
    methods, in sRGB.

    --output writes, as PNG, the distance to which an entry of the atlas affects the
    cube.

    \b
    Examples:
      uplift lab study sensitivity
      uplift lab study sensitivity macbeth-32.uplift --output out --force
      uplift lab study sensitivity --method otsu2018
      uplift lab study sensitivity --entries 4 --format json
    """,
)
@click.argument("cube", metavar="[CUBE]", required=False)
@options.atlas_folders
@click.option(
    "--entries",
    type=options.Whole(0),
    default=24,
    help="Number of atlas entries to change, one at a time.",
)
@options.repeatable(
    "--method",
    "methods",
    "Published method whose queries are perturbed too, such as otsu2018 or mallett2019",
    metavar="NAME",
)
@options.output(help="Folder for plots.", metavar="DIR")
@options.table_or_json
@options.force
def sensitivity(
    cube: str | None,
    folders: Sequence[str],
    entries: int,
    methods: Sequence[str],
    output: str | None,
    style: str,
    force: bool,
) -> None:
    enable_jit_cache()
    from uplift.colorimetry import observer
    from uplift.extras.colour.light_sets import NARROW_BAND_LIGHT
    from uplift.extras.report.rebuild import recorded_atlas
    from uplift.lab.chart.selection import perturb_method, select_methods
    from uplift.lab.study.sensitivity import perturb, perturb_atlas
    from uplift.lookup.cube import load

    others = select_methods(methods) if methods else ()
    loaded = load(cube)
    data = loaded.data
    atlas = None
    if cube is not None and entries:
        atlas = recorded_atlas(data, cube, folders)
    if output is not None and atlas is None:
        raise click.UsageError(
            "--output draws the effect of entries: it needs a CUBE with an atlas, and "
            "--entries."
        )
    check_folder(
        output,
        SENSITIVITY_PLOTS,
        inputs=() if atlas is None else {entry.path for entry in atlas.entries},
    )
    of_methods = []
    for method in others:
        of_methods += perturb_method(method, observer.light(NARROW_BAND_LIGHT))
    moves = perturb(loaded) + of_methods
    changes = []
    if atlas is not None:
        with progress_bar("builds") as progress:
            changes = perturb_atlas(data, atlas, entries, progress)
    if output is not None:
        from uplift.lab.study.plots import plot_locality

        write_files(output, SENSITIVITY_PLOTS, partial(plot_locality, changes))
    rows = [change.row() for change in changes]
    tables = [_table(moves), *([_table(rows)] if rows else [])]
    print_result(style, {"moves": moves, "changes": rows}, *tables)
