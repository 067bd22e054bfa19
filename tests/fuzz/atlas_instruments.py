"""Fuzz target: the readers of files of instruments and programs, with mutated files in each layout."""

from __future__ import annotations

import io
import zipfile
from functools import cache
from pathlib import Path

from tests.atlas.vendor_files import VENDORS, Files, sample
from tests.fuzz.mutate import NUMBERS, Random, mutate
from tests.fuzz.target import Target
from tests.fuzz.use_atlas import use_atlas
from uplift.atlas import read_atlas
from uplift.common.colour_science import colour_science

TOKENS = (
    b"BEGIN_DATA_FORMAT", b"END_DATA_FORMAT", b"BEGIN_DATA", b"END_DATA", b"SPECTRAL_NORM", b"SPEC_400", b"nm", b"R",
    b"##TITLE=", b"##XUNITS=", b"##NPOINTS=", b"##XYDATA=(X++(Y..Y))", b"##XYPOINTS=(XY..XY)", b"##END=", b"LINK",
    b"##DATATYPE=LINK\n", b"%J1T", b"ENVI", b"samples", b"lines", b"bands", b"data type", b"wavelength", b"{", b"}",
    b"spectra names", b"<cc:Object>", b"</cc:Object>", b"<a>" * 99, b"<!DOCTYPE a>", b"<!ENTITY a 'b'>", b"&a;",
    b'StartWL="', b'Increment="', b"<SpectralQuantity>", b"sep=|\n", b"#", b"\0", b"\xff\xfe", b"\t", b";", b",", b'"',
    b"\n", b"PK\x03\x04", b"PK\x05\x06", b"a" * 99_999, *NUMBERS,
)  # fmt: skip


@cache
def _seeds() -> tuple[Files, ...]:
    colour_science()  # its import takes longer than a reader may
    macbeth = sample(read_atlas("macbeth"))
    return tuple(vendor.write(macbeth[: vendor.count]) for vendor in VENDORS)


def _in_archive(content: bytes, random: Random) -> bytes:
    """Mutate a file inside of an archive, whose checksums stay valid."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    name = list(parts)[random.integers(len(parts))]
    parts[name] = mutate(parts[name], random, TOKENS)
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for each, data in parts.items():
            archive.writestr(each, data)
    return buffer.getvalue()


def _generate(random: Random, path: Path) -> None:
    seeds = _seeds()
    (name, content), *others = seeds[random.integers(len(seeds))].items()
    if others and name.endswith(".sli"):  # the header is the file to read
        (name, content), others = others[0], [(name, content)]
    if content.startswith(b"PK") and random.random() < 0.8:
        content = _in_archive(content, random)
    elif random.random() < 0.95:
        content = mutate(content, random, TOKENS)
    path.write_bytes(content)
    for _, data in others:
        path.with_suffix(".sli").write_bytes(mutate(data, random, TOKENS) if random.random() < 0.3 else data)


TARGET = Target("atlas of an instrument", _generate, use_atlas)
