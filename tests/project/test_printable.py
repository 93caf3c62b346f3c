"""Messages in words keep to 80 columns."""

from __future__ import annotations

import pytest

from udec_ia.printable_text import folded


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("short", ["short"]),
        ("", [""]),
        ("one\ntwo", ["one", "two"]),
        ("  " + "word " * 17, ["  " + " ".join(["word"] * 15), "      word word"]),
        ("a" * 90, ["a" * 90]),
        ("x " + "a" * 90 + " half-way", ["x", "    " + "a" * 90, "    half-way"]),
    ],
)
def test_what_is_said_keeps_to_the_width_of_a_terminal(text: str, lines: list[str]) -> None:
    assert folded(text) == "\n".join(lines)
