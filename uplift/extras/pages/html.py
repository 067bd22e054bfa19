"""Self-contained HTML pages from Jinja2 templates.

A page loads nothing and runs no script but its own, by its content security policy.
Templates are named by their path below the package, as
``extras/report/templates/page.html.j2``, and lie next to the code that renders them.
All values are escaped unless they are `markupsafe.Markup`; a name that a template does
not receive is an error. The filters are the functions of `uplift.extras.pages.format`
under their own names, and ``fixed``.
"""

import base64
import hashlib
import json
from functools import cache
from importlib.resources import files
from typing import Any, TypedDict

import jinja2
from markupsafe import Markup

from uplift.common.text import json_escapes, printable
from uplift.extras.pages import format as formats

__all__ = ["Markup", "Tooltip", "environment", "render", "resource"]


class Tooltip(TypedDict):
    """Tooltip of the markers of one row, for pages that extend
    ``extras/pages/templates/interactive.html.j2``.

    The parts of the picture that belong to row r have the identifiers
    ``marker-<panel>-<r>``, ``whisker-<panel>-<r>`` and ``label-<panel>-<r>``.
    ``family`` is the checkbox that hides them; ``lines`` are names and values, a line
    without a name takes the full width.
    """

    title: str
    family: str
    lines: list[tuple[str, str]]


def render(template: str, /, **values: Any) -> str:
    """Render a template as text that needs no other file."""
    return environment().get_template(template).render(**values)


def resource(*paths: str) -> Markup:
    """Read style sheets or scripts to be inlined in a page."""
    return Markup(
        "".join(
            files("uplift").joinpath(path).read_text(encoding="utf-8") for path in paths
        )
    )


def content_security_policy(script: str) -> str:
    """Return the policy of a page: no addresses, and no script but one."""
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    scripts = f"'sha256-{digest}'" if script else "'none'"
    return (
        f"default-src 'none'; script-src {scripts}; style-src 'unsafe-inline'; "
        "img-src data:; base-uri 'none'; form-action 'none'"
    )


@cache
def environment() -> jinja2.Environment:
    """Return what templates are rendered with, for those outside the package as
    well.
    """
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("uplift", ""),
        autoescape=True,
        finalize=_finalize,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.policies["json.dumps_function"] = _json
    environment.globals |= {
        "resource": resource,
        "content_security_policy": content_security_policy,
    }
    environment.filters |= {name: getattr(formats, name) for name in formats.__all__}
    environment.filters["fixed"] = _fixed
    return environment


def _finalize(value: Any) -> Any:
    """Escape control characters and marks of writing direction in texts, which come
    from files.
    """
    if isinstance(value, str) and not isinstance(value, Markup):
        return "\n".join(map(printable, value.split("\n")))
    return value


def _json(values: Any, **options: Any) -> str:
    return json_escapes(
        json.dumps(values, **options | {"ensure_ascii": False, "allow_nan": False})
    )


def _fixed(value: float, digits: int) -> str:
    return f"{value:.{digits}f}"
