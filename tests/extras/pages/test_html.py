"""Pages from templates: escaping, missing names, shared parts."""

import html
import re

import jinja2
import pytest

from uplift.extras.pages.html import content_security_policy, environment, render

HOSTILE = "</script><b title='\"'>&"
BASE = "extras/pages/templates/base.html.j2"


def rendered(template, **values):
    source = '{% import "extras/pages/templates/macros.html.j2" as parts %}' + template
    return environment().from_string(source).render(**values).strip()


def test_page_escapes_its_texts():
    page = render(BASE, title=HOSTILE, lead=HOSTILE)
    assert HOSTILE not in page
    assert page.count("&lt;/script&gt;&lt;b title=&#39;&#34;&#39;&gt;&amp;") == 3
    assert page.startswith('<!DOCTYPE html>\n<html lang="en">')


def test_missing_value_is_an_error():
    with pytest.raises(jinja2.UndefinedError, match="'lead' is undefined"):
        render(BASE, title="")


def test_json_cannot_end_its_script():
    text = rendered("<script>{{ rows | tojson }}</script>", rows=[HOSTILE, "ΔE00"])
    assert text.count("</script>") == 1
    assert "ΔE00" in text
    with pytest.raises(ValueError, match="not JSON compliant"):
        rendered("{{ rows | tojson }}", rows=[float("nan")])


def test_the_script_of_a_stored_page_is_the_one_that_its_policy_allows(repository):
    """A browser runs no other, such as one that was changed by hand."""
    for path in (repository / "docs").rglob("*.html"):
        page = path.read_text("utf-8")
        for script in re.findall('<script type="module">(.*?)</script>', page, re.S):
            assert content_security_policy(script) in html.unescape(page), path
