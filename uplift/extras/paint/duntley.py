"""Paints by Duntley's theory, per unit thickness, in a beam and in diffuse light.

It has eight constants, as collimated incident light and diffuse light
within a layer differ: a fraction K' of the beam is absorbed, B' is scattered backward
and F' forward; K, B and F are those of diffuse light (F has no effect), S' = B' + F'
and S = B + F. With μ = K' + B' + F' and γ² = K (K + 2B), the beam e^−μx feeds two
diffuse fluxes,

    t' = F' e^−μx − (K + B) t + B s,    −s' = B' e^−μx − (K + B) s + B t,
    t(0) = 0,  s(X) = 0.

−Q' e^−μx and −P' e^−μx are a particular solution. The rest is Kubelka and Munk's layer
(r, τ) with S = B, so that

    R = Q' r + P' e^−μX τ − P',    T = Q' τ + P' e^−μX r − (Q' − 1) e^−μX,

which is eq. 10.8 of Fishkin 1983. Where the denominator μ² − γ² of P' and Q' vanishes,
the mean of both sides is taken. Particles that scatter in all directions alike leave
two constants: K' = K / 2, B' = F' = S / 2 and B = F = S.

S. Q. Duntley, J. Opt. Soc. Am. 1942.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.document import read_document
from uplift.atlas.formats import read_any
from uplift.common.arrays import Array, StrPath
from uplift.extras.paint.optics import (
    NO_SURFACE,
    Coat,
    DirectedLayer,
    Surface,
    as_shares,
    check_thickness,
    weighted_sum,
)
from uplift.extras.paint.pigments import Pigment

# Relative difference of μ and γ below which the mean of both sides is taken; its error
# is the square of this.
MIN_RELATIVE_GAP = 1e-5
# of Duntley's eight, those that the others are sums of
CONSTANTS = ("K'", "B'", "F'", "K", "B", "F")


@dataclass(frozen=True, eq=False)
class Flux:
    """Fractions (..., N) of a kind of light that are absorbed, scattered backward and
    forward per unit thickness.
    """

    absorption: Array
    backward: Array
    forward: Array


def duntley_layer(beam: Flux, diffuse: Flux, thickness: float) -> DirectedLayer:
    """Return the optical properties of a layer for collimated light by Duntley's theory
    (eq. 10.8).
    """
    inner = Pigment(diffuse.absorption, diffuse.backward)
    layer = inner.layer(thickness)
    r = layer.reflectance
    tau = layer.transmittance
    K = inner.absorption
    B = inner.scattering
    gamma = inner.gamma
    B1 = beam.backward
    F1 = beam.forward
    S1 = beam.backward + beam.forward

    def one_side(K1: Array) -> Array:
        mu = K1 + S1
        unscattered = np.exp(-mu * thickness)
        denominator = mu**2 - K * (K + 2 * B)
        safe = np.where(denominator == 0, 1, denominator)
        # A beam that is not scattered feeds nothing.
        P = np.where(S1 > 0, ((K - K1) * B1 + (B - B1) * S1) / safe, 0)
        Q = np.where(S1 > 0, ((K + K1) * F1 + (B + F1) * S1) / safe, 0)
        return np.stack(
            [
                Q * r + P * unscattered * tau - P,
                Q * tau + P * unscattered * r - (Q - 1) * unscattered,
            ]
        )

    mu = beam.absorption + S1
    step = MIN_RELATIVE_GAP * np.maximum(mu, gamma)
    offset = np.where(np.abs(mu - gamma) < step, 2 * step, 0.0)
    reflectance, transmittance = (
        one_side(beam.absorption + offset) + one_side(beam.absorption - offset)
    ) / 2
    return DirectedLayer(reflectance, transmittance, layer)


@dataclass(frozen=True, eq=False)
class DuntleyPaints:
    """Paints by the constants of Duntley's theory.

    Parameters
    ----------
    constants : ndarray of shape (n, 6, N)
        K', B', F', K, B and F of each paint, per unit thickness.
    """

    constants: Array

    def coat(
        self,
        parts: ArrayLike,
        thickness: float | None = None,
        surface: Surface = NO_SURFACE,
    ) -> Coat:
        """Make a coat, whose constants are means by parts.

        Parameters
        ----------
        parts : array_like of shape (..., n)
            Amounts of the paints.
        thickness : float, optional
            Thickness in units, by default 1.
        surface : Surface
            Surface of the vehicle.

        Returns
        -------
        Coat
            The coat; ``coat.over(ground)`` is its reflectance on a ground.
        """
        check_thickness(thickness)
        flat = self.constants.reshape(len(self.constants), -1)
        mixed = weighted_sum(flat, as_shares(parts))
        fluxes = np.moveaxis(mixed.reshape(*mixed.shape[:-1], 6, -1), -2, 0)
        depth = 1.0 if thickness is None else thickness
        layer = duntley_layer(Flux(*fluxes[:3]), Flux(*fluxes[3:]), depth)
        return Coat(layer, surface)


def read_constants(path: StrPath, wavelengths: Array) -> Array:
    """Read Duntley's constants (6, N) of a paint, in the order of `CONSTANTS`, linear
    between the samples of a table.

    S' = B' + F' and S = B + F may be in the table too; they must be these sums. Raises
    `AtlasError`.
    """
    document = read_document(path)
    _, content = read_any(document)
    samples = dict[str, Array]()
    for spectrum in getattr(content, "spectra", ()):
        nm = np.asarray(spectrum.wavelengths, dtype=float)
        values = np.asarray(spectrum.values, dtype=float)
        if not (np.isfinite(values) & (values >= 0)).all():
            location = document.location.at(spectrum.line, spectrum.name)
            raise location.error(
                "constants of a paint must be finite and at least 0",
                "correct the table",
            )
        order = np.argsort(nm)
        samples[spectrum.name] = np.interp(wavelengths, nm[order], values[order])
    missing = [name for name in CONSTANTS if name not in samples]
    if missing:
        raise document.location.error(
            f"a table of Duntley's constants must have {', '.join(CONSTANTS)}; "
            f"{', '.join(missing)} missing",
            "write a column for each, and one of wavelengths in nm",
        )
    for total, first, second in (("S'", "B'", "F'"), ("S", "B", "F")):
        parts = samples[first] + samples[second]
        if total in samples and not np.allclose(samples[total], parts, rtol=1e-3):
            raise document.location.error(
                f"{total} must be {first} + {second}",
                f"correct {total} or leave it out",
            )
    return np.stack([samples[name] for name in CONSTANTS])


def diffuse_to_beam(diffuse: ArrayLike) -> Array:
    """Return the reflectance R = 2r / (3 − r) in a beam of an opaque layer that
    scatters in all directions alike.
    """
    r = np.asarray(diffuse, dtype=float)
    return 2 * r / (3 - r)


def beam_to_diffuse(directed: ArrayLike) -> Array:
    """Return the reflectance in diffuse light of such a layer, r = 3R / (2 + R)."""
    R = np.asarray(directed, dtype=float)
    return 3 * R / (2 + R)
