"""Crowding: how many lattice points an atlas needs."""

from __future__ import annotations

import numpy as np

from benchmarks.fidelity.materials import ahead, entries, large, materials
from benchmarks.page import table
from uplift import fit
from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Light
from uplift.fit.lattice_size import DIMS, lattice_error
from uplift.lattice import Lattice
from uplift.models import Moments
from uplift.pipeline.options import AXES, Options

WITHIN = (0.5, 1.0)
TOLERANCE = fit.solver_tolerance(Options.threshold)


def sections() -> list[str]:
    model, rows = Moments(9), []
    lights = [observer.light(name) for name in Options.lights]
    for name in ("macbeth", *large()):
        found = entries(model, materials(name))
        for axis in AXES:
            cells = []
            for dim in DIMS[1::2]:
                lattice = Lattice(observer.axis_nodes(axis, dim))
                errors = lattice_error(model, ahead(model), TOLERANCE, lattice, lights, found)
                cells.append(f"{np.median(errors):.2f} / {int((errors > WITHIN[0]).sum())}")
            rows.append([f"{name} ({len(found.rgb)})", axis, *cells])
        chosen = [_auto(model, found, lights, within) for within in WITHIN]
        rows.append([name, "--dim auto", *chosen, *[""] * (len(cells) - len(chosen))])
    return [
        table(
            "Crowding",
            "What the lattice alone, before entries become nodes of it, makes of the entries at their own colours: "
            f"ΔE00 against their stored spectra, the largest under {', '.join(Options.lights)}: median / entries over "
            f"{WITHIN[0]:g}. *--dim auto* shows what it chooses with --auto-tolerance "
            f"{' and '.join(f'{within:g}' for within in WITHIN)}.",
            ["atlas (entries)", "axis", *(f"{dim}³" for dim in DIMS[1::2])],
            rows,
        )
    ]


def _auto(model: Moments, found: fit.FittedEntries, lights: list[Light], within: float) -> str:
    axis, dim, lost = fit.choose_lattice(
        model, ahead(model), TOLERANCE, lights, found, observer.axis_nodes, AXES, within
    )
    return f"{within:g}: {dim}³ {axis}" + (f", {lost} over" if lost else "")
