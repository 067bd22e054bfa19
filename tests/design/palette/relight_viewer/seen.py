"""What a page shows, and what it should: plain formulas, in double precision, of the numbers before packing."""

from __future__ import annotations

import numpy as np

from uplift.colorimetry.srgb import encode

DISC = 84


def position(tab):
    """(x, y) of the handle, in radii of the dial."""
    tab.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))")
    told = tab.evaluate("document.getElementById('handle').getAttribute('transform')")
    return np.array(told.removeprefix("translate(").removesuffix(")").split(), dtype=float) / DISC


def box(tab, selector):
    """x, y, width and height of an element in the window."""
    told = tab.evaluate(f"document.querySelector('{selector}').getBoundingClientRect().toJSON()")
    return [told[name] for name in ("x", "y", "width", "height")]


def places(lights):
    """(L, 2) the first light at the top, the others clockwise."""
    turn = 2 * np.pi * np.arange(lights) / lights
    return np.stack([np.sin(turn), -np.cos(turn)], axis=1)


def shares(at, lights):
    """(L,) by the inverse square of the distance."""
    squares = ((places(lights) - at) ** 2).sum(axis=1)
    if squares.min() < 1e-12:
        return (squares == squares.min()).astype(float)
    return 1 / squares / (1 / squares).sum()


def codes(linear):
    """8-bit sRGB."""
    return np.rint(255 * encode(linear))


def wanted(shown, mix, stops=0.0):
    """(H, W, 3) 8-bit codes: the light's coefficients times each pixel's, then the matrix."""
    light = np.asarray(mix) @ shown.lights.coefficients
    signals = shown.weights.astype(float) @ shown.materials.coefficients * light
    return codes(2.0**stops * signals @ shown.to_rgb.T)


def apart(tab, shown, gains=1.0, stops=0.0):
    """The largest difference in 8-bit codes between the picture seen and the one wanted, where the handle stands."""
    mix = shares(position(tab), len(shown.lights.names)) * gains
    seen = tab.canvas("picture")
    assert (seen[..., 3] == 255).all()
    return np.abs(seen[..., :3] - wanted(shown, mix, stops)).max()
