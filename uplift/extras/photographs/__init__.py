"""Photographs under several lights: spectra of materials that have one RGB, and
differ.
"""

from uplift.extras.photographs.answers import Answers, Photographs, prepare
from uplift.extras.photographs.colour import PhotographedColour
from uplift.extras.photographs.errors import light_errors
from uplift.extras.photographs.photograph import Noise, Photograph, photograph

__all__ = [
    "Answers",
    "Noise",
    "Photograph",
    "PhotographedColour",
    "Photographs",
    "light_errors",
    "photograph",
    "prepare",
]
