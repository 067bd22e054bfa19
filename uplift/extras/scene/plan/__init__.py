"""Plans: the smallest cube, wavelengths and texture format that keep a scene's colours
within a tolerance.

Each decision is measured on colours of the scene's own textures; docs/plan.md describes
the method.

    from uplift.extras.scene import plan

    result = plan.plan(plan.read_scene_file("kitchen.toml"))
    result.chosen.name, result.confirmed.quantile, result.chosen.cube
"""

from uplift.extras.scene.plan.files import SceneFile, read_scene_file
from uplift.extras.scene.plan.planning import Plan, plan

__all__ = ["Plan", "SceneFile", "plan", "read_scene_file"]
