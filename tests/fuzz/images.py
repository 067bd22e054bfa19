"""Images of random formats, statements, alpha and depths: ``python -m tests.fuzz.images
FIRST COUNT`` tries seeds.

Each is read as lights are, without limits, and as reflectances. The result must be the
linear sRGB that colour-science computes from the statements, with a warning if one of
them cannot be used.
"""

import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
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
from uplift.extras import texture
from uplift.extras.texture.channels import coloured_parts
from uplift.extras.texture.colours import make_decoder, space_warnings
from uplift.extras.texture.image import open_image

WIDTH = 7
LIGHTS = texture.prepare_lights(uplift.load_emission(), threads=1)
SENSOR = LIGHTS.sensor
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


def first_usable(statements: list[Space | None]) -> tuple[Space, bool]:
    """Return the first usable statement, else sRGB, and whether one before it cannot be
    used.
    """
    for index, space in enumerate(statements):
        if space is not None:
            return space, index > 0
    return Space(), bool(statements)


def draw_codes(random: Random, channels: int, dtype: str) -> Array:
    codes = random.integers(
        0, np.iinfo(dtype).max, (1, WIDTH, channels), dtype=dtype, endpoint=True
    )
    codes[0, 0], codes[0, 1] = 0, np.iinfo(dtype).max
    return codes


def draw_png(random: Random, folder: Path) -> Drawn:
    """Draw a PNG file with any of the chunks of colours."""
    dtype = choose(random, ("uint8", "uint16"))
    bits = 8 * np.dtype(dtype).itemsize
    channels = int(random.integers(1, 5))
    codes = draw_codes(random, channels, dtype)
    chunks = []
    stated = []
    text = [dtype, f"{channels} channels"]
    if random.random() < 0.4:
        points = choose(random, list(POINTS))
        space = POINTS[points]
        if space is not None and not points[3]:
            space = Space(
                space.gamut, lambda codes, curve=space.curve: curve(narrow(bits)(codes))
            )
        chunks.append(files.cicp(*points))
        stated.append(space)
        text.append(f"cICP {points}")
    if (
        random.random() < 0.3 and channels > 2
    ):  # libpng drops profiles of RGB from grey images
        name = choose(random, list(PROFILES))
        chunks.append(files.iccp(PROFILES[name][0]))
        stated.append(PROFILES[name][1])
        text.append(f"iCCP {name}")
    elif random.random() < 0.3:
        chunks.append(files.SRGB)
        stated.append(Space())
        text.append("sRGB")
    gamut = "sRGB"
    curve = colour.models.eotf_sRGB
    has_gamma = random.random() < 0.5
    has_chrm = random.random() < 0.4
    if has_gamma:
        gamma = choose(random, GAMMAS)
        chunks.append(files.gama(gamma))
        curve = power(1 / gamma)
        text.append(f"gAMA {gamma}")
    if has_chrm:
        gamut = choose(random, GAMUTS)
        chunks.append(files.chrm(numbers(gamut)))
        text.append(f"cHRM {gamut}")
    if has_gamma or has_chrm:
        stated.append(Space(gamut, curve))
    order = random.permutation(len(chunks))
    path = folder / "a.png"
    after = files.gama(0.3) if random.random() < 0.2 else b""  # misplaced: ignored
    path.write_bytes(files.png_bytes(codes, *(chunks[k] for k in order), after=after))
    space, assumed = first_usable(stated)
    rgb = codes[0, :, :3] if channels > 2 else np.repeat(codes[0, :, :1], 3, axis=1)
    light = space.to_srgb(rgb / np.iinfo(dtype).max)
    return Drawn(path, ", ".join(text), light, light, assumed)


def draw_exr(random: Random, folder: Path) -> Drawn:
    """Draw an OpenEXR file of RGB, XYZ or grey, with alpha or without."""
    kind = choose(random, ("RGB", "XYZ", "XYZ", "Y"))
    layer = choose(random, ("", "", "diffuse.")) if kind != "Y" else ""
    dtype = choose(random, (np.float32, np.float16))
    gamut = choose(random, GAMUTS)
    header: dict[str, Any] = {}
    if random.random() < 0.6:
        header["chromaticities"] = numbers(gamut)
    else:
        gamut = "sRGB"
    stated: list[Space | None] = [Space(gamut)] if header else []
    if kind != "XYZ" and random.random() < 0.3:
        name = header["colorInteropID"] = choose(random, list(INTEROP))
        stated.insert(0, INTEROP[name])
    luminance = 1.0
    if random.random() < 0.3:
        luminance = header["whiteLuminance"] = choose(random, (100.0, 80.0))
    rgb = random.random((WIDTH, 3)) * choose(random, (1, 1, 1, 20))
    rgb[:2] = [[0, 0, 0], [1, 1, 1]]
    space = rgb_space(gamut)
    to_xyz = colour.normalised_primary_matrix(space.primaries, space.whitepoint)
    stored = rgb @ to_xyz.T * luminance if kind == "XYZ" else rgb
    if kind == "Y":
        stored = np.repeat(stored[:, :1], 3, axis=1)
    alpha = np.ones(WIDTH)
    has_alpha = random.random() < 0.6
    if has_alpha:
        alpha = random.random(WIDTH)
        alpha[2:5] = [0, 1e-6, 0.01]
        factors = alpha.copy()
        if random.random() < 0.5:
            factors[2:4] = 1  # light without opacity
        stored = stored * factors[:, None]
    names = [layer + letter for letter in (kind if kind != "Y" else "Y")]
    planes = {name: stored[None, :, k].astype(dtype) for k, name in enumerate(names)}
    if has_alpha:
        planes[layer + "A"] = alpha[None].astype(dtype)
    path = folder / "a.exr"
    OpenEXR.File({"type": OpenEXR.scanlineimage, **header}, dict(planes)).write(
        str(path)
    )
    held = np.stack(
        [planes[names[k % len(names)]][0].astype(float) for k in range(3)], axis=-1
    )
    given = alpha.astype(dtype).astype(float)[:, None]
    is_light = np.abs(held).max(axis=1, keepdims=True) > HALF_MAX * given
    divided = np.where(is_light, held, held / np.where(given == 0, 1, given))
    usable, assumed = first_usable(stated)
    convert = usable.linear_to_srgb
    if kind == "XYZ":
        white = np.array(space.whitepoint)
        convert = lambda values: xyz_to_srgb(values / luminance, white)  # noqa: E731
    text = f"{layer}{kind} {dtype.__name__} {header} alpha {has_alpha}"
    tolerance = 3e-3 if dtype is np.float16 else 1e-3
    return Drawn(path, text, convert(held), convert(divided), assumed, tolerance)


def draw_tags(
    random: Random, depth: int
) -> tuple[dict[int, Any], list[Space | None], str]:
    """Draw the tags of TIFF about colours, and what they state."""
    tags: dict[int, Any] = {}
    stated: list[Space | None] = []
    text = ""
    gamut = "sRGB"
    curve = colour.models.eotf_sRGB
    kinds = random.random(3) < 0.4
    if kinds[0]:
        gamut = choose(random, GAMUTS)
        *primaries, x, y = numbers(gamut)
        tags[319], tags[318] = (5, primaries), (5, [x, y])
        text += f" primaries {gamut}"
    if kinds[1]:
        count = 1 << depth
        table = np.rint(65535 * np.linspace(0, 1, count) ** 1.8).astype(int).tolist()
        tags[301] = (3, table * choose(random, (1, 3)))
        curve = power(1.8)
        text += " transfer 1.8"
    if kinds[2] and not kinds[0]:
        tags[318] = (5, [0.3457, 0.3585])  # a white without primaries
        stated.append(None)
        text += " white alone"
    elif kinds[0] or kinds[1]:
        stated.append(Space(gamut, curve))
    return tags, stated, text


EXIF_TAGS = {
    "sRGB": ({0xA001: (3, [1])}, None, Space()),
    "uncalibrated": ({0xA001: (3, [65535])}, None, None),
    "R03": ({0xA001: (3, [65535])}, {1: (2, b"R03\0")}, Space(ADOBE, power(563 / 256))),
    "2": ({0xA001: (3, [2])}, None, Space(ADOBE, power(563 / 256))),
}


def draw_exif(
    random: Random, chance: float, stated: list[Space | None]
) -> tuple[Any, Any, str]:
    """Draw the EXIF tags ColorSpace and interoperability index, by a chance, and add
    the space that they state.
    """
    if random.random() >= chance:
        return None, None, ""
    name = choose(random, list(EXIF_TAGS))
    exif, index, space = EXIF_TAGS[name]
    stated.insert(0 if name in ("R03", "2") else len(stated), space)
    return exif, index, f" EXIF {name}"


def draw_tiff(random: Random, folder: Path) -> Drawn:
    """Draw a TIFF file."""
    dtype = choose(random, ("uint8", "uint16", "float32"))
    channels = choose(random, (1, 3, 3, 4))
    is_float = dtype == "float32"
    codes = (
        random.random((1, WIDTH, channels)).astype(dtype)
        if is_float
        else draw_codes(random, channels, dtype)
    )
    bits = 16 if dtype == "uint16" else 8
    tags, stated, text = draw_tags(random, bits)
    if channels == 4:
        tags[338] = (3, [2])  # straight alpha
    exif, index, words = draw_exif(random, 0.4, stated)
    text += words
    if random.random() < 0.2:
        name = choose(random, ("P3", "Adobe"))
        tags[34675] = (7, PROFILES[name][0])
        stated.insert(0, PROFILES[name][1])
        text += f" ICC {name}"
    order = choose(random, "<>")
    path = folder / "a.tif"
    path.write_bytes(files.tiff_bytes(codes, tags, order, exif, index))
    space, assumed = first_usable(stated)
    rgb = codes[0, :, :3] if channels > 2 else np.repeat(codes[0, :, :1], 3, axis=1)
    light = (
        space.linear_to_srgb(rgb.astype(float))
        if is_float
        else space.to_srgb(rgb / np.iinfo(dtype).max)
    )
    return Drawn(path, f"{dtype} {channels} {order}{text}", light, light, assumed)


def draw_jpeg(random: Random, folder: Path) -> Drawn:
    """Draw a JPEG file of one colour."""
    path = folder / "a.jpg"
    image = Image.fromarray(
        np.tile(random.integers(0, 256, 3, dtype=np.uint8), (8, 8, 1))
    )
    tags, stated, text = draw_tags(random, 8)
    settings: dict[str, Any] = {"quality": 100, "subsampling": 0}
    exif, index, words = draw_exif(random, 0.6, stated)
    text += words
    order = choose(random, "<>")
    settings["exif"] = b"Exif\0\0" + files.tiff_bytes(None, tags, order, exif, index)
    if random.random() < 0.3:
        name = choose(random, ("P3", "Adobe"))
        settings["icc_profile"] = PROFILES[name][0]
        stated.insert(0, PROFILES[name][1])
        text += f" ICC {name}"
    image.save(path, **settings)
    space, assumed = first_usable(stated)
    light = space.to_srgb(np.asarray(Image.open(path)).reshape(-1, 3) / 255)
    return Drawn(path, text, light, light, assumed)


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


def largest_error(found: Array, expected: Array, colours: Array) -> float:
    """Return the largest difference, relative to the largest component of the
    ``colours`` if they are above 1.
    """
    scale = np.maximum(1, np.abs(colours).max(axis=1, keepdims=True))
    return float((np.abs(found - expected) / scale).max())


def wrong(seed: int) -> list[str]:
    """Return what is wrong with the colours of the image of a seed."""
    random = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as folder:
        drawn = choose(random, DRAW)(random, Path(folder))
        with open_image(drawn.path) as image:
            part, channels = coloured_parts(image)[0]
            values = image.rows(part, 0, part.window.height).reshape(
                -1, len(part.channels)
            )
            light, _ = LIGHTS.decoder(part)(
                LIGHTS.colour_channels(channels).straight(values)
            )
            decode = make_decoder(SENSOR, part, "auto", "clip")
            straight, _ = decode(channels.straight(values))
            codes = {warning.code for warning in space_warnings(image, SENSOR)}
    found = []
    error = largest_error(light, drawn.light, drawn.light)
    clipped = largest_error(straight, np.clip(drawn.straight, 0, 1), drawn.straight)
    where = f"seed {seed}: {drawn.path.name} {drawn.text}"
    if not error <= drawn.tolerance:
        found.append(f"{where}: light differs by {error:.3g}")
    if not clipped <= drawn.tolerance:
        found.append(f"{where}: colours differ by {clipped:.3g}")
    if (codes == {"colour-space-assumed"}) != drawn.assumed:
        found.append(f"{where}: warnings {codes}, expected {drawn.assumed}")
    return found


def main(first: int, count: int) -> int:
    """Try seeds, print what is wrong, and return the number of wrong images."""
    failures = 0
    for seed in range(first, first + count):
        found = wrong(seed)
        failures += bool(found)
        print(*found, sep="\n", end="\n" * bool(found), flush=True)
    print(f"{failures} of {count} images are wrong")
    return failures


if __name__ == "__main__":
    sys.exit(bool(main(*map(int, sys.argv[1:]))))
