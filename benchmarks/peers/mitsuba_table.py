"""Mitsuba 3's table of sigmoid spectra for sRGB, made when Mitsuba was built: looked up, not fitted."""

from __future__ import annotations

import numpy as np

from benchmarks.peers import task
from benchmarks.peers.row import Peer, judge, missing
from uplift.common.arrays import Array
from uplift.models.sigmoid import evaluate_unscaled

VARIANT = "scalar_spectral"
"""Of those that know spectra, the one that needs no LLVM."""
LEAST, WITHIN = 0.95, 2e-3
"""It interpolates in single precision between points that it fits."""
AT_ONCE = 4
"""Wavelengths that a call evaluates."""


def mitsuba_table(runs: int) -> list[Peer]:
    """Time lookups of the lattice's colours, one per call."""
    try:
        import mitsuba
    except ImportError:
        return [missing("Mitsuba 3", "Mitsuba", "sigmoid", 3)]
    mitsuba.set_variant(VARIANT)
    sensor, target = task.sensor(), task.lattice().points
    colours, wavelengths = target.tolist(), np.linspace(400, 700, AT_ONCE).tolist()

    def fetch() -> Array:
        return np.array([mitsuba.srgb_model_fetch(rgb) for rgb in colours], dtype=float)

    coefficients, cpu = task.measured(fetch, len(target), runs)
    spectra = evaluate_unscaled(coefficients, sensor.wavelengths)
    answer = judge(sensor.rgb(spectra), target, least=LEAST, within=WITHIN)
    rows = coefficients.tolist()

    def evaluate() -> Array:
        return np.array([mitsuba.srgb_model_eval(row, wavelengths) for row in rows])

    values, evaluation = task.measured(evaluate, len(target), runs)
    if not np.allclose(values, evaluate_unscaled(coefficients, np.array(wavelengths)), atol=1e-3):
        raise RuntimeError("Mitsuba's coefficients mean something else")
    notes = (
        "no fit: its table, looked up from Python a colour a call (what fitted it is not exposed); "
        f"evaluation at {AT_ONCE} wavelengths {evaluation.median:.1f} µs more"
    )
    return [Peer(f"Mitsuba {mitsuba.__version__}", "sigmoid", 3, len(target), cpu, answer, notes)]
