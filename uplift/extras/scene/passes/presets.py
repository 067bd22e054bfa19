"""Bands chosen for the library of materials under six lights, for those who do not
search.
"""

from uplift.extras.scene.passes.bands import Bands

PRESETS = {
    1: Bands((451.0, 543.0, 600.0), 19.0),
    2: Bands((449.0, 499.0, 543.0, 580.0, 610.0, 652.0), 10.0),
    3: Bands((432.0, 458.0, 489.0, 517.0, 545.0, 570.0, 593.0, 620.0, 662.0), 4.0),
    4: Bands(
        (
            *(429.0, 452.0, 476.0, 500.0, 522.0, 544.0),
            *(562.0, 580.0, 598.0, 616.0, 644.0, 687.0),
        ),
        2.0,
    ),
}
"""Bands by the number of passes: docs/guides/passes.md."""
