"""Images of random formats, statements, alpha and depths: ``python -m tests.fuzz.images
FIRST COUNT`` tries seeds.

Each is read as lights are, without limits, and as reflectances. The result must be the
linear sRGB that colour-science computes from the statements, with a warning if one of
them cannot be used.
"""

import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

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
Curve = Callable[[Array], Array]


@dataclass(frozen=True)
class Space:
    """A statement that can be used: primaries and white by x, y, and the curve of
    codes.
    """

    gamut: str | tuple[float, ...] = "sRGB"
    curve: Curve = colour.models.eotf_sRGB

    def to_srgb(self, codes: Array) -> Array:
        """Convert codes (n, 3) in [0, 1] to linear sRGB."""
        return self.linear_to_srgb(np.asarray(self.curve(codes)))

    def linear_to_srgb(self, rgb: Array) -> Array:
        """Convert linear RGB (n, 3) to linear sRGB, white to white."""
        space = rgb_space(self.gamut)
        xyz = (
            rgb @ colour.normalised_primary_matrix(space.primaries, space.whitepoint).T
        )
        return xyz_to_srgb(xyz, space.whitepoint)


def rgb_space(gamut: str | tuple[float, ...]) -> Any:
    """Return the space of colour-science of a name or of eight numbers."""
    if isinstance(gamut, str):
        return colour.RGB_COLOURSPACES[gamut]
    return colour.RGB_Colourspace(
        "a", np.reshape(gamut[:6], (3, 2)), np.array(gamut[6:])
    )


def xyz_to_srgb(xyz: Array, white: Array) -> Array:
    """Convert XYZ (n, 3), relative to a white of Y = 1, to linear sRGB, adapted by
    Bradford.
    """
    srgb = colour.RGB_COLOURSPACES["sRGB"]
    from_white = colour.xy_to_XYZ(white)
    to_white = colour.xy_to_XYZ(srgb.whitepoint)
    adapt = colour.adaptation.matrix_chromatic_adaptation_VonKries(
        from_white, to_white, transform="Bradford"
    )
    to_rgb = np.linalg.inv(
        colour.normalised_primary_matrix(srgb.primaries, srgb.whitepoint)
    )
    return xyz @ (to_rgb @ adapt).T


@dataclass
class Drawn:
    """An image in a file, and linear sRGB (n, 3) that it states; ``assumed`` if a
    statement cannot be used.
    """

    path: Path
    text: str
    light: Array
    """Colours as they are stored."""
    straight: Array
    """Colours divided by alpha."""
    assumed: bool = False
    tolerance: float = 1e-3


def numbers(gamut: str) -> tuple[float, ...]:
    """x, y of red, green, blue and white of a space."""
    space = colour.RGB_COLOURSPACES[gamut]
    return tuple(map(float, (*np.ravel(space.primaries), *space.whitepoint)))


def hlg(codes: Array) -> Array:
    return colour.models.eotf_BT2100_HLG(codes, L_B=0, L_W=1000) / 100


def narrow(bits: int) -> Curve:
    """Widen codes of narrow range."""
    step = 2 ** (bits - 8)
    return lambda codes: np.maximum(
        (codes * (2**bits - 1) - 16 * step) / (219 * step), 0
    )


POINTS: dict[tuple[int, ...], Space | None] = {
    (1, 13, 0, 1): Space(),
    (12, 13, 0, 1): Space(P3),
    (9, 14, 0, 1): Space("ITU-R BT.2020", colour.models.oetf_inverse_BT2020),
    (9, 8, 0, 1): Space("ITU-R BT.2020", np.asarray),
    (9, 16, 0, 1): Space(
        "ITU-R BT.2020", lambda codes: colour.models.eotf_ST2084(codes) / 100
    ),
    (12, 16, 0, 1): Space(P3, lambda codes: colour.models.eotf_ST2084(codes) / 100),
    (1, 16, 0, 1): Space("sRGB", lambda codes: colour.models.eotf_ST2084(codes) / 100),
    (9, 18, 0, 1): Space("ITU-R BT.2020", hlg),
    (1, 4, 0, 1): Space("sRGB", lambda codes: codes**2.2),
    (1, 18, 0, 1): None,
    (2, 2, 0, 1): None,
    (9, 16, 9, 1): None,
    (1, 13, 0, 0): Space(),
    (12, 4, 0, 0): Space(P3, lambda codes: codes**2.2),
}
PROFILES = {
    "P3": (by_matrix(P3, SRGB_TABLE), Space(P3)),
    "Adobe": (
        by_matrix(ADOBE, GAMMA),
        Space(ADOBE, lambda codes: codes ** (round(2.2 * 256) / 256)),
    ),
    "table": (by_matrix("sRGB", b"mft2 and so on"), None),
}
INTEROP = {
    "lin_ap1_scene": Space("ACEScg"),
    "lin_rec2020_scene": Space("ITU-R BT.2020"),
    "lin_p3d65_scene": Space(P3),
    "house_of_colours": None,
}
GAMMAS = (1.0, 0.45455, 0.55556, 0.5)
GAMUTS = ("sRGB", "ITU-R BT.2020", P3, ADOBE, "ProPhoto RGB")


def power(exponent: float) -> Curve:
    return lambda codes: codes**exponent


@dataclass
class Statements:
    """Spaces that a file states, in the order in which they count, None if one cannot
    be used, and their description.
    """

    spaces: list[Space | None] = field(default_factory=list)
    text: str = ""

    def add(self, text: str, space: Space | None, first: bool = False) -> None:
        self.text += f" {text}"
        self.spaces.insert(0 if first else len(self.spaces), space)

    def first_usable(self) -> tuple[Space, bool]:
        """Return the first usable space, else sRGB, and whether one before it cannot be
        used.
        """
        for index, space in enumerate(self.spaces):
            if space is not None:
                return space, index > 0
        return Space(), bool(self.spaces)


def draw_codes(random: Random, channels: int, dtype: str) -> Array:
    codes = random.integers(
        0, np.iinfo(dtype).max, (1, WIDTH, channels), dtype=dtype, endpoint=True
    )
    codes[0, 0] = 0
    codes[0, 1] = np.iinfo(dtype).max
    return codes


def first_three(codes: Array) -> Array:
    """Return codes (n, 3) of the colours of codes (1, n, channels)."""
    if codes.shape[2] > 2:
        return codes[0, :, :3]
    return np.repeat(codes[0, :, :1], 3, axis=1)


def draw_png(random: Random, folder: Path) -> Drawn:
    """Draw a PNG file with any of the chunks of colours."""
    dtype = choose(random, ("uint8", "uint16"))
    channels = int(random.integers(1, 5))
    codes = draw_codes(random, channels, dtype)
    stated = Statements()
    chunks = [
        *draw_points(random, stated, bits=8 * codes.itemsize),
        *draw_profile(random, stated, channels),
        *draw_gamma_and_gamut(random, stated),
    ]
    order = random.permutation(len(chunks))
    path = folder / "a.png"
    after = files.gama(0.3) if random.random() < 0.2 else b""  # misplaced: ignored
    path.write_bytes(files.png_bytes(codes, *(chunks[k] for k in order), after=after))
    space, assumed = stated.first_usable()
    light = space.to_srgb(first_three(codes) / np.iinfo(dtype).max)
    text = f"{dtype} {channels} channels{stated.text}"
    return Drawn(path, text, light, light, assumed)


def draw_points(random: Random, stated: Statements, bits: int) -> list[bytes]:
    """Draw the chunk cICP or none."""
    if random.random() >= 0.4:
        return []
    points = choose(random, list(POINTS))
    space = POINTS[points]
    if space is not None and not points[3]:
        curve = space.curve
        space = replace(space, curve=lambda codes: curve(narrow(bits)(codes)))
    stated.add(f"cICP {points}", space)
    return [files.cicp(*points)]


def draw_profile(random: Random, stated: Statements, channels: int) -> list[bytes]:
    """Draw the chunk iCCP, sRGB or none."""
    # libpng drops profiles of RGB from grey images.
    if random.random() < 0.3 and channels > 2:
        name = choose(random, list(PROFILES))
        profile, space = PROFILES[name]
        stated.add(f"iCCP {name}", space)
        return [files.iccp(profile)]
    if random.random() < 0.3:
        stated.add("sRGB", Space())
        return [files.SRGB]
    return []


def draw_gamma_and_gamut(random: Random, stated: Statements) -> list[bytes]:
    """Draw the chunks gAMA and cHRM, one of them or none: together they state a
    space.
    """
    chunks = []
    text = []
    space = Space()
    has_gamma = random.random() < 0.5
    has_gamut = random.random() < 0.4
    if has_gamma:
        gamma = choose(random, GAMMAS)
        chunks.append(files.gama(gamma))
        space = replace(space, curve=power(1 / gamma))
        text.append(f"gAMA {gamma}")
    if has_gamut:
        gamut = choose(random, GAMUTS)
        chunks.append(files.chrm(numbers(gamut)))
        space = replace(space, gamut=gamut)
        text.append(f"cHRM {gamut}")
    if chunks:
        stated.add(" ".join(text), space)
    return chunks


def draw_exr(random: Random, folder: Path) -> Drawn:
    """Draw an OpenEXR file of RGB, XYZ or grey, with alpha or without."""
    kind = choose(random, ("RGB", "XYZ", "XYZ", "Y"))
    layer = choose(random, ("", "", "diffuse.")) if kind != "Y" else ""
    dtype = choose(random, (np.float32, np.float16))
    stated = Statements()
    header, gamut = draw_header(random, stated, kind)
    luminance = header.get("whiteLuminance", 1.0)
    space = rgb_space(gamut)
    stored = random.random((WIDTH, 3)) * choose(random, (1, 1, 1, 20))
    stored[:2] = [[0, 0, 0], [1, 1, 1]]
    if kind == "XYZ":
        to_xyz = colour.normalised_primary_matrix(space.primaries, space.whitepoint)
        stored = stored @ to_xyz.T * luminance
    if kind == "Y":
        stored = np.repeat(stored[:, :1], 3, axis=1)
    has_alpha = random.random() < 0.6
    alpha = np.ones(WIDTH)
    if has_alpha:
        alpha, factors = draw_alpha(random)
        stored = stored * factors[:, None]
    stored = stored.astype(dtype)
    alpha = alpha.astype(dtype)
    planes = {
        layer + letter: stored[None, :, k].copy() for k, letter in enumerate(kind)
    }
    if has_alpha:
        planes[layer + "A"] = alpha[None]
    path = folder / "a.exr"
    attributes = {"type": OpenEXR.scanlineimage, **header}
    OpenEXR.File(attributes, planes).write(str(path))
    held = stored.astype(float)
    divided = divide_by_alpha(held, alpha[:, None].astype(float))
    usable, assumed = stated.first_usable()

    def to_srgb(values: Array) -> Array:
        if kind == "XYZ":
            return xyz_to_srgb(values / luminance, np.array(space.whitepoint))
        return usable.linear_to_srgb(values)

    text = f"{layer}{kind} {dtype.__name__} {header} alpha {has_alpha}"
    tolerance = 3e-3 if dtype is np.float16 else 1e-3
    return Drawn(path, text, to_srgb(held), to_srgb(divided), assumed, tolerance)


def draw_header(
    random: Random, stated: Statements, kind: str
) -> tuple[dict[str, Any], str | tuple[float, ...]]:
    """Draw the attributes of OpenEXR about colours; also return the primaries."""
    header: dict[str, Any] = {}
    gamut = choose(random, GAMUTS)
    if random.random() < 0.6:
        header["chromaticities"] = numbers(gamut)
        stated.add("chromaticities", Space(gamut))
    else:
        gamut = "sRGB"
    if kind != "XYZ" and random.random() < 0.3:
        name = header["colorInteropID"] = choose(random, list(INTEROP))
        stated.add(name, INTEROP[name], first=True)
    if random.random() < 0.3:
        header["whiteLuminance"] = choose(random, (100.0, 80.0))
    return header, gamut


def draw_alpha(random: Random) -> tuple[Array, Array]:
    """Draw alpha (n,) and factors (n,) of the colours: some are light without
    opacity.
    """
    alpha = random.random(WIDTH)
    alpha[2:5] = [0, 1e-6, 0.01]
    factors = alpha.copy()
    if random.random() < 0.5:
        factors[2:4] = 1
    return alpha, factors


def divide_by_alpha(colours: Array, alpha: Array) -> Array:
    """Divide colours (n, 3) by alpha (n, 1), except light without opacity."""
    is_light = np.abs(colours).max(axis=1, keepdims=True) > HALF_MAX * alpha
    return np.where(is_light, colours, colours / np.where(alpha == 0, 1, alpha))


def draw_tags(random: Random, stated: Statements, depth: int) -> dict[int, Any]:
    """Draw the tags of TIFF about colours."""
    tags: dict[int, Any] = {}
    text = []
    space = Space()
    has_primaries, has_transfer, has_white = random.random(3) < 0.4
    if has_primaries:
        gamut = choose(random, GAMUTS)
        *primaries, x, y = numbers(gamut)
        tags[319] = (5, primaries)
        tags[318] = (5, [x, y])
        space = replace(space, gamut=gamut)
        text.append(f"primaries {gamut}")
    if has_transfer:
        count = 1 << depth
        table = np.rint(65535 * np.linspace(0, 1, count) ** 1.8).astype(int).tolist()
        tags[301] = (3, table * choose(random, (1, 3)))
        space = replace(space, curve=power(1.8))
        text.append("transfer 1.8")
    if has_white and not has_primaries:
        tags[318] = (5, [0.3457, 0.3585])
        stated.add(" ".join([*text, "white alone"]), None)
    elif text:
        stated.add(" ".join(text), space)
    return tags


EXIF_TAGS = {
    "sRGB": ({0xA001: (3, [1])}, None, Space()),
    "uncalibrated": ({0xA001: (3, [65535])}, None, None),
    "R03": ({0xA001: (3, [65535])}, {1: (2, b"R03\0")}, Space(ADOBE, power(563 / 256))),
    "2": ({0xA001: (3, [2])}, None, Space(ADOBE, power(563 / 256))),
}


def draw_exif(random: Random, stated: Statements, chance: float) -> tuple[Any, Any]:
    """Draw the EXIF tags ColorSpace and interoperability index, by a chance."""
    if random.random() >= chance:
        return None, None
    name = choose(random, list(EXIF_TAGS))
    exif, index, space = EXIF_TAGS[name]
    stated.add(f"EXIF {name}", space, first=name in ("R03", "2"))
    return exif, index


def draw_icc(random: Random, stated: Statements, chance: float) -> bytes | None:
    """Draw an ICC profile, by a chance."""
    if random.random() >= chance:
        return None
    name = choose(random, ("P3", "Adobe"))
    profile, space = PROFILES[name]
    stated.add(f"ICC {name}", space, first=True)
    return profile


def draw_tiff(random: Random, folder: Path) -> Drawn:
    """Draw a TIFF file."""
    dtype = choose(random, ("uint8", "uint16", "float32"))
    channels = choose(random, (1, 3, 3, 4))
    is_float = dtype == "float32"
    if is_float:
        codes = random.random((1, WIDTH, channels)).astype(dtype)
    else:
        codes = draw_codes(random, channels, dtype)
    stated = Statements()
    tags = draw_tags(random, stated, depth=16 if dtype == "uint16" else 8)
    if channels == 4:
        tags[338] = (3, [2])  # straight alpha
    exif, index = draw_exif(random, stated, 0.4)
    if profile := draw_icc(random, stated, 0.2):
        tags[34675] = (7, profile)
    order = choose(random, "<>")
    path = folder / "a.tif"
    path.write_bytes(files.tiff_bytes(codes, tags, order, exif, index))
    space, assumed = stated.first_usable()
    rgb = first_three(codes)
    if is_float:
        light = space.linear_to_srgb(rgb.astype(float))
    else:
        light = space.to_srgb(rgb / np.iinfo(dtype).max)
    text = f"{dtype} {channels} {order}{stated.text}"
    return Drawn(path, text, light, light, assumed)


def draw_jpeg(random: Random, folder: Path) -> Drawn:
    """Draw a JPEG file of one colour."""
    path = folder / "a.jpg"
    pixel = random.integers(0, 256, 3, dtype=np.uint8)
    stated = Statements()
    tags = draw_tags(random, stated, depth=8)
    exif, index = draw_exif(random, stated, 0.6)
    order = choose(random, "<>")
    Image.fromarray(np.tile(pixel, (8, 8, 1))).save(
        path,
        quality=100,
        subsampling=0,
        exif=b"Exif\0\0" + files.tiff_bytes(None, tags, order, exif, index),
        icc_profile=draw_icc(random, stated, 0.3),
    )
    space, assumed = stated.first_usable()
    light = space.to_srgb(np.asarray(Image.open(path)).reshape(-1, 3) / 255)
    return Drawn(path, stated.text, light, light, assumed)


def draw_hdr(random: Random, folder: Path) -> Drawn:
    """Draw a Radiance HDR file."""
    path = folder / "a.hdr"
    mantissas = random.integers(0, 256, (1, WIDTH, 3), dtype=np.uint8)
    mantissas[..., 0] |= 128
    mantissas[0, 0] = 255, 3, 4  # not the start of a run
    exponent = int(random.integers(124, 132))
    gamut = "sRGB"
    header = ""
    if random.random() < 0.7:
        gamut = choose(random, GAMUTS)
        header = f"PRIMARIES= {' '.join(map(str, numbers(gamut)))}\n"
    path.write_bytes(files.hdr_bytes(mantissas, exponent, header))
    light = Space(gamut).linear_to_srgb(mantissas[0] / 256 * 2.0 ** (exponent - 128))
    return Drawn(path, header.strip(), light, light)


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


def largest_error(obtained: Array, expected: Array, colours: Array) -> float:
    """Return the largest difference, relative to the largest component of the
    ``colours`` if they are above 1.
    """
    scale = np.maximum(1, np.abs(colours).max(axis=1, keepdims=True))
    return float((np.abs(obtained - expected) / scale).max())


def wrong(seed: int) -> list[str]:
    """Return what is wrong with the colours of the image of a seed."""
    random = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as folder:
        drawn = choose(random, DRAW)(random, Path(folder))
        with open_image(drawn.path) as image:
            pixels, channels = coloured_parts(image)[0]
            rows = image.rows(pixels, 0, pixels.window.height)
            values = rows.reshape(-1, len(pixels.channels))
            unlimited = LIGHTS.channels(channels).straight(values)
            light, _ = LIGHTS.decoder(pixels)(unlimited)
            decode = SURFACES.decoder(pixels)
            straight, _ = decode(channels.straight(values))
            codes = {warning.code for warning in SURFACES.warnings(image)}
    error = largest_error(light, drawn.light, drawn.light)
    clipped = largest_error(straight, np.clip(drawn.straight, 0, 1), drawn.straight)
    findings = []
    if not error <= drawn.tolerance:
        findings.append(f"light differs by {error:.3g}")
    if not clipped <= drawn.tolerance:
        findings.append(f"colours differ by {clipped:.3g}")
    if (codes == {"colour-space-assumed"}) != drawn.assumed:
        findings.append(f"warnings {codes}, expected {drawn.assumed}")
    where = f"seed {seed}: {drawn.path.name} {drawn.text}"
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
