"""What a cycle calls by its address is asked for, and so compiled, where the scene has a use for it only."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from support.mechanics_scenes import on_base

from udec_ia import Model
from udec_ia.kernels.drive import cycle as module
from udec_ia.kernels.drive import history_recording
from udec_ia.layout import offsets as g
from udec_ia.ops.common.kernel_arguments import soft

ALWAYS = {"change_map"}


def rigid() -> Model:
    return on_base(2.0, 1.0, 0.1, 12.0)


def strained() -> Model:
    m = rigid()
    m.change(-1, 1, 0, 1, type="sdef")
    return m


def loaded() -> Model:
    m = rigid()
    m.boundary(-1, 1, 0, 1, xforce=1.0)
    return m


@pytest.mark.parametrize(
    ("make", "command", "wanted"),
    [
        (rigid, None, set()),
        (rigid, lambda m: m.damping(0.5, 10.0), set()),
        (rigid, lambda m: m.energy("on"), {"add_rigid_work", "add_contact_work"}),
        (rigid, lambda m: m.damping(local=0.8), {"relax"}),
        (rigid, lambda m: m.damping(kinetic=True), {"damp_by_motion", "relax"}),
        (rigid, lambda m: m.damping(adaptive=1.0), {"damp_by_motion"}),
        (rigid, lambda m: m.fraction(0.9, scaled=True), {"relax"}),
        (strained, None, set()),
        (
            strained,
            lambda m: m.energy("on"),
            {"add_work_before_motion", "add_work_after_motion", "add_contact_work"},
        ),
        (loaded, None, {"apply_boundary_conditions"}),
        (
            rigid,
            lambda m: m.boundary(-1, 1, 0, 1, xvel=0.0, rotation=1.0),
            {"apply_boundary_conditions", "turn_blocks"},
        ),
        (rigid, lambda m: m.function(1, 0.0, 1.0), set()),
        (
            rigid,
            lambda m: (m.function(1, 0.0, 1.0), m.gravity(0.0, -9.0, function=1)),
            {"follow_functions"},
        ),
        (
            loaded,
            lambda m: m.energy("on"),
            {"apply_boundary_conditions", "add_rigid_work", "add_load_work", "add_contact_work"},
        ),
    ],
)
def test_a_cycle_asks_for_what_it_runs(
    make: Callable[[], Model],
    command: Callable[[Model], None] | None,
    wanted: set[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: set[str] = set()

    def entry(kernel: Any, *_: Any) -> int:
        asked.add(kernel.__name__)
        return 1

    m = make()
    if command is not None:
        command(m)
    monkeypatch.setattr(module, "entry", entry)
    monkeypatch.setattr(module, "updating", lambda h: 1)
    monkeypatch.setattr(module, "entry_if", lambda wanted, kernel, h: 0)  # another test may have compiled it
    found = module.passes(m.array.h, soft(m.array.h), (), -1.0, False, ())
    assert asked == ALWAYS | wanted
    assert sum(1 for one in found if one and isinstance(one, int)) == len(asked) + 1  # and the update
    assert not any(found[module.MEASURES])
    assert m.array.h.ci[g.JPHASE] == g.AT_BLOCKS


def test_of_histories_of_the_whole_model_those_are_measured_that_there_are(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[str] = []
    m = rigid()
    m.history(5, "KXD", at=(1, 1.5))
    m.history(5, "kinetic")
    monkeypatch.setattr(history_recording, "entry", lambda kernel, *_: asked.append(kernel.__name__) or 1)
    assert history_recording.measures(m.array.h) == (0, 0, 1, 0, 0, 0, 0, 0)
    assert asked == ["measure_kinetic"]
