"""A plan as text, as the JSON values of a plan file, and as the command lines that
carry it out.
"""

import os
import shlex
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.errors import OutputError
from uplift.common.files import file_digest
from uplift.common.text import pluralise
from uplift.common.version import version
from uplift.extras.pages.format import format_error
from uplift.extras.scene.plan.candidates import SPECTRUM, Candidate, Cost
from uplift.extras.scene.plan.files import FORMAT, SUFFIX, SceneFile, cube_name
from uplift.extras.scene.plan.planning import Plan, cost_text
from uplift.extras.scene.plan.search import cheapest_first

CLEARLY_SMALLER = 0.95
"""Share of the error of a cheaper candidate that is worth a row."""
SHARE = 0.5
"""Share of the expected error of measurements below which a plan spends more than its
colours are worth.
"""
CUBE_KEYS = ("model", "coefficients", "warp", "dim", "axis")
"""Options of a build that a plan chooses."""
SCENE_KEYS = ("tolerance", "quantile", "encoding", "minimise", "limits")


def front_rows(plan: Plan) -> list[dict[str, Any]]:
    """The choice, and candidates whose error is clearly below that of all cheaper ones,
    by what the scene minimises, as JSON values with a mark of the choice.
    """
    rows = []
    smallest = np.inf
    for candidate in cheapest_first(plan.measured, plan.scene.minimise):
        error = candidate.error.quantile
        is_chosen = candidate is plan.chosen
        if is_chosen or error < CLEARLY_SMALLER * smallest:
            smallest = min(smallest, error)
            rows.append({"chosen": "→" * is_chosen, **_candidate(candidate)})
    return rows


def verdict(plan: Plan) -> str:
    """Errors and tolerance in one phrase."""
    errors = plan.chosen.error.quantile, plan.confirmed.quantile
    predicted, confirmed = map(format_error, errors)
    worst = plan.confirmed.worst
    text = (
        f"ΔE00 {predicted} predicted, {confirmed} confirmed on other pixels, tolerance "
        f"{plan.scene.tolerance:g} ({worst.group} under {worst.light})"
    )
    if plan.within_tolerance:
        return text
    return f"{text}; the tolerance is EXCEEDED: plan for a smaller one"


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
    if plan.spectra is not None:
        lines.append(
            f"The textures have {pluralise(len(plan.spectra[0]), 'colour')}: a list "
            "of spectra suffices."
        )
    if plan.passes is not None:
        count = "1 pass" if plan.passes.count == 1 else f"{plan.passes.count} passes"
        enough = "suffice ('uplift passes')" if plan.passes.within else "do not suffice"
        error = format_error(plan.passes.error)
        lines.append(
            f"Of an RGB renderer {count} {enough}: ΔE00 {error} of one to four "
            "reflections."
        )
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


def _costs(candidate: Candidate) -> str:
    memory, time, samples = (cost_text(candidate.cost, key) for key in Cost._fields)
    return f"{memory}, {time} and {samples}"


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
    check_path(plan.scene, path)
    scene = plan.scene
    chosen = plan.chosen
    predicted, confirmed = plan.chosen.error, plan.confirmed
    spectra = None
    if plan.spectra is not None:
        pairs = zip(*map(np.ndarray.tolist, plan.spectra), strict=True)
        spectra = [{"rgb": rgb, "reflectance": values} for rgb, values in pairs]
    return {
        "format": FORMAT,
        "uplift": version(),
        "scene": {
            "file": scene.path.name,
            "lights": list(map(str, scene.lights)),
            **_fields(scene, SCENE_KEYS),
            "textures": _sources(scene.textures, path),
            "atlases": _sources(scene.atlases, path),
        },
        "name": chosen.name,
        "build": chosen.cube and chosen.cube.record(),
        "cells": "sparse" if chosen.sparse else "whole",
        "texture": asdict(chosen.pixel),
        "rendering": _rendering(plan),
        "spectra": spectra,
        "error": {
            "predicted": asdict(predicted.worst) | asdict(predicted),
            "confirmed": asdict(confirmed.worst) | asdict(confirmed),
            "within": plan.within_tolerance,
            "without_spectra": plan.without_spectra.quantile,
            "expected_of_measurements": plan.expected_error,
        },
        "passes": plan.passes and asdict(plan.passes),
        "cost": chosen.cost._asdict(),
        "search": {"considered": plan.considered, "measured": len(plan.measured)},
        "front": list(map(_candidate, plan.front)),
        "lines": list(commands(plan, path)),
    }


def _fields(record: object, keys: Iterable[str]) -> dict[str, Any]:
    return {key: getattr(record, key) for key in keys}


def _candidate(candidate: Candidate) -> dict[str, Any]:
    cube = candidate.cube
    return {
        "name": candidate.name,
        "rendering": candidate.traced,
        "pixel": asdict(candidate.pixel),
        "cube": cube and _fields(cube, CUBE_KEYS),
        "sparse": candidate.sparse,
        **candidate.cost._asdict(),
        "error": asdict(candidate.error.worst),
    }


def _rendering(plan: Plan) -> dict[str, Any]:
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
