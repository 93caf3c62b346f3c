"""To rest with fewer cycles: each way does what its formula says, and the state of rest is the exact one."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive.stiffness import Scene
from support.every_group_kind import every_kind
from support.mechanics_scenes import G, block, box, model, on_base
from support.safe_step_scenes import draw

from udec_ia import Model, UdecError
from udec_ia.kernels.energy.stored_energy import kinetic_energy
from udec_ia.layout import offsets as g

KN, DENSITY = 1e8, 1000.0
WAYS: list[dict[str, Any]] = [{"local": 0.8}, {"combined": 0.8}, {"kinetic": True}, {"adaptive": 0.7}]


@pytest.fixture(autouse=True)
def _histories_go_elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def sign(v: float) -> float:
    return math.copysign(1.0, v) if v else 0.0


def bounces(way: str, f: float, dt: float, cycles: int) -> list[float]:
    """Velocities of a block of 1 x 1 m, dropped without a gap on two springs of KN, cycle by cycle."""
    m, v, fall, before, kinetic_energy, alpha = DENSITY, 0.0, 0.0, 0.0, 0.0, 0.0
    found = []
    for _ in range(cycles):
        now = m * v * v / 2
        if way == "kinetic":
            if now < kinetic_energy:
                v, now = 0.0, 0.0
            kinetic_energy = now
        force = 2 * KN * max(-fall, 0.0) - m * G
        damped = force
        if way == "adaptive":
            quotient = -v * (force - before) / (m * v * v * dt) if v else 0.0
            alpha = min(max(2 * f * math.sqrt(max(quotient, 0.0)), 1e-3 / dt), 1 / dt)
        if way == "local":
            damped = force - f * abs(force) * sign(v)
        elif way == "combined":
            damped = force - f * abs(force) * (sign(v) - sign(force - before)) / 2
        elif way == "kinetic" and kinetic_energy == 0:  # half a step from rest
            damped = force / 2
        before = force
        v = (v * (1 - alpha * dt / 2) + damped / m * dt) / (1 + alpha * dt / 2)
        fall += v * dt
        found.append(v)
    return found


@pytest.mark.parametrize("way", WAYS, ids=lambda way: next(iter(way)))
def test_a_block_on_springs_moves_as_the_formula_says(way: dict[str, Any]) -> None:
    m = on_base(1.0, 1.0, 0.05, 4.0, density=DENSITY, stiffness=(KN, KN))
    m.damping(**way)
    speeds = []
    for _ in range(60):
        m.cycle(1)
        speeds.append(float(block(m, 0, 0.5)["KYD"]))
    name, f = next(iter(way.items()))
    expected = bounces(name, float(f), float(m.h.cr[g.TDEL]), 60)
    # an overlap is the difference of coordinates of 1 m: each cycle adds a last digit of these times KN dt/m
    grain = 60 * 60 * np.finfo(float).eps * 2 * KN / DENSITY * float(m.h.cr[g.TDEL])
    assert speeds == pytest.approx(expected, abs=grain)
    assert max(map(abs, speeds)) > 1e3 * grain


def test_adaptive_damping_looks_at_all_that_moves_and_back_over_the_cycles_before() -> None:
    """Two blocks apart, of 1 x 1 and 1 x 3 m, which share one ALPHA: Rayleigh's quotient of both, fading."""
    m = model(*box(0, 9, -1, 3), d=0.05, density=DENSITY, stiffness=(KN, KN))
    m.split(-1, 0, 10, 0)
    m.split(1, -0.5, 1, 4)
    m.split(8, -0.5, 8, 4)
    m.split(7.5, 1, 10, 1)
    m.delete(1, 8, 0, 3)
    m.delete(8, 9, 1, 3)
    m.fix(0, 9, -1, 0)
    m.damping(adaptive=0.6)
    masses = np.array([3 * DENSITY, DENSITY])
    v, fall, before = (np.zeros(2) for _ in range(3))
    grown = moved = 0.0
    quotients = []
    for _ in range(80):
        m.cycle(1)
        dt = float(m.h.cr[g.TDEL])
        force = 2 * KN * np.maximum(-fall, 0.0) - masses * G
        growing, moving = -float((v * (force - before)).sum()) / dt, float((masses * v * v).sum())
        grown, moved = 0.93 * grown + growing, 0.93 * moved + moving
        w = math.sqrt(max(grown / moved, 0.0)) if moved else 0.0
        quotients.append(growing / moving / w**2 if w else 1.0)
        alpha = min(max(2 * 0.6 * w, 1e-3 / dt), 1 / dt)
        assert float(m.h.cr[g.ALPHA]) == pytest.approx(alpha, rel=1e-6)
        before = force
        v = (v * (1 - alpha * dt / 2) + force / masses * dt) / (1 + alpha * dt / 2)
        fall += v * dt
    speeds = [float(block(m, x, y)["KYD"]) for x, y in ((0.5, 1.5), (8.5, 0.5))]
    assert speeds == pytest.approx(v.tolist(), rel=1e-6)
    assert max(quotients) > 1.2  # of a cycle by itself
    assert min(quotients) < 0.9


def rotated(tensor: Any, angle: float) -> Any:
    """A tensor in the plane, turned anticlockwise."""
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    return turn @ np.asarray(tensor) @ turn.T


def strain_rates(angle: float, **damping: Any) -> Any:
    """Of a flat block that floats freely and is shaken at first, in its own axes, which are at `angle`."""
    c, s = math.cos(angle), math.sin(angle)
    outline = [(c * x - s * y, s * x + c * y) for x, y in box(0, 4, 0, 1)]
    m = model(*outline, d=0.05, gravity=(0.0, 0.0))
    m.property(1, bulk=2e7, g=1e7)
    m.change(-9, 9, -9, 9, type="sdef")
    m.damping(**damping)
    m.cycle(0)
    (ext,) = m.table("sdef")["address"].tolist()
    names = g.KED11, g.KED12, g.KED21, g.KED22
    for name, rate in zip(names, rotated([[1e-3, 4e-4], [4e-4, -7e-4]], angle).ravel(), strict=True):
        m.rset(float(rate), ext, name[m.array.scheme.ratio >> 1])
    m.cycle(25)
    (ext,) = m.table("sdef")
    return rotated([[ext["KED11"], ext["KED12"]], [ext["KED21"], ext["KED22"]]], -angle)


@pytest.mark.parametrize("way", WAYS, ids=lambda way: next(iter(way)))
def test_strains_are_damped_along_the_axes_of_the_block(way: dict[str, Any]) -> None:
    """However the block lies in x and y."""
    straight = strain_rates(0.0, **way)
    assert np.abs(straight).max() > 1e-6
    for angle in (0.5, 1.2, math.pi / 2, 2.8):
        np.testing.assert_allclose(strain_rates(angle, **way), straight, atol=1e-9)


@pytest.mark.parametrize("way", [{"local": 0.8}, {"combined": 0.8}], ids=["local", "combined"])
def test_a_slanted_block_that_strains_stays_stable_near_the_bound(way: dict[str, Any]) -> None:
    """Shaken, at 0.95 of the safe step: this scene blew up where strains were damped along x and y."""
    m = draw("deformable", 100026).model
    m.fraction(0.95, safe=True)
    m.damping(**way)
    m.cycle(1)
    rng, speed = np.random.default_rng(1), g.KXD[m.array.scheme.ratio >> 1]
    for row in m.table("block"):
        if row["KBFIX"] == 0:
            v = float(rng.uniform(-1, 1)) * 1e-8 * float(row["KBRO"]) / float(m.h.cr[g.TDEL])
            m.rset(v, int(row["address"]), speed)
    first = float(kinetic_energy(m.h, True))
    m.cycle(2000)
    assert float(kinetic_energy(m.h, True)) < 0.5 * first


@pytest.mark.parametrize("way", [*WAYS, {}], ids=lambda way: next(iter(way), "static"))
def test_a_column_comes_to_its_exact_overlaps(way: dict[str, Any]) -> None:
    """Level k carries k W on two contacts; what is out of balance may shift an overlap by as much."""
    n, ratio = 4, 1e-3
    m = model(*box(0, 1, -1, n), d=0.05, density=DENSITY, stiffness=(KN, KN), friction=0.5)
    for y in range(n):
        m.split(-1, y, 2, y)
    m.fix(0, 1, -1, 0)
    if way:
        m.damping(**way)
    assert m.solve(ratio, 20000, static=not way)
    overlaps = {round(float(c["KYC"])): float(c["KCN"]) for c in m.table("contact") if c["KCCOD"] != 4}
    weight = DENSITY * G
    mean = weight * (n + 1) / 2 / 2
    grain = 4 * n * float(np.finfo(m.h.cr.dtype).eps)
    for level in range(n):
        expected = (n - level) * weight / (2 * KN)
        assert overlaps[level] == pytest.approx(expected, abs=n * ratio * mean / KN + grain)


def kinds_of_blocks() -> Model:
    """Rigid, simply- and fully-deformable blocks, of which some are very stiff or very small."""
    m = every_kind()
    m.boundary(-1, 7, -2, 2, free=True)
    m.split(-1, 0.2, 2.5, 0.2)
    return m


def spread(scene: Scene) -> float:
    """The highest over the lowest frequency of a degree of freedom on its own."""
    free = np.setdiff1d(np.arange(len(scene.mass)), scene.held)
    own = (np.diag(scene.stiffness) / np.diag(scene.mass))[free]
    return math.sqrt(own.max() / own[own > 0].min())


def test_scaled_masses_are_safe_and_all_as_quick() -> None:
    """By dense matrices: the step stays below the critical one, and slow blocks are quicker than before."""
    m = kinds_of_blocks()
    m.fluid(mode="drained")  # water that is compressed adds to the stiffness
    m.fraction(1.0, scaled=True)
    m.cycle(1)
    dt = float(m.h.cr[g.TDEL])
    scene = Scene(m, (1e8, 5e7), (KN, KN))
    true, before = scene.critical(), spread(scene)
    relaxations = m.table("relax")
    assert len(relaxations) == len(m.table("block")) - 2 + len(m.table("gridpoint"))
    quickest = []
    for row in relaxations:
        at = scene.first[int(row["KRXG"] or row["KRXB"])]
        factors = [row["KRXM"]] * 2 if row["KRXG"] else [row["KRXM"], row["KRXM"], row["KRXI"]]
        if scene.blocks[int(row["KRXB"])]["HEAD"] == g.MSDEF:
            factors += [row["KRXE"]] * 3
        for k, factor in enumerate(factors, at):
            scene.mass[k] /= float(factor)
        held = set(range(at, at + 2)) & set(scene.held)
        if not held:
            quickest.append(float(row["KRXM"]))
    assert dt <= scene.critical() * (1 + 1e-9)
    assert dt <= true * (1 + 1e-9)
    assert max(quickest) > 2 * min(quickest)
    assert spread(scene) < before


def test_cycles_divide_as_they_will() -> None:
    """Scaled masses, COMBINED damping and contacts that are made: 7 and 293 cycles are 300."""
    one, two = kinds_of_blocks(), kinds_of_blocks()
    for m in (one, two):
        m.damping(combined=0.6)
        m.fraction(0.7, scaled=True)
    one.cycle(300)
    for n in (7, 90, 110, 93):
        two.cycle(n)
    used = int(one.h.ci[g.MFREE]) - 1
    assert (one.h.ia[:used] == two.h.ia[:used]).all()


@pytest.mark.parametrize("way", [{"local": 0.5}, {"combined": 0.5}, {"kinetic": True}])
def test_the_account_of_the_energy_knows_what_it_takes(way: dict[str, Any]) -> None:
    m = on_base(1.0, 1.0, 0.05, 4.0, density=DENSITY, stiffness=(KN, KN))
    m.energy()
    m.damping(**way)
    m.cycle(200)
    balance = m.balance()
    assert balance.relaxation > 0.3 * balance.throughput
    # linear springs that stay closed: only rounding is left, of overlaps that are differences of 1 m
    assert abs(balance.residual) < 1e-9 * balance.throughput


def test_static_leaves_all_as_it_was_but_the_state() -> None:
    m = kinds_of_blocks()
    m.damping(0.3, 12)
    m.fraction(0.05)
    m.cycle(5)
    kept = [g.ALPHA, g.BETA, g.ALPB, g.FRAC, g.RESTF]
    before = m.h.cr[kept].tolist(), int(m.h.ci[g.LREST]), int(m.h.ci[g.LSCALE]), int(m.h.ci[g.LSAFE])
    solution = m.solve(1e-3, 5000, static=True)
    assert solution
    assert (m.h.cr[kept].tolist(), *(int(m.h.ci[k]) for k in (g.LREST, g.LSCALE, g.LSAFE))) == before
    assert not len(m.table("relax"))
    assert not m.table("block")["KXD"].any()
    assert not m.table("gridpoint")["KYDG"].any()
    assert not m.check()
    assert "SOLVE 0.001 LIMIT 5000 STATIC" in m.deck()


def test_an_error_on_the_way_leaves_the_settings_as_they_were() -> None:
    m = on_base(1.0, 1.0, 0.05, 4.0, density=DENSITY, stiffness=(10 * G, 10 * G))  # far too soft
    m.damping(0.1, 1.0, "mass")
    with pytest.raises(UdecError) as caught:
        m.solve(1e-6, 10000, static=True)
    assert caught.value.number == 15
    assert int(m.h.ci[g.LREST]) == int(m.h.ci[g.LSCALE]) == int(m.h.ci[g.IRXPNT]) == 0
    assert float(m.h.cr[g.ALPHA]) == pytest.approx(0.1 * 2 * math.pi)
    assert "STATIC" in m.deck()


def test_a_command_gives_relaxations_back() -> None:
    m = kinds_of_blocks()
    m.damping(combined=0.5)
    m.cycle(3)
    assert len(m.table("relax"))
    m.delete(0, 1, 0.2, 1)
    assert not len(m.table("relax"))
    assert not m.check()
    m.cycle(3)
    hosts = [(int(r["KRXB"]), int(r["KRXG"])) for r in m.table("relax")]
    assert len(set(hosts)) == len(hosts) > 0
    assert not m.check()


def test_what_does_not_go_together_is_said() -> None:
    m = on_base(1.0, 1.0, 0.05, 4.0)
    for call, number in (
        (lambda: m.damping(), 7),
        (lambda: m.damping(0.1, 3.0, local=0.5), 7),
        (lambda: m.damping(local=1.5), 28),
        (lambda: m.damping(combined=-0.1), 28),
        (lambda: m.fraction(1.5, scaled=True), 28),
    ):
        with pytest.raises(UdecError) as caught:
            call()
        assert caught.value.number == number
    m.energy()
    for scaled in (lambda: m.fraction(0.5, scaled=True), lambda: m.solve(1e-3, static=True)):
        with pytest.raises(UdecError) as caught:
            scaled()
        assert caught.value.number == 26
    m.energy("off")
    m.fraction(0.5, scaled=True)
    with pytest.raises(UdecError) as caught:
        m.energy()
    assert caught.value.number == 26


def test_one_way_takes_the_place_of_another() -> None:
    m = on_base(1.0, 1.0, 0.05, 4.0)
    m.damping(0.5, 10)
    ways = [{"adaptive": 0.5}, {"local": 0.8}, {"adaptive": 0.5}, {"kinetic": True}, {"combined": 0.8}]
    for way in ways:
        m.damping(**way)
        m.cycle(3)
        assert (float(m.h.cr[g.ALPHA]) > 0) == ("adaptive" in way)
        assert float(m.h.cr[g.BETA]) > 0
    m.damping(0.5, 10, "mass")
    assert int(m.h.ci[g.LREST]) == g.UNDAMPED
    assert float(m.h.cr[g.BETA]) == 0


@pytest.mark.parametrize("friction", [0.05, 5.0])
def test_what_slides_on_is_named_and_does_not_rest(friction: float) -> None:
    """A push of a tenth of its weight moves a block on the one joint, and the other one holds it."""
    m = on_base(1.0, 1.0, 0.05, 6.0, density=DENSITY, stiffness=(KN, KN), friction=friction)
    m.boundary(-3, 3, -0.1, 1.1, xforce=0.1 * DENSITY * G)
    m.damping(0.5, 10, "mass")
    solution = m.solve(1e-3, 300, static=True)
    assert solution.keys == (("blocks-move",) if friction < 1 else ())
    assert (float(m.h.cd[g.WFRIC]) > 0) == (friction < 1)
