"""Looks of a build: checked, designed as reflectances, fitted as further entries, and
recorded.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.colorimetry.object_colours import solid
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import LookError, UpliftError, UpliftWarning, warn
from uplift.cube.data import AtlasTable
from uplift.extras.colour.srgb import hex_codes, parse_colour
from uplift.extras.looks.design import (
    MET,
    LookGoal,
    design_reflectance,
    fit_designs,
    join_entries,
)
from uplift.extras.looks.look import (
    Look,
    LooksLike,
    about,
    as_looks,
    format_rgb,
    look_error,
)
from uplift.fit.entries import MAX_STEPS, FittedEntries
from uplift.fit.kriging import DEFAULT, krige
from uplift.fit.prior import Prior, deviations_of
from uplift.fit.problem import Problem
from uplift.fit.solver import solve_in_numpy
from uplift.models.model import Model, evaluate
from uplift.pipeline.entries import Constraints, MeasuredEntries

SAME_CODE = 0.5
"""Colours whose 8-bit codes differ by at most this are the same: a query of one would
return the other.
"""
LOOK_VARIANCE = 0.01
"""Variance of the noise of a look relative to that of entries."""
DIGITS = 6
"""Decimals of recorded colours and distances."""


@dataclass(frozen=True, eq=False)
class LookTargets:
    """k looks in the colours of a sensor, the sRGB sensors of the lights of each, and
    their goals.

    ``designs`` (k, N) are reflectances that have the colours of the goals, or the
    nearest ones that are possible.
    """

    looks: tuple[Look, ...]
    screens: tuple[tuple[Sensor, ...], ...]
    goals: tuple[LookGoal, ...]
    designs: Array

    def fit(
        self, problem: Problem, entries: Constraints, prior: Prior
    ) -> tuple["LookTargets", Constraints, Prior]:
        """Design reflectances that differ as little as possible from those expected,
        and add them to the entries.

        The spectra of colours near a look deviate as that of the look. Kernel and
        standard errors of the prior stay, as looks are not measurements; the errors of
        looks are those that the prior states at their colours.
        """
        # The target becomes w y + (1 − w) y₀ in XYZ, with the colours y₀ of the
        # spectrum p₀ that is expected at x.
        rgb = np.array([goal.rgb for goal in self.goals])
        expected = solve_in_numpy(
            problem.forward, prior(rgb), rgb, problem.tolerance, MAX_STEPS
        )
        expected = evaluate(problem.model, expected, problem.sensor.wavelengths)
        parts = list(zip(self.looks, self.goals, expected, strict=True))
        goals = tuple(
            goal.softened(spectrum, look.weight) for look, goal, spectrum in parts
        )
        designs = np.array(
            [
                design_reflectance(problem.sensor, *pair)
                for pair in zip(goals, expected, strict=True)
            ]
        )

        errors = prior.standard_error(rgb)
        errors = np.zeros(len(rgb)) if errors is None else errors
        at_nodes = join_entries(
            entries.at_nodes,
            fit_designs(problem, goals, designs)._replace(error=errors),
        )
        at_entries = at_nodes
        if entries.entry_model != problem.model:
            fitted = fit_designs(
                replace(problem, model=entries.entry_model), goals, designs
            )
            at_entries = join_entries(entries.at_entries, fitted._replace(error=errors))
        names = (*entries.names, *(look.name for look in self.looks))
        constraints = Constraints(
            names, entries.entry_model, at_nodes, at_entries, len(self.looks)
        )
        return (
            replace(self, goals=goals, designs=designs),
            constraints,
            prior_with_looks(prior, at_nodes, len(self.looks)),
        )

    def describe(
        self, table: AtlasTable, model: Model, sensor: Sensor
    ) -> dict[str, Any]:
        """Return what a cube records of its looks, in JSON values, and warn of those
        that its answers miss.
        """
        answers = table.spectra.reflectance(
            np.arange(table.measured_count, len(table.names)), sensor.wavelengths
        )
        records = []
        for look, screens, goal, design, answer in zip(
            self.looks, self.screens, self.goals, self.designs, answers, strict=True
        ):
            # Per light: target and answer in linear sRGB, ΔE00 of the answer, and the
            # least that is possible
            rows = zip(
                screens,
                look.lights.values(),
                goal.delta_e(answer),
                goal.delta_e(design),
                strict=True,
            )
            lights = [
                {
                    "light": screen.illuminant,
                    "wish": parse_colour(target).rgb(screen).tolist(),
                    "answer": screen.rgb(answer).round(DIGITS).tolist(),
                    "delta_e": round(float(delta_e), DIGITS),
                    "possible": round(float(possible), DIGITS),
                }
                for screen, target, delta_e, possible in rows
            ]
            records.append(
                {
                    "name": look.name,
                    "rgb": goal.rgb.tolist(),
                    "weight": float(look.weight),
                    "lights": lights,
                }
            )
        _warn_of_missed(self.looks, records)
        return {"looks": records}


def targets_of(
    looks: LooksLike,
    model: Model,
    sensor: Sensor,
    atlas_names: Sequence[str],
    entries: MeasuredEntries,
) -> LookTargets | None:
    """Return looks in the colours of a sensor, whose entries have a spectrum model;
    None without any.

    Raises `LookError` for two looks, or a look and an entry, of one colour or name, for
    a colour that no reflectance has, for a light that is that of the build, unknown, or
    occurs twice, and for a model without freedom.
    """
    looks = as_looks(looks)
    if not looks:
        return None
    if model.is_determined:
        raise LookError(
            f"looks need spectra of more than three coefficients, got {model.name} "
            f"with {model.count}",
            hint='use model="moments" with entry_coefficients of 4 to 17',
        )
    screens = tuple(_screens(look, sensor) for look in looks)
    goals = tuple(
        _goal(look, sensor, screen) for look, screen in zip(looks, screens, strict=True)
    )
    taken = dict.fromkeys(atlas_names, "an atlas entry")
    codes = np.interp(
        [*entries.rgb, *(goal.rgb for goal in goals)], sensor.decoding, np.arange(256.0)
    )
    known = list(entries.names)
    for look in looks:
        if look.name in taken:
            raise look_error(
                look, f"its name is that of {taken[look.name]}", hint="rename the look"
            )
        change = np.abs(codes[: len(known)] - codes[len(known)])
        same = change.max(axis=1, initial=0) <= SAME_CODE
        if same.any():
            other = known[int(same.argmax())]
            raise look_error(
                look,
                f"its colour {format_rgb(look.rgb)} is that of {taken[other]}, "
                f"'{other}'",
                hint="a colour has one answer: change the look, or leave out the other",
            )
        taken[look.name] = "another look"
        known.append(look.name)
    return LookTargets(looks, screens, goals, np.zeros((0, len(sensor.wavelengths))))


def _screens(look: Look, sensor: Sensor) -> tuple[Sensor, ...]:
    try:
        screens = display_sensors(list(look.lights), sensor.observer, *sensor.range)
    except UpliftError as error:
        raise look_error(look, error.problem, error.code, error.hint) from error
    if len(screens) < len(look.lights):
        problem = f"two of its lights are the same: {', '.join(look.lights)}"
        raise look_error(look, problem, hint="remove one of the two")
    if sensor.illuminant in (screen.illuminant for screen in screens):
        problem = (
            f"{sensor.illuminant} is the illuminant of the build, under which the "
            "colour is that of rgb"
        )
        raise look_error(look, problem, hint="remove it")
    return screens


def _goal(look: Look, sensor: Sensor, screens: Sequence[Sensor]) -> LookGoal:
    rgb = parse_colour(look.rgb).rgb(sensor)
    if not solid(sensor.matrix).contains(rgb[None])[0]:
        problem = (
            f"no reflectance has the colour {format_rgb(look.rgb)} under "
            f"{sensor.illuminant}"
        )
        raise look_error(look, problem, hint="choose one of less chroma")
    # Targets y in XYZ, of colours of sRGB whose white is that of the light
    targets = zip(look.lights.values(), screens, strict=True)
    xyz = np.array(
        [screen.xyz(parse_colour(target).rgb(screen)) for target, screen in targets]
    )
    return LookGoal(rgb, tuple(screen.light for screen in screens), xyz)


def recorded_looks(provenance: Mapping[str, Any]) -> tuple[Look, ...]:
    """Return the looks that a cube recorded, for a rebuild. Raises `LookError` for
    values that do not fit.
    """
    looks = []
    for record in provenance.get("looks", ()):
        lights = {light["light"]: light["wish"] for light in record["lights"]}
        looks.append(Look(record["rgb"], lights, record["weight"], record["name"]))
    return tuple(looks)


def _warn_of_missed(
    looks: Sequence[Look], records: Sequence[Mapping[str, Any]]
) -> None:
    """Warn once of the looks with impossible targets, and once of those that the model
    does not reach.
    """
    impossible = []
    unreached = []
    for look, record in zip(looks, records, strict=True):
        missed = [light for light in record["lights"] if light["delta_e"] > MET]
        if any(light["possible"] > MET for light in missed):
            impossible.append((look, missed))
        elif missed:
            unreached.append((look, missed))
    _warn_of_worst(impossible, "no reflectance meets it", code="look-impossible")
    problem = "the coefficients of its spectrum do not reach it"
    _warn_of_worst(
        unreached, problem, code="look-not-reached", hint="use more entry_coefficients"
    )


def _warn_of_worst(
    missed: Sequence[tuple[Look, Sequence[Mapping[str, Any]]]],
    problem: str,
    *,
    code: str,
    hint: str = "",
) -> None:
    """Warn of looks and the lights under which they are missed, by the one that is
    missed by most.
    """
    if not missed:
        return
    look, lights = max(
        missed, key=lambda pair: max(light["delta_e"] for light in pair[1])
    )
    shown = []
    for light in lights:
        answer, target = hex_codes(np.array([light["answer"], light["wish"]]))
        least = (
            f" (at least {light['possible']:.2f})" if light["possible"] > MET else ""
        )
        shown.append(
            f"under {light['light']} it is {answer}, ΔE00 {light['delta_e']:.2f} from "
            f"{target}{least}"
        )
    text = about(look, f"{problem}: {', '.join(shown)}")
    if len(missed) > 1:
        text += f", and {len(missed) - 1} other looks are missed by less"
    warn(UpliftWarning(text, code=code, hint=hint, path=look.path))


def prior_with_looks(prior: Prior, entries: FittedEntries, looks: int) -> Prior:
    """Return the prior of entries whose last ones are looks, with the same kernel and
    standard errors.

    Looks are nearly certain: see `LOOK_VARIANCE`.
    """
    measured = len(entries.rgb) - looks
    # Of the same entries in any order, sums round alike.
    order = np.lexsort([*entries.rgb.T, np.arange(len(entries.rgb)) >= measured])
    deviations, _ = deviations_of(prior.model, prior.base, entries.rows(order))
    kernel = DEFAULT
    variances = np.zeros(0)
    trust = 1.0
    if prior.kriging is not None:
        kernel = prior.kriging.kernel
        variances = prior.kriging.variances
        trust = prior.kriging.trust
    variances = np.append(variances, np.full(looks, LOOK_VARIANCE))
    locations = rgb_to_lab(prior.sensor, entries.rgb[order])
    kriging, _ = krige(locations, deviations, kernel, variances)
    surprise = prior.surprise
    if surprise is not None:
        surprise = np.append(surprise, np.zeros(looks))
    return replace(prior, kriging=replace(kriging, trust=trust), surprise=surprise)
