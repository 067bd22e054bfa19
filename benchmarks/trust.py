"""What an atlas does to materials unlike it, to shades, and to gradients, for
docs/prior.md.
"""

from functools import cache
from itertools import permutations, starmap
from typing import Any

import numpy as np

import uplift
from benchmarks import DOCS, Row, record
from benchmarks.materials import (
    FETCHED,
    MIXTURE,
    SENSOR,
    Materials,
    materials,
    other_halves,
    shipped_families,
)
from uplift.colorimetry import delta_e_spectra, in_unit_cube, observer, rgb_to_lab
from uplift.colorimetry.gamut import SRGB
from uplift.common.arrays import Array, distances
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.figure import new_figure, show_image, write_png
from uplift.extras.report.measures import delta_e_under
from uplift.lookup import Cube

DIM = 32
LIGHTS = ("A", "FL2", "FL11", "LED-B3", "LED-RGB1", "HP1")
RAMP_LIGHTS = ("A", "FL2", "FL11", "LED-B3", "HP1")
ATLASES = ("macbeth", "pmc", "cie2017", "rawtoaces", *FETCHED)
SETS = (*ATLASES, MIXTURE)
CODES = 14
"""Codes of a ramp to each side of an entry."""
DIRECTIONS = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])
TRUSTS: dict[str, dict[str, Any]] = {"learnt": {}, "full": {"trust_atlas": True}}
"""Options of builds by the trust in the atlas."""
SPOT_LIGHT = "HP1"
"""Light of the strips."""
STRIPS = 2
"""Entries that the strips show."""
BLACK = 0.04
WHITE = 0.9
"""Reflectances of paint that is mixed with an entry for its shades."""
SHARES = (0.05, 0.15)
"""Shares of the paint."""
NEIGHBOURS = 8
"""Nearest entries, one of which may be the paint."""


def main() -> None:
    """Measure and store."""
    pairs = permutations(ATLASES, 2)
    write_png(draw_strips(), DOCS / "prior" / "spots.png", force=True)
    record(
        "trust",
        dim=DIM,
        lights=list(LIGHTS),
        ramp_lights=list(RAMP_LIGHTS),
        own=map(of_own_kind, SETS),
        others=starmap(of_pair, pairs),
        ramps=map(of_ramps, SETS),
    )


def mean_errors(cube: Cube, queried: Materials) -> Array:
    """Mean ΔE00 (L,) of answers under each light."""
    lights = [observer.light(name) for name in LIGHTS]
    answers = cube.reflectance(queried.rgb)
    return delta_e_under(lights, answers, queried.measured).mean(axis=0)


def shades(known: Materials) -> Materials:
    """Mix each entry with black, white or a neighbour."""
    random = np.random.default_rng(0)
    measured = known.measured
    lab = rgb_to_lab(SENSOR, known.rgb)
    near = distances(lab, lab).argsort(axis=1)[:, 1 : NEIGHBOURS + 1]
    neighbour = measured[random.permuted(near, axis=1)[:, 0]]
    flat = np.ones_like(measured)
    paints = np.stack([BLACK * flat, WHITE * flat, neighbour])
    paint = paints[random.integers(3, size=len(measured)), np.arange(len(measured))]
    share = random.uniform(*SHARES, (len(measured), 1))
    mixed = (1 - share) * measured + share * paint
    rgb = SENSOR.rgb(mixed)
    rows = in_unit_cube(rgb)
    return Materials(mixed[rows], np.clip(rgb[rows], 0, 1))


def of_own_kind(name: str) -> Row:
    """Return errors at unseen halves of a set, and at shades of the known halves, with
    the learnt trust and with full trust.
    """
    row: Row = {"set": name}
    row["without"] = alone_at(name).mean()
    for label, options in TRUSTS.items():
        halves = other_halves(name, dim=DIM, **options)
        unseen = [mean_errors(cube, queried) for cube, queried in halves]
        row[label] = np.mean(unseen)
        known = [_entries(cube) for cube, _ in halves]
        pairs = zip(halves, known, strict=True)
        row[f"{label}_shades"] = np.mean(
            [mean_errors(cube, shades(entries)) for (cube, _), entries in pairs]
        )
    return row


def _entries(cube: Cube) -> Materials:
    """Return the entries of a cube as measured."""
    table = cube.data.atlas
    measured = np.zeros((0, len(SENSOR.wavelengths)))
    if table.measured is not None:
        measured = table.measured.astype(float)
    return Materials(measured, table.rgb)


@cache
def alone_at(name: str) -> Array:
    """Mean ΔE00 (L,) of a cube without an atlas at a set that it does not know."""
    cube = uplift.build(dim=DIM, leave_out=shipped_families(name))
    return mean_errors(cube, materials(name))


def of_pair(atlas: str, queried: str) -> Row:
    """Return how many times the errors of a cube without an atlas those of one with
    another set as atlas are: the mean over lights, and the worst light.
    """
    row: Row = {"atlas": atlas, "queried": queried}
    left_out = shipped_families(queried)
    for label, options in TRUSTS.items():
        cube = materials(atlas).cube(dim=DIM, leave_out=left_out, **options)
        delta_e = mean_errors(cube, materials(queried))
        if label == "learnt":
            row["trust"] = cube.data.provenance["prior"]["trust"]
        row[label] = delta_e.mean() / alone_at(queried).mean()
        row[f"{label}_worst"] = (delta_e / alone_at(queried)).max()
    return row


def of_ramps(name: str) -> Row:
    """Return how steep gradients through the entries of a set are, smoothed and
    exact.
    """
    row: Row = {"set": name, "entries": len(materials(name).rgb)}
    for label, options in (("smoothed", {}), ("exact", {"exact_entries": True})):
        cube = materials(name).cube(dim=DIM, **options)
        excess = steepest(cube)
        row[label] = {
            "largest": excess.max(),
            "above": (excess > 1).sum(),
            "count": len(cube.data.provenance["smoothed"]),
        }
    return row


def steepest(cube: Cube) -> Array:
    """The largest ΔE00 (E,) by which a light's step of an 8-bit code exceeds that of
    daylight, on ramps through each entry.
    """
    spectra = cube.reflectance(ramps(cube, cube.data.atlas.rgb, DIRECTIONS))
    before = spectra[:, :, :-1].reshape(-1, spectra.shape[-1])
    after = spectra[:, :, 1:].reshape(-1, spectra.shape[-1])
    daylight = delta_e_spectra(observer.light("D65"), before, after)
    lights = map(observer.light, RAMP_LIGHTS)
    steps = [delta_e_spectra(light, before, after) for light in lights]
    excess = np.max(steps, axis=0) - daylight
    return excess.reshape(len(spectra), -1).max(axis=1)


def ramps(cube: Cube, rgb: Array, directions: Array) -> Array:
    """Linear RGB (n, D, 2 CODES + 1, 3) of ramps through colours (n, 3) in directions
    (D, 3).
    """
    codes = np.round(cube.encode(rgb))
    offsets = np.arange(-CODES, CODES + 1)[:, None] * directions[:, None]
    return cube.decode(np.clip(codes[:, None, None] + offsets, 0, 255))


def draw_strips() -> Any:
    """Draw gradients through the two entries whose exact spectra show most, under
    daylight and under `SPOT_LIGHT`.
    """
    exact = materials(MIXTURE).cube(dim=DIM, exact_entries=True)
    smoothed = materials(MIXTURE).cube(dim=DIM)
    worst = np.argsort(-steepest(exact))[:STRIPS]
    strips = [
        ("D65", exact, "daylight"),
        (SPOT_LIGHT, exact, f"{SPOT_LIGHT}, exact"),
        (SPOT_LIGHT, smoothed, f"{SPOT_LIGHT}, smoothed"),
    ]
    figure = new_figure(6.4, 0.5 * len(strips) * len(worst))
    panels = figure.subplots(len(strips) * len(worst), 1)
    greyward = ramps(exact, exact.data.atlas.rgb[worst], DIRECTIONS[-1:])[:, 0]
    for row, rgb in enumerate(greyward):
        for number, (light, cube, title) in enumerate(strips):
            shown = observer.sensor(illuminant=light)
            linear = shown.rgb(cube.reflectance(rgb))
            codes = to_display_codes(linear, SRGB).astype(np.uint8)
            axes = panels[row * len(strips) + number]
            show_image(axes, codes[None], aspect="auto")
            axes.set_title(title, loc="left", pad=2)
    return figure
