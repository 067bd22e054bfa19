"""Photographs under several lights: spectra of materials that have one RGB, and
differ: answers that several photographs decide, and samples where nothing does.
"""

from uplift.extras.photographs.answers import Answers, Photographs, prepare
from uplift.extras.photographs.colour import PhotographedColour
from uplift.extras.photographs.errors import light_errors
from uplift.extras.photographs.photograph import Noise, Photograph, photograph
from uplift.extras.photographs.samples import SpectrumSampler, prepare_samples

__all__ = [
    "Answers",
    "Noise",
    "Photograph",
    "PhotographedColour",
    "Photographs",
    "SpectrumSampler",
    "light_errors",
    "photograph",
    "prepare",
    "prepare_samples",
]
