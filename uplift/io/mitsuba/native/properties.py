"""Properties of the texture in C++."""

from __future__ import annotations

from typing import Any

from uplift.io.mitsuba.spectra import phase_range
from uplift.io.mitsuba.texels import Placement, Samples, Texels
from uplift.models import Moments, Sigmoid


def native_properties(texels: Texels, placement: Placement) -> dict[str, Any]:
    """Describe a texture for Mitsuba.

    Parameters
    ----------
    texels : Texels
        The texels.
    placement : Placement
        How they lie on the surface.

    Returns
    -------
    dict
        Properties for `mitsuba.load_dict`.
    """
    import mitsuba

    model = texels.model
    if isinstance(model, Moments):
        start, end, warp = model.phase.start, model.phase.end, model.phase.warp
        low, high = phase_range(model).tolist()
    else:
        assert isinstance(model, Samples | Sigmoid)
        start, end, warp, low, high = model.start, model.end, "none", 0.0, 1.0
    return {
        "type": "uplift_texels",
        # Four axes, because Mitsuba tries to convert tensors of three rows to colours, and reports that it cannot.
        "numbers": mitsuba.TensorXf(placement.pad(texels.numbers)[None]),
        "to_uv": " ".join(f"{each:.9g}" for each in placement.to_uv[:2].ravel()),
        "model": model.name,
        "filter": placement.filter,
        "wrap": placement.wrap,
        "warp": warp,
        "start": start,
        "end": end,
        "low": low,
        "high": high,
        "mean": texels.mean,
        "summary": texels.describe(placement.wrap),
    }
