"""Colours of unseen materials under other lights by cubes without an atlas, by
root-polynomials, and by averages of both, for docs/integrate.md.

A root-polynomial maps XYZ x, y, z under D65, relative to white, to XYZ under a light:
6 terms x, y, z, √xy, √yz, √xz for each of X, Y and Z (Finlayson, Mackiewicz & Hurlbert
2015, "Color correction using root-polynomial regression"). It is fitted to colours of
the library in L*a*b*, white stays exact, and each family weighs as the root of its
size. Cube and map do not know the family that is predicted. Neither do they know
the spectra of Otsu et al. to predict the Munsell book that these stand
for. The weight of the map in the average is the best one for the other families.
"""

import numpy as np

import uplift
from benchmarks import Row, record
from benchmarks.materials import FETCHED, SENSOR, materials
from uplift.colorimetry import (
    Light,
    delta_e_2000,
    in_unit_cube,
    lab,
    lab_jacobian,
    observer,
)
from uplift.common.arrays import Array
from uplift.fit import shipped_library
from uplift.fit.families import STAND_IN

DIM = 32
LIGHTS = ("A", "FL11", "LED-B3", "HP1")
METHODS = CUBE, MAP, AVERAGE = "cube", "root-polynomial", "average"
WEIGHTS = np.linspace(0, 1, 11)
"""Weights of the root-polynomial in averages with the cube's colours."""
STEPS = 6
"""Steps of Gauss and Newton."""
ROUNDING = 0.5
"""ΔE² added to squares, whose root the fit minimises: outliers count less."""
DARKEST = 1e-4
CHROMA = np.array([0.0, 0.045, 0.03])
"""Loss of weight of L*, a* and b* by chroma."""


def main() -> None:
    """Predict each family, choose weights by the others, and store."""
    families = [family.name for family in shipped_library((STAND_IN,))]
    errors = {name: family_errors(name, (name,)) for name in families}
    for name in FETCHED:
        errors[name] = family_errors(name, (STAND_IN,))
    rows = []
    for name in errors:
        others = [errors[other] for other in families if other != name]
        for number, light in enumerate(LIGHTS):
            chosen = best_weight([error[number] for error in others])
            rows.append(
                {
                    "family": name,
                    "light": light,
                    "colours": errors[name].shape[-1],
                    "weight": WEIGHTS[chosen],
                    CUBE: summary(errors[name][number, 0]),
                    MAP: summary(errors[name][number, -1]),
                    AVERAGE: summary(errors[name][number, chosen]),
                }
            )
    record("grading", dim=DIM, lights=list(LIGHTS), rows=rows, pooled=pooled(rows))


def family_errors(name: str, leave_out: tuple[str, ...]) -> Array:
    """Return ΔE00 (L, W, n) of a family, or of a set, by light and weight."""
    known = {family.name: family.measured for family in shipped_library()}
    measured = known[name] if name in known else materials(name).measured
    rgb = SENSOR.rgb(measured)
    rows = in_unit_cube(rgb)
    measured = measured[rows]
    rgb = np.clip(rgb[rows], 0, 1)
    cube = uplift.build(dim=DIM, leave_out=leave_out)
    answers = cube.reflectance(rgb)
    training = [spectra for other, spectra in known.items() if other not in leave_out]
    errors = []
    for light in map(observer.light, LIGHTS):
        truth = lab(measured @ light.xyz.T, light.white)
        by_cube = answers @ light.xyz.T
        polynomial = fit_polynomial(training, light)
        by_map = terms(SENSOR.xyz(rgb)) @ polynomial * light.white
        averages = [(1 - w) * by_cube + w * by_map for w in WEIGHTS]
        errors.append([delta_e_2000(truth, lab(xyz, light.white)) for xyz in averages])
    return np.array(errors)


def terms(xyz: Array) -> Array:
    """Terms (n, 6) of XYZ (n, 3) under D65; 1 for white."""
    x, y, z = np.maximum(xyz / SENSOR.light.white, 0).T
    return np.stack([x, y, z, np.sqrt(x * y), np.sqrt(y * z), np.sqrt(x * z)], axis=1)


def fit_polynomial(training: list[Array], light: Light) -> Array:
    """Coefficients (6, 3) of XYZ relative to white, of families of spectra."""
    spectra = np.concatenate(training)
    weight = np.concatenate(
        [np.full(len(rows), len(rows) ** -0.5) for rows in training]
    )
    known = terms(spectra @ SENSOR.light.xyz.T)
    goal = lab(spectra @ light.xyz.T, light.white)
    chroma = np.hypot(goal[:, 1], goal[:, 2])[:, None]
    scale = 1 / (1 + CHROMA * chroma)
    # coefficients of a column sum to 1, so that white is exact
    free = known[:, 1:] - known[:, :1]
    coefficients = np.vstack([np.eye(3), np.zeros((3, 3))])
    for _ in range(STEPS):
        xyz = np.maximum(known @ coefficients, DARKEST) * light.white
        residual = goal - lab(xyz, light.white)
        distance = np.sqrt((residual**2).sum(axis=1) + ROUNDING)
        row_weight = np.sqrt(weight / distance)[:, None] * scale
        slope = lab_jacobian(xyz, light.white) * light.white
        matrix = row_weight[:, :, None, None] * slope[..., None] * free[:, None, None]
        step = np.linalg.lstsq(matrix.reshape(-1, 15), (row_weight * residual).ravel())[
            0
        ].reshape(3, 5)
        change = np.vstack([-step.sum(axis=1), step.T])
        coefficients = coefficients + change
    return coefficients


def best_weight(errors: list[Array]) -> int:
    """Row of the weight with the smallest mean error relative to the cube, of errors
    (W, n) of several families.
    """
    ratios = [error.mean(axis=1) / error[0].mean() for error in errors]
    return int(np.mean(ratios, axis=0).argmin())


def summary(errors: Array) -> dict[str, float]:
    """Return mean and 95 % of errors."""
    return {"mean": errors.mean(), "p95": np.quantile(errors, 0.95)}


def pooled(rows: list[Row]) -> list[Row]:
    """Return the means over the families, and the chosen weights, by light."""
    summaries = []
    for light in LIGHTS:
        of_light = [row for row in rows if row["light"] == light]
        weights = sorted({row["weight"] for row in of_light})
        means = {method: mean_over(of_light, method) for method in METHODS}
        about = {"light": light, "families": len(of_light), "weights": weights}
        summaries.append(about | means)
    return summaries


def mean_over(rows: list[Row], method: str) -> dict[str, float]:
    """Return the averages of the figures of a method."""
    means = np.mean([list(row[method].values()) for row in rows], axis=0)
    return dict(zip(rows[0][method], means, strict=True))
