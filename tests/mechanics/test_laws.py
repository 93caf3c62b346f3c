"""Laws of the user's: found, looked at, compiled, and called by kernels that were compiled long before."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from numba.core import config
from support.mechanics_scenes import on_base

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import puti
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import scheme
from udec_ia.kernels.constitutive.block_laws import stress_increment
from udec_ia.layout import offsets as g
from udec_ia.layout.material import ARRAYS, Material
from udec_ia.ops.commands import model_settings
from udec_ia.ops.laws.law_file import _compiled, read_laws
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.restart import info

ROOT = Path(__file__).parents[2]
BLOCK = "def cl2(s11, s12, s22, de11, de12, de22, m):\n"
JOINT = "def clj2(fn, fs, dun, dus, un, us, m):\n"
STATE = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
REALS = ("i32r64", "i32r32")


def array(build: str = "i32r64") -> MainArray:
    """An empty array, its material 3 elastic."""
    empty = MainArray(scheme(build))
    model_settings.set_property(empty, 3, bulk=5.0, g=3.0)
    return empty


def echo(s11: Any, s12: Any, s22: Any, de11: Any, de12: Any, de22: Any, m: Any) -> Any:
    return s11 + 10 * s12 + 100 * s22, de11 + 10 * de12 + 100 * de22, m.bulk + 10 * m.p4


def stop(s11: Any, s12: Any, s22: Any, de11: Any, de12: Any, de22: Any, m: Any) -> Any:
    return s11, s12, de11 / (de22 - 6.0)


# ---- what kernels call


def test_a_material_tells_what_stands_in_the_common_block() -> None:
    assert len(ARRAYS) == len(Material._fields)
    places = {**model_settings.PROPERTIES, "shear": g.SHEAR, "alam1": g.ALAM1, "alam2": g.ALAM2}
    del places["g"]
    assert dict(zip(Material._fields, ARRAYS, strict=True)) == places


@pytest.mark.parametrize("build", REALS)
def test_a_law_gets_state_and_material_and_its_increments_come_back(build: str) -> None:
    a = array(build)
    model_settings.set_property(a, 3, p4=7.0)
    book = LawBook({"cl4": echo})
    laws = book.pack(a)
    found = stress_increment(a.h, laws, 4, 3, 1, *map(a.scheme.real_type.type, STATE))
    assert tuple(found) == (321.0, 654.0, 75.0)
    assert a.h.ci[g.NERR] == 0


@pytest.mark.parametrize("build", REALS)
def test_number_1_and_numbers_without_a_law_are_elastic(build: str) -> None:
    """Plane strain: K + 4G/3 = 9, K - 2G/3 = 3, 2G = 6."""
    a = array(build)
    state = [a.scheme.real_type.type(x) for x in STATE]
    book = LawBook({"cl4": echo})
    laws = book.pack(a)
    for given, number in ((None, 1), (laws, 1), (laws, 3)):
        found = stress_increment(a.h, given, number, 3, 1, *state)
        assert tuple(found) == (9 * 4.0 + 3 * 6.0, 6 * 5.0, 3 * 4.0 + 9 * 6.0)


@pytest.mark.parametrize("build", REALS)
def test_what_is_no_number_is_error_35(build: str) -> None:
    a = array(build)
    book = LawBook({"cl2": stop})
    laws = book.pack(a)
    assert tuple(stress_increment(a.h, laws, 2, 3, 88, *map(a.scheme.real_type.type, STATE))) == (0, 0, 0)
    assert (a.h.ci[g.NERR], a.h.ci[g.IERAD]) == (35, 88)


PROBE = """
import sys
import numpy as np
from udec_ia.heap.accessors import puti
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import scheme
from udec_ia.kernels.constitutive import block_laws as kernels
from udec_ia.ops.commands import model_settings
from udec_ia.ops.laws.registered_laws import LawBook

states = np.random.default_rng(1).normal(size=(20, 6)) * [1e6, 1e6, 1e6, 1e-3, 1e-3, 1e-3]
for build in ("i32r64", "i32r32"):
    a = MainArray(scheme(build))
    values = {"bulk": 2e9, "g": 1e9, "block_friction": 0.6, "block_cohesion": 2e5, "block_tension": 1e5}
    model_settings.set_property(a, 1, **values)
    book = LawBook(sys.argv[1])
    laws = book.pack(a)
    for state in states.astype(a.scheme.real_type):
        print(*(float(x).hex() for x in kernels.stress_increment(a.h, laws, 2, 1, 1, *state)))
whole = getattr(kernels.stress_increment, "dispatcher", None)
found = getattr(whole, "stats", None)
hits = found and [sum(found.cache_hits.values()), sum(found.cache_misses.values())]
print(*(hits or []), file=sys.stderr)
"""


def probe(law: str | Path, cache: Path, **environment: str) -> tuple[str, str]:
    """Stresses by `law` in another process, and how many kernels it found and missed on disk."""
    done = subprocess.run(
        [sys.executable, "-c", PROBE, str(law)],
        env={**os.environ, "PYTHONPATH": str(ROOT), "UDEC_CACHE": str(cache), **environment},
        capture_output=True,
        text=True,
        timeout=300,
        check=True,
    )
    return done.stdout, done.stderr.strip()


def test_kernels_on_disk_serve_every_law_and_uncompiled_ones_agree(tmp_path: Path) -> None:
    """A second process, with another law, compiles no kernel. Without compiling the bits are the same."""
    twice = tmp_path / "twice.py"
    twice.write_text(
        "from udec_ia.laws import mohr_coulomb\n" + BLOCK + "    return 2 * s11, 2 * s12, 2 * s22\n"
    )
    _, first = probe(twice, tmp_path)
    compiled, second = probe("mohr-coulomb", tmp_path)
    assert (first.splitlines(), second) == (
        ["compiling once for this machine, up to a minute ...", "0 2"],
        "2 0",
    )
    assert len(set(compiled.splitlines())) == 40
    assert probe("mohr-coulomb", tmp_path, NUMBA_DISABLE_JIT="1")[0] == compiled


# ---- laws that raise exceptions

TABLE = (
    "import numpy as np\n"
    "TABLE = np.linspace(0.0, 1.0, 5)\n"
    "def entry(x):\n"
    "    return TABLE[int(x)]\n"
    + JOINT
    + "    return entry(m.p1) * m.kn * dun, m.ks * dus\n"
    + BLOCK
    + "    a, b = m.p2, TABLE[int(m.p2)]\n"
    "    return b * de11, de12, a * de22\n"
)


def stack(law: Path, p1: float = 0.0, p2: float = 0.0) -> Model:
    """A block on a fixed one; both are deformable if they follow cl2 with `p2`, else clj2 alone is called."""
    model = Model(constitutive=law)
    model.property(1, density=2e3, kn=1e8, ks=1e8, bulk=1e8, g=5e7, p1=p1, p2=p2)
    model.gravity(0, -10)
    model.round(0.1)
    model.block(0, 0, 0, 2, 2, 2, 2, 0, constitutive=2)
    model.split(-1, 1, 3, 1)
    model.fix(0, 2, 0, 1)
    if p2:
        model.change(0, 2, 1, 2, type="sdef")
    return model


def test_a_law_of_the_program_fails_with_error_35_too() -> None:
    m = on_base(2.0, 1.0, 0.1, 12.0)
    contact = int(m.table("contact")["address"][0])
    puti(m.h, contact, g.KCC, 6)
    error = LawBook().failure(m.array, contact)
    assert (error.number, error.group) == (35, contact)
    assert "material 1" in error.advice


@pytest.mark.parametrize(("index", "shown"), [(5, 5), (-6, -6), (1e15, 10**15)])
def test_a_law_that_indexes_out_of_bounds_is_error_35_and_the_state_is_sound(
    index: float, shown: int, tmp_path: Path
) -> None:
    law = tmp_path / "law.py"
    law.write_text(TABLE)
    out = f"IndexError: index {shown} is out of bounds for axis 0 with size 5"
    for given, name, line in (({"p1": index}, "clj2, for contact", 4), ({"p2": index}, "cl2, for block", 8)):
        model = stack(law, **given)
        with pytest.raises(
            UdecError, match=f"error 35: .*: {name}@.* in cycle 1: {out}, in line {line} of law"
        ) as e:
            model.cycle(3)
        assert model.check() == []
        assert model.h.ci[g.MCTOT] == 1
        names = "fn = 0, fs = 0, dun = " if line == 4 else "s11 = 0, s12 = 0, s22 = 0, de11 = "
        assert e.value.advice.startswith(f"correct the law; it was called with {names}")
        model.property(1, p1=-5.0, p2=4.0)  # as in Python, numbers from -5 to 4 are places
        assert model.cycle(3) == 3


INTERPRETED = """
import sys
from test_laws import BLOCK, JOINT, Path, UdecError, stack
law = Path(sys.argv[1])
for body in ("[][int(m.p1)]", "zip", "1, 2, 3", "1j, 2j", "'a', 1", "1 / 0, 1", "none.x"):
    law.write_text(JOINT + "    return " + body + "\\n")
    model = stack(law)
    try:
        model.cycle(3)
    except UdecError as error:
        print(error.number, error.detail.partition("cycle 1: ")[2], model.check())
"""


def test_whatever_an_uncompiled_law_raises_or_returns_is_error_35(tmp_path: Path) -> None:
    tests = os.pathsep.join(map(str, (ROOT, ROOT / "tests", Path(__file__).parent)))
    done = subprocess.run(
        [sys.executable, "-c", INTERPRETED, str(tmp_path / "law.py")],
        env={**os.environ, "PYTHONPATH": tests, "NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        timeout=300,
        check=True,
    )
    assert [line.split(",")[0] for line in done.stdout.splitlines()] == [
        "35 IndexError: list index out of range",
        "35 TypeError: 'type' object is not iterable",
        "35 ValueError: 3 numbers returned instead of 2",
        "35 TypeError: float() argument must be a string or a real number",
        "35 ValueError: could not convert string to float: 'a'",
        "35 ZeroDivisionError: division by zero",
        "35 NameError: name 'none' is not defined",
    ]
    assert done.stdout.count(" in line 2 of law.py []") == 3
    assert done.stdout.count(" in line 1 of law.py []") == 4


def checked(text: str, tmp_path: Path) -> dict[str, Any]:
    """Whether the functions of a law in `text` are compiled with bounds checks, by name."""
    path = tmp_path / "law.py"
    path.write_text(text)
    space: dict[str, Any] = {"__name__": "law"}
    exec(compile(text, str(path), "exec"), space)
    done: dict[Any, Any] = {}
    _compiled(space["clj2"], done)
    return {function.__name__: compiled.targetoptions["boundscheck"] for function, compiled in done.items()}


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_bounds_are_checked_unless_the_author_of_a_function_says_otherwise(tmp_path: Path) -> None:
    decorated = TABLE.replace("def entry", "{}\ndef entry")
    for decorator, entry in (
        ("njit", True),
        ("njit(boundscheck=True)", True),
        ("njit(boundscheck=False)", False),
    ):
        found = checked("from numba import njit\n" + decorated.format("@" + decorator), tmp_path)
        assert found == {"clj2": True, "entry": entry}
    assert checked(TABLE, tmp_path) == {"clj2": True, "entry": True}


# ---- files and mappings


def refusal(given: Any) -> UdecError:
    with pytest.raises(UdecError) as caught:
        read_laws(given)
    assert caught.value.number == 34
    return caught.value


@pytest.mark.parametrize(
    ("text", "line", "column", "detail"),
    [
        (BLOCK + "    return (s11\n", 2, 12, "'(' was never closed"),
        (BLOCK + "\treturn (s11\n", 2, 9, "'(' was never closed"),
        ("import math\n\nimport no_such_thing\n", 3, 1, "No module named 'no_such_thing'"),
        ("def f():\n    return z\n\nf()\n", 2, 5, "name 'z' is not defined"),
        ("raise SystemExit(3)\n", 1, 1, "SystemExit: 3"),
        ("\ndef cl2(a, b):\n    return a, b, a\n", 2, 1, "cl2 does not take 7 arguments"),
        (BLOCK + "    return s11, s12\n", 1, 1, "cl2 returns UniTuple(float64 x 2) instead of 3 numbers"),
        (BLOCK + "    return s11, s12, 's'\n", 1, 1, "instead of 3 numbers"),
        (JOINT + "    return fn\n", 1, 1, "clj2 returns float64 instead of 2 numbers"),
        (JOINT + "    fn + 1\n", 1, 1, "clj2 returns none instead of 2 numbers"),
        (BLOCK + "    a = 1\n    return m.x, a, a\n", 3, 5, "cannot be compiled: Unknown attribute 'x'"),
        (BLOCK + "    return s11 + z, 0, 0\n", 1, 1, "name 'z' is not defined"),
        ("def f(x):\n    raise ValueError\n" + BLOCK + "    return f(s11), 0, 0\n", 2, 5, "f raises an exc"),
        (BLOCK + "    assert s11 < 0\n    return 0, 0, 0\n", 2, 5, "cl2 raises an exception"),
        (BLOCK + "    a = m.x\n    return z.flat[0], 0, 0\n", 3, 5, "does not check the indices of flat"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_file_is_shown_where_it_stands(
    text: str, line: int, column: int, detail: str, tmp_path: Path
) -> None:
    path = tmp_path / "law.py"
    path.write_text(text)
    error = refusal(path)
    assert (error.file, error.line, error.column) == (str(path), line, column)
    assert error.source == text.splitlines()[line - 1].replace("\t", " ")
    assert detail in error.detail
    assert "\n" not in error.detail
    assert f"{path}:{line}:{column}: error 34: constitutive law cannot be used: " in str(error)


def test_what_is_no_law(tmp_path: Path) -> None:
    (tmp_path / "none.py").write_text("def cl6(a):\n    return a\n")
    (tmp_path / "latin.py").write_bytes(b"# \xe9\n")
    (tmp_path / "number.py").write_text("cl2 = 3\n")
    assert "none.py defines no law" in refusal(tmp_path / "none.py").detail
    assert "latin.py cannot be read: 'utf-8'" in refusal(tmp_path / "latin.py").detail
    assert "cl2 is not a function" in refusal(tmp_path / "number.py").detail
    assert "cannot be read: Is a directory" in refusal(tmp_path).detail
    assert "'cl6' is not the name of a law" in refusal({"cl6": echo}).detail
    assert "clj3 is not a function" in refusal({"clj3": 1.0}).detail
    missing = refusal("mohr-coulombs")
    assert missing.detail == "mohr-coulombs cannot be read: No such file or directory"
    assert missing.advice == "give a file, or joint-dilation or mohr-coulomb"


def test_laws_from_several_places_and_no_law_twice(tmp_path: Path) -> None:
    mine = tmp_path / "mine.py"
    mine.write_text("from udec_ia.laws.joint_dilation import clj2 as clj5\n")
    laws = read_laws(["mohr-coulomb", mine, {"cl3": echo}])
    assert {name: law.origin for name, law in laws.items()} == {
        "cl2": "mohr_coulomb.py", "clj5": "mine.py", "cl3": "Python"
    }  # fmt: skip
    assert (
        "cl2 is defined by mohr_coulomb.py and by Python"
        in refusal(["mohr_coulomb.py", {"cl2": echo}]).detail
    )


def test_functions_of_the_same_file_are_compiled_too(tmp_path: Path) -> None:
    path = tmp_path / "law.py"
    path.write_text(
        "from math import sqrt\nimport numpy as np\nfour = 4.0\n"
        "def inner(x):\n    return x + four\n"
        "def outer(x):\n    return inner(x) + inner(0)\n"
        + BLOCK + "    return sqrt(four), np.hypot(3.0, 4.0), outer(s11)\n"
    )  # fmt: skip
    a, book = array(), LawBook(path)
    assert stress_increment(a.h, book.pack(a), 2, 3, 1, *STATE) == (2.0, 5.0, 9.0)


def test_a_book_keeps_the_laws_of_a_restart_file(tmp_path: Path) -> None:
    path = tmp_path / "law.py"
    path.write_text(BLOCK + "    return 0, 0, 0\n")
    saved = LawBook(path).record()
    assert saved.keys() == {"cl2"}
    again, without = LawBook(path), LawBook()
    assert again.note(saved) == []
    assert without.note(saved) == []
    assert without.record() == saved
    path.write_text(BLOCK + "    return 1, 0, 0\n")
    (warning,) = LawBook(path).note(saved)
    assert "cl2 of law.py differs from cl2 of law.py" in warning
    assert again.record() == saved


# ---- from the outside


def test_properties_for_laws_come_from_a_deck_and_go_to_the_law() -> None:
    model = Model(constitutive={"cl2": echo})
    model.run(
        "START\nPROP MAT=2 KN=1 KS=2 F=3 C=4 DI=5 RF=6 RC=7 CR=8 D=9 B=10 G=11\n"
        "PROP MAT=2 BF=14 BC=15 BT=16 BD=17 P1=-18 P2=19 P3=20 P4=21\n"
    )
    told = Material(*(float(model.h.cr[i + 1]) for i in ARRAYS))._asdict()
    assert told == {
        **{"kn": 1, "ks": 2, "friction": 3, "cohesion": 4, "dilation": 5, "residual_friction": 6},
        **{"residual_cohesion": 7, "critical_slip": 8, "density": 9, "bulk": 10, "shear": 11},
        **{"alam1": pytest.approx(10 + 44 / 3), "alam2": pytest.approx(10 - 22 / 3)},
        **{"block_friction": 14, "block_cohesion": 15, "block_tension": 16, "block_dilation": 17},
        **{"p1": -18, "p2": 19, "p3": 20, "p4": 21},
    }
    with pytest.raises(UdecError, match="error 28"):
        model.property(2, block_tension=-1.0)
    with pytest.raises(UdecError, match="error 28"):
        model.property(2, p1=float("nan"))


def test_a_restart_file_knows_its_laws(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    law = tmp_path / "law.py"
    law.write_text(JOINT + "    return m.kn * dun, m.ks * dus\n")
    model = Model(constitutive=law, out=tmp_path)
    model.start()
    assert "law       clj2 of law.py, sha256 " in info(model.save(tmp_path / "one.h5"))
    assert Model.restore(tmp_path / "one.h5").session.laws.record() == model.session.laws.record()
    law.write_text(JOINT + "    return 0.0, 0.0\n")
    Model.restore(tmp_path / "one.h5", constitutive=law)
    assert "clj2 of law.py differs from" in caplog.text
    model.start()
    model.restart(tmp_path / "one.h5")
    assert model.session.laws.recorded == model.session.laws.record()
    model.start()
    assert model.session.laws.recorded == {}


def test_a_law_of_a_restart_file_is_asked_for_first(tmp_path: Path) -> None:
    """Blocks and contacts have number 3; the blocks have followed a law, the contacts are elastic."""
    law = tmp_path / "law_ok.py"
    law.write_text(BLOCK.replace("cl2", "cl3") + "    return de11, de12, de22\n")
    model = Model(constitutive=law, out=tmp_path)
    model.round(0.05)
    model.property(1, density=1e3, kn=1e8, ks=1e8, bulk=1e8, g=5e7)
    model.block(0, 0, 0, 2, 2, 2, 2, 0, constitutive=3)
    model.split(-1, 1, 3, 1)
    model.change(0, 2, 0, 2, type="sdef")
    again = Model.restore(model.save())
    with pytest.raises(UdecError, match=r"block@\d+ follows cl3 of law_ok\.py, which is not given") as caught:
        again.cycle(0)
    assert caught.value.advice == "give it again: --constitutive law_ok.py"


def test_a_law_that_cannot_be_used_ends_a_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    law = tmp_path / "law.py"
    law.write_text(JOINT + "    return fn\n")
    assert main(["run", "no.dat", "--constitutive", str(law)]) == 1
    assert f"{law}:1:1: error 34: constitutive law cannot be used: clj2 returns" in capsys.readouterr().err


def test_a_law_that_comes_with_the_program_is_compiled_once_in_a_process(tmp_path: Path) -> None:
    one, two = (read_laws("mohr-coulomb") for _ in range(2))
    assert one
    assert all(two[name] is law for name, law in one.items())
    mine = tmp_path / "mohr_coulomb.py"
    mine.write_text("def cl2(s11, s12, s22, de11, de12, de22, m):\n    return 0.0, 0.0, 0.0\n")
    assert read_laws(mine)["cl2"] is not read_laws(mine)["cl2"]  # what it depends on is not known
