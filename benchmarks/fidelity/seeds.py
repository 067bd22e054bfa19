"""Seeds: how much lights, ends and curvature weigh against the spectrum."""

from __future__ import annotations

import numpy as np

from benchmarks.fidelity.materials import (
    CHOSEN_ON,
    HEAD,
    JUDGED_ON,
    Materials,
    entries,
    materials,
    row,
    spectra_of,
)
from benchmarks.page import table
from uplift.fit import Weights
from uplift.lab.study.held_out import spectrum_errors
from uplift.models import Moments
from uplift.pipeline.options import Options

LIT = Options.lights
WITHOUT_LED = LIT[:4]
CANDIDATES: dict[str, tuple[tuple[str, ...], Weights]] = {
    "spectrum alone (and the build light)": (LIT, Weights(lights=0.0)),
    "lights 0.01": (LIT, Weights(lights=0.01)),
    "lights 0.03, the default": (LIT, Weights()),
    "lights 0.1": (LIT, Weights(lights=0.1)),
    "lights 0.03, LED-B3 not among them": (WITHOUT_LED, Weights()),
    "ends weigh a tenth": (LIT, Weights(ends=0.1)),
    "ends weigh half": (LIT, Weights(ends=0.5)),
    "ends weigh twice": (LIT, Weights(ends=2.0)),
    "curvature 1": (LIT, Weights(curvature=1.0)),
    "curvature 5": (LIT, Weights(curvature=5.0)),
    "curvature 20": (LIT, Weights(curvature=20.0)),
}
UNSEEN = ("FL7", "LED-RGB1", "HP1")
ENDS = np.r_[:8, 73:81]


def sections() -> list[str]:
    return [_validation(), *(_judged(name) for name in JUDGED_ON)]


def _validation() -> str:
    rows = []
    for count in (9, 17):
        for name, (lights, weights) in CANDIDATES.items():
            cells = np.array(
                [_scores(Moments(count), materials(part), lights, weights) for part in CHOSEN_ON]
            )
            mean = np.average(cells, axis=0, weights=[len(materials(part).rgb) for part in CHOSEN_ON])
            spread = cells[:, 0].std()
            rows.append(
                [str(count), name, f"{mean[0]:.3f} ± {spread:.3f}", *(f"{value:.4f}" for value in mean[1:])]
            )
    return table(
        "Seeds: weights by cross-validation",
        f"Entries of {', '.join(CHOSEN_ON)} fitted with each set of weights, and looked at under lights that no fit "
        f"has seen ({', '.join(UNSEEN)}): mean ΔE00, ± its spread over the atlases. *rms* is over the whole spectrum, "
        "*ends* over its first and last 40 nm. More weight on the lights buys colour with spectrum. Less weight on "
        "the ends buys 5–10 % of colour with ends that drift; the default keeps them. Curvature buys nothing.",
        ["coefficients", "weights", "unseen lights", "rms", "ends"],
        rows,
    )


def _scores(model: Moments, some: Materials, lights: tuple[str, ...], weights: Weights) -> list[float]:
    answered = spectra_of(model, entries(model, some, lights, weights).multipliers)
    unseen = spectrum_errors(answered, some.measured, UNSEEN).delta_e.mean()
    off = answered - some.measured
    return [float(unseen), float(np.sqrt((off**2).mean())), float(np.sqrt((off[:, ENDS] ** 2).mean()))]


def _judged(name: str) -> str:
    some, rows = materials(name), []
    for count in (9, 13, 17):
        for label in list(CANDIDATES)[:5]:
            lights, weights = CANDIDATES[label]
            found = entries(Moments(count), some, lights, weights)
            cells = row(label, spectra_of(Moments(count), found.multipliers), some)
            rows.append([str(count), *cells])
    return table(
        f"Seeds of {name}, which no weight was chosen on",
        "What the model keeps of the measurements: rms, and mean ΔE00 under each light.",
        ["coefficients", "weights", *HEAD],
        rows,
    )
