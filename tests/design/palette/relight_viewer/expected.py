"""State of a page in the browser, and its expected picture by plain formulas in double precision."""

from __future__ import annotations

import numpy as np

from uplift.colorimetry.srgb import encode

DISC = 84


def position(tab):
    """(x, y) of the handle, in radii of the dial."""
    tab.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))")
    value = tab.evaluate("document.getElementById('handle').getAttribute('transform')")
    return np.array(value.removeprefix("translate(").removesuffix(")").split(), dtype=float) / DISC


def box(tab, selector):
    """x, y, width and height of an element in the window."""
    value = tab.evaluate(f"document.querySelector('{selector}').getBoundingClientRect().toJSON()")
    return [value[name] for name in ("x", "y", "width", "height")]


def rim_positions(lights):
    """(L, 2) the first light at the top, the others clockwise."""
    turn = 2 * np.pi * np.arange(lights) / lights
    return np.stack([np.sin(turn), -np.cos(turn)], axis=1)


def shares(at, lights):
    """(L,) by the inverse square of the distance."""
    squares = ((rim_positions(lights) - at) ** 2).sum(axis=1)
    if squares.min() < 1e-12:
        return (squares == squares.min()).astype(float)
    return 1 / squares / (1 / squares).sum()


def codes(linear):
    """8-bit sRGB."""
    return np.rint(255 * encode(linear))


def expected_codes(view, mix, stops=0.0):
    """(H, W, 3) 8-bit codes: the light's coefficients times each pixel's, then the matrix."""
    light = np.asarray(mix) @ view.lights.coefficients
    signals = view.weights.astype(float) @ view.materials.coefficients * light
    return codes(2.0**stops * signals @ view.to_rgb.T)


def largest_difference(tab, view, gains=1.0, stops=0.0):
    """The largest difference in 8-bit codes between the displayed and the expected picture."""
    mix = shares(position(tab), len(view.lights.names)) * gains
    pixels = tab.canvas("picture")
    assert (pixels[..., 3] == 255).all()
    return np.abs(pixels[..., :3] - expected_codes(view, mix, stops)).max()
