"""The Python face: what only Python users meet. Errors that say what to do, paths, and the log."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from udec_ia import Model, UdecError
from udec_ia.deck.command_table import COMMANDS
from udec_ia.errors import MESSAGES
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets as g

ROOT = Path(__file__).parents[2]
SQUARE = (0, 0, 0, 1, 1, 1, 1, 0)

WRONG: list[tuple[str, int, Callable[[Model], object]]] = [
    ("material", 4, lambda m: m.property(51, kn=1.0)),
    ("two corners", 5, lambda m: m.block(0, 0, 1, 1)),
    ("anticlockwise", 6, lambda m: m.block(0, 0, 1, 0, 1, 1)),
    ("crossed", 6, lambda m: m.block(0, 0, 2, 2, 2, 0, 0, 1)),
    ("turned back", 6, lambda m: m.block(0, 0, 0, 1, 1, 1, 1, 0, 2, 0)),
    ("repeated", 6, lambda m: m.block(0, 0, 0, 0, 0, 1, 1, 1)),
    ("no y", 8, lambda m: m.block(0, 0, 1)),
    ("constitutive", 9, lambda m: m.block(*SQUARE, constitutive=6)),
    ("half a cycle", 10, lambda m: m.cycle(0.5)),  # type: ignore[arg-type]
    ("half a material", 10, lambda m: m.property(1.5)),  # type: ignore[arg-type]
    ("half an address", 10, lambda m: m.dump(1.0, 10)),  # type: ignore[arg-type]
    ("damping of what", 10, lambda m: m.damping(0.1, 1, "all")),
    ("type", 10, lambda m: m.change(0, 1, 0, 1, type="soft")),
    ("force in words", 10, lambda m: m.boundary(0, 1, 0, 1, xforce="much")),  # type: ignore[arg-type]
    ("pressure", 10, lambda m: m.boundary(0, 1, 0, 1, stress=1e5)),  # type: ignore[arg-type]
    ("stress in words", 10, lambda m: m.boundary(0, 1, 0, 1, stress="111")),  # type: ignore[arg-type]
    ("two stresses", 26, lambda m: m.boundary(0, 1, 0, 1, stress=(1e5, 0))),  # type: ignore[arg-type]
    ("sine without end", 10, lambda m: m.boundary(0, 1, 0, 1, xforce=1.0, sine=5.0)),  # type: ignore[arg-type]
    ("two gradients", 26, lambda m: m.insitu(0, 1, 0, 1, 1, 0, 1, (1, 0))),  # type: ignore[arg-type]
    ("no stiffness", 11, lambda m: (m.block(*SQUARE) and m.property(1, density=1.0)) or m.cycle(1)),
    ("no mass", 12, lambda m: m.block(*SQUARE) and m.cycle(1)),
    ("long rounding", 14, lambda m: m.block(*SQUARE) and m.round(0.6)),
    ("long rounding first", 14, lambda m: m.round(0.6) or m.block(*SQUARE)),
    ("second block", 18, lambda m: m.block(*SQUARE) and m.block(*SQUARE)),
    ("last block", 19, lambda m: m.block(*SQUARE) and m.delete(0, 1, 0, 1)),
    ("half a point", 8, lambda m: m.function(1, 0, 0, 1)),
    ("zones of nothing", 26, lambda m: m.block(*SQUARE) and m.generate(0, 1, 0, 1, "manual")),
    ("load on nothing", 24, lambda m: m.boundary(0, 1, 0, 1, xforce=1.0)),
    ("stress in nothing", 24, lambda m: m.insitu(0, 1, 0, 1, 1.0, 0.0, 0.0)),
    ("load without end", 28, lambda m: m.boundary(0, 1, 0, 1, stress=(0.0, np.inf, 0.0))),
    ("no sine", 28, lambda m: m.boundary(0, 1, 0, 1, xforce=1.0, sine=(0.0, 1.0))),
    ("back in time", 28, lambda m: m.function(1, 0, 0, 0, 1)),
    ("function of no number", 28, lambda m: m.function(0, 0, 0)),
    ("zones of no size", 7, lambda m: m.block(*SQUARE) and m.generate(0, 1, 0, 1, "automatic")),
    ("zones of no kind", 22, lambda m: m.block(*SQUARE) and m.generate(0, 1, 0, 1, "somehow")),
    ("zones of no block", 24, lambda m: m.generate(0, 1, 0, 1, "automatic")),
    ("no blocks", 26, lambda m: m.cycle(1)),
    ("not a number", 28, lambda m: m.gravity(0, np.nan)),
    ("infinite", 28, lambda m: m.split(0, 0, np.inf, 1)),
    ("negative", 28, lambda m: m.property(1, friction=-0.5)),
    ("no frequency", 28, lambda m: m.damping(0.1, 0)),
    ("no fraction", 28, lambda m: m.fraction(0)),
    ("no scale", 28, lambda m: m.scale(-1)),
    ("no line", 28, lambda m: m.split(1, 1, 1, 1)),
    ("backwards", 28, lambda m: m.cycle(-1)),
    ("endless", 28, lambda m: m.cycle(2**70)),
    ("which frame", 28, lambda m: m.plot(2)),
    ("far away", 28, lambda m: m.block(1e13, 0, 1e13, 1, 1e13 + 1, 1)),
    ("huge", 28, lambda m: m.block(0, 0, 0, 1e80, 1e80, 1e80)),
    ("tiny", 28, lambda m: m.block(0, 0, 0, 1e-80, 1e-80, 1e-80)),
    ("no restart file", 29, lambda m: m.restart("there/is/none.h5")),
    ("odd address", 30, lambda m: m.rset(1, 2, 1)),
    ("dump", 30, lambda m: m.dump(3, 2)),
]

CORNERS = [(0, 0), (0, 1), (1, 1), (1, 0)]
GENERATED: list[tuple[str, int, dict[str, Any]]] = [
    ("zone of two", 26, {"zones": [(1, 2), (1, 3, 4)]}),
    ("zone of four", 10, {"zones": [(1, 2, 3, 4)]}),
    ("half a grid-point", 10, {"zones": [(1, 1.5, 3)]}),
    ("zones in one row", 10, {"zones": [1, 2, 3]}),
    ("a number of zones", 10, {"zones": 2}),
    ("grid-points in space", 10, {"gridpoints": [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)]}),
    ("grid-points in words", 10, {"gridpoints": ["ab", "cd"]}),
    ("edge in words", 10, {"mode": "automatic", "gridpoints": None, "zones": None, "edge": "a"}),
]


@pytest.mark.parametrize(("what", "number", "wrong"), GENERATED)
def test_what_has_another_shape_is_refused(what: str, number: int, wrong: dict[str, Any]) -> None:
    m = Model()
    m.block(*SQUARE)
    given: dict[str, Any] = {"mode": "manual", "gridpoints": CORNERS, "zones": [(1, 2, 3), (1, 3, 4)]} | wrong
    with pytest.raises(UdecError) as caught:
        m.generate(0, 1, 0, 1, **given)
    assert caught.value.number == number
    assert caught.value.parameter in wrong
    assert str(caught.value).endswith(caught.value.advice)


def test_arrays_of_numpy_are_lists_and_words_have_any_case() -> None:
    m = Model()
    m.round(0.05)
    ib = m.block(*SQUARE)
    assert m.change(0, 1, 0, 1, type="SDEF") == 1
    assert len(m.table("sdef")) == 1
    zones = np.array([(1, 2, 3), (1, 3, 4)])
    assert m.generate(0, 1, 0, 1, "MANUAL", np.array(CORNERS, float), zones) == ib  # type: ignore[arg-type]
    assert len(m.table("zone")) == 2


@pytest.mark.parametrize(("number", "wrong"), [row[1:] for row in WRONG], ids=[row[0] for row in WRONG])
def test_every_error_says_what_to_do(number: int, wrong: Callable[[Model], object]) -> None:
    with pytest.raises(UdecError) as caught:
        wrong(Model())
    assert caught.value.number == number
    assert len(caught.value.advice) > 5
    assert str(caught.value).endswith(caught.value.advice)


def test_every_command_has_its_method() -> None:
    methods = {name for name in dir(Model) if callable(getattr(Model, name))}
    for_decks_alone = {"default", "call"}
    assert {command.name for command in COMMANDS} - for_decks_alone <= methods


def test_every_public_name_is_documented() -> None:
    """In docs/python.md, which names nothing else; a user may call what it names."""
    page = (ROOT / "docs/python.md").read_text()
    tables = page[page.index("## Commands") : page.index("## Copies")]
    named = {
        name for row in tables.splitlines() if row.startswith("| `") for name in re.findall(r"`(\w+)`", row)
    }
    public = {name for name in {*dir(Model), *vars(Model())} if not name.startswith("_")}
    assert named - {"None", "udec_ia"} == public


def test_help_and_end_are_those_of_a_deck(tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    shown = m.run("HELP\nHELP prop\nSTART\n")
    assert shown == f"> HELP\n{m.help()}\n> HELP prop\n{m.help('prop')}\n> START\n"
    m.block(*SQUARE)
    m.plot()
    assert "1 block," in m.end()
    assert (tmp_path / "udec-plot-1.png").exists()


def test_no_error_is_without_advice() -> None:
    assert all(UdecError(number).advice for number in MESSAGES)


@pytest.mark.parametrize("build", ["i16r32", "i32r32"])
@pytest.mark.parametrize(
    "line",
    [
        "GRAVITY 0 -1E39",
        "PROP MAT=1 KN=1E39",
        "PROP MAT=1 BULK=3E38 G=3E38",
        "DAMP 1E38 1E10",
        "DAMP 1 1E-45",
        "FRACTION 1E39",
        "SCALE 1E39",
        "ROUND 1E39",
        "SPLIT 0 0 1E39 0",
        "BLOCK 0,0 0,1E10 1E10,1E10",
    ],
)
def test_a_number_that_32_bits_cannot_hold_is_refused(build: str, line: str, tmp_path: Path) -> None:
    """It would have become infinite, silently."""
    m = Model(build=build, out=tmp_path)
    with pytest.raises(UdecError) as caught:
        m.run(f"START\n{line}\n")
    assert caught.value.number == 28
    assert np.isfinite(m.h.cr).all()


@pytest.mark.parametrize("mtop", [1e5, "100000", [1]])
def test_a_size_that_is_no_integer_is_refused(mtop: object) -> None:
    with pytest.raises(TypeError, match="mtop is a number of words, an integer, not "):
        Model(mtop=mtop)  # type: ignore[arg-type]
    assert Model(mtop=np.int64(1000)).session.mtop == 1000  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["nothere.dat", "no where/nothere.dat", "P.dat", "run-2.d"])
def test_a_deck_that_is_not_there(name: str, tmp_path: Path) -> None:
    for given in (name, Path(name)):
        with pytest.raises(FileNotFoundError, match="No such file") as caught:
            Model(out=tmp_path).run(given)
        assert str(caught.value.filename) == name


@pytest.mark.parametrize(
    ("text", "number"),
    [("PROPS MAT=1 KN=1.E8", 2), ("STRAT", 2), ("CYCLE 1", 3), ("SAVE x.h5", 3), ("nothere.dat\n", 2)],
)
def test_text_that_does_not_look_like_a_path_is_a_deck(text: str, number: int, tmp_path: Path) -> None:
    with pytest.raises(UdecError) as caught:
        Model(out=tmp_path).run(text)
    assert caught.value.number == number


def test_paths_start_from_the_working_directory_and_in_a_deck_from_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    m = Model(out="o")
    m.block(*SQUARE)
    assert m.save() == Path("o/restart.h5")
    assert m.save("here.h5") == Path("here.h5")
    assert m.save("o/x.h5") == Path("o/x.h5")
    m.run("SAVE y.h5\nRESTART x.h5\n")
    m.restart("o/y.h5")
    m.restart()
    written = sorted(path.as_posix() for path in Path().rglob("*.h5"))
    assert written == ["here.h5", "o/restart.h5", "o/x.h5", "o/y.h5"]
    assert len(Model.restore("o/x.h5").table("block")) == 1


@pytest.mark.parametrize("name", ["../elsewhere/x.h5", "{}/elsewhere/x.h5"])
def test_save_creates_folders_within_out_only(name: str, tmp_path: Path) -> None:
    m = Model(out=tmp_path / "out")
    m.block(*SQUARE)
    with pytest.raises(UdecError) as caught:
        m.run(f"SAVE {name.format(tmp_path)}\n")
    assert caught.value.number == 31
    assert not (tmp_path / "elsewhere").exists()
    (tmp_path / "elsewhere").mkdir()
    m.run(f"SAVE {name.format(tmp_path)}\nSAVE in/x.h5\n")
    assert (tmp_path / "elsewhere/x.h5").exists()
    assert (tmp_path / "out/in/x.h5").exists()


def test_the_folder_for_files_may_be_set_later_and_as_text(tmp_path: Path) -> None:
    m = Model()
    m.out = str(tmp_path)
    m.block(*SQUARE)
    assert m.save() == tmp_path / "restart.h5"


def test_an_interpreted_run_does_not_say_that_it_compiles(tmp_path: Path) -> None:
    code = (
        "from udec_ia import Model\n"
        "m = Model()\n"
        "m.property(1, density=1000, kn=1e6, ks=1e6)\n"
        "m.block(0, 0, 0, 1, 1, 1, 1, 0)\n"
        "print(m.cycle(1), m.stop())\n"
    )
    env = {**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": str(ROOT), "UDEC_CACHE": str(tmp_path)}
    command, both = [sys.executable, "-u", "-c", code], subprocess.STDOUT
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=both, text=True, env=env, check=True)
    assert re.fullmatch(r"1 1 cycle .*; no file written; \d+\.\d s\n", done.stdout)


def test_every_scheme_is_a_build() -> None:
    with pytest.raises(ValueError, match="i16r32, i32r32") as caught:
        Model("i8r8")
    assert all(name in str(caught.value) for name in ALL_SCHEMES)


def test_the_error_of_no_damping_names_how_to_switch_it_off() -> None:
    m = Model()
    with pytest.raises(UdecError) as caught:
        m.damping(0, 0)
    assert (caught.value.number, caught.value.parameter) == (28, "freq")
    assert "DAMPING 0 1" in caught.value.advice
    m.damping(local=0.8)
    m.damping(0, 1)
    assert (m.h.cr[[g.ALPHA, g.BETA]] == 0).all()
    assert m.h.ci[g.LREST] == 0


def test_with_closes_the_files_also_after_an_error(tmp_path: Path) -> None:
    def draw_and_fail() -> None:
        with m:
            m.block(*SQUARE)
            m.plot()
            assert m.session.plots is not None
            assert m.session.plots.frame is not None
            raise ZeroDivisionError

    m = Model(out=tmp_path)
    with pytest.raises(ZeroDivisionError):
        draw_and_fail()
    assert m.session.plots is not None
    assert m.session.plots.frame is None
