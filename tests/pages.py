"""HTML pages as tests read them: elements, texts and tables."""

import json
import re
from collections import Counter
from dataclasses import dataclass, field
from html.parser import HTMLParser

VOID_ELEMENTS = ("br", "img", "input", "meta")
"""Elements without content or end tag."""


@dataclass
class Cell:
    """A table cell: its tag, attributes and texts; ``parts`` are the texts of its
    innermost elements.
    """

    tag: str
    attributes: dict
    parts: list = field(default_factory=list)

    @property
    def text(self):
        return " ".join(self.parts)

    @property
    def value(self):
        """The number that the column is sorted by."""
        return float(self.attributes["data-value"])


def texts(row):
    return [cell.text for cell in row]


class Page(HTMLParser):
    """A page that must be well formed: every element ends where it should.

    ``tags`` and ``attributes`` list those of all elements, ``tables`` the rows of every
    table, ``text`` is the visible text.
    """

    def __init__(self, html):
        super().__init__()
        self.open = []
        self.tags = []
        self.attributes = []
        self.words = []
        self.tables = []
        self.feed(html)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs
        if tag not in VOID_ELEMENTS:
            self.open.append(tag)
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append([])
        elif tag in ("td", "th"):
            self.tables[-1][-1].append(Cell(tag, dict(attrs)))

    def handle_startendtag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] in ("style", "script"):
            return
        self.words.append(data)
        if data.strip() and ("td" in self.open or "th" in self.open):
            self.tables[-1][-1][-1].parts.append(data.strip())

    @property
    def text(self):
        return " ".join(" ".join(self.words).split())

    def table(self, *headings):
        """The body rows of the only table that begins with these headings."""
        (body,) = [
            body
            for head, *body in self.tables
            if texts(head)[: len(headings)] == list(headings)
        ]
        return body


def markers(html):
    """Numbers of the panel and of the row of every marker, counted."""
    found = re.findall(r'id="marker-(\d+)-(\d+)"', html)
    return Counter((int(panel), int(row)) for panel, row in found)


def tooltips(html):
    """The rows that the script of a page shows at its markers."""
    (data,) = re.findall(r'json" id="rows">(.*?)</script>', html, re.DOTALL)
    return json.loads(data)


def external_links(html):
    """Addresses that a browser would load."""
    page = Page(html)
    links = [
        value
        for name, value in page.attributes
        if name in ("src", "srcset", "href", "xlink:href")
    ]
    return [link for link in links if not link.startswith("#")] + [
        tag for tag in page.tags if tag in ("link", "iframe", "object")
    ]
