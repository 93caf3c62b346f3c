"""SOLVE: cycling ends when the forces balance, and says so when they do not."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.every_group_kind import every_kind
from support.mechanics_scenes import block, on_base, push

from udec_ia import Model, UdecError
from udec_ia.cli import main
from udec_ia.kernels.drive.unbalanced_force import force_ratio
from udec_ia.layout import offsets as g

CHECK = 10  # cycles between two looks, as docs/histories.md says


def damped(out: Path) -> Model:
    """Two blocks on a base, settling under mass damping."""
    m = on_base(1.0, 1.0, 0.1, 4.0, friction=0.5)
    m.split(-9, 0.5, 9, 0.5)
    m.damping(0.5, 30, "mass")
    m.out = out
    return m


def ratio(m: Model) -> float:
    """Greatest unbalanced force over mean contact force, from the tables."""
    blocks, contacts = m.table("block"), m.table("contact")
    free = blocks[blocks["KBFIX"] == 0]
    fx = free["KBFX"] + free["KBM"] * m.h.cr[g.GRAVX]
    fy = free["KBFY"] + free["KBM"] * m.h.cr[g.GRAVY]
    forces = [math.hypot(c["KCFN"], c["KCFS"]) for c in contacts if c["KCFN"] != 0]
    greatest = max(map(math.hypot, fx, fy))
    return greatest / (sum(forces) / len(forces)) if forces else math.inf


def moving(m: Model) -> float:
    """Kinetic over strain energy of rigid blocks on springs of 1e8 N/m, from the tables."""
    blocks, contacts = m.table("block"), m.table("contact")
    free = blocks[blocks["KBFIX"] == 0]
    kinetic = free["KBM"] * (free["KXD"] ** 2 + free["KYD"] ** 2) + free["KBI"] * free["KTD"] ** 2
    return float(kinetic.sum() / ((contacts["KCFN"] ** 2 + contacts["KCFS"] ** 2).sum() / 1e8))


def loads(m: Model) -> Any:
    """(x, y) force of every boundary condition, from the tables: F f - C v."""
    subjects = {
        kind: {int(row["address"]): row for row in m.table(kind)}
        for kind in ("block", "gridpoint", "corner", "signal", "sdef")
    }
    for row in m.table("bound"):
        factor = subjects["signal"][row["KUS"]]["KTNOW"] if row["KUS"] else 1.0
        owner = subjects["block"][row["KUB"]]
        if row["KUG"]:
            point = subjects["gridpoint"][row["KUG"]]
            v = np.array([point["KXDG"], point["KYDG"]])
        else:
            assert owner["HEAD"] == g.MRIG
            r = np.zeros(2)
            if row["KUP"]:
                corner = subjects["corner"][row["KUP"]]
                r = np.array([corner["KXP"] - owner["KX"], corner["KYP"] - owner["KY"]])
            v = np.array([owner["KXD"] - owner["KTD"] * r[1], owner["KYD"] + owner["KTD"] * r[0]])
        c = np.array([[row["KUCXX"], row["KUCXY"]], [row["KUCXY"], row["KUCYY"]]])
        yield row, np.array([row["KUFX"], row["KUFY"]]) * factor - c @ v


def deformable_ratio(m: Model) -> float:
    """As `ratio` with all kinds of blocks, of which simply-deformable ones carry no load."""
    blocks, points, sdef = m.table("block"), m.table("gridpoint"), m.table("sdef")
    gravity = np.array([m.h.cr[g.GRAVX], m.h.cr[g.GRAVY]])
    forces = {int(b["address"]): np.array([b["KBFX"], b["KBFY"]]) + b["KBM"] * gravity for b in blocks}
    forces |= {int(p["address"]): np.array([p["KGFX"], p["KGFY"]]) + p["KGPM"] * gravity for p in points}
    for row, force in loads(m):
        forces[int(row["KUG"] or row["KUB"])] += force
    given = {int(b["address"]): {0: 0, 1: 3, 2: 1, 4: 2, 6: 3}[int(b["KBFIX"])] for b in blocks}
    given |= {int(p["address"]): int(p["KGFIX"]) for p in points}
    most = 0.0
    for address, (fx, fy) in forces.items():
        if blocks["HEAD"][blocks["address"] == address].tolist() != [g.MFDEF]:
            most = max(most, math.hypot(0 if given[address] & 1 else fx, 0 if given[address] & 2 else fy))
    for e in sdef:
        (reach,) = blocks["KBRO"][blocks["KBEX"] == e["address"]]
        applied = np.array([[e["KSA11"], e["KSA12"]], [e["KSA21"], e["KSA22"]]])
        most = max(most, np.abs((applied + applied.T) / 2 - stress(e) * e["KSAREA"]).max() / reach)
    return float(most / np.mean(carried(m)))


def stress(sdef: Any) -> Any:
    return np.array([[sdef["KS111"], sdef["KS112"]], [sdef["KS121"], sdef["KS122"]]])


def carried(m: Model) -> list[float]:
    """Forces that contacts, simply-deformable blocks and zones carry."""
    found = [math.hypot(c["KCFN"], c["KCFS"]) for c in m.table("contact") if c["KCFN"] != 0]
    found += [float(np.linalg.norm(stress(e))) * math.sqrt(e["KSAREA"]) for e in m.table("sdef")]
    where = {int(p["address"]): np.array([p["KXG"], p["KYG"]]) for p in m.table("gridpoint")}
    for z in m.table("zone"):
        a, b, c = (where[int(i)] for i in z["KZG"])
        area = abs(np.linalg.det([b - a, c - a])) / 2
        size = np.linalg.norm([z["KZS11"], z["KZS12"], z["KZS12"], z["KZS22"]])
        found.append(float(size) * math.sqrt(area))
    return found


def test_the_ratio_of_deformable_blocks_under_loads(tmp_path: Path) -> None:
    """Against the tables, while loads, springs and zones are at work; and looking changes no bit."""
    m = every_kind(structures=False)
    m.out = tmp_path
    m.boundary(1, 3, 0, 1, free=True)  # simply-deformable blocks
    seen = []
    for _ in range(5):
        m.cycle(40)
        before = m.h.ia.tobytes(), m.h.cr.tobytes(), m.h.cd.tobytes()
        seen.append(float(force_ratio(m.h, True)))
        assert (m.h.ia.tobytes(), m.h.cr.tobytes(), m.h.cd.tobytes()) == before
        assert seen[-1] == pytest.approx(deformable_ratio(m), rel=1e-9)
    assert len(set(seen)) == 5


@pytest.mark.parametrize("kind", ["sdef", "fdef"])
def test_a_block_that_is_strained_is_not_in_balance(kind: str, tmp_path: Path) -> None:
    """Nothing pushes it as a whole: only its own stress, which nothing holds."""
    m = on_base(1.0, 1.0, 0.1, 4.0, gravity=(0.0, 0.0))
    m.out = tmp_path
    m.property(1, bulk=1e7, g=5e6)
    m.change(-1, 1, 0, 1, type=kind)
    if kind == "fdef":
        corners = [(-0.5, 0), (-0.5, 1), (0.5, 1), (0.5, 0), (0, 0.5)]
        m.generate(-1, 1, 0, 1, "manual", corners, [(1, 2, 3), (1, 3, 4), (1, 4, 5), (1, 5, 2)])
    assert m.solve(1e-6).cycles == CHECK
    m.insitu(-1, 1, 0, 1, 1e4, 0, 0)
    m.damping(0.5, 30, None if kind == "fdef" else "internal")
    solution = m.solve(1e-4, limit=20)
    assert (solution.reached, solution.cycles) == (False, 20)


def test_a_column_that_is_solved_hands_its_weight_on(tmp_path: Path) -> None:
    """All unbalanced forces together, those of its grid-points, are what the base lacks of it."""
    m = on_base(1.0, 1.0, 0.1, 4.0, density=2000, friction=0.5)
    m.out = tmp_path
    m.property(1, bulk=1e7, g=5e6)
    m.change(-1, 1, 0, 1, type="fdef")
    corners = [(-0.5, 0), (-0.5, 1), (0.5, 1), (0.5, 0), (0, 0.5)]
    m.generate(-1, 1, 0, 1, "manual", corners, [(1, 2, 3), (1, 3, 4), (1, 4, 5), (1, 5, 2)])
    m.damping(0.5, 10, "mass")
    assert m.solve(1e-3)
    lacking = abs(m.table("contact")["KCFN"].sum() - 2000 * 10)
    assert 0 < lacking <= len(corners) * 1e-3 * np.mean(carried(m))


@pytest.mark.parametrize("wanted", [0.3, 1e-2, 1e-5])
def test_it_stops_at_the_first_look_that_finds_balance(wanted: float, tmp_path: Path) -> None:
    """The same cycles as CYCLE, up to the first multiple of ten at which the ratio is there."""
    m, twin = damped(tmp_path), damped(tmp_path)
    twin.cycle(CHECK)
    while ratio(twin) > wanted or moving(twin) > wanted:
        twin.cycle(CHECK)
    solution = m.solve(wanted)
    assert solution
    assert solution.cycles == m.h.ci[g.MCTOT] == twin.h.ci[g.MCTOT]
    assert solution.ratio == pytest.approx(ratio(twin), rel=1e-9)
    for kind in ("block", "corner", "contact", "domain"):
        assert np.array_equal(m.table(kind), twin.table(kind))
    assert "reached: it is" in str(solution)


def test_where_it_stops_depends_on_the_cycle_only(tmp_path: Path) -> None:
    """After CYCLEs of any length, over a restart, with histories: the same cycle."""
    plain, other = damped(tmp_path / "a"), damped(tmp_path / "b")
    plain.cycle(33)
    plain.solve(1e-3)
    other.history(7, "ratio")
    other.cycle(4)
    other.cycle(29)
    assert not other.solve(1e-3, limit=21)
    other.save()
    other.restart()
    assert other.solve(1e-3)
    assert other.h.ci[g.MCTOT] == plain.h.ci[g.MCTOT]
    assert other.h.ci[g.MCTOT] % CHECK == 0
    recorded = other.histories()[0].numbers
    assert np.array_equal(recorded[:, 0], np.arange(0, int(plain.h.ci[g.MCTOT]) + 1, 7))


def test_what_is_in_balance_is_found_so_at_the_first_look(tmp_path: Path) -> None:
    """After a cycle at least: only that tells what the properties of now make of the forces."""
    m = damped(tmp_path)
    assert m.solve(1e-6)
    before = m.h.ci[g.MCTOT]
    solution = m.solve(1e-4)
    assert (bool(solution), solution.cycles, m.h.ci[g.MCTOT]) == (True, CHECK, before + CHECK)
    assert not m.solve(1e-4, limit=0)
    assert m.solve(1e-4, limit=1).cycles == 1


def test_blocks_without_weight_are_in_balance_at_once(tmp_path: Path) -> None:
    m = on_base(1.0, 1.0, 0.1, 4.0, gravity=(0.0, 0.0))
    m.out = tmp_path
    solution = m.solve(0)
    assert (solution.reached, solution.ratio, solution.motion) == (True, 0.0, 0.0)
    assert solution.cycles <= 5 * CHECK  # while roundings of the overlaps part


def test_a_block_in_the_air_is_not_in_balance(tmp_path: Path) -> None:
    """No contact carries anything: the ratio is infinite, and the limit ends it."""
    m = damped(tmp_path)
    push(m, int(block(m, 0, 0.75)["address"]), yd=3.0)
    push(m, int(block(m, 0, 0.25)["address"]), yd=3.0)
    m.cycle(1)
    solution = m.solve(0.5, limit=25)
    assert (solution.reached, solution.cycles, solution.ratio) == (False, 25, math.inf)
    assert solution.worst in {f"block@{address}" for address in m.table("block")["address"]}
    assert solution.worst in str(solution)


def test_a_limit_that_is_met_is_no_error_but_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    deck = tmp_path / "fall.dat"
    deck.write_text(
        "START\nPROP MAT=1 DENS=1000 KN=1E8 KS=1E8\nBLOCK 0 0 0 2 1 2 1 0\nSPLIT -1 1 2 1\n"
        "FIX 0 1 0 1\nGRAVITY 0 -10\nSOLVE 1E-6 LIMIT=30\nSOLVE 1E9\nSTOP\n"
    )
    assert main(["run", str(deck), "--out", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith("force ratio 1e-06 NOT REACHED: it is") for line in lines)
    assert any(line.startswith("force ratio 1e+09 reached: it is") for line in lines)
    assert "; SOLVE 1e-06 NOT REACHED (" in lines[-1]
    assert "1e+09" not in lines[-1]


@pytest.mark.parametrize(
    ("numbers", "number", "parameter"),
    [((-1.0,), 28, "ratio"), ((math.nan,), 28, "ratio"), ((0.1, -5), 28, "limit")],
)
def test_wrong_parameters(numbers: tuple[float, int], number: int, parameter: str, tmp_path: Path) -> None:
    m = damped(tmp_path)
    with pytest.raises(UdecError) as caught:
        m.solve(*numbers)
    assert (caught.value.number, caught.value.parameter) == (number, parameter)
    assert m.h.ci[g.MCTOT] == 0


def test_an_error_on_the_way_is_an_error(tmp_path: Path) -> None:
    m = damped(tmp_path)
    push(m, int(block(m, 0, 0.25)["address"]), yd=-60.0)
    with pytest.raises(UdecError) as caught:
        m.solve(1e-3)
    assert caught.value.number == 15


def test_what_is_out_of_balance_is_named(tmp_path: Path) -> None:
    """A simply-deformable block that breathes, far from anything, is out of balance in its strain alone."""
    m = on_base(1.0, 1.0, 0.1, 4.0, gravity=(0.0, 0.0))
    m.out = tmp_path
    m.property(1, bulk=2e8, g=1e8)
    m.change(-1, 1, 0, 1, type="sdef")
    m.cycle(0)
    address = int(block(m, 0, 0.5)["address"])
    m.insitu(-1, 1, 0, 1, -1e5, 0, -1e5)
    push(m, address, yd=10.0)
    solution = m.solve(1e-6, limit=40)
    assert solution.worst == f"the strain of block@{address}"
    assert "DAMPING ... INTERNAL" in str(solution)


def test_conditions_that_go_with_a_mesh_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = tmp_path / "mesh.dat"
    deck.write_text(
        "START\nPROP MAT=1 DENS=1000 KN=1E8 KS=1E8 BULK=2E8 G=1E8\nBLOCK 0 0 0 2 1 2 1 0\nSPLIT -1 1 2 1\n"
        "FIX 0 1 0 1\nBOUNDARY -1 2 1.9 3 STRESS 0 0 -1E3\nGENERATE 0 1 1 2 AUTOMATIC EDGE 0.5\n"
        "BOUNDARY -1 2 1.9 3 STRESS 0 0 -1E3\nCHANGE 0 1 1 2 RIGID\nCHANGE 0 1 1 2 RIGID\nSTOP\n"
    )
    assert main(["run", str(deck), "--out", str(tmp_path)]) == 0
    told = [line for line in capsys.readouterr().out.splitlines() if "removed together with" in line]
    assert [line.split(" boundary")[0] for line in told] == [" GENERATE: 2", " CHANGE: 3"]


def sliding(out: Path, friction: float = 0.8) -> Model:
    """A block on a base, under a pull of 31 degrees from the vertical: it slides if friction is below 0.6."""
    m = Model(out=out)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=friction)
    m.property(2, density=2000, kn=1e8, ks=1e8, friction=0.1)
    m.block(0, 0, 0, 4, 4, 4, 4, 0)
    m.split(-1, 2, 5, 2)
    m.fix(0, 4, 0, 2)
    m.round(0.1)
    m.damping(0.5, 8, "mass")
    m.gravity(6, -10)
    return m


UPPER = (0.0, 4.0, 2.0, 4.0)


def weaken(m: Model) -> None:
    m.property(1, friction=0.1)


def weaken_and_restart(m: Model) -> None:
    weaken(m)
    m.restart(m.save((m.out / "weak.h5").absolute()))


def give_other_material(m: Model) -> None:
    m.change(*UPPER, material=2)
    m.change(0, 4, 0, 2, material=2)


def load_by_function(m: Model) -> None:
    m.function(1, 0, 1, 1, 1)
    m.boundary(*UPPER, xforce=1e5, function=1)


def pull(m: Model) -> None:
    m.boundary(*UPPER, xvel=0.01)


def throw(m: Model) -> None:
    push(m, int(block(m, 2, 3)["address"]), xd=1.0)


def turn_gravity(m: Model) -> None:
    m.gravity(9, -10)


@pytest.mark.parametrize(
    "change", [weaken, weaken_and_restart, give_other_material, load_by_function, pull, throw, turn_gravity]
)
def test_what_a_command_has_set_in_motion_is_not_at_rest(
    change: Callable[[Model], None], tmp_path: Path
) -> None:
    """The forces of before are balanced; with the properties, loads and velocities of now it slides."""
    m = sliding(tmp_path)
    assert m.solve(1e-5)
    change(m)
    solution = m.solve(1e-5, limit=CHECK)
    assert (solution.reached, solution.cycles) == (False, CHECK)


def test_a_strength_reduction_finds_the_strength(tmp_path: Path) -> None:
    """Friction is lowered step by step; the block holds down to the tangent of the pull, 0.6."""
    m = sliding(tmp_path)
    held = []
    for friction in (0.8, 0.7, 0.62, 0.58, 0.5):
        m.property(1, friction=friction)
        held.append(bool(m.solve(1e-5, limit=3000)))
    assert held == [True, True, True, False, False]


def test_what_slides_at_constant_speed_is_in_balance_and_not_at_rest(tmp_path: Path) -> None:
    """Friction takes all that drives it, and nothing damps."""
    m = sliding(tmp_path, friction=0.6)
    m.damping(0, 8)
    m.cycle(0)
    m.damping(0.5, 8, "mass")
    m.cycle(400)
    m.damping(0, 8)
    push(m, int(block(m, 2, 3)["address"]), xd=0.2)
    solution = m.solve(0.01, limit=100)
    assert not solution
    assert solution.ratio <= 0.01
    assert solution.motion > 0.01
    assert solution.greatest_energy == f"block@{block(m, 2, 3)['address']}"
    assert f"NOT REACHED (kinetic over strain energy {solution.motion:.3g}" in solution.short


def test_the_last_line_forgets_what_was_reached_later(tmp_path: Path) -> None:
    m = sliding(tmp_path)
    assert not m.solve(1e-5, limit=20)
    assert "SOLVE 1e-05 NOT REACHED" in m.summary()
    assert m.solve(1e-2)
    assert "SOLVE 1e-05 NOT REACHED" in m.summary()
    assert m.solve(1e-5)
    assert "NOT REACHED" not in m.summary()
    weaken(m)
    assert not m.solve(1e-5, limit=20)
    assert not m.solve(1e-5, limit=30)
    assert m.summary().count("NOT REACHED") == 1
    m.start()
    assert "NOT REACHED" not in m.summary()


def mean_ratio(m: Model) -> float:
    """Mean unbalanced force on free rigid blocks over mean contact force, from the tables."""
    blocks, contacts = m.table("block"), m.table("contact")
    free = blocks[blocks["KBFIX"] == 0]
    fx = free["KBFX"] + free["KBM"] * m.h.cr[g.GRAVX]
    fy = free["KBFY"] + free["KBM"] * m.h.cr[g.GRAVY]
    forces = np.maximum(np.hypot(fx, fy), np.abs(free["KBFT"]) / free["KBRO"])
    borne = np.hypot(contacts["KCFN"], contacts["KCFS"])[contacts["KCFN"] != 0]
    return float(forces.mean() / borne.mean())


def test_the_mean_ratio(tmp_path: Path) -> None:
    """SOLVE ... MEAN stops at the first look that finds the mean of all unbalanced forces small enough."""
    m, twin = damped(tmp_path), damped(tmp_path)
    twin.cycle(CHECK)
    while mean_ratio(twin) > 1e-3 or moving(twin) > 1e-3:
        twin.cycle(CHECK)
    solution = m.solve(1e-3, criterion="mean")
    assert solution
    assert (solution.cycles, solution.ratio) == (
        twin.h.ci[g.MCTOT],
        pytest.approx(mean_ratio(twin), rel=1e-9),
    )
    assert solution.ratio < solution.largest
    assert str(solution).startswith("mean force ratio 0.001 reached: it is")
    with pytest.raises(UdecError) as caught:
        m.solve(1e-3, criterion="median")
    assert (caught.value.number, caught.value.parameter) == (10, "criterion")


def test_a_deck_chooses_the_ratio(tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    printed = m.run(
        "START\nPROP MAT=1 DENS=1000 KN=1E8 KS=1E8\nBLOCK 0 0 0 2 1 2 1 0\nSPLIT -1 1 2 1\n"
        "FIX 0 1 0 1\nGRAVITY 0 -10\nSOLVE 1E-6 LIMIT=30 MEAN\nSOLVE 1E9 MAX\n"
    )
    assert printed is not None
    assert "mean force ratio 1e-06 NOT REACHED: it is" in printed
    assert [one.criterion for one in m.solutions()] == ["mean", "max"]
    other = Model(out=tmp_path)
    other.property(1, density=1000, kn=1e8, ks=1e8)
    other.block(0, 0, 0, 2, 1, 2, 1, 0)
    other.solve(0.1, 1, criterion="mean")
    assert "SOLVE 0.1 LIMIT 1 MEAN" in other.deck()


def bar(out: Path, friction: float, damping: float) -> Model:
    """Three simply-deformable blocks whose joints stand 15 degrees askew, loaded along them at once."""
    m = Model(out=out)
    m.property(1, density=2000, kn=1e9, ks=1e9, bulk=2e9 / 3, g=1e9, friction=friction)
    m.fraction(0.3)
    m.round(0.02)
    m.block(0, 0, 0, 1, 4.5, 1, 4.5, 0)
    lean = math.tan(math.radians(15))
    for x in (1.5, 3.0):
        m.split(x - lean, -0.5, x + lean, 1.5)
    m.change(0, 4.5, 0, 1, type="sdef")
    m.damping(damping, 55, "mass")
    m.damping(damping, 55, "internal")
    for x in (0.0, 4.5):
        m.boundary(x - 0.001, x + 0.001, -1, 2, stress=(-1e5, 0, 0))
    return m


@pytest.mark.parametrize(("friction", "damping"), [(0.3, 0.1), (1e3, 0.1)])
def test_a_sudden_load_that_spoils_the_rest_is_told(friction: float, damping: float, tmp_path: Path) -> None:
    """The angle of friction is 17 degrees: nothing slips at rest, and much in the overshoot."""
    m = bar(tmp_path, friction, damping)
    long = np.ptp(m.table("block")["KX"])
    solution = m.solve(1e-4, 20_000)
    assert solution
    modulus = 1e5 * long / (long - np.ptp(m.table("block")["KX"]))
    exact = 1 / (1 / 2e9 + 1 / (2 * 1e9 * 1.5))
    spoilt = abs(modulus / exact - 1) > 0.02
    assert spoilt == (friction < 1)
    assert solution.keys == (("joints-slipped",) if spoilt else ())
    assert ("contact@" in str(solution)) == spoilt


def test_where_there_is_no_rest_the_blocks_that_move_are_named(tmp_path: Path) -> None:
    """It slides at the speed that mass damping leaves, and without damping ever faster."""
    for damping in (0.5, 0.0):
        m = sliding(tmp_path, 0.1)
        m.damping(damping, 30, "mass")
        before = block(m, 2, 3)
        solution = m.solve(1e-7, 600)
        address = int(before["address"])
        moved = next(one for one in solution.remarks if one.key == "blocks-move")
        assert f"1 block has moved most in the last 120 cycles, block@{address} at (" in moved
        after = m.table("block")[m.table("block")["address"] == address][0]
        way = math.hypot(after["KX"] - before["KX"], after["KY"] - before["KY"])
        far = 0.1 * 2 * after["KBRO"]
        assert (solution.fallen == (address,)) == (way > far)
        assert ("no-damping" in solution.keys) == (damping == 0)


def test_a_block_that_has_fallen_and_landed_is_named(tmp_path: Path) -> None:
    """The middle block of a roof loses its hold, falls by 3 m and comes to rest."""
    m = Model(out=tmp_path)
    printed = m.run(
        "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.1\nBLOCK 0,0 0,8 9,8 9,0\nSPLIT -1,1 10,1\n"
        "SPLIT 3,0.5 3,9\nSPLIT 6,0.5 6,9\nSPLIT 2.5,4 6.5,4\nDELETE 3 6 1 4\nFIX 0 9 0 1\n"
        "FIX 0 3 1 8\nFIX 6 9 1 8\nROUND 0.1\nGRAVITY 0 -10\nDAMP LOCAL 0.8\nSOLVE 1E-3\n"
    )
    (solution,) = m.solutions()
    assert solution
    assert solution.fallen == (int(block(m, 4.5, 3)["address"]),)
    assert "blocks-fallen" in solution.keys
    assert "SOLVE 0.001 reached, but: 1 block fallen" in m.summary()
    assert printed is not None
    again = m.solve(1e-3)
    assert (bool(again), again.fallen, again.keys) == (True, (), ())


def test_a_block_that_loses_its_contacts_has_fallen_however_short_its_way(tmp_path: Path) -> None:
    """Without weight it flies off by a tenth of the size at which the way by itself would count."""
    m = on_base(1.0, 1.0, 0.02, 4.0, gravity=(0.0, 0.0))
    m.out = tmp_path
    push(m, int(block(m, 0, 0.5)["address"]), yd=1.5)
    solution = m.solve(1e-9, limit=100)
    assert not solution
    top = m.table("block")[m.table("block")["KY"] > 0.5][0]
    assert 0.02 < top["KY"] - 0.5 < 0.1 * 2 * top["KBRO"]
    assert solution.fallen == (int(top["address"]),)
