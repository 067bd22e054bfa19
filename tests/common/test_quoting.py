"""Received values in messages."""

from __future__ import annotations

from uplift.common.quoting import format_value


def test_values_are_shortened():
    assert format_value("a" * 100) == "'" + "a" * 39 + "…"


def test_every_value_has_a_text_without_control_characters():
    deep: list[object] = []
    for _ in range(100_000):
        deep = [deep]
    for value in ("\x1b]0;title\x07", "\ud800", "\u202e", "\n", 16**5000, deep):
        text = format_value(value)
        assert text.isprintable()
        assert text.encode()
