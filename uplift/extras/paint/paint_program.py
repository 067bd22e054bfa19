"""Programs in C, GLSL and HLSL that mix measured paints at the few wavelengths that
suffice.

The wavelengths are those that `uplift.extras.papers.wavelengths` chooses for mixtures
of the paints; the weights from reflectances to linear sRGB are fitted to mixtures, and
judged by others.
"""

from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Self

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array
from uplift.common.errors import unknown_name
from uplift.common.files import write_text
from uplift.common.version import version
from uplift.extras.export.source import comment, identifier, literal, name_program
from uplift.extras.paint.paints import Paints
from uplift.extras.papers.wavelengths.choice import choose
from uplift.extras.papers.wavelengths.sampling import make_setup

COUNT = 8
"""Wavelengths of a program."""
MIXTURES = 400
"""Mixtures that weights are fitted to, and as many that judge them."""
CONCENTRATION = 0.5
"""Parameter of Dirichlet's distribution of shares: mostly a few paints."""
FLOOR = 0.02
"""Reflectance from which errors weigh relative to the colour."""
THICKNESSES = (0.05, 2.0)
"""Range of layers, times the thickness that half hides the ground."""


@dataclass(frozen=True)
class Language:
    """How a language spells constants, parameters and functions."""

    opening: str
    closing: str
    table: str  # of ${name}, ${size} and ${numbers}


GUARD = """#ifndef UP_PAINTS_H
#define UP_PAINTS_H
#include <math.h>
#define UP_FUNCTION static inline
#define UP_IN(name, size) const float *name
#define UP_OUT(name, size) float *name
#define UP_EXP expf
#define UP_SQRT sqrtf"""
SHADER = """#define UP_FUNCTION
#define UP_IN(name, size) in float name[size]
#define UP_OUT(name, size) out float name[size]
#define UP_EXP exp
#define UP_SQRT sqrt"""
PRECISION = """#ifdef GL_ES
precision highp float;
precision highp int;
#endif
"""
C_TABLE = "static const float up_${name}[${size}] = {\n${numbers}\n};\n"
GLSL_TABLE = "const float up_${name}[${size}] = float[${size}](\n${numbers}\n);\n"
LANGUAGES = {
    "c": Language(GUARD, "#endif", C_TABLE),
    "glsl": Language(PRECISION + SHADER, "", GLSL_TABLE),
    "hlsl": Language(SHADER, "", C_TABLE),
}
"""Languages of `write_program`."""


@dataclass(frozen=True, eq=False)
class FewSamples:
    """Paints at a few wavelengths, with weights (3, n) to linear sRGB, and ΔE00 of
    mixtures that the weights were not fitted to.
    """

    paints: Paints
    weights: Array
    opaque_errors: Array
    layer_errors: Array


def few_samples(paints: Paints, count: int = COUNT) -> FewSamples:
    """Choose wavelengths for mixtures of paints, and fit weights there."""
    sensor = paints.sensor
    fitted, judged = _Mixtures.random(paints, 0), _Mixtures.random(paints, 1)
    exact = fitted.spectra(paints)
    setup = make_setup(exact[:MIXTURES], ["D65"], wavelengths=paints.wavelengths)
    few = paints.at(np.sort(choose(setup, count=count).sampling.wavelengths))
    # White is fitted as well.
    spectra = np.concatenate([fitted.spectra(few), np.ones((1, count))])
    rgb = sensor.rgb(np.concatenate([exact, np.ones_like(exact[:1])]))
    scale = 1 / (np.abs(rgb).mean(axis=1, keepdims=True) ** (2 / 3) + FLOOR)
    weights, *_ = np.linalg.lstsq(spectra * scale, rgb * scale, rcond=None)
    true = np.clip(sensor.rgb(judged.spectra(paints)), 0, 1)
    near = np.clip(judged.spectra(few) @ weights, 0, 1)
    opaque_errors, layer_errors = np.split(delta_e_rgb(sensor, true, near), 2)
    return FewSamples(few, weights.T, opaque_errors, layer_errors)


@dataclass(frozen=True, eq=False)
class _Mixtures:
    """Random mixtures, opaque and in layers on grey grounds."""

    parts: Array
    thickness: Array
    grounds: Array

    @classmethod
    def random(cls, paints: Paints, seed: int) -> Self:
        rng = np.random.default_rng(seed)
        parts = rng.dirichlet(np.full(len(paints), CONCENTRATION), MIXTURES)
        mixed = paints.pigments.mix(parts)
        hiding = 1 / (mixed.absorption + mixed.scattering).mean(axis=1)
        low, high = np.log(THICKNESSES).tolist()
        thickness = hiding * np.exp(rng.uniform(low, high, MIXTURES))
        return cls(parts, thickness, rng.random(MIXTURES))

    def spectra(self, paints: Paints) -> Array:
        """Return the reflectances (2 m, N) of the opaque mixtures, then of layers."""
        films = zip(self.parts, self.thickness, self.grounds, strict=True)
        layers = [paints.reflectance(*film) for film in films]
        return np.concatenate([paints.reflectance(self.parts), layers])


def write_program(
    paints: Paints, path: Path, *, style: str = "c", force: bool = False
) -> FewSamples:
    """Write a program that mixes paints.

    Parameters
    ----------
    paints : Paints
        The paints.
    path : Path
        File to write. Names in the program begin with its stem.
    style : {"c", "glsl", "hlsl"}
        Language; C is also valid C++.
    force : bool
        Whether to replace an existing file.

    Returns
    -------
    FewSamples
        What the program contains, and its errors.

    Raises
    ------
    UnknownNameError
        The language does not exist.
    OutputError
        The file cannot be written, or exists and ``force`` is off.
    """
    if style not in LANGUAGES:
        raise unknown_name(style, LANGUAGES, "language")
    samples = few_samples(paints)
    write_text(_text(samples, LANGUAGES[style], path.stem), path, force=force)
    return samples


def describe_errors(samples: FewSamples) -> str:
    """Return a line about the errors of a program."""
    opaque = samples.opaque_errors
    layers = samples.layer_errors
    return (
        f"dE00 to full spectra: {opaque.mean():.2f} of opaque mixtures, at most "
        f"{opaque.max():.1f}; {layers.mean():.2f} of layers, at most {layers.max():.1f}"
    )


def _text(samples: FewSamples, language: Language, stem: str) -> str:
    paints = samples.paints
    values = {**vars(paints.pigments), "weights": samples.weights}
    tables = [_table(language, name, table) for name, table in values.items()]
    surface = paints.surface
    words = {
        "title": f"{identifier(stem)}: mixtures of {len(paints)} paints, in the order",
        "paints": ", ".join(map(comment, paints.names)),
        "version": version(),
        "wavelengths": ", ".join(f"{value:.0f}" for value in paints.wavelengths),
        "error": describe_errors(samples),
        "opening": language.opening,
        "closing": language.closing,
        "count": len(paints),
        "samples": len(paints.wavelengths),
        "tables": "\n".join(tables),
        "outside": literal(surface.outside),
        "inside": literal(surface.inside),
        "transmitted": literal((1 - surface.outside) * (1 - surface.inside)),
    }
    source = files("uplift.extras.paint") / "source" / "paints.txt"
    text = Template(source.read_text(encoding="ascii")).substitute(words)
    return name_program(text, stem).rstrip() + "\n"


def _table(language: Language, name: str, values: Array) -> str:
    rows = [", ".join(map(literal, row)) for row in values.tolist()]
    numbers = ",\n".join(f"    {row}" for row in rows)
    template = Template(language.table)
    return template.substitute(name=name, size=values.size, numbers=numbers)
