"""Write the atlases of atlases/ from tables of colour-science: ``python tools/ship_atlases.py [FOLDER]``.

atlases/README.md describes the files; tests/atlas/test_shipped.py compares them with the output.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
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


@dataclass(frozen=True)
class AtlasFile:
    """Name, content and copyright of an atlas file."""

    file: str
    content: str
    entries: Callable[[], Iterable[Entry]]
    copyright: str = COPYRIGHT

    def write(self, folder: Path) -> None:
        """Write the file."""
        header = Header(self.content, self.copyright, LICENCE)
        write_atlas(Atlas(tuple(self.entries())), folder / self.file, header)


def checker(key: str, prefix: str, description: str) -> Iterable[Entry]:
    """Patches of a colour checker; the prefix makes their names unique."""
    for name, sd in colour.SDS_COLOURCHECKERS[key].items():
        text = description.format(name.lower())
        yield Entry(prefix + name, sd.wavelengths, sd.values, description=text)


def test_colours() -> Iterable[Entry]:
    """CIE 13.3, TCS01–TCS14."""
    for name, sd in SDS_TCS["CIE 1995"].items():
        text = f"CIE 13.3-1995 test colour sample {int(name[3:])}"
        yield Entry(name, sd.wavelengths, sd.values, description=text)


def vivid_samples() -> Iterable[Entry]:
    """Colour Quality Scale 9.0, VS01–VS15."""
    for name, sd in SDS_VS["NIST CQS 9.0"].items():
        index = int(name[2:])
        text = f"NIST Colour Quality Scale 9.0 sample {index}"
        yield Entry(f"VS{index:02}", sd.wavelengths, sd.values, description=text)


def evaluation_samples() -> Iterable[Entry]:
    """CIE 224, CES01–CES99."""
    samples = load_TCS_CIE2017(GRID)
    for index, values in enumerate(samples.values.T, start=1):
        text = f"CIE 224:2017 colour evaluation sample {index}"
        yield Entry(f"CES{index:02}", samples.wavelengths, values, description=text)


def training_patches() -> Iterable[Entry]:
    """Training patches of RAW to ACES."""
    patches = read_training_data_rawtoaces_v1()
    for index, values in enumerate(patches.values.T, start=1):
        text = f"RAW to ACES training patch {index}"
        yield Entry(f"patch{index:03}", patches.wavelengths, values, description=text)


ATLASES = (
    AtlasFile(
        "macbeth.txt",
        "24 patches of the Macbeth ColorChecker, measured by Ohta (1997)",
        lambda: checker("ColorChecker N Ohta", "", '"{}" patch of the Macbeth ColorChecker'),
    ),
    AtlasFile(
        "babelcolor.txt",
        "24 patches of the ColorChecker Classic, average of 30 charts by BabelColor (2012)",
        lambda: checker("BabelColor Average", "BabelColor ", '"{}" patch, average of 30 ColorChecker charts'),
        BABELCOLOR + COPYRIGHT,
    ),
    AtlasFile(
        "pmc.txt",
        "30 patches of the preferred memory colour chart, Luo (2024)",
        lambda: checker("PMC", "PMC ", '"{}" patch of the preferred memory colour chart'),
    ),
    AtlasFile("tcs.txt", "14 test colour samples of the CIE colour rendering index (CIE 13.3-1995)", test_colours),
    AtlasFile("vs.txt", "15 saturated samples of the NIST Colour Quality Scale 9.0, Ohno (2013)", vivid_samples),
    AtlasFile(
        "cie2017.txt",
        "99 samples of the CIE 2017 colour fidelity index (CIE 224:2017)",
        evaluation_samples,
    ),
    AtlasFile(
        "rawtoaces.txt",
        "190 patches that RAW to ACES 1.0 trains camera transforms on, Dyer et al. (2017)",
        training_patches,
    ),
)


def main(folder: Path = FOLDER) -> None:
    """Write all atlases to a folder."""
    for atlas in ATLASES:
        atlas.write(folder)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
