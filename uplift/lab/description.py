"""Texts about a method: a stored chart is read without the methods themselves."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Description:
    """Texts about a method: columns of the table of a chart.

    ``method``, ``title``: name for the command line, and name to display. ``label``:
    label of its marker, by default the title. ``family``: name in the legend, by
    default the title up to a comma. ``source``: publication. ``mode``: mode of lookup
    of a cube, which determines the shape of the marker. ``build``, ``call``: command
    and call that give a user of this package the same; empty for other methods.
    """

    method: str
    title: str
    label: str = ""
    family: str = ""
    source: str
    mode: str = ""
    dtype: str = "float64"
    build: str = ""
    call: str = ""
    note: str = ""
