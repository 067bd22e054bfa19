"""Palette spec as a TOML file (docs/palette.md)."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import PaletteError, unknown_name
from uplift.extras.colour.srgb import WrittenColour
from uplift.extras.emission.lamps import lamp_file
from uplift.extras.files.spec import Key, SpecFile, read_toml
from uplift.extras.papers.palette.palette import ColourGoal, MinDifference, Palette
from uplift.extras.papers.palette.tables import FreeGoal, FreeRange, PaletteTable


def read_palette(path: StrPath) -> Palette:
    """Read a palette spec.

    Parameters
    ----------
    path : path-like
        A TOML file. Paths of atlases and cubes start in its folder.

    Returns
    -------
    Palette
        Its lights and materials with their spectra, and its goals.

    Raises
    ------
    PaletteError
        If the file cannot be read or a value does not fit; the error names the key.
    """
    file = read_toml(path, PaletteError)
    table = file.validate(PaletteTable)
    sensor = observer.sensor()
    folder = file.path.parent
    for number, difference in enumerate(table.apart):
        for material in difference.materials:
            _check_known(
                file,
                ("apart", number, "materials"),
                material,
                table.materials,
                "material",
            )
        _check_known(
            file, ("apart", number, "light"), difference.light, table.lights, "light"
        )
    goals = tuple(_goals(file, table, sensor))
    free = dict(table.free)
    for goal in goals:
        if goal.free is not None:
            free.setdefault(goal.free, FreeRange())
    named = [
        spec.file
        for spec in (*table.materials.values(), *table.lights.values())
        if spec.file is not None
    ]
    return Palette(
        sensor=sensor,
        lights=tuple(
            light.spectrum(name, sensor, folder) for name, light in table.lights.items()
        ),
        materials=tuple(
            material.spectrum(name, sensor, folder)
            for name, material in table.materials.items()
        ),
        goals=goals,
        free={
            name: _free_range(file, name, colours, sensor)
            for name, colours in free.items()
        },
        min_differences=tuple(
            MinDifference(
                (difference.materials[0], difference.materials[1]),
                difference.light,
                difference.delta_e,
            )
            for difference in table.apart
        ),
        smoothness=table.smoothness,
        model_error=table.model_error,
        count=int(table.coefficients),
        fit=table.fit,
        sources=(
            file.path,
            *(Path(lamp_file(str(folder / name))) for name in named),
        ),
    )


def _goals(file: SpecFile, table: PaletteTable, sensor: Sensor) -> Iterator[ColourGoal]:
    for material, goals in table.colours.items():
        _check_known(file, ("colours", material), material, table.materials, "material")
        for light, goal in goals.items():
            _check_known(
                file, ("colours", material, light), light, table.lights, "light"
            )
            if isinstance(goal, WrittenColour):
                yield ColourGoal(material, light, rgb=goal.rgb(sensor))
            elif isinstance(goal, FreeGoal):
                yield ColourGoal(material, light, free=goal.free, weight=goal.weight)
            else:
                yield ColourGoal(
                    material, light, rgb=goal.rgb.rgb(sensor), weight=goal.weight
                )


def _free_range(
    file: SpecFile, name: str, colours: FreeRange, sensor: Sensor
) -> tuple[Array, Array]:
    low = colours.low.rgb(sensor)
    high = colours.high.rgb(sensor)
    if not (low < high).all():
        text = (
            f"must have low < high in every channel, got {low.round(4).tolist()} and "
            f"{high.round(4).tolist()}"
        )
        file.fail(("free", name), text, hint="widen the range")
    return low, high


def _check_known(
    file: SpecFile,
    keys: tuple[Key, ...],
    name: str,
    known: Mapping[str, object],
    kind: str,
) -> None:
    if name not in known:
        error = unknown_name(name, known, kind)
        file.fail(keys, error.problem, code=error.code, hint=error.hint)
