"""Fuzz target: the reader and the design of palettes, with mutated specifications."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np

from tests.fuzz.mutate import NUMBERS, Random, mutate
from tests.fuzz.target import ROOT, Target
from uplift.colorimetry import observer
from uplift.design.palette import FactorModel, design, matrix, read_palette, standard_model

SAMPLES = ROOT / "uplift" / "samples" / "files"
SEEDS = tuple(
    (SAMPLES / f"{name}.toml").read_bytes().replace(b"paints.csv", bytes(SAMPLES / "paints.csv"))
    for name in ("constant", "engine", "light", "metamers", "vanish")
)
TOKENS = (
    b"lights", b"materials", b"colours", b"free", b"apart", b"design", b"bounds", b"illuminant", b"planck",
    b"luminance", b"atlas", b"entry", b"rgb", b"cube", b"weight", b"low", b"high", b"smoothness", b"model-error",
    b"coefficients", b"delta-e", b"day", b"lamp", b"true", b"false", b"#808080", b"[0.5, 0.2, 0.1]", b"D65",
    b"FL11", b"[", b"]", b"{", b"}", b"[[", b"=", b",", b'"', b"'", b"\n", b"\0", b"\xff", b"#", b"[" * 100_000,
    b"a." * 2000, *NUMBERS,
)  # fmt: skip


@functools.cache
def _model(count: int) -> FactorModel:
    return standard_model(observer.sensor(), count)


def _generate(random: Random, path: Path) -> None:
    path.write_bytes(mutate(SEEDS[random.integers(len(SEEDS))], random, TOKENS))


def _use(path: Path) -> None:
    """Design the palette. Raises `UpliftError` for invalid files, ValueError for invalid spectra."""
    palette = read_palette(path)
    result = design(palette, _model(palette.count))
    matrix(result)
    if not (np.isfinite(result.powers).all() and np.isfinite(result.reflectances).all()):
        raise ValueError("spectra that are not finite")


TARGET = Target("palette", _generate, _use)
