"""Speed against accuracy: methods of spectral upsampling on the same colours and measured spectra."""

from __future__ import annotations

from uplift.lab.chart.recommend import Requirement, recommend_cube, shipped_chart
from uplift.lab.chart.table import Chart, State, chart_csv, parse_chart, read_chart
from uplift.lab.chart.task import Effort, Task, make_task

__all__ = [
    "Chart",
    "Effort",
    "Requirement",
    "State",
    "Task",
    "chart_csv",
    "make_task",
    "parse_chart",
    "read_chart",
    "recommend_cube",
    "shipped_chart",
]
