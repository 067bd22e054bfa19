"""Fit of entries: weights of lights, ends and curvature relative to the spectrum."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.fidelity.materials import (
    CHOSEN_ON,
    TESTED_ON,
    Materials,
    entries,
    errors,
    materials,
    spectra_of,
)
from uplift.fit.entries import Weights
from uplift.lab.study.held_out import spectrum_errors
from uplift.models import Moments
from uplift.pipeline.options import Options

LIGHTS = Options.lights
WITHOUT_LED = LIGHTS[:4]
CANDIDATES: dict[str, tuple[tuple[str, ...], Weights]] = {
    "spectrum alone (and the build light)": (LIGHTS, Weights(lights=0.0)),
    "lights 0.01": (LIGHTS, Weights(lights=0.01)),
    "lights 0.03, the default": (LIGHTS, Weights()),
    "lights 0.1": (LIGHTS, Weights(lights=0.1)),
    "lights 0.03, without LED-B3": (WITHOUT_LED, Weights()),
    "ends × 0.1": (LIGHTS, Weights(ends=0.1)),
    "ends × 0.5": (LIGHTS, Weights(ends=0.5)),
    "ends × 2": (LIGHTS, Weights(ends=2.0)),
    "curvature 1": (LIGHTS, Weights(curvature=1.0)),
    "curvature 5": (LIGHTS, Weights(curvature=5.0)),
    "curvature 20": (LIGHTS, Weights(curvature=20.0)),
}
UNSEEN = ("FL7", "LED-RGB1", "HP1")
"""Lights that no fit includes."""
ENDS = np.r_[:8, 73:81]
"""Samples of the first and last 40 nm."""
TESTED = 5
"""Candidates that are tested on other atlases."""


def measure() -> dict[str, Any]:
    """Cross-validate the weights, and test the first candidates on other atlases."""
    return {
        "seed_weights": [validation(count, name) for count in (9, 17) for name in CANDIDATES],
        "seed_tests": [
            evaluate(atlas, count, name)
            for atlas in TESTED_ON
            for count in (9, 13, 17)
            for name in list(CANDIDATES)[:TESTED]
        ],
    }


def validation(count: int, name: str) -> dict[str, Any]:
    """Return the errors of a candidate over the atlases used for design choices."""
    parts = [materials(part) for part in CHOSEN_ON]
    scores = np.array([_scores(Moments(count), part, *CANDIDATES[name]) for part in parts])
    unseen, rms, ends = np.average(scores, axis=0, weights=[len(part.rgb) for part in parts]).tolist()
    spread = {"mean": unseen, "std": float(scores[:, 0].std())}
    return {"coefficients": count, "weights": name, "unseen": spread, "rms": rms, "ends": ends}


def _scores(model: Moments, some: Materials, lights: tuple[str, ...], weights: Weights) -> list[float]:
    fitted = spectra_of(model, entries(model, some, lights, weights).multipliers)
    unseen = spectrum_errors(fitted, some.measured, UNSEEN).delta_e.mean()
    squares = (fitted - some.measured) ** 2
    return [float(unseen), float(np.sqrt(squares.mean())), float(np.sqrt(squares[:, ENDS].mean()))]


def evaluate(atlas: str, count: int, name: str) -> dict[str, Any]:
    """Return the errors of a candidate on an atlas that no weight was chosen on."""
    some, model = materials(atlas), Moments(count)
    fitted = entries(model, some, *CANDIDATES[name])
    row = errors(spectra_of(model, fitted.multipliers), some)
    return {"atlas": atlas, "coefficients": count, "weights": name, **row}
