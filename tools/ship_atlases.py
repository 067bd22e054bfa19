"""Write the atlases of atlases/ from tables of colour-science: ``python tools/ship_atlases.py [FOLDER]``.

atlases/README.md describes the files; tests/atlas/test_shipped.py compares them with the output.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import colour
from colour.characterisation import read_training_data_rawtoaces_v1
from colour.quality import SDS_TCS, SDS_VS
from colour.quality.cfi2017 import load_TCS_CIE2017

from uplift.atlas import Atlas, Entry, Header, write_atlas

FOLDER = Path(__file__).parents[1] / "atlases"
LICENCE = "BSD-3-Clause (https://opensource.org/licenses/BSD-3-Clause), as part of colour-science"
COPYRIGHT = "Copyright 2013 Colour Developers (colour-science 0.4.7)"
BABELCOLOR = "Copyright 2004-2012 Danny Pascale (www.babelcolor.com), used by permission in colour-science; "
GRID = colour.SpectralShape(380, 780, 5)


def atlases() -> Iterator[tuple[str, Atlas, Header]]:
    """Yield name, entries and header of every atlas."""
    checkers = colour.SDS_COLOURCHECKERS
    yield atlas(
        "macbeth",
        "24 patches of the Macbeth ColorChecker, measured by Ohta (1997)",
        checkers["ColorChecker N Ohta"],
        ("{name}", '"{lower}" patch of the Macbeth ColorChecker'),
    )
    yield atlas(
        "babelcolor",
        "24 patches of the ColorChecker Classic, average of 30 charts by BabelColor (2012)",
        checkers["BabelColor Average"],
        ("BabelColor {name}", '"{lower}" patch, average of 30 ColorChecker charts'),
        BABELCOLOR + COPYRIGHT,
    )
    yield atlas(
        "pmc",
        "30 patches of the preferred memory colour chart, Luo (2024)",
        checkers["PMC"],
        ("PMC {name}", '"{lower}" patch of the preferred memory colour chart'),
    )
    yield atlas(
        "tcs",
        "14 test colour samples of the CIE colour rendering index (CIE 13.3-1995)",
        SDS_TCS["CIE 1995"],
        ("TCS{number:02}", "CIE 13.3-1995 test colour sample {number}"),
    )
    yield atlas(
        "vs",
        "15 saturated samples of the NIST Colour Quality Scale 9.0, Ohno (2013)",
        SDS_VS["NIST CQS 9.0"],
        ("VS{number:02}", "NIST Colour Quality Scale 9.0 sample {number}"),
    )
    yield atlas(
        "cie2017",
        "99 samples of the CIE 2017 colour fidelity index (CIE 224:2017)",
        columns(load_TCS_CIE2017(GRID)),
        ("CES{number:02}", "CIE 224:2017 colour evaluation sample {number}"),
    )
    yield atlas(
        "rawtoaces",
        "190 patches that RAW to ACES 1.0 trains camera transforms on, Dyer et al. (2017)",
        columns(read_training_data_rawtoaces_v1()),
        ("patch{number:03}", "RAW to ACES training patch {number}"),
    )


def atlas(
    name: str,
    content: str,
    spectra: dict[str, colour.SpectralDistribution],
    patterns: tuple[str, str],
    copyright: str = COPYRIGHT,
) -> tuple[str, Atlas, Header]:
    """Return an atlas whose names and descriptions fill in the patterns."""
    entries = []
    for number, (key, spectrum) in enumerate(spectra.items(), start=1):
        title, description = (each.format(name=key, lower=key.lower(), number=number) for each in patterns)
        entries.append(Entry(title, spectrum.wavelengths, spectrum.values, description=description))
    return name, Atlas(tuple(entries)), Header(content, copyright, LICENCE)


def columns(spectra: colour.MultiSpectralDistributions) -> dict[str, colour.SpectralDistribution]:
    """Return the columns of a table by their labels."""
    return dict(zip(spectra.labels, spectra.to_sds(), strict=True))


def main(folder: Path = FOLDER) -> None:
    """Write all atlases to a folder."""
    for name, entries, header in atlases():
        write_atlas(entries, folder / f"{name}.txt", header)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
