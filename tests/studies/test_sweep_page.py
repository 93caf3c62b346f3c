"""docs/sweep.md: its commands print what stands below them, but for seconds, and its Python runs."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from udec_ia.cli import main
from udec_ia.studies.quantities import read_quantities, read_rule

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "sweep.md").read_text()
SHOWN = re.findall(r"^    \$ udec (.*)\n((?:    .*\n)*)", TEXT, re.M)
(PYTHON,) = re.findall(r"^```python\n(.*?)^```", TEXT, re.M | re.S)
SECONDS = re.compile(r"(?<=cycles, )[\d.]+ s|(?<=\d)  +[\d.]+(?=  +\d+$)| {2,}(?=(cycles|seconds))")


def without_seconds(text: str) -> list[str]:
    """The lines with nothing in the place of what depends on the machine."""
    return [SECONDS.sub("", line) for line in text.splitlines()]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the examples."""
    made = tmp_path_factory.mktemp("sweep")
    (made / "examples").symlink_to(ROOT / "examples")
    return made


def test_the_page_shows_what_is_printed(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    assert len(SHOWN) == 2
    for command, shown in SHOWN:
        assert main(shlex.split(command)) == 0
        expected = "".join(f"{line[4:]}\n" for line in shown.splitlines())
        assert without_seconds(capsys.readouterr().out) == without_seconds(expected)


def test_the_velocities_are_those_of_a_sliding_block(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What gravity leaves, for 600 time-steps; and on top of it the block swings on the springs of its joint.

    These let go at most the weight along the slope, m g / sqrt(5): a speed of that over the circular
    frequency, sqrt(2 KS / m), where m = 8000 kg per m stands on two contacts.
    """
    monkeypatch.chdir(folder)
    for command, _ in SHOWN:
        assert main(shlex.split(command)) == 0
    swing = 10 / 5**0.5 / (2 * 1e8 / 8000) ** 0.5
    rows = (folder / "incline-sweep" / "incline.csv").read_text().splitlines()[1:]
    assert len(rows) == 3
    for row in rows:
        friction, v = map(float, row.split(",")[1:3])
        assert v == pytest.approx(min(0, -4.293 * (1 - 2 * friction)), abs=swing)


def test_the_python_of_the_page(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    exec(compile(PYTHON, "docs/sweep.md", "exec"), {})


def test_every_quantity_that_is_named_is_one() -> None:
    (table,) = re.findall(r"^\| quantity .*\n\|.*\n((?:\|.*\n)*)", TEXT, re.M)
    named = [text for row in table.splitlines() for text in re.findall(r"`([^`]+)`", row.split("|")[1])]
    assert len(read_quantities(named)) == len(named) > 10
    for rule in re.findall(r'--stop "([^"]+)"', TEXT):
        read_rule(rule)
