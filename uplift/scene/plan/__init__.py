"""A plan for a scene: the least that will do, measured on its own colours (docs/plan.md).

from uplift.scene import plan

found = plan.plan(plan.read_brief("kitchen.toml"))
found.confirmed.quantile, found.options, found.sampling.wavelengths
"""

from __future__ import annotations

from uplift.scene.plan.context import Effort
from uplift.scene.plan.plan_file import Planned, numbers, read_plan
from uplift.scene.plan.planning import Plan, plan
from uplift.scene.plan.scene_file import Brief, read_brief

__all__ = ["Brief", "Effort", "Plan", "Planned", "numbers", "plan", "read_brief", "read_plan"]
