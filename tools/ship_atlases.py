"""Write the atlases of atlases/ from tables of colour-science: ``python
tools/ship_atlases.py [FOLDER]``.

atlases/README.md describes the files; tests/atlas/test_shipped.py compares them with
the output.
"""

import sys
from pathlib import Path

import colour
from colour.characterisation import read_training_data_rawtoaces_v1
from colour.quality import SDS_TCS, SDS_VS
from colour.quality.cfi2017 import load_TCS_CIE2017

from uplift.atlas.atlas import Atlas, Entry, Header
from uplift.atlas.sources import write_atlas

FOLDER = Path(__file__).parents[1] / "atlases"
LICENCE = (
    "BSD-3-Clause (https://opensource.org/licenses/BSD-3-Clause), as part of "
    "colour-science"
)
COPYRIGHT = "Copyright 2013 Colour Developers (colour-science 0.4.7)"
BABELCOLOR = (
    "Copyright 2004-2012 Danny Pascale (www.babelcolor.com), used by permission in "
    "colour-science; "
)


def columns(
    spectra: colour.MultiSpectralDistributions,
) -> dict[str, colour.SpectralDistribution]:
    """Return the columns of a table by their labels."""
    return dict(zip(spectra.labels, spectra.to_sds(), strict=True))


CHECKERS = colour.SDS_COLOURCHECKERS
ATLASES = {
    "macbeth": (
        "24 patches of the Macbeth ColorChecker, measured by Ohta (1997)",
        CHECKERS["ColorChecker N Ohta"],
        ("{name}", '"{lower}" patch of the Macbeth ColorChecker'),
    ),
    "babelcolor": (
        (
            "24 patches of the ColorChecker Classic, average of 30 charts by "
            "BabelColor "
            "(2012)"
        ),
        CHECKERS["BabelColor Average"],
        ("BabelColor {name}", '"{lower}" patch, average of 30 ColorChecker charts'),
    ),
    "pmc": (
        "30 patches of the preferred memory colour chart, Luo (2024)",
        CHECKERS["PMC"],
        ("PMC {name}", '"{lower}" patch of the preferred memory colour chart'),
    ),
    "tcs": (
        "14 test colour samples of the CIE colour rendering index (CIE 13.3-1995)",
        SDS_TCS["CIE 1995"],
        ("TCS{number:02}", "CIE 13.3-1995 test colour sample {number}"),
    ),
    "vs": (
        "15 saturated samples of the NIST Colour Quality Scale 9.0, Ohno (2013)",
        SDS_VS["NIST CQS 9.0"],
        ("VS{number:02}", "NIST Colour Quality Scale 9.0 sample {number}"),
    ),
    "cie2017": (
        "99 samples of the CIE 2017 colour fidelity index (CIE 224:2017)",
        columns(load_TCS_CIE2017(colour.SpectralShape(380, 780, 5))),
        ("CES{number:02}", "CIE 224:2017 colour evaluation sample {number}"),
    ),
    "rawtoaces": (
        (
            "190 patches that RAW to ACES 1.0 trains camera transforms on, Dyer et al. "
            "(2017)"
        ),
        columns(read_training_data_rawtoaces_v1()),
        ("patch{number:03}", "RAW to ACES training patch {number}"),
    ),
}
"""Content, spectra, and the patterns of names and descriptions."""


def main(folder: Path = FOLDER) -> None:
    """Write all atlases to a folder."""
    for file, (content, spectra, patterns) in ATLASES.items():
        entries = []
        for number, (key, spectrum) in enumerate(spectra.items(), start=1):
            name, description = (
                each.format(name=key, lower=key.lower(), number=number)
                for each in patterns
            )
            entries.append(
                Entry(
                    name, spectrum.wavelengths, spectrum.values, description=description
                )
            )
        owner = BABELCOLOR + COPYRIGHT if file == "babelcolor" else COPYRIGHT
        write_atlas(
            Atlas(tuple(entries)),
            folder / f"{file}.txt",
            Header(content, owner, LICENCE),
        )


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
