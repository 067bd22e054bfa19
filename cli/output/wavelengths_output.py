"""A choice of wavelengths as it is printed: table, JSON, CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from .console import console, json_text

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Sensor
    from uplift.scene.wavelengths import Choice, ColourErrors

ALL = "all lights"


@dataclass(frozen=True, eq=False)
class Found:
    """A choice, the space that it is shown in, and the names of the materials."""

    choice: Choice
    sensor: Sensor
    materials: tuple[str, ...]

    def errors(self) -> Iterator[tuple[str, ColourErrors]]:
        """Errors under each light, and where there are several, under all."""
        lights = self.choice.sampling.lights
        for row, light in enumerate(lights):
            yield light, self.choice.errors.under(row)
        if len(lights) > 1:
            yield ALL, self.choice.errors

    def worst(self, errors: ColourErrors) -> str:
        """The material that is farthest off."""
        return self.materials[int(errors.delta_e.max(axis=0).argmax())]


def _print_json(found: Found) -> None:
    sampling, sensor = found.choice.sampling, found.sensor
    answer = {
        "method": found.choice.method,
        "count": len(sampling),
        "materials": len(found.materials),
        "observer": sensor.observer,
        "space": sensor.space,
        "illuminant": sensor.illuminant,
        "wavelengths": sampling.wavelengths.tolist(),
        "to_xyz": sampling.to_xyz.tolist(),
        "to_rgb": sampling.to_rgb(sensor).tolist(),
        "powers": dict(zip(sampling.lights, sampling.powers.tolist(), strict=True)),
        "errors": {name: _stated(found, errors) for name, errors in found.errors()},
    }
    click.echo(json_text(answer))


def _stated(found: Found, errors: ColourErrors) -> dict[str, Any]:
    return {"mean": errors.mean, "p95": errors.p95, "max": errors.max, "worst": found.worst(errors)}


def _print_csv(found: Found) -> None:
    sampling = found.choice.sampling
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["wavelength", *"XYZ", *"rgb", *(f"power {light}" for light in sampling.lights)])
    writer.writerows(_rows(found))
    click.echo(out.getvalue(), nl=False)


def _rows(found: Found) -> Iterator[list[float]]:
    """Wavelength, weights to XYZ and RGB, powers, of each wavelength."""
    sampling = found.choice.sampling
    parts = (sampling.wavelengths[:, None], sampling.to_xyz, sampling.to_rgb(found.sensor), sampling.powers.T)
    for row in zip(*(part.tolist() for part in parts), strict=True):
        yield [number for numbers in row for number in numbers]


def _print_table(found: Found) -> None:
    from rich import box
    from rich.table import Table

    sampling = found.choice.sampling
    table = Table(box=box.SIMPLE_HEAD, title=f"{len(sampling)} wavelengths, {found.choice.method}")
    heads = [f"to {axis}" for axis in ("X", "Y", "Z", "R", "G", "B")]
    for head in ("nm", *heads, *(f"power of {light}" for light in sampling.lights)):
        table.add_column(head, justify="right", no_wrap=True)
    for nm, *others in _rows(found):
        table.add_row(f"{nm:.1f}", *(f"{other:.4f}" for other in others))
    told = Table(box=box.SIMPLE_HEAD, title=f"ΔE00 of {len(found.materials)} materials")
    told.add_column("light")
    for head in ("mean", "95 % under", "max"):
        told.add_column(head, justify="right")
    told.add_column("worst material")
    for name, errors in found.errors():
        numbers = (errors.mean, errors.p95, errors.max)
        told.add_row(name, *(f"{number:.3f}" for number in numbers), found.worst(errors))
    console().print(table, told)


PRINTERS: dict[str, Callable[[Found], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
