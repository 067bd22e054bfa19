"""Looks of a build: colours and what they are to be under other lights, checked, fitted and recorded."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from uplift import fit
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.sensor import Light, Sensor
from uplift.colorimetry.solid import solid
from uplift.colorimetry.srgb import hex_codes
from uplift.colorimetry.written_colour import parse_colour
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import LookError, UpliftError, UpliftWarning
from uplift.common.text import format_value
from uplift.cube import AtlasTable, EntrySpectra
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap
from uplift.pipeline.look import Look, format_rgb

SAME_CODE = 0.5
"""Colours whose 8-bit codes differ by at most this are the same: a query of one would return the other."""
DIGITS = 6
"""Decimals of recorded colours and distances."""
STACK_LEVEL = 5
"""Frames between a warning and the caller of `uplift.build`, whose decorator adds one."""

LooksLike = StrPath | Look | Sequence[Look] | None


@dataclass(frozen=True, eq=False)
class LookSet:
    """Looks in the colours of a sensor.

    Parameters
    ----------
    looks : tuple of Look
        The k looks.
    screens : tuple of tuple of Sensor
        sRGB sensors of the lights of each look.
    goals : tuple of LookGoal
        Their colours.
    """

    looks: tuple[Look, ...]
    screens: tuple[tuple[Sensor, ...], ...]
    goals: tuple[fit.LookGoal, ...]

    def __len__(self) -> int:
        return len(self.looks)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the looks."""
        return tuple(look.name for look in self.looks)

    @property
    def rgb(self) -> Array:
        """(k, 3) linear RGB under the build illuminant."""
        return np.array([goal.rgb for goal in self.goals]).reshape(-1, 3)


@dataclass(frozen=True, eq=False)
class DesignedLooks:
    """Looks with reflectances.

    Parameters
    ----------
    looks : LookSet
        The looks.
    goals : tuple of LookGoal
        Their colours, with the weights of the looks applied.
    reflectances : ndarray, shape (k, N)
        Reflectances that have the colours, or the nearest ones that are possible.
    """

    looks: LookSet
    goals: tuple[fit.LookGoal, ...]
    reflectances: Array

    def fit(self, model: Model, sensor: Sensor, error_light: Light, tolerance: float) -> fit.FittedEntries:
        """Fit the reflectances by a spectrum model; see `uplift.fit.fit_designs`."""
        return fit.fit_designs(model, sensor, self.goals, self.reflectances, error_light, tolerance)


def as_looks(looks: LooksLike) -> tuple[Look, ...]:
    """Return looks as given, or read from a file."""
    if looks is None:
        return ()
    if isinstance(looks, str | os.PathLike):
        from uplift.pipeline.look_file import read_looks  # imports pydantic

        return read_looks(looks)
    given = (looks,) if isinstance(looks, Look) else tuple(looks)
    for each in given:
        if not isinstance(each, Look):
            raise LookError(f"looks must be Look objects, got {format_value(each)}", code="look-type")
    return given


def resolve_looks(
    looks: Sequence[Look],
    model: Model,
    sensor: Sensor,
    names: Sequence[str],
    entry_names: Sequence[str],
    rgb: Array,
) -> LookSet:
    """Return looks in the colours of a sensor.

    Parameters
    ----------
    looks : sequence of Look
        The looks.
    model : Model
        Spectrum model of the entries.
    sensor : Sensor
        Sensor of the cube.
    names : sequence of str
        Names of all spectra of the atlas.
    entry_names : sequence of str
        Names of the E entries of the cube.
    rgb : ndarray, shape (E, 3)
        Linear RGB of these.

    Returns
    -------
    LookSet

    Raises
    ------
    LookError
        Two looks, or a look and an entry, of one colour or name, a colour that no reflectance has, or a light that is
        that of the build, unknown, or occurs twice; or a model whose spectra their colours determine.
    """
    if looks and not fit.has_freedom(model):
        raise LookError(
            f"looks need spectra of more than three coefficients, got {model.name} with {model.count}",
            code="looks-without-freedom",
            hint='use model="moments" with entry_coefficients of 4 to 17',
        )
    screens = tuple(_screens(look, sensor) for look in looks)
    goals = tuple(_goal(look, sensor, each) for look, each in zip(looks, screens, strict=True))
    taken = dict.fromkeys(names, "an atlas entry")
    known = list(zip(entry_names, (_codes(sensor, each) for each in rgb), strict=True))
    for look, goal in zip(looks, goals, strict=True):
        if look.name in taken:
            raise look.error(f"its name is that of {taken[look.name]}", code="look-name-taken", hint="rename the look")
        codes = _codes(sensor, goal.rgb)
        for name, others in known:
            if np.abs(codes - others).max() <= SAME_CODE:
                raise look.error(
                    f"its colour {format_rgb(look.rgb)} is that of {taken[name]}, '{name}'",
                    code="look-colour-taken",
                    hint="a colour has one answer: change the look, or leave out the other",
                )
        taken[look.name] = "another look"
        known.append((look.name, codes))
    return LookSet(tuple(looks), screens, goals)


def _codes(sensor: Sensor, rgb: Array) -> Array:
    return np.interp(rgb, sensor.decoding, np.arange(256.0))


def _screens(look: Look, sensor: Sensor) -> tuple[Sensor, ...]:
    screens: dict[str, Sensor] = {}
    for name in look.lights:
        try:
            (screen,) = display_sensors([name], sensor.observer, *sensor.range)
        except UpliftError as error:
            raise look.error(error.problem, code=error.code, hint=error.hint) from error
        if screen.illuminant == sensor.illuminant:
            raise look.error(
                f"{name} is the illuminant of the build, under which the colour is that of rgb",
                code="look-of-build-light",
                hint="remove it",
            )
        if screen.illuminant in screens:
            raise look.error(f"{name} occurs twice", code="look-light-repeated", hint="remove one of the two")
        screens[screen.illuminant] = screen
    return tuple(screens.values())


def _goal(look: Look, sensor: Sensor, screens: Sequence[Sensor]) -> fit.LookGoal:
    rgb = parse_colour(look.rgb).rgb(sensor)
    if not solid(sensor.matrix).contains(rgb[None])[0]:
        raise look.error(
            f"no reflectance has the colour {format_rgb(look.rgb)} under {sensor.illuminant}",
            code="look-unrealisable",
            hint="choose one of less chroma",
        )
    wishes = zip(look.lights.values(), screens, strict=True)
    xyz = np.array([screen.xyz(parse_colour(wish).rgb(screen)) for wish, screen in wishes])
    return fit.LookGoal(rgb, tuple(screen.light for screen in screens), xyz)


def design_looks(looks: LookSet, prior: fit.Prior, forward: ForwardMap, tolerance: float) -> DesignedLooks:
    """Design the reflectances of looks, which differ as little as possible from those that a prior expects.

    Parameters
    ----------
    looks : LookSet
        The looks.
    prior : Prior
        Prior without the looks.
    forward : ForwardMap
        Map from its multipliers to RGB.
    tolerance : float
        Largest residual of expected spectra, in linear RGB.

    Returns
    -------
    DesignedLooks
    """
    if not len(looks):
        return DesignedLooks(looks, (), np.zeros((0, len(prior.sensor.wavelengths))))
    expected = fit.expected_reflectances(prior, forward, looks.rgb, tolerance)
    goals = tuple(
        goal.softened(spectrum, look.weight)
        for look, goal, spectrum in zip(looks.looks, looks.goals, expected, strict=True)
    )
    design = partial(fit.design_reflectance, prior.sensor)
    return DesignedLooks(looks, goals, np.array(list(map(design, goals, expected))))


def describe(designed: DesignedLooks, table: AtlasTable, model: Model, sensor: Sensor) -> dict[str, Any]:
    """Return what a cube records of its looks, in JSON values, and warn of those that its answers miss.

    Parameters
    ----------
    designed : DesignedLooks
        The looks.
    table : AtlasTable
        Entries of the cube; the last ones are the looks.
    model : Model
        Spectrum model of the nodes.
    sensor : Sensor
        Sensor of the cube.

    Returns
    -------
    dict
        ``looks``, a list of wishes and of their distances from the answers; empty without looks.
    """
    if not len(designed.looks):
        return {}
    rows = np.arange(table.measured_count, len(table.names))
    stored = table.spectra or EntrySpectra(model, table.coefficients)
    answers = stored.reflectance(rows, sensor.wavelengths)
    parts = zip(designed.looks.screens, designed.goals, designed.reflectances, answers, strict=True)
    records = [
        {
            "name": look.name,
            "rgb": goal.rgb.tolist(),
            "weight": float(look.weight),
            "lights": list(_describe_lights(look, *each)),
        }
        for look, goal, each in zip(designed.looks.looks, designed.goals, parts, strict=True)
    ]
    _warn_of_missed(designed.looks.looks, records)
    return {"looks": records}


def _describe_lights(
    look: Look, screens: Sequence[Sensor], goal: fit.LookGoal, design: Array, answer: Array
) -> Iterator[dict[str, Any]]:
    """Per light: the wish and the answer in linear sRGB, ΔE00 of the answer, and the least that is possible."""
    rows = zip(screens, look.lights.values(), goal.delta_e(answer), goal.delta_e(design), strict=True)
    for screen, wish, delta_e, possible in rows:
        yield {
            "light": screen.illuminant,
            "wish": parse_colour(wish).rgb(screen).tolist(),
            "answer": screen.rgb(answer).round(DIGITS).tolist(),
            "delta_e": round(float(delta_e), DIGITS),
            "possible": round(float(possible), DIGITS),
        }


def recorded_looks(provenance: Mapping[str, Any]) -> tuple[Look, ...]:
    """Return the looks that a cube recorded, for a rebuild. Raises `LookError` for values that do not fit."""
    return tuple(
        Look(
            record["rgb"],
            {each["light"]: each["wish"] for each in record["lights"]},
            record["weight"],
            record["name"],
        )
        for record in provenance.get("looks", ())
    )


def _warn_of_missed(looks: Sequence[Look], records: Sequence[Mapping[str, Any]]) -> None:
    """Warn of each look that is not met: impossible wishes, and those that the spectrum model does not reach."""
    for look, record in zip(looks, records, strict=True):
        missed = [each for each in record["lights"] if each["delta_e"] > fit.MET]
        if not missed:
            continue
        place: dict[str, Any] = {"path": look.path, "line": look.line}
        if any(each["possible"] > fit.MET for each in record["lights"]):
            problem = f"no reflectance meets it: {_missed(missed, 'at least {possible:.2f}')}"
            warning = UpliftWarning(look.about(problem), code="look-impossible", **place)
        else:
            problem = f"the coefficients of its spectrum do not reach it: {_missed(missed)}"
            hint = "use more entry_coefficients"
            warning = UpliftWarning(look.about(problem), code="look-not-reached", hint=hint, **place)
        warnings.warn(warning, stacklevel=STACK_LEVEL)


def _missed(rows: Sequence[Mapping[str, Any]], more: str = "") -> str:
    """'under A it is #46609f, ΔE00 1.16 from #5060a0; …'."""
    return ", ".join(
        f"under {row['light']} it is {_hex(row['answer'])}, ΔE00 {row['delta_e']:.2f} from {_hex(row['wish'])}"
        + (f" ({more.format(**row)})" if more else "")
        for row in rows
    )


def _hex(rgb: Sequence[float]) -> str:
    return hex_codes(np.array([rgb]))[0]
