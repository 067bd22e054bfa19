"""The fewest wavelengths that show the scene's spectra under its lights."""

from __future__ import annotations

from uplift.lookup import Cube
from uplift.plan.bench import Bench
from uplift.plan.decision import Decision, Trial, decide
from uplift.plan.question import Question
from uplift.plan.rendering import Rendering, at_all


def wavelengths(bench: Bench, question: Question, limit: float, cube: Cube) -> tuple[Decision, Rendering]:
    rendering = at_all(bench.sensor.wavelengths, question.lights)
    error = question.seen(rendering.xyz(cube.reflectance(question.rgb)))
    trial = Trial("81", 81, "81 samples a ray", "--wavelengths 380:780:5", {}, error)
    return decide("wavelengths", "Wavelengths", "wavelengths", limit, [trial]), rendering
