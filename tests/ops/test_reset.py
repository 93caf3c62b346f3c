"""RESET: displacements of plots, slip of contacts and the time of the model begin anew."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.text import Text
from support.mechanics_scenes import on_base, sound

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g


def sliding(out: Path) -> Model:
    """A block that gravity lets slide on its base."""
    m = on_base(1.0, 1.0, 0.1, 8.0, friction=0.2, gravity=(4.0, -10.0))
    m.out = out
    m.damping(local=0.5)
    m.cycle(time=0.2)
    return m


def test_slip_begins_anew_and_nothing_else_changes(tmp_path: Path) -> None:
    m = sliding(tmp_path)
    before = m.table("contact").copy()
    assert np.abs(before["KCS"]).max() > 1e-3
    step = float(m.h.cr[g.TDEL]), int(m.h.ci[g.LREADY])
    m.reset("slip")
    after = m.table("contact")
    assert (after["KCS"] == 0).all()
    assert all((after[name] == before[name]).all() for name in after.dtype.names if name != "KCS")
    assert (float(m.h.cr[g.TDEL]), int(m.h.ci[g.LREADY])) == step
    sound(m)


def test_functions_begin_again_and_sines_go_on(tmp_path: Path) -> None:
    """The velocity of a sine is that without RESET; the factor of a function is that of the new time."""
    one, two = (on_base(1.0, 1.0, 0.1, 4.0) for _ in range(2))
    for m in (one, two):
        m.cycle(10)
        m.boundary(-1, 1, 0, 1, xvel=0.01, sine=(5.0, 1.0))
        m.cycle(50)
    two.function(1, 0.0, 1.0, 0.05, 2.0)
    two.property(2, p1=1.0, function=1)
    two.reset("time")
    assert float(two.h.cd[g.TIME]) == 0.0
    for m in (one, two):
        m.cycle(20)
    np.testing.assert_allclose(two.table("block")["KXD"], one.table("block")["KXD"], rtol=1e-9)
    t = float(two.h.cd[g.TIME]) - float(two.h.cr[g.TDEL]) / 2
    assert float(two.h.cr[g.PAR1 + 1]) == pytest.approx(np.interp(t, [0.0, 0.05], [1.0, 2.0]), rel=1e-12)
    sound(two)


def test_displacements_are_measured_from_the_reset(tmp_path: Path) -> None:
    """In the open picture, and in a new one; without it from the first state of the picture."""
    m = sliding(tmp_path)
    x = float(m.table("block")["KX"].max())
    m.plot(0)
    m.cycle(time=0.1)
    middle = float(m.table("block")["KX"].max())
    m.plot(1, displacements=True)
    assert _largest(m) == pytest.approx(middle - x, rel=1e-3)
    m.reset("displacements")
    m.cycle(time=0.1)
    end = float(m.table("block")["KX"].max())
    for n in (1, 0):
        m.plot(n, displacements=True)
        assert _largest(m) == pytest.approx(end - middle, rel=1e-3)
    m.start()
    assert m.session.plots is not None
    assert m.session.plots.origin is None


def _largest(m: Model) -> float:
    """The largest displacement by the note below the picture."""
    plots = m.session.plots
    assert plots is not None
    assert plots.frame is not None
    texts = [text.get_text() for text in plots.frame.figure().findobj(Text)]
    (found,) = [found for text in texts if (found := re.search(r"largest displacement: (\S+) (m|mm)$", text))]
    return float(found[1]) * {"m": 1.0, "mm": 1e-3}[found[2]]


def test_words_are_combined_and_wrong_ones_refused(tmp_path: Path) -> None:
    m = sliding(tmp_path)
    before = [part.tobytes() for part in m.array.h[:4]]
    for words, number in (((), 7), (("slip", "forces"), 10)):
        with pytest.raises(UdecError) as caught:
            m.reset(*words)
        assert caught.value.number == number
    assert [part.tobytes() for part in m.array.h[:4]] == before
    m.run("RESET SLIP DISP TIME\n")
    assert float(m.h.cd[g.TIME]) == 0
    assert (m.table("contact")["KCS"] == 0).all()


def test_a_reset_is_undone(tmp_path: Path) -> None:
    m = sliding(tmp_path)
    before = [part.tobytes() for part in m.array.h[:4]]

    def fail() -> None:
        m.reset("slip", "time", "displacements")
        raise ValueError

    with pytest.raises(ValueError, match=r"^$"):
        m.whole(fail)
    assert [part.tobytes() for part in m.array.h[:4]] == before
    assert m.session.plots is None
