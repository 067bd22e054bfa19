"""Relighting page: mixes the lights of a palette on a picture of its materials in real time."""

from __future__ import annotations

from uplift.design.palette.relight_viewer.cutaway import cutaway
from uplift.design.palette.relight_viewer.page import page
from uplift.design.palette.relight_viewer.picture_file import read_weights
from uplift.design.palette.relight_viewer.relighting import Lights, Materials, Relighting, relighting

__all__ = ["Lights", "Materials", "Relighting", "cutaway", "page", "read_weights", "relighting"]
