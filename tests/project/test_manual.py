"""The manual does what it shows: lessons, short answers and notebooks run, and the site has no dead link."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import matplotlib
import nbclient
import nbformat
import numpy as np
import pytest
from support.page_runner import agrees, fenced_blocks, missing_line, run_page

from udec_ia import Model

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
LESSONS = sorted((DOCS / "tutorial").glob("*.md"))


def test_there_are_five_lessons_each_with_a_deck_or_python_and_exercises() -> None:
    assert [page.name[0] for page in LESSONS] == list("12345")
    for page in LESSONS:
        languages = {block.language for block in fenced_blocks(page)}
        assert languages & {"deck", "python"}
        assert languages <= {"deck", "console", "python", "output", "sh"}  # sh: only the installation
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


@pytest.mark.parametrize("name", ["histories", "loading"])
def test_python_of_other_pages(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert run_page(DOCS / f"{name}.md", tmp_path) == []


def test_forces_do_not_depend_on_units() -> None:
    """docs/units.md: the same model in N and kg, and in kN and t."""
    found = []
    for unit in (1.0, 1000.0):
        m = Model()
        m.property(1, density=2500 / unit, kn=1e9 / unit, ks=1e9 / unit, friction=0.5)
        m.gravity(3, -9)
        m.block(0, 0, 0, 3, 4, 3, 4, 0)
        m.split(-1, 1, 5, 1)
        m.round(0.05)
        m.fix(0, 4, 0, 1)
        m.damping(local=0.8)
        m.solve(1e-5)
        found.append(unit * m.table("contact")["KCFN"])
    assert found[0].sum() == pytest.approx(2500 * 8 * 9, rel=1e-4)
    np.testing.assert_allclose(found[0], found[1], rtol=1e-9)


def test_signs() -> None:
    """docs/units.md: a block slides to the right on a floor. Compression, slip and reactions."""
    m = Model()
    m.property(1, density=2500, kn=1e9, ks=1e9, friction=0.1)
    m.gravity(5, -8.66)
    m.block(0, 0, 0, 1, 6, 1, 6, 0)
    m.block(2, 1, 2, 3, 4, 3, 4, 1)
    m.fix(0, 6, 0, 1)
    m.damping(0.5, 50, "stiffness")
    m.cycle(300)
    above = next(row for row in m.table("block") if row["KY"] > 1)
    assert above["KXD"] > 0
    for contact in m.table("contact"):
        normal = 1 if contact["KB2"] == above["address"] else -1  # upwards or downwards, from KB1 to KB2
        tangent = -normal  # along x: the normal turned anticlockwise
        second = above["KXD"] if normal > 0 else -above["KXD"]  # velocity of KB2 relative to KB1
        assert contact["KCFN"] > 0
        assert contact["KCN"] > 0
        assert np.sign(contact["KCS"]) == np.sign(second * tangent)
    assert m.reactions()["fx"].sum() < 0 < m.reactions()["fy"].sum()


@pytest.mark.parametrize("page", sorted((DOCS / "notebooks").glob("*.ipynb")), ids=lambda page: page.stem)
def test_a_notebook_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its cells have no error; they assert what they claim."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]))
    monkeypatch.setenv("PYTHONWARNINGS", "ignore")
    notebook = nbformat.read(page, as_version=4)
    nbclient.NotebookClient(
        notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}
    ).execute()
    assert sum(cell.cell_type == "code" for cell in notebook.cells) >= 5


def test_a_figure_is_shown_that_pyplot_has_not_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]))
    notebook = nbformat.v4.new_notebook()
    code = "from udec_ia import Model\nm = Model()\nm.block(0, 0, 0, 1, 1, 1, 1, 0)\nm.figure().figure"
    notebook.cells = [nbformat.v4.new_code_cell(code)]
    nbclient.NotebookClient(
        notebook, timeout=100, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}
    ).execute()
    (output,) = (one for one in notebook.cells[0].outputs if one.output_type == "execute_result")
    assert "image/png" in output.data


def test_every_example_is_in_the_gallery() -> None:
    page = (DOCS / "gallery.md").read_text()
    for deck in (ROOT / "examples").glob("*.dat"):
        assert f"(../examples/{deck.name})" in page
        picture = DOCS / "images" / "gallery" / f"{deck.stem}.png"
        assert f"(images/gallery/{picture.name})" in page
        assert picture.stat().st_size < 150_000


def test_the_site_has_no_dead_link_and_all_its_equations(tmp_path: Path) -> None:
    """`mkdocs build --strict`, and MathML in place of every equation."""
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "-d", str(tmp_path / "site")],
        cwd=ROOT,
        env=os.environ | {"NO_MKDOCS_2_WARNING": "1"},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    for page in (DOCS / "theory").glob("*.md"):
        made = (tmp_path / "site" / "theory" / f"{page.stem}.html").read_text()
        written = re.sub(r"`[^`]*`", "", page.read_text()).replace("$$", "$").count("$") // 2
        assert made.count("<math ") == written
        assert "arithmatex" not in made
    reference = (tmp_path / "site" / "api.html").read_text()
    methods = {name for name in dir(Model) if not name.startswith("_") and callable(getattr(Model, name))}
    assert len(methods) > 60
    assert {name for name in methods if f'id="udec_ia.model.model.Model.{name}"' not in reference} == set()
    assert reference.count("doc-section-title") > 3 * len(methods)  # Parameters, Returns, Examples ...


def test_what_a_page_shows_is_compared() -> None:
    assert agrees("ratio ... after 100 cycles", "ratio 0.3: it is 1 after 100 cycles")
    assert agrees("a  2.50 m", "a 2.501 m")
    assert not agrees("a  2.50 m", "a 2.60 m")
    assert not agrees("1 block", "1 block has fallen")
    assert missing_line("one\ntwo\n", "one\nother\ntwo\n") == ""
    assert missing_line("two\none\n", "one\nother\ntwo\n") == "one"
