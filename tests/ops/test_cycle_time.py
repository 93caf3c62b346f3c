"""CYCLE TIME: the number of cycles follows from the time, also where the step changes."""

from __future__ import annotations

import io
import re
from pathlib import Path

import pytest
from support.mechanics_scenes import colliding, standing_block

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g
from udec_ia.output import run_progress

TIME, STEP = g.TIME, g.TDEL


@pytest.mark.parametrize("steps", [0.0, 0.3, 1.0, 7.0, 1000.0, 1000.5, 999.999])
def test_the_last_cycle_reaches_the_time(steps: float, tmp_path: Path) -> None:
    """Within a step beyond it; as many cycles as whole steps fit, whatever the sum of steps rounds to."""
    m, other = standing_block(tmp_path), standing_block(tmp_path)
    m.cycle(3)
    other.cycle(3)
    dt, before = float(m.h.cr[STEP]), float(m.h.cd[TIME])
    n = m.cycle(time=steps * dt)
    assert n == -(-round(steps * 1000) // 1000)
    passed = float(m.h.cd[TIME]) - before
    assert -1e-6 * dt <= passed - steps * dt < dt
    assert other.cycle(n) == n
    assert m.h.ia.tobytes() == other.h.ia.tobytes()
    assert m.h.ci[g.NCYC] == n


def test_a_step_that_becomes_shorter_takes_more_cycles(tmp_path: Path) -> None:
    m = colliding(tmp_path)
    m.fraction(1.0, safe=True)
    m.cycle(0)
    dt, before, t = float(m.h.cr[STEP]), float(m.h.cd[TIME]), 0.4
    n = m.cycle(time=t)
    assert float(m.h.cr[STEP]) < dt
    assert n > t / dt + 1
    assert -1e-9 < float(m.h.cd[TIME]) - before - t < dt


def test_progress_has_the_cycles_that_a_shorter_step_takes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run_progress, "QUIET", 0.0)
    m = colliding(tmp_path)
    m.fraction(1.0, safe=True)
    m.progress = stream = io.StringIO()
    n = m.cycle(time=0.4)
    shown = re.findall(r"cycle (\d+) of (\d+)", stream.getvalue())
    assert shown[-1] == (str(n), str(n))
    assert all(int(done) <= int(total) for done, total in shown)


def test_it_stops_and_goes_on_in_the_debugger(tmp_path: Path) -> None:
    deck = """START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8
BLOCK 0,0 0,2 1,2 1,0
SPLIT -1,1 2,1
FIX 0 1 0 1
FUNCTION 1 0 0.5 0.1 1
GRAVITY 0 -10 FUNCTION 1
BOUNDARY 0 1 0 1 YVEL 0.001 ROTATION 0 FUNCTION 1
CYCLE TIME 0.1
STOP
"""
    plain, debugged = Model(out=tmp_path), Model(out=tmp_path)
    plain.run(deck)
    debugged.debug(deck, ["goto 17", "reverse-step 2", "resume", "continue"])
    assert debugged.h.cd[TIME] == pytest.approx(float(plain.h.cd[TIME]), rel=1e-12)
    assert debugged.h.ci[g.MCTOT] == plain.h.ci[g.MCTOT] > 10
    assert debugged.h.ia.tobytes() == plain.h.ia.tobytes()


def test_the_log_has_it(tmp_path: Path) -> None:
    m = standing_block(tmp_path)
    m.cycle(2)
    m.cycle(time=0.01)
    m.cycle(3)
    other = Model(out=tmp_path)
    other.run(m.deck())
    assert "CYCLE TIME 0.01\n" in m.deck()
    assert other.h.ia.tobytes() == m.h.ia.tobytes()


@pytest.mark.parametrize(
    ("given", "number"),
    [
        *[({}, 7), ({"n": 1, "time": 1.0}, 10)],
        *[({"time": one}, 28) for one in (-1.0, float("inf"), 1e30)],
    ],
)
def test_wrong_times_are_refused(given: dict[str, float], number: int, tmp_path: Path) -> None:
    m = standing_block(tmp_path)
    with pytest.raises(UdecError) as caught:
        m.cycle(**given)  # type: ignore[arg-type]
    assert caught.value.number == number
    assert m.h.ci[g.MCTOT] == 0
