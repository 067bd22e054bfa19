"""Design of the open spectra of a palette by linear least squares (section 3.3)."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from uplift.atlas.atlas import HIGHEST, LOWEST, Atlas, Entry, Header
from uplift.atlas.sources import write_atlas
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import PaletteError, UpliftWarning, warn
from uplift.common.text import listed, pluralise
from uplift.extras.papers.palette.colours import screen_matrix
from uplift.extras.papers.palette.equations import equations, solve, unknowns
from uplift.extras.papers.palette.factor import FactorModel
from uplift.extras.papers.palette.palette import (
    Palette,
    SpectrumSpec,
)


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
                f"light or material of a goal must be given, got {goal}, both to be "
                "designed",
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
    fitted: Array  # (M, L, 3) those of the two that the goals are about
    # (M, L) ΔE00 from target to the fitted colour; NaN without a goal
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
    fitted = factor if palette.fit == "factor-model" else obtained
    return Matrix(
        target,
        obtained,
        factor,
        fitted,
        delta_e_rgb(palette.sensor, target, fitted),
        delta_e_rgb(palette.sensor, obtained, factor),
        design.powers @ screen.T,
    )


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
    palette = design.palette
    entries = []
    skipped = []
    for material, values in zip(palette.materials, design.reflectances, strict=True):
        if not material.designed:
            continue
        if values.min() < LOWEST or values.max() > HIGHEST:
            skipped.append(
                f"'{material.name}' has {values.min():.3g} to {values.max():.3g}"
            )
            continue
        lights = [
            goal.light
            for goal in palette.goals
            if goal.material == material.name and goal.weight
        ]
        description = "designed"
        if lights:
            description = f"designed for its colours under {', '.join(lights)}"
        nm = palette.sensor.wavelengths
        entries.append(Entry(material.name, nm, values, description=description))
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
