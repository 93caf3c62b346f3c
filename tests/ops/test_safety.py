"""FOS: the factor of safety against statics, whatever the number of processes; and what it refuses."""

from __future__ import annotations

import json
import logging
from math import radians, sin, sqrt, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from udec_ia import Model, UdecError, sweep
from udec_ia.cli import main
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import scheme
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.running import factor_of_safety
from udec_ia.running.factor_of_safety import FAILING, STABLE, UNDECIDED, FactorOfSafety, Trial, take_trials

SLAB, ANGLE, LENGTH, DEPTH = 20e3, radians(20), 4.0, 1.0  # N/m3; the plane; the slab along and across it


@pytest.fixture(autouse=True)
def _quiet(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.CRITICAL, "udec_ia")


def slab(friction: float, cohesion: float = 0.0, build: str = "i32r64", **jproperty: Any) -> Model:
    """A slab at rest on another one, under a gravity that has turned by ANGLE."""
    m = Model(build)
    m.tell = lambda _: None
    m.property(1, density=2000, kn=1e9, ks=1e9, bulk=1e9, g=6e8)
    m.jproperty(1, kn=1e9, ks=1e9, friction=5.0)
    m.block(0, -1, 0, DEPTH, LENGTH, DEPTH, LENGTH, -1)
    m.split(-1, 0, LENGTH + 1, 0, joint=1, jmaterial=1)
    m.round(0.01)
    m.gravity(10 * sin(ANGLE), -10 * sqrt(1 - sin(ANGLE) ** 2))
    m.fix(0, LENGTH, -1, 0)
    m.solve(1e-6, static=True)
    m.jproperty(1, friction=friction, cohesion=cohesion, **jproperty)
    return m


def exact(friction: float, cohesion: float = 0.0) -> float:
    weight = SLAB * LENGTH * DEPTH
    return (weight * friction + cohesion * LENGTH / sqrt(1 - sin(ANGLE) ** 2)) / (weight * tan(ANGLE))


@pytest.mark.parametrize(("friction", "cohesion"), [(0.5, 0.0), (0.3, 0.0), (0.2, 5e3), (3.0, 0.0)])
def test_a_slab_slides_at_its_factor(friction: float, cohesion: float, tmp_path: Path) -> None:
    m = slab(friction, cohesion)
    m.out, m.name = tmp_path, "slab"
    found = m.fos(tolerance=0.004)
    low, high = found.bracket
    assert low < exact(friction, cohesion) < high * (1 + 1e-5)
    assert high - low <= 0.004 * found.factor
    assert [path.name for path in found.files] == ["slab-fos-1.png", "slab-fos-1.svg"]
    assert all(path.exists() for path in found.files)
    assert found.stable is not None
    assert found.stable.verdict == STABLE
    assert found.failing is not None
    assert found.failing.verdict == FAILING
    assert found.failing.moved > 10 * found.stable.moved
    factors = [one.factor for one in found.trials]
    assert factors == sorted(factors)
    assert f"{found.factor:.4g}" in str(found)


def test_processes_do_not_change_a_digit_and_the_model_stays() -> None:
    m = slab(0.5)
    before = m.h.ia.copy(), m.h.cr.copy(), m.h.cd.copy()
    one, two = (m.fos(tolerance=0.02, picture=False, jobs=jobs) for jobs in (1, 2))
    for a, b in zip(before, (m.h.ia, m.h.cr, m.h.cd), strict=True):
        assert a.tobytes() == np.asarray(b).tobytes()
    assert str(one) == str(two)
    for trial, other in ((one.stable, two.stable), (one.failing, two.failing)):
        states = [one.array.h.ia.tobytes() for one in (trial, other) if one is not None and one.array]
        assert len(states) == 2
        assert states[0] == states[1]


@pytest.mark.parametrize("build", ["i16r64", "i64r64"])
def test_every_scheme_with_64_bit_reals_finds_it(build: str) -> None:
    found = slab(0.5, build=build).fos(tolerance=0.02, picture=False)
    assert found.factor == pytest.approx(exact(0.5), rel=0.02)


def test_properties_of_contacts_are_divided_too() -> None:
    """Friction and cohesion of materials, as in 1980: the cohesion is a force of each of the two contacts."""
    m = Model()
    m.tell = lambda _: None
    m.property(1, density=2000, kn=1e9, ks=1e9, friction=0.2, cohesion=10e3)
    m.block(0, -1, 0, DEPTH, LENGTH, DEPTH, LENGTH, -1)
    m.split(-1, 0, LENGTH + 1, 0)
    m.round(0.01)
    m.gravity(10 * sin(ANGLE), -10 * sqrt(1 - sin(ANGLE) ** 2))
    m.fix(0, LENGTH, -1, 0)
    m.solve(1e-6, static=True)
    weight = SLAB * LENGTH * DEPTH * sqrt(1 - sin(ANGLE) ** 2)
    factor = (weight * 0.2 + 2 * 10e3) / (weight * tan(ANGLE))
    assert m.fos(tolerance=0.01, picture=False).factor == pytest.approx(factor, rel=0.01)


@pytest.mark.parametrize("friction", [0.5, 0.2])
def test_a_function_that_multiplies_friction_is_divided(friction: float) -> None:
    """And ends where the strength is unlimited: with 0.2 the slab would not rest."""
    m = slab(friction)
    m.function(1, 0.0, 1.0, 1e9, 1.0)
    m.jproperty(1, friction=friction, function=1)
    assert m.fos(tolerance=0.02, picture=False).factor == pytest.approx(exact(friction), rel=0.02)


def test_only_the_strength_in_a_range_is_divided() -> None:
    """Two slabs side by side with joint materials of their own."""
    m = Model()
    m.tell = lambda _: None
    m.property(1, density=2000, kn=1e9, ks=1e9)
    for n, friction in ((1, 0.5), (2, 0.6)):
        m.jproperty(n, kn=1e9, ks=1e9, friction=friction)
    m.block(0, -1, 0, 1, 10, 1, 10, -1)
    m.split(-1, 0, 11, 0, joint=1, jmaterial=1)
    m.split(5, -0.01, 5, 2, joint=3)
    m.round(0.01)
    m.gravity(10 * sin(ANGLE), -10 * sqrt(1 - sin(ANGLE) ** 2))
    m.fix(0, 10, -1, 0)
    with pytest.raises(UdecError) as error:
        m.fos(0, 5, -1, 1, joints=True, picture=False)
    assert error.value.number == 10
    m.change(5, 10, -0.5, 0.5, jmaterial=2)
    m.solve(1e-6, static=True)
    whole, right = m.fos(joints=True, picture=False), m.fos("JMATERIAL 2", joints=True, picture=False)
    assert whole.factor < right.factor  # the left slab holds the right one


def test_what_cannot_be_done_is_refused() -> None:
    with pytest.raises(UdecError) as error:
        slab(0.0).fos(picture=False)
    assert error.value.number == 26
    m = slab(0.5)
    for wrong in ({"tolerance": 0.0}, {"jobs": 0}):
        with pytest.raises(UdecError) as error:
            m.fos(**wrong)
        assert error.value.number == 28
    m.jproperty(1, model="barton", jrc=5, jcs=1e8, sigmac=1e8)
    with pytest.raises(UdecError) as error:
        m.fos(joints=True)
    assert error.value.number == 26


def test_a_deck_and_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = tmp_path / "slab.dat"
    deck.write_text(
        "START\nGRAVITY 3.4202 -9.3969\nPROP MAT=1 DENS=2000 KN=1E9 KS=1E9 F=0.5\nBLOCK 0,-1 0,1 4,1 4,-1\n"
        "SPLIT -1 0 5 0\nROUND 0.01\nFIX BELOW 0 0 4 0\nSOLVE 1E-6 STATIC\n"
    )
    m = Model(out=tmp_path)
    more = "FOS\nFOS JOINTS TOLERANCE=0.05\nFOS 0 4 -2 2 TOLERANCE=0.05\nFOS RANGE MATERIAL 1\n"
    text = m.run(f"{deck.read_text()}{more}")
    assert str(text).count("factor of safety") == 4
    assert main(["fos", str(deck), "--tolerance", "0.02", "--out", str(tmp_path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    stable = [row["factor"] for row in found["rows"] if row["verdict"] == "stable"]
    assert max(stable) == pytest.approx(exact(0.5), rel=0.02)
    assert (tmp_path / "slab-fos-1.png").exists()
    m.stage("rest")
    stage = f"{tmp_path}/udec-stages.zip/rest"
    assert main(["fos", stage, "--tolerance", "0.05", "--out", str(tmp_path)]) == 0
    assert "factor of safety" in capsys.readouterr().out


def test_a_sweep_has_the_factor_of_each_run(tmp_path: Path) -> None:
    deck = (
        "START\nGRAVITY 3.4202 -9.3969\nPROP MAT=1 DENS=2000 KN=1E9 KS=1E9 F=2\nBLOCK 0,-1 0,1 4,1 4,-1\n"
        "SPLIT -1 0 5 0\nROUND 0.01\nFIX BELOW 0 0 4 0\nSOLVE 1E-6 STATIC\nPROP MAT=1 F=$F\n"
        "FOS TOLERANCE=0.05\n"
    )
    found = sweep(deck, {"F": [0.4, 0.6]}, out=tmp_path, jobs=0)
    for friction, factor in zip((0.4, 0.6), found.table.column("factor of safety"), strict=True):
        assert factor == pytest.approx(exact(friction), rel=0.05)
    asked = ("low = fos.stable", "high = fos.failing", "middle = fos.factor")
    found = sweep(deck, {"F": [0.4]}, quantities=asked, out=tmp_path / "asked", jobs=0)
    ((low,), (high,), (middle,)) = (found.table.column(name) for name in ("low", "high", "middle"))
    assert low < high
    assert middle == (low + high) / 2


@pytest.mark.parametrize(("width", "is_found"), [(0.001, True), (0.1, False)])
def test_an_undecided_factor_is_tried_once(
    width: float, is_found: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The bracket closes in on it until it is as narrow as the tolerance; else the result says so."""
    tried: list[float] = []

    def run_round(
        array: object, laws: object, places: object, factors: tuple[float, ...], *_: object
    ) -> list[Trial]:
        tried.extend(factors)
        return [trial(one) for one in factors]

    def trial(factor: float) -> Trial:
        verdict = UNDECIDED if abs(factor - 1.25) < width else STABLE if factor < 1.25 else FAILING
        return Trial(factor, verdict, 1000, 1e-3, 0.0, 0.0, 0.0, 0)

    monkeypatch.setattr(factor_of_safety, "_run_round", run_round)
    monkeypatch.setattr(factor_of_safety, "response_cycles", lambda array, laws: 1000)
    found = factor_of_safety.factor_of_safety(MainArray(scheme("i32r64")), LawBook(None), [], 0.02)
    assert len(tried) == len({*tried})
    assert found.is_found is is_found
    assert ("trials between are undecided" in str(found)) is not is_found


@pytest.mark.parametrize(("height", "factor"), [(0.7, 3.357), (0.78, 3.00), (1.0, 2.022)])
def test_cohesion_acts_along_all_of_a_joint_that_is_partly_open(height: float, factor: float) -> None:
    """A block on a plane of 60 degrees; N acts at 2 m less half the height times the tangent from its toe.

    The closed part is three times as long as N is away from the toe, 4 m at most.
    """
    m = Model()
    m.tell = m.inform = lambda _: None
    x, y = -np.sqrt(3) / 2 * height, height / 2
    m.property(1, density=2000, kn=1e9, ks=1e9)
    m.jproperty(1, kn=1e9, ks=1e9, friction=5, cohesion=1e9, between=(1, 1))
    m.block(-4, -7, -4, -4 * np.sqrt(3), 5, 5 * np.sqrt(3), 9, 5 * np.sqrt(3), 9, -7)
    m.block(0, 0, x, y, 2 + x, 2 * np.sqrt(3) + y, 2, 2 * np.sqrt(3))
    m.round(0.005)
    m.fix("NOT AREA < 10")
    m.gravity(0, -10)
    m.solve(1e-7, static=True)
    m.jproperty(1, friction=0.1, cohesion=4e4)
    closed = min(4.0, 3 * (2 - height / 2 * np.sqrt(3)))
    weight = 2000 * 10 * 4 * height
    exact = (4e4 * closed + 0.1 * weight / 2) / (weight * np.sqrt(3) / 2)
    assert exact == pytest.approx(factor, rel=2e-3)
    assert m.fos(tolerance=0.01, picture=False).factor == pytest.approx(exact, rel=0.012)


@pytest.mark.parametrize("tension", [2.05e4, 1.5e4])
def test_tensile_strength_is_unlimited_in_the_first_run(tension: float) -> None:
    m = Model()
    m.tell = m.inform = lambda _: None
    m.property(1, density=2000, kn=1e9, ks=1e9)
    m.jproperty(1, kn=1e9, ks=1e9, friction=1, cohesion=1e7, tension=1e9, between=(1, 1))
    m.block(0, 0, 0, 2, 3, 2, 3, 0)
    m.split(-1, 1, 4, 1)
    m.round(0.005)
    m.fix("ABOVE 0 1 3 1")
    m.gravity(0, -10)
    m.solve(1e-7, static=True)
    m.jproperty(1, tension=tension)
    assert m.fos(tolerance=0.01, picture=False).factor == pytest.approx(tension / 2e4, rel=0.012)


def test_a_trial_that_is_slow_below_a_stable_factor_does_not_count() -> None:
    def trial(factor: float, verdict: str, fallen: int = 0) -> Trial:
        return Trial(factor, verdict, 1000, 1e-3, 0.0, 0.0, 0.0, fallen)

    found = FactorOfSafety(trial(1.25, STABLE), trial(1.5, FAILING), 1000, [])
    take_trials(found, [trial(1.3, FAILING), trial(1.35, STABLE), trial(1.4, FAILING)])
    assert found.bracket == (1.35, 1.4)
    found = FactorOfSafety(trial(1.25, STABLE), trial(1.5, FAILING), 1000, [])
    take_trials(found, [trial(1.3, FAILING, 2), trial(1.35, STABLE), trial(1.4, FAILING)])
    assert found.bracket == (1.25, 1.3)


def test_an_empty_range_is_refused() -> None:
    m = slab(0.8, 0.0)
    for words, number in (("CIRCLE 100 100 5", 24), ("AREA < 1e-6", 24)):
        with pytest.raises(UdecError) as error:
            m.fos(words)
        assert error.value.number == number
    with pytest.raises(UdecError) as error:
        m.fos(tolerance=2.0)
    assert error.value.number == 28


def test_an_answer_without_both_ends_is_no_number() -> None:
    trials = [Trial(factor, UNDECIDED, 1000, 1e-3, 0.0, 0.0, 0.0, 0) for factor in (0.5, 1.0, 2.0)]
    found = FactorOfSafety(None, None, 1000, trials)
    assert np.isnan(found.factor)
    assert "undecided" in str(found)
