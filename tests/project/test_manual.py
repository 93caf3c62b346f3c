"""The manual does what it shows: lessons, short answers and notebooks are run, and the site has no dead link."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import matplotlib
import pytest
from support.page_runner import agrees, fenced_blocks, missing_line, run_page

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
LESSONS = sorted((DOCS / "tutorial").glob("*.md"))


def test_there_are_five_lessons_each_with_a_deck_or_python_and_exercises() -> None:
    assert [page.name[0] for page in LESSONS] == list("12345")
    for page in LESSONS:
        assert {"deck", "python"} & {block.language for block in fenced_blocks(page)}
        assert "\n## Exercises\n" in page.read_text()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One folder for all lessons, as a reader has it."""
    return tmp_path_factory.mktemp("lessons")


@pytest.mark.parametrize("page", LESSONS, ids=lambda page: page.stem)
def test_a_lesson_prints_what_it_shows(page: Path, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    matplotlib.use("Agg")
    if "CALL rock.dat" in page.read_text():
        (rock,) = [block for block in fenced_blocks(LESSONS[1]) if block.name == "rock.dat"]
        (folder / "rock.dat").write_text(rock.text)
    assert run_page(page, folder) == []


def test_short_answers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """docs/how-do-i.md: 20 to 40 questions, whose lines run and print what they show."""
    monkeypatch.chdir(tmp_path)
    page = DOCS / "how-do-i.md"
    assert 20 <= page.read_text().count("\n### How do I") <= 40
    assert run_page(page, tmp_path) == []


def test_what_a_page_shows_is_compared() -> None:
    assert agrees("ratio ... after 100 cycles", "ratio 0.3: it is 1 after 100 cycles")
    assert agrees("a  2.50 m", "a 2.501 m")
    assert not agrees("a  2.50 m", "a 2.60 m")
    assert not agrees("1 block", "1 block has fallen")
    assert missing_line("one\ntwo\n", "one\nother\ntwo\n") == ""
    assert missing_line("two\none\n", "one\nother\ntwo\n") == "one"
