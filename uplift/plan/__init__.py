"""A plan for a scene: the least that will do, measured on its own colours (docs/plan.md).

from uplift import plan

found = plan.plan(plan.read_brief("kitchen.toml"))
"""

from __future__ import annotations

from uplift.plan.bench import Effort, Step
from uplift.plan.brief import Brief, read_brief
from uplift.plan.planning import Plan, plan

__all__ = ["Brief", "Effort", "Plan", "Step", "plan", "read_brief"]
