"""A method for tests."""

import numpy as np


def grey(rgb, wavelengths):
    """A valid answer with a large error."""
    return np.repeat(rgb.mean(axis=1, keepdims=True), len(wavelengths), axis=1)
