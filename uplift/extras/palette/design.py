"""Design of the open spectra of a palette by linear least squares (section 3.3), its
colours, and goals it misses.
"""

import dataclasses
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.atlas import HIGHEST, LOWEST, Atlas, Entry, Header, write_atlas
from uplift.colorimetry import delta_e_rgb
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import PaletteError, UpliftWarning, warn
from uplift.common.text import listed, pluralise
from uplift.extras.palette.colours import screen_matrix
from uplift.extras.palette.equations import equations, solve, unknowns
from uplift.extras.palette.factor import FactorModel
from uplift.extras.palette.palette import (
    ColourGoal,
    MinDifference,
    Palette,
    SpectrumSpec,
)

# ΔE00 above which a goal is missed: about half of a difference that is visible side by
# side
MISSED = 0.5
MAX_REMAINING = 0.8  # fraction of the ΔE00 that a useful relaxation may leave
MAX_RELAXATIONS = 3  # relaxations that are listed for a goal


@dataclass(frozen=True, eq=False)
class Design:
    """A palette with all its spectra."""

    palette: Palette
    model: FactorModel  # whose error the design keeps small
    powers: Array  # (L, N), in the order of the palette's lights
    reflectances: Array  # (M, N)
    free: Mapping[str, Array]  # linear RGB (3,) of each free colour


def design(palette: Palette, model: FactorModel) -> Design:
    """Compute the open spectra and the free colours of a palette.

    Parameters
    ----------
    palette : Palette
        The palette.
    model : FactorModel
        Factor model on the palette's wavelengths.

    Returns
    -------
    Design
        The spectra of least squared error within their bounds.

    Raises
    ------
    PaletteError
        If both light and material of a goal are open.
    """
    for goal in palette.goals:
        if (
            palette.material(goal.material).designed
            and palette.light(goal.light).designed
        ):
            raise PaletteError(
                (
                    f"light or material of a goal must be given, got {goal}, both to "
                    "be "
                    "designed"
                ),
                hint="give one of them, or remove the goal",
            )
    where = unknowns(palette)
    x = solve(equations(palette, model))

    def spectra(kind: str, specs: tuple[SpectrumSpec, ...]) -> Array:
        return np.array(
            [
                x[where[kind, spec.name]] if spec.samples is None else spec.samples
                for spec in specs
            ]
        )

    free = {name: x[where["free", name]] for name in palette.free}
    return Design(
        palette,
        model,
        spectra("light", palette.lights),
        spectra("material", palette.materials),
        free,
    )


@dataclass(frozen=True, eq=False)
class Matrix:
    """Linear RGB of M materials under L lights on a display."""

    target: Array  # (M, L, 3) of the goals; NaN without a goal
    obtained: Array  # (M, L, 3) by full spectra
    factor: Array  # (M, L, 3) by the factor model
    # (M, L) ΔE00 from target to the colour that the palette fits; NaN without a goal
    delta_e: Array
    model_error: Array  # (M, L) ΔE00 from full spectra to the factor model
    whites: Array  # (L, 3) of the perfect reflector under each light


def matrix(design: Design) -> Matrix:
    """Compute all colours of a design.

    Parameters
    ----------
    design : Design
        The design.

    Returns
    -------
    Matrix
        Targets and colours (M, L, 3) of M materials under L lights, and their ΔE00
        against the white of the display.
    """
    palette = design.palette
    model = design.model
    screen = screen_matrix(palette.sensor)
    obtained = (design.reflectances[:, None] * design.powers) @ screen.T
    surfaces = model.reflectance(design.reflectances)
    lights = model.light(design.powers)
    factor = model.rgb(model.product(surfaces[:, None], lights))
    target = np.full_like(obtained, np.nan)
    for goal in palette.goals:
        # The target of a free colour is the value that the design chose.
        target[palette.cell(goal.material, goal.light)] = (
            design.free[goal.free] if goal.free else goal.rgb
        )
    return Matrix(
        target,
        obtained,
        factor,
        delta_e_rgb(
            palette.sensor,
            target,
            factor if palette.fit == "factor-model" else obtained,
        ),
        delta_e_rgb(palette.sensor, obtained, factor),
        design.powers @ screen.T,
    )


@dataclass(frozen=True, eq=False)
class UnmetGoal:
    """A goal that a design misses."""

    goal: ColourGoal | MinDifference
    delta_e: float  # ΔE00 from the target, or between the materials
    # Names of the criteria to relax, the most effective first, and the ΔE00 of the goal
    # without them.
    relaxations: tuple[tuple[str, float], ...] = ()

    def __str__(self) -> str:
        if isinstance(self.goal, MinDifference):
            first, second = self.goal.materials
            return (
                f"{first} and {second} under {self.goal.light}: ΔE00 must be at least "
                f"{self.goal.delta_e:g}, "
                f"got {self.delta_e:.2f}; choose colours that differ more"
            )
        criteria = ", ".join(
            f"{name} (then {remaining:.2f})" for name, remaining in self.relaxations
        )
        hint = f"relax {criteria}" if criteria else "no single criterion is responsible"
        return f"{self.goal}: missed by ΔE00 {self.delta_e:.2f}; {hint}"


def unmet_goals(found: Design) -> tuple[UnmetGoal, ...]:
    """Find the goals that a design misses. The palette is designed again without each
    criterion in turn.

    Parameters
    ----------
    found : Design
        The design.

    Returns
    -------
    tuple of UnmetGoal
        Colours missed by a visible difference, then differences that are too small.
    """
    colours = matrix(found)
    palette = found.palette
    fitted = colours.factor if palette.fit == "factor-model" else colours.obtained
    errors = {
        goal: float(colours.delta_e[palette.cell(goal.material, goal.light)])
        for goal in palette.goals
    }
    missed = [goal for goal in palette.goals if goal.weight and errors[goal] > MISSED]
    relaxed = []
    for name, changed in _relaxed(palette) if missed else ():
        relaxed.append((name, matrix(design(changed, found.model)).delta_e))
    unmet = []
    for goal in missed:
        cell = palette.cell(goal.material, goal.light)
        remaining = [(name, float(delta_e[cell])) for name, delta_e in relaxed]
        useful = _useful(goal, remaining, MAX_REMAINING * errors[goal])
        unmet.append(UnmetGoal(goal, errors[goal], useful))
    return (*unmet, *_too_alike(palette, fitted))


def _too_alike(palette: Palette, colours: Array) -> Iterator[UnmetGoal]:
    """Yield the pairs of materials whose colours differ too little."""
    for pair in palette.min_differences:
        first, second = pair.materials
        delta_e = float(
            delta_e_rgb(
                palette.sensor,
                colours[palette.cell(first, pair.light)],
                colours[palette.cell(second, pair.light)],
            )
        )
        if delta_e < pair.delta_e:
            yield UnmetGoal(pair, delta_e)


def _useful(
    goal: ColourGoal, remaining: list[tuple[str, float]], limit: float
) -> tuple[tuple[str, float], ...]:
    """Relaxed criteria that bring the ΔE00 of a goal below the limit, best first."""
    useful = []
    for name, delta_e in remaining:
        if name != _weight_of(goal) and delta_e < limit:
            useful.append((name, delta_e))
    useful.sort(key=lambda relaxation: relaxation[1])
    return tuple(useful[:MAX_RELAXATIONS])


def _weight_of(goal: ColourGoal) -> str:
    return f"the weight of {goal}"


def _relaxed(palette: Palette) -> Iterator[tuple[str, Palette]]:
    """Yield the name of each criterion, and the palette without it."""
    if palette.smoothness:
        yield "smoothness", dataclasses.replace(palette, smoothness=0.0)
    if palette.model_error:
        yield "model-error", dataclasses.replace(palette, model_error=0.0)
    for name in palette.free:
        unbounded = (np.full(3, -np.inf), np.full(3, np.inf))
        yield (
            f"the range of {name}",
            dataclasses.replace(palette, free={**palette.free, name: unbounded}),
        )
    for spec in (*palette.lights, *palette.materials):
        if spec.designed and (math.isfinite(spec.low) or math.isfinite(spec.high)):
            free = dataclasses.replace(spec, low=-math.inf, high=math.inf)
            without = dataclasses.replace(
                palette,
                lights=_replaced(palette.lights, spec, free),
                materials=_replaced(palette.materials, spec, free),
            )
            yield f"the bounds of {spec.name}", without
    for goal in palette.goals:
        if goal.weight:
            weightless = dataclasses.replace(goal, weight=0.0)
            goals = _replaced(palette.goals, goal, weightless)
            yield _weight_of(goal), dataclasses.replace(palette, goals=goals)


def _replaced(items: tuple[Any, ...], old: object, new: object) -> tuple[Any, ...]:
    return tuple(new if item is old else item for item in items)


def write_designed(design: Design, path: StrPath, *, force: bool = False) -> int:
    """Write the designed materials as an atlas file, so that they can constrain a cube
    like measured ones.

    Parameters
    ----------
    design : Design
        The design. A warning lists the materials outside the range of reflectances of
        an atlas, which are left out.
    path : path-like
        The file, in the format of `uplift.write_atlas`.
    force : bool
        Replace an existing file.

    Returns
    -------
    int
        Number of entries written.

    Raises
    ------
    PaletteError
        If no material can be written.
    """
    entries = []
    skipped = []
    for material, values in zip(
        design.palette.materials, design.reflectances, strict=True
    ):
        if not material.designed:
            continue
        if values.min() < LOWEST or values.max() > HIGHEST:
            skipped.append(
                f"'{material.name}' has {values.min():.3g} to {values.max():.3g}"
            )
            continue
        lights = [
            goal.light
            for goal in design.palette.goals
            if goal.material == material.name and goal.weight
        ]
        description = (
            f"designed for its colours under {', '.join(lights)}"
            if lights
            else "designed"
        )
        entries.append(
            Entry(
                material.name,
                design.palette.sensor.wavelengths,
                values,
                description=description,
            )
        )
    if skipped:
        materials = pluralise(len(skipped), "material")
        text = (
            f"{materials} left out of the atlas: reflectance must be in [{LOWEST:g}, "
            f"{HIGHEST:g}]"
        )
        warn(UpliftWarning(f"{text}, but {listed(skipped)}", code="material-skipped"))
    if not entries:
        raise PaletteError(
            "no designed material has reflectances that an atlas can hold",
            hint="design one with bounds within [0, 1]",
        )
    write_atlas(
        Atlas(tuple(entries)),
        path,
        Header(content="Reflectances designed by uplift palette"),
        force=force,
    )
    return len(entries)
