"""A plan as text, as the JSON values of a plan file, and as the command lines that
carry it out.
"""

import os
import shlex
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from uplift.common.errors import OutputError
from uplift.common.files import file_digest
from uplift.common.text import pluralise
from uplift.common.version import version
from uplift.extras.pages.format import format_error, format_size
from uplift.extras.scene.plan.candidates import INDEX, SPECTRUM, Candidate, Cost
from uplift.extras.scene.plan.files import FORMAT, SUFFIX, SceneFile, cube_name
from uplift.extras.scene.plan.passes_advice import PassesAdvice
from uplift.extras.scene.plan.planning import Plan, cost_text
from uplift.extras.scene.plan.search import cheapest_first

HEADINGS = ("ΔE00", "memory", "time", "samples", "cube", "traced", "pixel")
CLEARLY_SMALLER = 0.95
"""Share of the error of a cheaper candidate that is worth a row."""
SHARE = 0.5
"""Share of the expected error of measurements below which a plan spends more than its
colours are worth.
"""
CUBE_KEYS = ("model", "coefficients", "warp", "dim", "axis")
"""Options of a build that a plan chooses."""
SCENE_KEYS = ("tolerance", "quantile", "encoding", "minimise", "limits")


def front_rows(plan: Plan) -> list[Candidate]:
    """The choice, and candidates whose error is clearly below that of all cheaper ones,
    by what the scene minimises.
    """
    front = list[Candidate]()
    smallest = float("inf")
    for candidate in cheapest_first(plan.measured, plan.scene.minimise):
        error = candidate.error.quantile
        if candidate is plan.chosen or error < CLEARLY_SMALLER * smallest:
            front.append(candidate)
            smallest = min(smallest, error)
    return front


def front_row(measured: Candidate) -> tuple[str, ...]:
    """Texts of a candidate in the order of `HEADINGS`."""
    cost = measured.cost
    words = (measured.cube_name, measured.traced, measured.pixel.name)
    costs = (format_size(cost.memory), f"{cost.time:,.0f}", f"{cost.samples:g}")
    return format_error(measured.error.quantile), *costs, *words


def verdict(plan: Plan) -> str:
    """Errors and tolerance in one phrase."""
    end = (
        ""
        if plan.within_tolerance
        else "; the tolerance is EXCEEDED: plan for a smaller one"
    )
    return (
        f"ΔE00 {format_error(plan.chosen.error.quantile)} predicted, "
        f"{format_error(plan.confirmed.quantile)} confirmed "
        f"on other pixels, tolerance {plan.scene.tolerance:g}{end}"
    )


def notes(plan: Plan) -> list[str]:
    """What the choice costs, whether the scene needs spectra, and what its colours are
    worth.
    """
    lines = [f"It costs {_costs(plan.chosen)}."]
    if plan.chosen.rendering is None:
        lines.append(
            "This scene needs no spectra: RGB and a 3 × 3 matrix per light suffice."
        )
    else:
        rgb = format_error(plan.without_spectra.quantile)
        lines.append(
            "Without spectra, by RGB and the best 3 × 3 matrix per light, ΔE00 is "
            f"{rgb}."
        )
    if plan.chosen.pixel.form == INDEX and plan.spectra is not None:
        lines.append(
            f"The textures have {pluralise(len(plan.spectra[0]), 'colour')}: a list "
            "of spectra suffices."
        )
    if plan.passes is not None:
        lines.append(_passes_note(plan.passes))
    known = plan.expected_error
    if known is not None:  # RGB alone does not identify a material
        lines.append(
            f"Your colours are known within ΔE00 {known:.2g}; this plan adds "
            f"{plan.confirmed.quantile:.2g}."
        )
        cheaper = plan.cheapest(known)
        if cheaper is not None and plan.confirmed.quantile <= SHARE * known:
            lines.append(f"With tolerance {known:.2g} it would need {_costs(cheaper)}.")
    return lines


def _passes_note(advice: PassesAdvice) -> str:
    count = "1 pass" if advice.count == 1 else f"{advice.count} passes"
    error = f"ΔE00 {format_error(advice.error)} of one to four reflections"
    if advice.within:
        return f"Of an RGB renderer {count} suffice ('uplift passes'): {error}."
    return f"Of an RGB renderer {count} do not suffice: {error}."


def _costs(candidate: Candidate) -> str:
    memory, time, samples = (cost_text(candidate.cost, key) for key in Cost._fields)
    return f"{memory}, {time} and {samples}"


def describe_error(plan: Plan) -> str:
    """Definition of the errors."""
    scene = plan.scene
    materials = " and of the atlas's entries" if scene.atlases else ""
    lights = ", ".join(map(str, scene.lights))
    measured = ", entries with their measurements" if scene.atlases else ""
    return (
        f"ΔE00 of {100 * scene.quantile:.4g} % of the textures' pixels{materials} is "
        f"at most this value, under the worst of {lights}. Pixels are compared with a "
        "cube of the finest lattice and the most coefficients at all "
        f"wavelengths{measured}. {len(plan.measured):,} of "
        f"{pluralise(plan.considered, 'candidate')} were measured; the bounds of the "
        "others exclude them."
    )


def check_path(scene: SceneFile, path: Path) -> None:
    """Check that the folder of a plan holds the sources of its scene. `read_plan` opens
    no others.
    """
    folder = os.path.abspath(path.parent)
    for source in (*scene.textures, *scene.atlases):
        if not Path(os.path.abspath(source)).is_relative_to(folder):
            hint = f"write for example {scene.path.with_suffix(SUFFIX)}"
            raise OutputError(
                f"must lie in the folder of {source}, or above it", path=path, hint=hint
            )


def to_json(plan: Plan, path: Path) -> dict[str, Any]:
    """The choice of a plan, its wavelengths and command lines, and the Pareto front, as
    JSON values.

    Paths of textures and atlases are relative to the folder of ``path``, the file.
    Raises `OutputError` for others.
    """
    chosen = plan.chosen
    check_path(plan.scene, path)
    return {
        "format": FORMAT,
        "uplift": version(),
        "scene": _scene_json(plan.scene, path),
        "name": chosen.name,
        "build": chosen.cube and chosen.cube.record(),
        "cells": "sparse" if chosen.sparse else "whole",
        "texture": asdict(chosen.pixel),
        "rendering": _rendering_json(plan),
        "spectra": _spectra_json(plan),
        "error": _error_json(plan),
        "passes": plan.passes and asdict(plan.passes),
        "cost": chosen.cost._asdict(),
        "search": {"considered": plan.considered, "measured": len(plan.measured)},
        "front": list(map(_candidate_json, plan.front)),
        "lines": list(commands(plan, path)),
    }


def _scene_json(scene: SceneFile, path: Path) -> dict[str, Any]:
    return {
        "file": scene.path.name,
        "lights": list(map(str, scene.lights)),
        **{key: getattr(scene, key) for key in SCENE_KEYS},
        "textures": _sources(scene.textures, path),
        "atlases": _sources(scene.atlases, path),
    }


def _spectra_json(plan: Plan) -> list[dict[str, Any]] | None:
    if plan.spectra is None:
        return None
    return [
        {"rgb": rgb.tolist(), "reflectance": reflectance.tolist()}
        for rgb, reflectance in zip(*plan.spectra, strict=True)
    ]


def _error_json(plan: Plan) -> dict[str, Any]:
    predicted = plan.chosen.error
    confirmed = plan.confirmed
    return {
        "predicted": asdict(predicted.worst) | asdict(predicted),
        "confirmed": asdict(confirmed.worst) | asdict(confirmed),
        "within": plan.within_tolerance,
        "without_spectra": plan.without_spectra.quantile,
        "expected_of_measurements": plan.expected_error,
    }


def _candidate_json(candidate: Candidate) -> dict[str, Any]:
    cube = candidate.cube
    return {
        "name": candidate.name,
        "rendering": candidate.traced,
        "pixel": asdict(candidate.pixel),
        "cube": cube and {key: getattr(cube, key) for key in CUBE_KEYS},
        "sparse": candidate.sparse,
        **candidate.cost._asdict(),
        "error": asdict(candidate.error.worst),
    }


def _rendering_json(plan: Plan) -> dict[str, Any]:
    """Wavelengths, their weights and the powers of lights, or matrices of RGB."""
    if plan.chosen.rendering is None:
        lights = map(str, plan.scene.lights)
        matrices = dict(zip(lights, plan.matrices.tolist(), strict=True))
        return {"rgb_to_xyz": matrices}
    sampling = plan.chosen.rendering.sampling
    powers = dict(zip(sampling.lights, sampling.powers.tolist(), strict=True))
    return {
        "wavelengths": sampling.wavelengths.tolist(),
        "to_xyz": sampling.to_xyz.tolist(),
        "powers": powers,
    }


def _sources(paths: Iterable[Path], plan: Path) -> list[dict[str, str]]:
    return [
        {
            "path": Path(os.path.relpath(path, plan.parent)).as_posix(),
            "digest": file_digest(path),
        }
        for path in paths
    ]


def commands(plan: Plan, path: Path) -> tuple[str, ...]:
    """Command lines for a plan at ``path``: its build, and its textures or the program
    that looks colours up.
    """
    scene = plan.scene
    pixel = plan.chosen.pixel
    if plan.chosen.cube is None:
        return ()
    build = f"uplift build --plan {shlex.quote(str(path))}"
    cube = cube_name(path)
    if pixel.mode:
        return build, shlex.join(
            ["uplift", "export", cube, "--format", "c", "--mode", pixel.mode]
        )
    target = (
        f"{scene.textures[0].stem}-uplifted.exr"
        if len(scene.textures) == 1
        else "uplifted"
    )
    words = ["uplift", "texture", *map(str, scene.textures), "-o", target]
    words += ["--cube", cube, "--representation", pixel.form, "--depth", pixel.depth]
    rendering = plan.chosen.rendering
    if pixel.form == SPECTRUM and rendering is not None:
        nm = map("{:g}".format, rendering.sampling.wavelengths)
        words += ["--wavelengths", ",".join(nm)]
    if scene.encoding != SceneFile.encoding:
        words += ["--encoding", scene.encoding]
    return build, shlex.join(words)
