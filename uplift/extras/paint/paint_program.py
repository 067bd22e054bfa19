"""Programs in C, GLSL and HLSL that mix measured paints at the few wavelengths that
suffice.

The wavelengths are those that `uplift.extras.papers.wavelengths` chooses for mixtures
of the paints; the weights from reflectances to linear sRGB are fitted to mixtures, and
judged by others.
"""

import re
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from string import Template

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array
from uplift.common.errors import unknown_name
from uplift.common.files import write_text
from uplift.common.version import version
from uplift.extras.export.source import comment, identifier, literal
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
    nm = paints.wavelengths
    sensor = paints.sensor
    fitted, judged = _mixtures(paints, 0), _mixtures(paints, 1)
    setup = make_setup(fitted.opaque, ["D65"], wavelengths=nm)
    chosen = np.sort(choose(setup, count=count).sampling.wavelengths)
    few = paints.at(chosen)
    at_few = fitted.at(few)
    spectra = np.concatenate([at_few.opaque, at_few.layers, np.ones((1, count))])
    full = np.concatenate([fitted.opaque, fitted.layers, np.ones((1, len(nm)))])
    rgb = sensor.rgb(full)
    scale = 1 / (np.abs(rgb).mean(axis=1, keepdims=True) ** (2 / 3) + FLOOR)
    weights, *_ = np.linalg.lstsq(spectra * scale, rgb * scale, rcond=None)
    test = judged.at(few)
    errors = [
        delta_e_rgb(sensor, np.clip(sensor.rgb(exact), 0, 1), np.clip(near, 0, 1))
        for exact, near in (
            (judged.opaque, test.opaque @ weights),
            (judged.layers, test.layers @ weights),
        )
    ]
    return FewSamples(few, weights.T, *errors)


@dataclass(frozen=True, eq=False)
class _Mixtures:
    """Reflectances of random mixtures: opaque, and in layers on grey grounds."""

    parts: Array
    thickness: Array
    grounds: Array
    opaque: Array
    layers: Array

    def at(self, paints: Paints) -> "_Mixtures":
        """Return the same mixtures of the paints at other wavelengths."""
        return _spectra(paints, self.parts, self.thickness, self.grounds)


def _mixtures(paints: Paints, seed: int) -> _Mixtures:
    rng = np.random.default_rng(seed)
    parts = rng.dirichlet(np.full(len(paints), CONCENTRATION), MIXTURES)
    mixed = paints.pigments.mix(parts)
    hiding = 1 / (mixed.absorption + mixed.scattering).mean(axis=1)
    low, high = np.log(THICKNESSES).tolist()
    thickness = hiding * np.exp(rng.uniform(low, high, MIXTURES))
    return _spectra(paints, parts, thickness, rng.random(MIXTURES))


def _spectra(
    paints: Paints, parts: Array, thickness: Array, grounds: Array
) -> _Mixtures:
    layers = [
        paints.reflectance(row, x, ground)
        for row, x, ground in zip(parts, thickness, grounds, strict=True)
    ]
    opaque = paints.reflectance(parts)
    return _Mixtures(parts, thickness, grounds, opaque, np.array(layers))


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
    write_text(_text(samples, style, path.stem), path, force=force)
    return samples


def describe_errors(samples: FewSamples) -> str:
    """Return a line about the errors of a program."""
    opaque = samples.opaque_errors
    layers = samples.layer_errors
    return (
        f"dE00 to full spectra: {opaque.mean():.2f} of opaque mixtures, at most "
        f"{opaque.max():.1f}; {layers.mean():.2f} of layers, at most {layers.max():.1f}"
    )


def _text(samples: FewSamples, style: str, stem: str) -> str:
    language = LANGUAGES[style]
    paints = samples.paints
    name = identifier(stem)
    values = {
        "absorption": paints.pigments.absorption,
        "scattering": paints.pigments.scattering,
        "weights": samples.weights,
    }
    surface = paints.surface
    words = {
        "title": f"{name}: mixtures of {len(paints)} paints, in the order",
        "paints": ", ".join(map(comment, paints.names)),
        "version": version(),
        "wavelengths": ", ".join(f"{value:.0f}" for value in paints.wavelengths),
        "error": describe_errors(samples),
        "opening": language.opening,
        "closing": language.closing,
        "count": len(paints),
        "samples": len(paints.wavelengths),
        "tables": "\n".join(
            _table(language.table, key, table) for key, table in values.items()
        ),
        "outside": literal(surface.outside),
        "inside": literal(surface.inside),
        "transmitted": literal((1 - surface.outside) * (1 - surface.inside)),
    }
    source = files("uplift.extras.paint") / "source" / "paints.txt"
    text = Template(source.read_text(encoding="ascii")).substitute(words)
    text = re.sub(r"\bup_", f"{name}_", text)
    return re.sub(r"\bUP_", f"{name.upper()}_", text).rstrip() + "\n"


def _table(template: str, name: str, values: Array) -> str:
    rows = [", ".join(map(literal, row)) for row in values.tolist()]
    numbers = ",\n".join(f"    {row}" for row in rows)
    return Template(template).substitute(name=name, size=values.size, numbers=numbers)
