"""The problems of udec verify: the quicker ones hold, and they notice when the program or its input is wrong.

That is tried by telling the program something else than the problem means: 2 % more gravity, stiffness or
density. Each problem that depends on it must then be above its tolerance.
"""

from __future__ import annotations

import re
import runpy
from functools import wraps
from pathlib import Path
from typing import Any

import pytest

from udec_ia import Model
from udec_ia.studies.verification import (
    Answer,
    Case,
    find_problem,
    problem_folder,
    problem_names,
    solve_case,
)

QUICK = (
    "ball",
    "bar_modulus",
    "barton_joint",
    "column",
    "eccentric",
    "flat_arch",
    "four_blocks",
    "free_flight",
    "glued_cantilever",
    "hole_hydrostatic",
    "incline",
    "joint_rocking",
    "joint_rotation",
    "jointed_bar",
    "oedometer",
    "plane_failure",
    "ploughing_safety",
    "released_mass",
    "retaining_wedge",
    "rolling_slip",
    "shear_box",
    "shear_column",
    "skid_to_roll",
    "slip_force",
    "thick_cylinder",
    "toppling",
    "toppling_safety",
    "water_buoyancy",
    "water_in_joint",
    "water_network",
    "water_sliding",
    "water_squeeze",
    "water_transient",
    "water_uplift",
    "wave_speed",
    "wedge_safety",
    "yielding_joint",
)
MORE = 1.02  # of what is altered


@pytest.mark.parametrize(
    ("name", "blocks"), [(name, blocks) for name in QUICK for blocks in find_problem(name).blocks]
)
def test_a_problem_holds(name: str, blocks: str) -> None:
    result = solve_case(find_problem(name), "i32r64", blocks)
    assert result.failure == ""
    for answer in result.answers:
        assert answer.holds, f"{answer.what}: {answer.computed:g}, exact {answer.exact:g}; {answer.why}"
    assert result.case.frame or result.case.curves


def altered(method: str, *keys: str) -> Any:
    """The method of Model of that name, told 2 % more: of all its numbers, or of those called `keys`."""
    true = getattr(Model, method)

    @wraps(true)
    def wrong(self: Model, *numbers: float, **named: Any) -> Any:
        if not keys:
            numbers = tuple(MORE * number for number in numbers)
        return true(self, *numbers, **{k: MORE * v if k in keys else v for k, v in named.items()})

    return wrong


@pytest.mark.parametrize(
    ("name", "method", "keys"),
    [
        ("incline", "gravity", ()),
        ("column", "gravity", ()),
        ("free_flight", "gravity", ()),
        ("flat_arch", "gravity", ()),
        ("eccentric", "gravity", ()),
        ("incline", "property", ("friction",)),
        ("skid_to_roll", "property", ("friction",)),
        ("plane_failure", "property", ("cohesion",)),
        ("column", "property", ("kn",)),
        ("jointed_bar", "property", ("kn",)),
        ("eccentric", "property", ("density",)),
        ("shear_column", "property", ("density",)),
        ("oedometer", "property", ("bulk",)),
        ("thick_cylinder", "property", ("g",)),
        ("bar_modulus", "jproperty", ("kn",)),
        ("slip_force", "jproperty", ("cohesion",)),
        ("glued_cantilever", "jproperty", ("tension",)),
        ("joint_rocking", "gravity", ()),
        ("joint_rotation", "jproperty", ("kn",)),
        ("shear_box", "jproperty", ("dilation",)),
        ("barton_joint", "jproperty", ("jrc",)),
        ("yielding_joint", "jproperty", ("roughness",)),
        ("released_mass", "gravity", ()),
        ("water_in_joint", "jproperty", ("aperture",)),
        ("water_network", "fluid", ("viscosity",)),
        ("water_squeeze", "fluid", ("kw",)),
        ("water_uplift", "fluid", ("density",)),
    ],
)
def test_a_wrong_answer_is_caught(
    monkeypatch: pytest.MonkeyPatch, name: str, method: str, keys: tuple[str, ...]
) -> None:
    monkeypatch.setattr(Model, method, altered(method, *keys))
    result = solve_case(find_problem(name), "i32r64", find_problem(name).blocks[0])
    assert result.failure == ""
    assert not result.holds


def test_a_footing_without_pairs_of_zones_is_too_strong() -> None:
    """Mixed discretisation is what brings the limit load down to its place."""
    space = runpy.run_path(str(problem_folder() / "footing.py"))
    _, loads = space["press"](Case("footing", "i32r64", "fdef"), mixed=False, n=20)
    assert loads[-1] > 1.02 * (2 + 3.14159) * space["COHESION"]


@pytest.mark.parametrize("name", problem_names())
def test_a_problem_says_what_it_is(name: str) -> None:
    problem = find_problem(name)
    paragraphs = problem.text.split("\n\n")
    assert re.fullmatch(r"[A-Z].*[^.]", problem.title)
    assert sum(one.startswith("Tolerance.") for one in paragraphs) == 1
    assert paragraphs[-1].startswith("Source: ")
    assert re.search(r"1[5-9]\d\d|20\d\d|Archimedes", paragraphs[-1]), "a source has a year"
    assert any(line.startswith("    ") for line in problem.text.splitlines()), "a sketch"


def test_titles_differ() -> None:
    titles = [find_problem(name).title for name in problem_names()]
    assert len({*titles}) == len(titles) >= 24


def test_an_answer_holds_up_to_its_tolerance() -> None:
    parts = {"one": 0.03, "other": 0.01}
    assert Answer("x", "m", 2.0399, 2.0, parts).holds
    assert Answer("x", "m", 1.9601, 2.0, parts).holds
    assert not Answer("x", "m", 2.0401, 2.0, parts).holds
    assert not Answer("x", "m", float("nan"), 2.0, parts).holds
    assert not Answer("x", "m", 2.0, 2.0, parts | {"none": float("nan")}).holds
    assert Answer("x", "m", 2.0, 2.0, parts).why == "1.5 % one; 0.5 % other"
    assert Answer("x", "m", 0.0, 0.0, parts).why == "0.03 m one; 0.01 m other"


def test_the_page_is_of_these_problems() -> None:
    """docs/verification.md names each problem and shows its picture, which is small, and nothing fails."""
    docs = Path(__file__).parents[2] / "docs"
    page = (docs / "verification.md").read_text()
    assert page.startswith("# Verification\n\n*This page")
    assert "\n    python docs/studies/verification_page.py docs\n" in page
    for name in problem_names():
        problem = find_problem(name)
        assert f"\n## {problem.title}\n" in page
        assert problem.text.partition("\n")[2].strip() in page
        assert f"(images/verify/{name}.png)" in page
    pictures = list((docs / "images" / "verify").iterdir())
    assert {one.name for one in pictures} == {f"{name}.png" for name in problem_names()}
    assert max(one.stat().st_size for one in pictures) < 60_000
    assert "**" not in page
