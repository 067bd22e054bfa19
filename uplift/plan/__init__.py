"""A plan for a scene: the least that will do, measured on its own colours (docs/plan.md).

from uplift import plan

found = plan.plan(plan.read_brief("kitchen.toml"))
found.confirmed.quantile, found.options, found.sampling.wavelengths
"""

from __future__ import annotations

from uplift.plan.bench import Effort, Step
from uplift.plan.brief import Brief, read_brief
from uplift.plan.file import Planned, numbers, read_plan
from uplift.plan.planning import Plan, plan

__all__ = ["Brief", "Effort", "Plan", "Planned", "Step", "numbers", "plan", "read_brief", "read_plan"]
