"""``uplift build``: build a cube from atlases."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.errors import OptionError, OutputError, UpliftWarning
from uplift.common.text import format_value, parse_float, pluralise
from uplift.extras.images.sequences import expand_patterns

from .. import options, sensor_options
from ..output.console import paragraph, say
from ..output.diagnostics import warn
from ..output.notes import collect_notes, print_notes
from ..output.progress import progress_bar
from ..outputs import check_outputs
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.atlas.atlas import Source
    from uplift.lookup.cube import Cube

ALLOWED_WITH_PLAN = {"plan_path", "output", "debug", "force", "quiet"}
"""Parameters that may accompany --plan."""
OTHER_FILES = {
    ".csv", ".cube", ".exr", ".h", ".html", ".json", ".npz", ".pdf", ".png", ".svg",
    ".toml", ".txt",
}  # fmt: skip
"""Suffixes of what is not a cube."""
OF_IMAGES = ("encoding", "method", "input_space")
"""Parameters of --scene images, in the order of
`uplift.extras.texture.scene_colours.Images`.
"""


def parse_range(
    ctx: click.Context, param: click.Parameter, value: str
) -> tuple[float, float]:
    """Parse '360:830', a first and a last wavelength in nm."""
    try:
        start, end = map(parse_float, value.split(":"))
    except ValueError as error:
        problem = f"a range must be START:END in nm, got {format_value(value)}"
        raise OptionError(problem, hint="write for example 360:830") from error
    return start, end


@click.command(
    "build",
    cls=options.Command,
    everyday=("files", "output", "dim", "space", "coefficients", "force"),
    no_arguments=(
        "Measured spectra are named with --atlas: uplift build --atlas macbeth."
    ),
    help="""Build an uplifting cube constrained by measured spectra.

    \b
    Examples:
      uplift build --atlas macbeth --dim 32
      uplift build --atlas paints.csv --atlas fabrics.csv -o book.uplift
      uplift build --atlas paints.csv --dim auto
      uplift build --atlas macbeth --space ACEScg
    \f

    \b
    More examples:
      uplift build --atlas fabrics.csv --dim auto --tolerance 1 --coefficients 17
      uplift build --atlas paints.csv --dim 64 --scene wood.png --scene 'shot.*'
      uplift build --atlas macbeth --library fabrics.csv -o fabrics.uplift
      uplift build --atlas macbeth --look looks.toml -o looks.uplift
      uplift build --atlas paints.csv --range 360:830 --step 1 -o range.uplift
      uplift build --model sigmoid --space 'ITU-R BT.2020' -o wide.uplift
      uplift build --observer 'Nikon 5100 (NPL)' --space camera --dim 16
      uplift plan kitchen.toml
      uplift build --plan kitchen.plan.json

    Warnings name the entries that were left out, clipped or crowded. Colours without
    measurements get the spectra that real materials of such colours are expected to
    have.

    Looks state colours under other lights, such as rgb = "#8a2a20" and HP1 = "#70392a"
    (docs/looks.md). They become entries. A look that no reflectance meets gets the
    nearest colour, and a warning.

    Entries have their own values in the --range as far as they were measured, and
    continue as constants. So does the learnt prior, from 380 and 780 nm.

    With --scene the cube is sparse: it is smaller and faster to build, and gives the
    same spectra for colours of the images. Other colours are errors, unless 'query' and
    'texture' are given --fill-missing.
    """,
)
@options.atlas("Measured spectra")
@options.scale
@options.missing
@options.output(
    help="Cube to write. [default: named after atlas and dim, in the current folder]"
)
@click.option(
    "--dim",
    default=32,
    type=options.WHOLE_OR_AUTO,
    metavar="N",
    help="Lattice nodes along each axis. 'auto' chooses the smallest dim, and its "
    "axis, that resolves every entry.",
)
@options.tolerance(
    "auto_tolerance",
    default=0.5,
    help="Largest difference to the entries that the lattice of --dim auto may have.",
)
@click.option("--model", default="moments", help="Spectrum model: moments or sigmoid.")
@options.coefficients
@options.whole(
    "--entry-coefficients",
    default=17,
    metavar="N",
    help="Coefficients per spectrum of an atlas entry, from --coefficients to 17.",
)
@click.option(
    "--warp", default="none", help="Phase warp of the moments: none, vision or colour."
)
@click.option("--axis", default="srgb", help="Spacing of the nodes: srgb or linear.")
@sensor_options.sensor
@click.option(
    "--range",
    "limits",
    default="380:780",
    callback=parse_range,
    help="First and last wavelength of the spectra in nm, from 300 to 1000.",
)
@options.number("--step", default=5, help="Distance of wavelengths in nm: 1, 5 or 10.")
@options.light(
    "Illuminant under which entries must keep their colour", "D65 A FL2 FL11 LED-B3"
)
@click.option(
    "--prior",
    default="learnt",
    help="Spectra of colours without measurements: learnt (from real materials) or "
    "smooth.",
)
@click.option(
    "--neutral",
    default="expected",
    help="Spectra of greys: expected (of real materials) or flat (docs/prior.md).",
)
@options.repeatable(
    "--library",
    "library",
    "Measured spectra that shape the learnt prior without being constraints",
    metavar="FILE",
)
@click.option(
    "--look",
    "looks",
    metavar="LOOKS.toml",
    help="File of looks: colours, and what they are to be under other lights.",
)
@options.repeatable(
    "--exclude-family",
    "leave_out",
    "Family of the shipped library that the learnt prior must not know, for tests on "
    "it",
    metavar="FAMILY",
)
@options.number(
    "--threshold", default=1e-4, help="Largest residual of a node, |linear RGB|."
)
@options.repeatable(
    "--scene",
    "images",
    "Build only the cells that the colours of this image, or quoted pattern, need",
    metavar="IMAGE",
)
@click.option(
    "--growth",
    default="outward",
    help="Order of the nodes: outward from the entries, coarse-to-fine, or neighbours: "
    "outward, each node from the spectra of its neighbours.",
)
@click.option(
    "--solver",
    default="least-change",
    help="Solver: least-change, dogleg, levenberg-marquardt or gauss-newton. Only "
    "nearly box-shaped spectra differ.",
)
@options.encoding
@options.input_space("--scene images")
@click.option(
    "--plan",
    "plan_path",
    metavar="PLAN",
    help="Build the cube of a plan by 'uplift plan'.",
)
@options.out_of_gamut(*options.PIXELS, "pixels of --scene images")
@options.flag(
    "--seed-corners",
    help="Start all eight nodes around an entry from it: closer near entries, less so "
    "for other materials.",
)
@options.flag(
    "--trust-atlas",
    help="Expect every material to be like those of the atlas: for scenes painted with "
    "nothing else.",
)
@options.flag(
    "--exact-entries",
    help="Keep exact spectra of entries that show as spots under other lights.",
)
@options.flag(
    "--debug",
    help="Store the round of every node, and write slices as .exr next to the cube.",
)
@options.force
@options.quiet
def command(
    plan_path: str | None,
    output: str | None,
    force: bool,
    quiet: bool,
    **settings: Any,
) -> None:
    enable_jit_cache()
    debug = settings["debug"]
    if plan_path is None:
        task = _task_of_atlases(output, **settings)
    else:
        task = _task_of_plan(plan_path, output, debug)
    path = Path(task.output)
    if path.suffix.lower() in OTHER_FILES:
        hint = "give a name ending in .uplift; uplift export writes other formats"
        raise OutputError("cubes are .uplift files", path=path, hint=hint)
    slices = path.with_suffix(".exr") if debug else None
    check_outputs(path, slices, inputs=task.inputs)
    begin = time.perf_counter()
    with progress_bar(quiet=quiet) as progress:
        cube, notes = collect_notes(partial(task.make, progress=progress))
    notes = [*task.notes, *notes]
    cube.save(path, force=force)
    if slices is not None:
        from uplift.extras.images.slices import write_slices

        write_slices(cube.data, slices, force=force)
    if quiet:
        warn(notes)
        return
    _print_summary(cube, path, time.perf_counter() - begin)
    if slices is not None:
        say(f"{slices}: {pluralise(cube.data.lattice.dim, 'blue slice')}")
    print_notes(cube, notes)
    for source in task.sources:  # of which some state no scale
        for note in source.assumptions:
            paragraph(f"{source.name}: {note}")


@dataclass(frozen=True)
class _Task:
    """A cube to build: its file, what builds it, and the files that it reads."""

    output: str | Path
    make: Callable[..., Cube]
    inputs: Sequence[str | Path] = ()
    sources: Sequence[Source] = ()
    notes: Sequence[UpliftWarning] = ()


def _task_of_plan(plan_path: str, output: str | None, debug: bool) -> _Task:
    from uplift.extras.scene.plan.files import cube_name, read_plan

    given = options.given()
    others = [given[name] for name in given if name not in ALLOWED_WITH_PLAN]
    if others:
        raise click.UsageError(
            f"The plan already sets these options: leave out {', '.join(others)}."
        )
    plan = read_plan(plan_path)
    return _Task(
        cube_name(plan_path) if output is None else output,
        partial(plan.build, debug=debug),
        (*plan.images.paths, *plan.atlases),
    )


def _task_of_atlases(
    output: str | None,
    files: Sequence[str],
    scale: Any,
    missing: Any,
    images: Sequence[str],
    limits: tuple[float, float],
    **settings: Any,
) -> _Task:
    given = options.given()
    useless = [given[name] for name in OF_IMAGES if name in given]
    if useless and not images:
        raise click.UsageError(
            f"{', '.join(useless)}: no --scene image is given to which this applies."
        )
    if output is None:
        output = _default_name(files, images, settings)
    settings["shortest"], settings["longest"] = limits
    pixels = [settings.pop(name) for name in OF_IMAGES]
    paths: tuple[Path, ...] = ()
    if images:
        from uplift.extras.texture.scene_colours import Images

        paths = tuple(map(Path, expand_patterns(images)))
        settings["scene"] = Images(paths, *pixels)
    from uplift.atlas.sources import read_atlas
    from uplift.pipeline.build import build

    stated = {
        name: value for name, value in settings.items() if value not in (None, ())
    }
    if not files:
        return _Task(output, partial(build, None, **stated), paths)
    read = partial(read_atlas, *files, measured=scale, missing=missing)
    atlas, notes = collect_notes(read)
    make = partial(build, atlas, **stated)
    return _Task(output, make, paths, atlas.sources, notes)


def _default_name(
    atlases: Sequence[str], images: Sequence[str], settings: dict[str, Any]
) -> str:
    """Return the name of a cube file: atlases, dim, and the space if it is not sRGB."""
    from uplift.colorimetry.camera import CAMERA

    space = settings["space"]
    if space not in ("sRGB", CAMERA):
        from uplift.extras.colour.spaces import look_up_space

        space = str(look_up_space(space).name)
    space = re.sub("[ /]", "-", space).lower()
    stem = "+".join(Path(atlas).stem for atlas in atlases) or space
    suffix = f"-{space}" if atlases and space != "srgb" else ""
    return f"{stem}-{settings['dim']}{suffix}{'-scene' if images else ''}.uplift"


def _print_summary(cube: Cube, path: Path, seconds: float) -> None:
    from uplift.fit.kernel_learning import TRUST_ENTRIES

    data = cube.data
    counts = data.points.counts()
    facts = [f"{data.lattice.dim}³ nodes"]
    if data.is_sparse:
        count = int(data.points.present.sum())
        nodes = pluralise(data.lattice.size, "node")
        facts = [f"{count:,} of {nodes} ({count / data.lattice.size:.1%})"]
    if data.provenance["atlases"]:
        entries = pluralise(data.atlas.measured_count, "atlas entry")
        trust = data.provenance["prior"].get("trust", 1)
        is_learnt = trust < 1 and data.atlas.measured_count >= TRUST_ENTRIES
        facts.append(f"{entries} trusted to {trust:.0%}" if is_learnt else entries)
    if data.atlas.looks:
        facts.append(pluralise(data.atlas.looks, "look"))
    facts += [f"{path.stat().st_size / 1e6:.1f} MB", f"{seconds:.1f} s"]
    paragraph(f"{path}: {', '.join(facts)}")
    for number, remark in (
        (
            counts["unrealisable"],
            "whose colour no reflectance has: stored with less chroma",
        ),
        (
            data.provenance.get("softened"),
            "moved towards neighbours: gradients near entries would be steep under "
            "other lights",
        ),
        (
            counts["unfitted"],
            f"EXCEED the threshold {data.threshold:g}: 'uplift report' shows where",
        ),
    ):
        if number:
            paragraph(f"{pluralise(number, 'node')} {remark}")
