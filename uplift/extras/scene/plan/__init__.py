"""Plans: the smallest cube, wavelengths and texture format that keep a scene's colours
within a tolerance.

Each decision is measured on colours of the scene's own textures; docs/plan.md describes
the method.

    from uplift.extras.scene import plan

    result = plan.plan(plan.read_scene_file("kitchen.toml"))
    result.chosen.name, result.confirmed.quantile, result.chosen.cube
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
