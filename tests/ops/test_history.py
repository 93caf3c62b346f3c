"""HISTORY: what is recorded is what the tables show, and a point means the nearest group."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.every_group_kind import GROUPS, every_kind
from support.handmade_map import two_blocks
from support.mechanics_scenes import at, block, standing_block, value

from udec_ia import Model, UdecError
from udec_ia.checker import check, check_links
from udec_ia.heap.accessors import getr, iget, puti
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.commands.history_definitions import define, named
from udec_ia.reader.recordable_numbers import recordable
from udec_ia.running.history_series import ROWS, Recording

KINDS = ("block", "corner", "contact", "domain")


def test_every_field_of_every_kind_of_group_is_recorded(tmp_path: Path) -> None:
    """Cycle by cycle the same, bit for bit, as the tables of the same run without these histories.

    Every CYCLE finds a time-step for the zones as they are, so both runs are cut into the same pieces.
    """
    m, twin = every_kind(), every_kind()
    m.out = twin.out = tmp_path
    before = len(m.histories())
    for one in (m, twin):
        one.cycle(5)
    wanted = []
    for group in GROUPS:
        address = int(m.table(group.name)["address"][-1])
        for field in group.fields:
            if field.role != "head" and field.count == 1 and group.name != "history":
                m.history(1, field.name, address)
                wanted.append((group.name, address, field.name))
    m.history(1, "time")
    m.history(1, "MCTOT")
    seen = []
    for k in range(12):
        for one in (m, twin):
            one.cycle(int(k > 0))
        seen.append([value(twin, *one) for one in wanted] + [twin.h.cd[g.TIME], twin.h.ci[g.MCTOT]])
    recorded = np.column_stack([one.numbers[:, 2] for one in m.histories()[before:]])
    assert np.array_equal(recorded, np.array(seen, float))
    assert np.array_equal(m.histories()[before].numbers[:, 0], np.arange(5, 17))
    assert np.array_equal(m.histories()[-1].numbers[:, 1], recorded[:, -2])


def test_what_has_no_single_number_is_not_recorded() -> None:
    names = recordable()
    fields = [field for group in read_table().groups for field in group.fields]
    histories = {field.name for field in read_table().group("history").fields}
    assert {f.name for f in fields if f.count == 1} - names.keys() == {"HEAD"} | histories
    assert {f.name for f in read_table().common if f.count == 1} <= names.keys()
    assert names.keys().isdisjoint({"KZG", "AKN", "HEAD"})


def state(m: Model) -> list[Any]:
    return [m.table(kind).tolist() for kind in KINDS] + [m.h.cr.tolist(), m.h.cd.tolist()]


def test_recording_changes_nothing_and_does_not_depend_on_the_commands(tmp_path: Path) -> None:
    """Multiples of n only, each once, over CYCLE commands of any length; more rows than fit at once."""
    plain = standing_block(tmp_path / "plain")
    plain.damping(0.3, 10)
    plain.cycle(ROWS + 700)
    runs = []
    for pieces in ([ROWS + 700], [1, 1, 5, 0, ROWS, 693]):
        m = standing_block(tmp_path / str(len(pieces)))
        m.damping(0.3, 10)
        m.history(1, "KY", at=(0, 0.5))
        m.history(7, "unbalanced")
        m.history(40, "KY", at=(0, 0.5))
        for n in pieces:
            m.cycle(n)
        assert state(m) == state(plain)
        runs.append([one.numbers for one in m.histories()])
    for one, other in zip(*runs, strict=True):
        assert np.array_equal(one, other)
    every, by_seven, by_forty = runs[0]
    assert np.array_equal(every[:, 0], np.arange(ROWS + 701))
    assert np.array_equal(by_seven[:, 0], np.arange(0, ROWS + 701, 7))
    assert np.array_equal(by_forty, every[::40])


SCHEMES = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from support.mechanics_scenes import on_base
for build in ("i16r32", "i32r32", "i16r64", "i32r64", "i64r64"):
    m = on_base(1.0, 1.0, 0.1, 4.0, build=build)
    m.out = Path(sys.argv[2]) / build
    m.history(1, "KCFN", at=(1, 0))
    m.history(1, "KCM", at=(1, 0))
    m.history(1, "ratio")
    address = int(m.history(1, "KY", at=(0, 0.5))[0].group.split("@")[1])
    seen = []
    for _ in range(25):
        contacts, blocks = m.table("contact"), m.table("block")
        nearest = contacts[contacts["KXC"] > 0][0]
        row = blocks[blocks["address"] == address][0]
        seen.append((float(nearest["KCFN"]), 1.0, float(row["KY"])))
        m.cycle(1)
    force, material, _, height = (one.numbers[:-1, 2].tolist() for one in m.histories())
    assert list(zip(force, material, height)) == seen, build
    assert not m.check(), build
"""


def test_all_word_schemes_interpreted(tmp_path: Path) -> None:
    """The kernels' source on every scheme, against the tables; compiled, the default scheme above."""
    tests = Path(__file__).parents[1]
    subprocess.run(
        [sys.executable, "-c", SCHEMES, str(tests), str(tmp_path)],
        env={**os.environ, "PYTHONPATH": str(tests.parent), "NUMBA_DISABLE_JIT": "1"},
        timeout=300,
        check=True,
    )


def test_a_recording_of_a_bare_array_makes_its_own_series() -> None:
    array = two_blocks()
    define(array, named("KX"), [int(array.h.ci[g.IBPNT])], 2)
    recording = Recording(array, [])
    recording.begin(0)
    assert recording.series[0].numbers.tolist() == [[0.0, 0.0, 0.5]]
    assert iget(array.h, int(array.h.ci[g.IHPNT]), g.KHN) == 2
    assert getr(array.h, int(array.h.ci[g.IBPNT]), g.KX) == 0.5


# ---- points


def test_a_point_means_the_nearest_group(tmp_path: Path) -> None:
    """By brute force over the tables; a domain is where its contacts are on the mean."""
    m = standing_block(tmp_path)
    m.split(-9, 0.5, 9, 0.5)
    m.split(0, 0.4, 0, 2)
    m.cycle(1)
    rng = np.random.default_rng(5)
    contacts = m.table("contact")
    real = contacts[contacts["KCCOD"] != 4]
    places: dict[str, dict[int, Any]] = {
        "KX": {row["address"]: (row["KX"], row["KY"]) for row in m.table("block")},
        "KXP": {row["address"]: (row["KXP"], row["KYP"]) for row in m.table("corner")},
        "KCN": {row["address"]: (row["KXC"], row["KYC"]) for row in real},
        "KPP": {
            address: np.mean([(c["KXC"], c["KYC"]) for c in real if address in (c["KD1"], c["KD2"])], axis=0)
            for address in m.table("domain")["address"]
            if address != m.h.ci[g.IODPNT]
        },
    }
    for field, where in places.items():
        for point in rng.uniform((-2.5, -1.5), (2.5, 1.5), (25, 2)).tolist():
            (one,) = m.history(1, field, at=[point])
            distance = {a: np.hypot(p[0] - point[0], p[1] - point[1]) for a, p in where.items()}
            assert distance[int(one.group.split("@")[1])] == pytest.approx(min(distance.values()))


def test_what_belongs_to_deformable_blocks_is_found_by_points(tmp_path: Path) -> None:
    """Extensions are where the block is, zones amid grid-points, conditions where their subjects are."""
    m = every_kind()
    m.out = tmp_path

    def chosen(field: str, *at: float) -> int:
        return int(m.history(1, field, at=at)[0].group.partition("@")[2])

    gridpoints = {(r["KXG"], r["KYG"]): r["address"] for r in m.table("gridpoint")}
    assert chosen("KXDG", 3.55, 0.6) == gridpoints[3.5, 0.5]
    zone = at(m, "zone", chosen("KZS11", 3.5, 0.9))
    corners = [at(m, "gridpoint", int(address)) for address in zone["KZG"]]
    assert sorted((p["KXG"], p["KYG"]) for p in corners) == [(3, 1), (3.5, 0.5), (4, 1)]
    for x, extension in ((1.5, "KS111"), (4.5, "KFNG")):
        assert chosen(extension, x, 0.6) == block(m, x, 0.5)["KBEX"]
    assert at(m, "bound", chosen("KUVX", 0.5, 0.5))["KUB"] == block(m, 0.5, 0.5)["address"]
    assert at(m, "bound", chosen("KUFX", 3, 1.1))["KUG"] == gridpoints[3, 1]
    edge = at(m, "bound", chosen("KUCXX", 6, 0.8))
    assert edge["KUB"] == block(m, 5.5, 0.5)["address"]
    assert edge["KUP"] != 0
    with pytest.raises(UdecError, match="give its address"):
        m.history(1, "KTNOW", at=(0, 0))


# ---- what is refused


@pytest.mark.parametrize(
    ("what", "number", "parameter"),
    [
        ({"field": "KXX", "address": 1}, 10, "field"),
        ({"field": "AKN"}, 10, "field"),
        ({"field": "KX"}, 7, "field"),
        ({"field": "KX", "address": 3}, 30, "address"),
        ({"field": "KX", "address": 1, "at": (0, 0)}, 10, "at"),
        ({"field": "KX", "at": (0, 0, 1)}, 8, "at"),
        ({"field": "KX", "at": (0, np.nan)}, 28, "at"),
        ({"field": "KZM", "at": (0, 0)}, 26, "field"),
        ({"field": "TIME", "at": (0, 0)}, 10, "at"),
        ({"field": "unbalanced", "address": 1}, 10, "address"),
        ({"field": "TIME", "n": 0}, 28, "n"),
        ({"field": "TIME", "n": -3}, 28, "n"),
        ({"field": "TIME", "n": 2**31}, 28, "n"),
    ],
)
def test_wrong_parameters(what: dict[str, Any], number: int, parameter: str, tmp_path: Path) -> None:
    m = standing_block(tmp_path)
    before = m.h.ia.tobytes(), m.h.ci.tobytes()
    with pytest.raises(UdecError) as caught:
        m.history(**{"n": 1} | what)
    assert (caught.value.number, caught.value.parameter) == (number, parameter)
    assert (m.h.ia.tobytes(), m.h.ci.tobytes()) == before
    assert m.histories() == []


def test_no_room_for_a_history(tmp_path: Path) -> None:
    m = Model(mtop=110, out=tmp_path)
    m.block(0, 0, 0, 1, 1, 0)
    with pytest.raises(UdecError, match="main array has 110"):
        m.history(1, "KX", at=[(0, 0)] * 4)
    assert m.histories() == []
    assert m.h.ci[g.IHPNT] == 0


@pytest.mark.parametrize(("field", "number"), [("KHK", 99), ("KHF", 999), ("KHN", 0), ("KHG", "corner")])
def test_the_checker_knows_histories(field: str, number: int | str, tmp_path: Path) -> None:
    m = standing_block(tmp_path)
    m.history(5, "KY", at=(0, 0.5))
    m.history(5, "TIME")
    assert check(m.array) == []
    address = int(m.table("history")["address"][0])
    puti(
        m.h,
        address,
        getattr(g, field),
        int(m.table("corner")["address"][0]) if number == "corner" else int(number),
    )
    broken = [violation.message for violation in check_links(m.array)]
    assert any(field in message and f"history@{address}" in message for message in broken)


def test_a_damaged_history_stops_the_next_cycle(tmp_path: Path) -> None:
    m = standing_block(tmp_path)
    m.history(5, "KY", at=(0, 0.5))
    m.rset(1e300, int(m.table("history")["address"][0]), 2)
    with pytest.raises(UdecError) as caught:
        m.cycle(1)
    assert caught.value.number == 20


@pytest.mark.parametrize("field", ["KYG", "KYP"])
def test_of_points_at_one_place_that_of_the_block_around_the_given_point_counts(
    field: str, tmp_path: Path
) -> None:
    """So that a point of the rock is not lost with the block that is excavated beside it."""
    m = Model(out=tmp_path)
    m.tell = lambda _: None
    m.property(1, density=2600, bulk=1e10, g=8e9, kn=1e10, ks=1e10)
    m.block(0, 0, 0, 3, 2, 3, 2, 0)
    m.split(-1, 1, 3, 1)
    m.split(-1, 2, 3, 2)
    if field == "KYG":
        m.generate("ALL", edge=1)
    (upper,), (lower,) = (m.history(1, field, at=(0.1, y)) for y in (1.05, 0.95))
    m.delete(0, 2, 0, 1)
    m.cycle(2)
    assert np.isfinite(upper.numbers[:, 2]).all()
    assert np.isnan(lower.numbers[:, 2]).all()
