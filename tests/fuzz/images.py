"""Images of random formats, statements, alpha and depths: ``python -m tests.fuzz.images
FIRST COUNT`` tries seeds.

Each is read as lights are, without limits, and as reflectances. The result must be the
linear sRGB that colour-science computes from the statements, with a warning if one of
them cannot be used.
"""

import sys
import tempfile
from collections import ChainMap
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import colour
import numpy as np
import OpenEXR
from PIL import Image

import uplift
from tests.extras.texture import image_bytes as files
from tests.extras.texture.test_colour_profile import (
    ADOBE,
    GAMMA,
    P3,
    SRGB_TABLE,
    by_matrix,
)
from tests.fuzz.fuzzing import Random, choose
from uplift.common.arrays import Array
from uplift.extras.images.channels import coloured_parts
from uplift.extras.images.image import open_image
from uplift.extras.images.reader import SurfaceReader
from uplift.extras.texture.emission import light_reader

WIDTH = 7
LIGHTS = light_reader(uplift.load_emission())
SURFACES = SurfaceReader(sensor=LIGHTS.sensor)
HALF_MAX = 65504.0
TOLERANCE = 3e-3
"""Largest error, relative to the largest component of colours above 1."""
SRGB = colour.RGB_COLOURSPACES["sRGB"].copy()
SRGB.use_derived_transformation_matrices(True)
BT2020 = "ITU-R BT.2020"
GAMUTS = ("sRGB", BT2020, P3, ADOBE, "ProPhoto RGB")
Curve = Callable[[Array], Array]


def xyz_to_srgb(xyz: Array, white: Array) -> Array:
    """Convert XYZ (n, 3), relative to a white, to linear sRGB, white to white."""
    return np.asarray(colour.XYZ_to_RGB(xyz, SRGB, white, "Bradford"))


@dataclass(frozen=True)
class Space:
    """A statement that can be used: primaries and white by name, and the curve of
    codes.
    """

    gamut: str = "sRGB"
    curve: Curve = colour.models.eotf_sRGB

    @property
    def white(self) -> Array:
        return np.asarray(colour.RGB_COLOURSPACES[self.gamut].whitepoint)

    @property
    def to_xyz(self) -> Array:
        space = colour.RGB_COLOURSPACES[self.gamut]
        matrix = colour.normalised_primary_matrix(space.primaries, space.whitepoint)
        return np.asarray(matrix)

    @property
    def numbers(self) -> tuple[float, ...]:
        """x, y of red, green, blue and white."""
        space = colour.RGB_COLOURSPACES[self.gamut]
        return tuple(map(float, (*np.ravel(space.primaries), *space.whitepoint)))

    def to_srgb(self, codes: Array) -> Array:
        """Convert codes (n, 3) in [0, 1] to linear sRGB."""
        return self.linear_to_srgb(np.asarray(self.curve(codes)))

    def linear_to_srgb(self, rgb: Array) -> Array:
        """Convert linear RGB (n, 3) to linear sRGB."""
        return xyz_to_srgb(rgb @ self.to_xyz.T, self.white)


Row = tuple[Any, Space | None]
"""A statement as its format stores it, and its space, None if it cannot be used."""


class Drawn(NamedTuple):
    """An image in a file, and linear sRGB (n, 3) that it states: as it is stored, and
    divided by alpha.
    """

    path: Path
    stated: "Statements"
    light: Array
    straight: Array


class Statements:
    """Statements of an image, drawn from groups of them in the order in which they
    count, one of each group or none.
    """

    def __init__(self, random: Random, *groups: Sequence[Row]) -> None:
        drawn = [choose(random, group) for group in groups if random.random() < 0.4]
        self.stored = [stored for stored, _ in drawn]
        self.spaces = [space for _, space in drawn]

    def first_usable(self) -> Space:
        """Return the first usable space, else sRGB."""
        return next((space for space in self.spaces if space), Space())

    @property
    def assumed(self) -> bool:
        """Whether the first statement cannot be used."""
        return self.spaces[:1] == [None]


def power(exponent: float) -> Curve:
    return lambda codes: codes**exponent


def pq(codes: Array) -> Array:
    return np.asarray(colour.models.eotf_ST2084(codes) / 100)


def hlg(codes: Array) -> Array:
    return np.asarray(colour.models.eotf_BT2100_HLG(codes, L_B=0, L_W=1000) / 100)


def narrow(curve: Curve, bits: int) -> Curve:
    """The curve of codes of narrow range."""
    step = 2 ** (bits - 8)
    return lambda codes: curve(
        np.maximum((codes * (2**bits - 1) - 16 * step) / (219 * step), 0)
    )


def points(bits: int) -> list[Row]:
    """Code points of images of that many bits."""
    return [
        (files.cicp(*numbers), space)
        for numbers, space in {
            (1, 13, 0, 1): Space(),
            (12, 13, 0, 1): Space(P3),
            (9, 14, 0, 1): Space(BT2020, colour.models.oetf_inverse_BT2020),
            (9, 8, 0, 1): Space(BT2020, np.asarray),
            (12, 16, 0, 1): Space(P3, pq),
            (9, 16, 0, 1): Space(BT2020, pq),
            (9, 18, 0, 1): Space(BT2020, hlg),
            (1, 4, 0, 1): Space("sRGB", power(2.2)),
            (1, 18, 0, 1): None,
            (2, 2, 0, 1): None,
            (9, 16, 9, 1): None,
            (1, 13, 0, 0): Space("sRGB", narrow(colour.models.eotf_sRGB, bits)),
            (12, 4, 0, 0): Space(P3, narrow(power(2.2), bits)),
        }.items()
    ]


SPACES = [Space(gamut) for gamut in GAMUTS]
PROFILES: list[Row] = [
    (by_matrix(P3, SRGB_TABLE), Space(P3)),
    (by_matrix(ADOBE, GAMMA), Space(ADOBE, power(round(2.2 * 256) / 256))),
]
UNUSABLE_PROFILE: Row = (by_matrix("sRGB", b"mft2 and so on"), None)
CHUNKS: list[Row] = [(files.SRGB, Space())]
CHUNKS += [
    (files.iccp(profile), space) for profile, space in [*PROFILES, UNUSABLE_PROFILE]
]
GAMMA_AND_GAMUT: list[Row] = [(files.chrm(space.numbers), space) for space in SPACES]
for value in (1.0, 0.45455, 0.5):
    chunk = files.gama(value)
    GAMMA_AND_GAMUT.append((chunk, Space("sRGB", power(1 / value))))
    GAMMA_AND_GAMUT += [
        (chunk + files.chrm(space.numbers), Space(space.gamut, power(1 / value)))
        for space in SPACES
    ]
CHROMATICITIES: list[Row] = [
    ({"chromaticities": space.numbers}, space) for space in SPACES
]
INTEROP: list[Row] = [
    ({"colorInteropID": "lin_ap1_scene"}, Space("ACEScg")),
    ({"colorInteropID": "lin_rec2020_scene"}, Space(BT2020)),
    ({"colorInteropID": "house_of_colours"}, None),
]
EXIF_ADOBE = Space(ADOBE, power(563 / 256))
STRONG_EXIF: list[Row] = [
    (
        {"exif": {0xA001: (3, [65535])}, "interoperability": {1: (2, b"R03\0")}},
        EXIF_ADOBE,
    ),
    ({"exif": {0xA001: (3, [2])}}, EXIF_ADOBE),
]
WEAK_EXIF: list[Row] = [
    ({"exif": {0xA001: (3, [1])}}, Space()),
    ({"exif": {0xA001: (3, [65535])}}, None),
]


def tags(depth: int) -> list[Row]:
    """Tags of TIFF: primaries and white, a transfer function of that many bits, both,
    and a white alone.
    """
    table = np.rint(65535 * np.linspace(0, 1, 1 << depth) ** 1.8).astype(int).tolist()
    transfer = {301: (3, table)}
    rows: list[Row] = [({318: (5, [0.3457, 0.3585])}, None)]
    rows.append(({301: (3, table * 3)}, Space("sRGB", power(1.8))))
    for space in SPACES:
        primaries = {319: (5, space.numbers[:6]), 318: (5, space.numbers[6:])}
        rows.append((primaries, space))
        rows.append((primaries | transfer, Space(space.gamut, power(1.8))))
    return rows


def draw_codes(random: Random, dtype: str, channels: int) -> tuple[Array, Array]:
    """Draw codes (1, n, channels), and the shares (n, 3) of their colours."""
    largest = np.iinfo(dtype).max
    shape = (1, WIDTH, channels)
    codes = random.integers(0, largest, shape, dtype=dtype, endpoint=True)
    codes[0, :2] = [[0], [largest]]
    colours = codes[0, :, :3] if channels > 2 else codes[0, :, :1].repeat(3, axis=1)
    return codes, colours / largest


def draw_png(random: Random, folder: Path) -> Drawn:
    """Draw a PNG file with any of the chunks of colours."""
    dtype = choose(random, ("uint8", "uint16"))
    channels = int(random.integers(1, 5))
    codes, shares = draw_codes(random, dtype, channels)
    # libpng drops profiles of RGB from grey images.
    chunks = CHUNKS if channels > 2 else CHUNKS[:1]
    stated = Statements(random, points(8 * codes.itemsize), chunks, GAMMA_AND_GAMUT)
    stored = random.permutation(np.array(stated.stored, dtype=object))
    path = folder / "a.png"
    after = files.gama(0.3) if random.random() < 0.2 else b""  # misplaced: ignored
    path.write_bytes(files.png_bytes(codes, *stored, after=after))
    light = stated.first_usable().to_srgb(shares)
    return Drawn(path, stated, light, light)


def draw_exr(random: Random, folder: Path) -> Drawn:
    """Draw an OpenEXR file of RGB, XYZ or grey, with alpha or without."""
    kind = choose(random, ("RGB", "XYZ", "XYZ", "Y"))
    dtype = choose(random, (np.float32, np.float16))
    # A space that is named is of RGB alone.
    groups = (CHROMATICITIES,) if kind == "XYZ" else (INTEROP, CHROMATICITIES)
    stated = Statements(random, *groups)
    space = stated.first_usable()
    header = dict(ChainMap(*stated.stored))
    if random.random() < 0.3:
        header["whiteLuminance"] = choose(random, (100.0, 80.0))
    luminance = header.get("whiteLuminance", 1.0)
    stored = random.random((WIDTH, 3)) * choose(random, (1, 1, 1, 20))
    if kind == "XYZ":
        stored = stored @ space.to_xyz.T * luminance
    if kind == "Y":
        stored = np.repeat(stored[:, :1], 3, axis=1)
    alpha = np.ones(WIDTH)
    if has_alpha := random.random() < 0.6:
        alpha = random.random(WIDTH)
        alpha[2:5] = [0, 1e-6, 0.01]
        is_light = choose(random, (False, True))  # without opacity
        stored[[0, 1, 4, 5, 6]] *= alpha[[0, 1, 4, 5, 6], None]
        stored[2:4] *= 1 if is_light else alpha[2:4, None]
    stored = stored.astype(dtype)
    alpha = alpha.astype(dtype)
    planes = {letter: stored[None, :, k].copy() for k, letter in enumerate(kind)}
    if has_alpha:
        planes["A"] = alpha[None]
    path = folder / "a.exr"
    attributes = {"type": OpenEXR.scanlineimage, **header}
    OpenEXR.File(attributes, planes).write(str(path))
    held = stored.astype(float)
    divided = divide_by_alpha(held, alpha[:, None].astype(float))

    def to_srgb(values: Array) -> Array:
        if kind == "XYZ":
            return xyz_to_srgb(values / luminance, space.white)
        return space.linear_to_srgb(values)

    return Drawn(path, stated, to_srgb(held), to_srgb(divided))


def divide_by_alpha(colours: Array, alpha: Array) -> Array:
    """Divide colours (n, 3) by alpha (n, 1), except light without opacity."""
    is_light = np.abs(colours).max(axis=1, keepdims=True) > HALF_MAX * alpha
    return np.where(is_light, colours, colours / np.where(alpha == 0, 1, alpha))


def draw_tags(
    random: Random, depth: int
) -> tuple[Statements, dict[str, Any], bytes | None]:
    """Draw the tags of TIFF and EXIF about colours, and an ICC profile or none."""
    exif = choose(random, ([STRONG_EXIF, tags(depth)], [tags(depth), WEAK_EXIF]))
    stated = Statements(random, PROFILES, *exif)
    found: dict[str, Any] = {"tags": {}, "order": choose(random, "<>")}
    profile = None
    for stored in stated.stored:
        if isinstance(stored, bytes):
            profile = stored
        elif "exif" in stored:
            found |= stored
        else:
            found["tags"] = dict(stored)
    return stated, found, profile


def draw_tiff(random: Random, folder: Path) -> Drawn:
    """Draw a TIFF file."""
    dtype = choose(random, ("uint8", "uint16", "float32"))
    channels = choose(random, (1, 3, 3, 4))
    depth = 16 if dtype == "uint16" else 8
    stated, found, profile = draw_tags(random, depth)
    space = stated.first_usable()
    codes, shares = draw_codes(random, f"uint{depth}", channels)
    light = space.to_srgb(shares)
    if dtype == "float32":
        codes = (codes / 255).astype(dtype)
        light = space.linear_to_srgb(shares)
    if profile:
        found["tags"][34675] = (7, profile)
    if channels == 4:
        found["tags"][338] = (3, [2])  # straight alpha
    path = folder / "a.tif"
    path.write_bytes(files.tiff_bytes(codes, **found))
    return Drawn(path, stated, light, light)


def draw_jpeg(random: Random, folder: Path) -> Drawn:
    """Draw a JPEG file of one colour."""
    path = folder / "a.jpg"
    pixel = random.integers(0, 256, 3, dtype=np.uint8)
    stated, found, profile = draw_tags(random, depth=8)
    exif = b"Exif\0\0" + files.tiff_bytes(None, **found)
    image = Image.fromarray(np.tile(pixel, (8, 8, 1)))
    image.save(path, quality=100, subsampling=0, exif=exif, icc_profile=profile)
    shares = np.asarray(Image.open(path)).reshape(-1, 3) / 255
    light = stated.first_usable().to_srgb(shares)
    return Drawn(path, stated, light, light)


def draw_hdr(random: Random, folder: Path) -> Drawn:
    """Draw a Radiance HDR file."""
    path = folder / "a.hdr"
    mantissas = random.integers(0, 256, (1, WIDTH, 3), dtype=np.uint8)
    mantissas[..., 0] |= 128
    mantissas[0, 0] = 255, 3, 4  # not the start of a run
    exponent = int(random.integers(124, 132))
    space = Space(choose(random, GAMUTS))
    header = f"PRIMARIES= {' '.join(map(str, space.numbers))}\n"
    path.write_bytes(files.hdr_bytes(mantissas, exponent, header))
    light = space.linear_to_srgb(mantissas[0] / 256 * 2.0 ** (exponent - 128))
    return Drawn(path, Statements(random), light, light)


DRAW = (
    draw_png,
    draw_png,
    draw_png,
    draw_exr,
    draw_exr,
    draw_tiff,
    draw_jpeg,
    draw_hdr,
)


def draw_image(random: Random, folder: Path) -> Drawn:
    """Draw an image of any format into a folder."""
    return choose(random, DRAW)(random, folder)


def wrong(seed: int) -> list[str]:
    """Return what is wrong with the colours of the image of a seed."""
    with tempfile.TemporaryDirectory() as folder:
        drawn = draw_image(np.random.default_rng(seed), Path(folder))
        with open_image(drawn.path) as image:
            pixels, channels = coloured_parts(image)[0]
            rows = image.rows(pixels, 0, pixels.window.height)
            values = rows.reshape(-1, len(pixels.channels))
            unlimited = LIGHTS.channels(channels).straight(values)
            light, _ = LIGHTS.decoder(pixels)(unlimited)
            decode = SURFACES.decoder(pixels)
            straight, _ = decode(channels.straight(values))
            codes = {warning.code for warning in SURFACES.warnings(image)}
    findings = []
    for name, obtained, colours in (
        ("light", light, drawn.light),
        ("colours", straight, drawn.straight),
    ):
        expected = colours if name == "light" else np.clip(colours, 0, 1)
        scale = np.maximum(1, np.abs(colours).max(axis=1, keepdims=True))
        error = np.abs((obtained - expected) / scale).max()
        if not error <= TOLERANCE:
            findings.append(f"{name} differ by {error:.3g}")
    if (codes == {"colour-space-assumed"}) != drawn.stated.assumed:
        findings.append(f"warnings {codes}")
    where = f"seed {seed}: {drawn.path.name} {drawn.stated.spaces}"
    return [f"{where}: {finding}" for finding in findings]


def main(first: int, count: int) -> int:
    """Try seeds, print what is wrong, and return the number of wrong images."""
    failures = 0
    for seed in range(first, first + count):
        findings = wrong(seed)
        failures += bool(findings)
        print(*findings, sep="\n", end="\n" * bool(findings), flush=True)
    print(f"{failures} of {count} images are wrong")
    return failures


if __name__ == "__main__":
    sys.exit(bool(main(*map(int, sys.argv[1:]))))
