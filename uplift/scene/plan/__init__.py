"""A plan for a scene: the least that will do, measured on its own colours (docs/plan.md).

from uplift.scene import plan

found = plan.plan(plan.read_scene_file("kitchen.toml"))
found.confirmed.quantile, found.options, found.sampling.wavelengths
"""

from __future__ import annotations

from uplift.scene.plan.context import SearchGrid
from uplift.scene.plan.plan_file import PlanFile, read_plan, to_json
from uplift.scene.plan.planning import Plan, plan
from uplift.scene.plan.scene_file import SceneFile, read_scene_file

__all__ = ["Plan", "PlanFile", "SceneFile", "SearchGrid", "plan", "read_plan", "read_scene_file", "to_json"]
