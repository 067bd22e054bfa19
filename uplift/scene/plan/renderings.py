"""What a renderer traces in place of full spectra: wavelengths, other representations, or RGB."""

import contextlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from uplift.colorimetry import Light, Sensor, observer
from uplift.colorimetry.delta_e import delta_e_2000_weights, lab_jacobian
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.progress import Progress, ProgressCallback
from uplift.lookup import Cube
from uplift.scene.plan.candidates import UNMEASURED, SearchGrid, front
from uplift.scene.plan.evaluation import ErrorSummary, EvaluationSet
from uplift.scene.representations import Representation, all_representations, samples
from uplift.scene.wavelengths import Sampling, choose, make_setup
from uplift.scene.wavelengths.sampling import RenderSetup, interp_curves

FEW = 200
"""Colours of each group that wavelengths are fitted to."""
DIGITS = 2
"""Decimals of a wavelength in nm, so that the measured wavelengths are those of the command line."""
MAX_MEYER = 12
"""Meyer's wavelengths that are tried; more take long."""
FAMILIES = ("PS", "PF", "RS", "RE", "CS", "GQ", "LM")
"""Representations that are tried: no models, which cubes have, and none with noise."""


@dataclass(frozen=True, eq=False)
class Rendering:
    """Numbers that stand for a spectrum in a renderer.

    ``samples`` of a ray, ``operations`` of a product of light and surface with its share in the sum to XYZ, numbers of
    a surface, and ``xyz``, from reflectances (n, W) at ``wavelengths`` (W,) in nm to XYZ (K, n, 3) under each light.
    ``sampling`` is None for representations that are not wavelengths. ``error`` is that of the reference's spectra.
    """

    name: str
    samples: float
    operations: float
    surface: float
    wavelengths: Array
    xyz: Callable[[Array], Array]
    error: ErrorSummary = UNMEASURED
    sampling: Sampling | None = None


def renderings(
    grid: SearchGrid, sensor: Sensor, tests: EvaluationSet, reference: Cube, floor: float, progress: ProgressCallback
) -> list[Rendering]:
    """Measure fitted wavelengths up to a ΔE00 of ``floor``, Meyer's, and representations, and drop dominated ones."""

    fitted, lights = tests.reflectances[tests.subsample(FEW)], [light.name for light in tests.lights]
    setup = make_setup(fitted, lights, wavelengths=sensor.wavelengths, observer_name=sensor.observer)
    full = Sampling(setup.wavelengths, setup.cmfs, setup.lights, setup.powers)
    found = [_measured(_of_sampling(f"{len(full)} wavelengths", full), tests, reference)]
    for done, count in enumerate(grid.samples):
        progress(Progress("wavelengths", done, len(grid.samples)))
        chosen = _of_sampling(f"{count} wavelengths", _rounded(choose(setup, count=count).sampling))
        found.append(_measured(chosen, tests, reference))
        if found[-1].error.quantile <= floor:
            break
    if grid.others:
        progress(Progress("other representations", 0, 1))
        others = (each for each in _others(sensor, tests, setup) if each.samples < found[-1].samples)
        found += [_measured(each, tests, reference) for each in others]
    rows = np.array([(each.samples, each.operations, each.surface, max(each.error.quantile, floor)) for each in found])
    return [found[row] for row in sorted(front(rows))]


def _measured(rendering: Rendering, tests: EvaluationSet, reference: Cube) -> Rendering:
    return replace(rendering, error=tests.error(rendering.xyz(reference.reflectance(tests.rgb, rendering.wavelengths))))


def _of_sampling(name: str, sampling: Sampling) -> Rendering:
    count = len(sampling)
    return Rendering(name, count, 7 * count, count, sampling.wavelengths, sampling.xyz, sampling=sampling)


def _rounded(sampling: Sampling) -> Sampling:
    """Round wavelengths to `DIGITS`, all distinct."""
    steps = np.arange(len(sampling)) / 10**DIGITS
    distinct = np.maximum.accumulate(np.round(sampling.wavelengths, DIGITS) - steps) + steps
    return replace(sampling, wavelengths=np.round(distinct, DIGITS))


def _others(sensor: Sensor, tests: EvaluationSet, setup: RenderSetup) -> Iterator[Rendering]:
    """Meyer's wavelengths, and representations, which are defined for one observer."""
    for count in range(4, MAX_MEYER + 1):
        with contextlib.suppress(OptionError):  # no rule of this order
            sampling = _rounded(choose(setup, count=count, method="meyer").sampling)
            yield _of_sampling(f"{count} wavelengths of Meyer", sampling)
    if sensor.observer != observer.DEFAULT_OBSERVER:
        return
    dense = np.stack([observer.illuminant_spd(light.name, step=samples.STEP) for light in tests.lights])
    powers = dense / (dense @ samples.xyz_weights()[:, 1:2])
    surfaces = interp_curves(samples.wavelengths(), setup.wavelengths, setup.reflectances)
    for each in all_representations(powers, surfaces):
        if each.name[:2] in FAMILIES:
            of_surface = float(each.storage(each.encode_surface(surfaces)).mean())
            of_light = float(each.storage(each.encode_light(powers)).mean())
            xyz = partial(_representation_xyz, each, powers, tests.lights)
            yield Rendering(each.name, of_light, of_surface + 6 * of_light, of_surface, samples.wavelengths(), xyz)


def _representation_xyz(
    representation: Representation, powers: Array, lights: Sequence[Light], reflectances: Array
) -> Array:
    """XYZ (K, n, 3) of dense reflectances (n, 401): those of the 5 nm table, and what the representation changes."""
    surfaces, found = representation.encode_surface(reflectances), []
    for power, light in zip(powers, lights, strict=True):
        lit = representation.encode_light(np.broadcast_to(power, reflectances.shape))
        product = representation.xyz(representation.multiply(lit, surfaces))
        change = product - (power * reflectances) @ samples.xyz_weights()
        found.append(reflectances[:, :: samples.TABLE_STRIDE] @ light.xyz.T + change)
    return np.stack(found)


def fit_matrices(tests: EvaluationSet) -> Array:
    """Matrices (K, 3, 3) from linear RGB to XYZ under each light: least squares of small differences in ΔE00."""
    weight = np.sqrt(tests.weights)[:, None, None]
    found = []
    for light, reference, xyz in zip(tests.lights, tests.lab, tests.xyz(tests.reflectances), strict=True):
        # ΔE00 ≈ |F (M r − x)|
        factor = weight * (delta_e_2000_weights(reference) @ lab_jacobian(xyz, light.white))
        design = np.einsum("nij,nl->nijl", factor, tests.rgb).reshape(-1, 9)
        target = np.einsum("nij,nj->ni", factor, xyz).ravel()
        found.append(np.linalg.lstsq(design, target, rcond=None)[0].reshape(3, 3))
    return np.stack(found)
