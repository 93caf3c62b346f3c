"""docs/studies/stability_page.py replaces the tables of docs/stability.md and leaves its text."""

from __future__ import annotations

import runpy
import shlex
from pathlib import Path
from types import SimpleNamespace

import pytest

stability = SimpleNamespace(
    **runpy.run_path(str(Path(__file__).parents[2] / "docs" / "studies" / "stability_page.py"))
)

SECTION = (
    "\n    python some.py --out docs/images/a.png\n\nWords | with a bar.\n\n| a |\n|---|\n| 1 |\n\nMore.\n"
)


def test_the_tables_of_a_section_are_those_that_are_printed_and_the_words_stay() -> None:
    asked = []

    def run(command: str) -> str:
        asked.append(command)
        return "told first\n| a |\n|---|\n| 2 |\n| 3 |\n- a remark\n"

    found = stability.renewed(SECTION, run)
    assert asked == ["some.py --out docs/images/a.png"]
    assert found == SECTION.replace("| 1 |\n", "| 2 |\n| 3 |\n")


@pytest.mark.parametrize("printed", ["", "| a |\n|---|\n\n| b |\n|---|\n"])
def test_another_number_of_tables_is_refused(printed: str) -> None:
    with pytest.raises(ValueError, match=r"where the page has 1: some\.py"):
        stability.renewed(SECTION, lambda _: printed)


def test_each_section_names_a_tool_that_is_there_and_shows_its_picture() -> None:
    found = stability.sections(stability.PAGE.read_text())
    assert len(found) > 5
    for text in found.values():
        command = stability.COMMAND.search(text)
        assert command
        script, *options = shlex.split(command[1])
        assert (stability.ROOT / script).is_file()
        assert stability.tables(text)
        if "--out" in options:
            picture = options[options.index("--out") + 1]
            assert f"({picture.removeprefix('docs/')})" in text
            assert (stability.ROOT / picture).is_file()
