"""Options of version 0.2 that later versions do not have, and what replaces them."""

REPLACEMENTS = {
    "atlas": {"--convert": "--output"},
    "build": {
        "--auto-tolerance": "--tolerance",
        "--entry-moments": "--entry-coefficients, one more,",
        "--leave-out": "--exclude-family",
        "--moments": "--coefficients, one more,",
        "--start": "--growth",
    },
    "chart": {
        "--colours": "uplift.lab.chart.task.Effort in Python",
        "--delta-e": "--tolerance",
        "--methods": "--method",
    },
    "compare": {"--target": "--tolerance"},
    "mix": {
        "--incidence": "--surface-reflectance",
        "--km-constants": "--scattering",
        "--light": "--additive",
        "--swatches": "--plot",
    },
    "palette": {
        "--atlas": "--output",
        "--matrix": "--plot",
        "--spectra": "--plot-spectra",
    },
    "query": {"--primaries": "--input-space"},
    "slices": {"--sheet": "--plot"},
    "study held-out": {"--moments": "--coefficients, one more,"},
    "study stability": dict.fromkeys(
        (
            "--atlases",
            "--coefficients",
            "--dims",
            "--models",
            "--peer-dims",
            "--samples",
            "--spaces",
            "--thresholds",
        ),
        "uplift.lab.study.stability.DesignSpace in Python",
    ),
    "texture": {"--store": "--representation"},
    "wavelengths": {"--target": "--tolerance"},
}
"""By command, and by the name of the option."""
