"""Names of earlier versions and what replaces them: a command runs under its old name,
and an old option is an error that names its successor.
"""

REPLACED = {
    "bounds": "lab bounds",
    "compare": "lab compare",
    "diff": "lab diff",
    "mix": "paints mix",
    "palette": "lab palette",
    "study": "lab study",
    "wavelengths": "lab wavelengths",
    "atlas --convert": "--output",
    "build --auto-tolerance": "--tolerance",
    "build --entry-moments": "--entry-coefficients, one more,",
    "build --leave-out": "--exclude-family",
    "build --moments": "--coefficients, one more,",
    "build --start": "--growth",
    "chart --colours": "uplift.lab.chart.task.Effort in Python",
    "chart --delta-e": "--tolerance",
    "chart --methods": "--method",
    "lab compare --target": "--tolerance",
    "lab palette --atlas": "--output",
    "lab palette --matrix": "--plot",
    "lab palette --spectra": "--plot-spectra",
    "lab study held-out --moments": "--coefficients, one more,",
    "lab wavelengths --target": "--tolerance",
    "paints mix --incidence": "--surface-reflectance",
    "paints mix --km-constants": "--scattering",
    "paints mix --light": "--additive",
    "paints mix --swatches": "--plot",
    "query --primaries": "--input-space",
    "slices --sheet": "--plot",
    "texture --store": "--representation",
}
"""By the words of the command line."""
for name in (
    "atlases",
    "coefficients",
    "dims",
    "models",
    "peer-dims",
    "samples",
    "spaces",
    "thresholds",
):
    REPLACED[f"lab study stability --{name}"] = (
        "uplift.lab.study.stability.DesignSpace in Python"
    )


def current_words(words: list[str]) -> list[str]:
    """Return the words of a command line with the present name of its command."""
    new = REPLACED.get(words[0], words[0]) if words else ""
    return [*new.split(), *words[1:]]
