"""Wavelengths of ``uplift wavelengths`` as table, JSON or CSV."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .console import make_table, print_csv, print_json, show

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Sensor
    from uplift.scene.wavelengths import Choice, ColourErrors

ALL = "all lights"


@dataclass(frozen=True, eq=False)
class Result:
    """Chosen wavelengths, the RGB space of the output, and the names of the materials."""

    choice: Choice
    sensor: Sensor
    materials: tuple[str, ...]

    def errors(self) -> Iterator[tuple[str, ColourErrors]]:
        """Yield errors by light, and for several lights also over all of them."""
        lights = self.choice.sampling.lights
        for row, light in enumerate(lights):
            yield light, self.choice.errors.under(row)
        if len(lights) > 1:
            yield ALL, self.choice.errors

    def worst(self, errors: ColourErrors) -> str:
        """Return the material with the largest error."""
        return self.materials[int(errors.delta_e.max(axis=0).argmax())]


def _print_json(result: Result) -> None:
    sampling, sensor = result.choice.sampling, result.sensor
    fields = {
        "method": result.choice.method,
        "count": len(sampling),
        "materials": len(result.materials),
        "observer": sensor.observer,
        "space": sensor.space,
        "illuminant": sensor.illuminant,
        "wavelengths": sampling.wavelengths.tolist(),
        "to_xyz": sampling.to_xyz.tolist(),
        "to_rgb": sampling.to_rgb(sensor).tolist(),
        "powers": dict(zip(sampling.lights, sampling.powers.tolist(), strict=True)),
        "errors": {name: _statistics(result, errors) for name, errors in result.errors()},
    }
    print_json(fields)


def _statistics(result: Result, errors: ColourErrors) -> dict[str, Any]:
    return {"mean": errors.mean, "p95": errors.p95, "max": errors.max, "worst": result.worst(errors)}


def _print_csv(result: Result) -> None:
    lights = result.choice.sampling.lights
    header = ["wavelength", *"XYZ", *"rgb", *(f"power {light}" for light in lights)]
    print_csv(header, _rows(result))


def _rows(result: Result) -> Iterator[list[float]]:
    """Yield wavelength, weights to XYZ, weights to RGB and powers, per wavelength."""
    sampling = result.choice.sampling
    parts = (
        sampling.wavelengths[:, None],
        sampling.to_xyz,
        sampling.to_rgb(result.sensor),
        sampling.powers.T,
    )
    for row in zip(*(part.tolist() for part in parts), strict=True):
        yield [number for numbers in row for number in numbers]


def _print_table(result: Result) -> None:
    sampling = result.choice.sampling
    weights = make_table((), ("nm", *"XYZRGB"), title=f"{len(sampling)} wavelengths, {result.choice.method}: weights")
    powers = make_table((), ("nm", *sampling.lights), title="power of the lights")
    for nm, *others in _rows(result):
        cells = [f"{other:.4f}" for other in others]
        weights.add_row(f"{nm:.1f}", *cells[:6])
        powers.add_row(f"{nm:.1f}", *cells[6:])
    errors_table = make_table(("light",), ("mean", "95 %", "max"), title=f"ΔE00 of {len(result.materials)} materials")
    errors_table.add_column("worst material")
    for name, errors in result.errors():
        numbers = (errors.mean, errors.p95, errors.max)
        errors_table.add_row(name, *(f"{number:.3f}" for number in numbers), result.worst(errors))
    show(weights, powers, errors_table)


PRINTERS: dict[str, Callable[[Result], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
