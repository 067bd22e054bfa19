"""Six invented paints, whose constants are formulas, and the samples of them that
``uplift samples`` has as swatches.csv.

They have the features of artists' acrylics: steps of cadmiums and azos, the bands of a
blue, a black; scattering is largest next to the long-wave side of an absorption.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks import ROOT
from uplift.common.arrays import Array
from uplift.extras.files.csv import csv_text
from uplift.extras.paint import Paints, Surface
from uplift.extras.paint.pigments import Pigment

NM = np.arange(400.0, 705, 10)
SEED = 7
NOISE = (0.001, 0.002)
"""Standard deviation of the samples: absolute, and relative."""
FILM = 0.5
"""Thickness of films in mm."""
SAMPLE = ROOT / "uplift" / "samples" / "files" / "swatches.csv"
REMARK = (
    "# Samples of six invented paints, with parts and noise as if measured; thickness "
    "in mm.\n"
)


def band(centre: float, width: float, height: float) -> Array:
    """Return a band of absorption or scattering."""
    return np.asarray(height * np.exp(-(((NM - centre) / width) ** 2) / 2))


def step(centre: float, width: float, height: float) -> Array:
    """Return a step that falls from ``height`` to 0 at a wavelength."""
    return np.asarray(height / (1 + np.exp((NM - centre) / width)))


def invented_paints() -> Paints:
    """Return the paints."""
    constants = {
        "titanium white": (0.0006 + step(405, 6, 0.06), np.ones(len(NM))),
        "lemon yellow": (0.0009 + step(492, 7, 1.3), 0.14 + band(505, 40, 0.22)),
        "warm red": (
            0.0012 + step(588, 7, 0.85) + band(560, 25, 0.25),
            0.07 + band(605, 45, 0.22),
        ),
        "deep blue": (
            0.02 + band(620, 55, 2.1) + band(690, 40, 1.2) + step(425, 12, 0.25),
            0.02 + band(680, 60, 0.14),
        ),
        "earth brown": (0.08 + step(560, 28, 0.75), 0.16 - step(600, 30, 0.06)),
        "carbon black": (np.full(len(NM), 2.4), np.full(len(NM), 0.06)),
    }
    absorption, scattering = zip(*constants.values(), strict=True)
    pigments = Pigment(np.array(absorption), np.array(scattering))
    return Paints(tuple(constants), NM, pigments, Surface(0.004, 0.58))


@dataclass(frozen=True)
class Swatch:
    """A sample: its parts by paint, and its thickness and ground if it is a film."""

    name: str
    parts: dict[str, float]
    ground: str = ""


def swatches(paints: Paints) -> list[Swatch]:
    """Return the samples: mass tones, tints, three mixtures and three films."""
    white, *coloured = paints.names
    samples = [Swatch(name, {name: 1}) for name in paints.names]
    for name in coloured:
        samples.append(Swatch(f"{name} tint 1:4", {name: 1, white: 4}))
        samples.append(Swatch(f"{name} tint 1:20", {name: 1, white: 20}))
    samples += [
        Swatch("leaf green", {"lemon yellow": 3, "deep blue": 1}),
        Swatch("orange", {"lemon yellow": 2, "warm red": 1}),
        Swatch("violet", {"warm red": 2, "deep blue": 1, white: 3}),
    ]
    for name in (white, "lemon yellow", "deep blue"):
        samples.append(Swatch(f"{name} film on white", {name: 1}, "white card"))
        samples.append(Swatch(f"{name} film on black", {name: 1}, "black card"))
    return samples


def swatches_text() -> str:
    """Return the text of swatches.csv."""
    paints = invented_paints()
    grounds = {
        "white card": 0.86 - step(430, 15, 0.02),
        "black card": np.full(len(NM), 0.045),
    }
    random = np.random.default_rng(SEED)
    header = ["name", *paints.names, "thickness", "ground", *(f"{nm:g}" for nm in NM)]
    rows = []
    for name, spectrum in grounds.items():
        cells = [name, *[""] * (len(paints) + 2)]
        rows.append([*cells, *_measured(spectrum, random)])
    for swatch in swatches(paints):
        parts = [swatch.parts.get(name, 0) for name in paints.names]
        thickness = FILM if swatch.ground else None
        ground = grounds.get(swatch.ground, 1.0)
        spectrum = paints.reflectance(parts, thickness, ground)
        amounts = [f"{part:g}" if part else "" for part in parts]
        film = ["" if thickness is None else f"{thickness:g}", swatch.ground]
        rows.append([swatch.name, *amounts, *film, *_measured(spectrum, random)])
    return REMARK + csv_text(header, rows)


def _measured(spectrum: Array, random: np.random.Generator) -> list[str]:
    spread = NOISE[0] + NOISE[1] * spectrum
    noisy = spectrum + spread * random.standard_normal(len(spectrum))
    return [f"{value:.4f}" for value in np.maximum(noisy, 0.0005)]


def main(path: Path = SAMPLE) -> None:
    """Write the sample."""
    path.write_text(swatches_text(), encoding="utf-8")


if __name__ == "__main__":
    main()
