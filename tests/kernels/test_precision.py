"""What the reals of a word scheme resolve: no place is lost to rounding, and what is too fine is refused."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr, putr
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.kernels.detect.contact_search import arc_on_arc, arc_on_edge
from udec_ia.kernels.drive.cycle import KEEP
from udec_ia.kernels.geometry.block_shape import crad
from udec_ia.layout import offsets as g
from udec_ia.model import Model
from udec_ia.ops.common.number_limits import EDGE_DIGITS, ROUNDING_DIGITS, last_digit
from udec_ia.reader.list_walks import corners, groups

ROUNDING = 0.5
SIDE = 4.0


def stack(build: str, angle: float, far: float) -> tuple[Model, int, int]:
    """Two squares on one another, turned by `angle`: the model, the lower and the upper block."""
    c, s = cos(angle), sin(angle)

    def at(x: float, y: float) -> tuple[float, float]:
        return far + c * x - s * y, far + s * x + c * y

    model = Model(build)
    corner = [at(*point) for point in ((0, -SIDE), (0, SIDE), (SIDE, SIDE), (SIDE, -SIDE))]
    model.block(*(number for point in corner for number in point))
    model.split(*at(-1, 0), *at(SIDE + 1, 0))
    model.round(ROUNDING)
    lower, upper = sorted(
        groups(model.h, "block"),
        key=lambda ib: c * (getr(model.h, ib, g.KY) - far) - s * (getr(model.h, ib, g.KX) - far),
    )
    return model, lower, upper


def can_touch(model: Model, one: int, two: int) -> bool:
    """True if any arc of one block can have a contact with an arc or edge of the other."""
    h = model.h
    most = h.cr[g.CTOL]
    return any(
        arc_on_arc(h, ip, iq, most)[0] or arc_on_edge(h, ip, iq, most)[0] or arc_on_edge(h, iq, ip, most)[0]
        for ip in corners(h, one)
        for iq in corners(h, two)
    )


@pytest.mark.parametrize("build", ["i32r32", "i32r64"])
@pytest.mark.parametrize("far", [0.0, 100.0])
def test_no_place_between_edge_and_arc_is_lost(build: str, far: float) -> None:
    """A square slides, digit by digit, over the place where the edge below it passes into an arc.

    Its corner's circle stands on the edge, or on the arc, or its own edge stands on the arc.
    """
    rng = np.random.default_rng(3)
    for angle in rng.uniform(0, 2 * pi, 20):
        model, lower, upper = stack(build, angle, far)
        h = model.h
        digit = last_digit(model.array, 2 * far + 2 * SIDE)
        there = [(ip, getr(h, ip, g.KXP), getr(h, ip, g.KYP)) for ip in corners(h, upper)]
        for k in range(-20, 21):
            slide = SIDE - 2 * ROUNDING + k * digit  # now the two circles are one above the other
            for ip, x, y in there:
                putr(h, ip, g.KXP, x + slide * cos(angle))
                putr(h, ip, g.KYP, y + slide * sin(angle))
            crad(h, upper, False)
            assert can_touch(model, upper, lower), (angle, k)


def memory(model: Model) -> list[bytes]:
    """All words of a model but NSPARE, by which the array is kept ready for the next command."""
    common = np.delete(model.h.ci, g.NSPARE)
    return [part.tobytes() for part in (model.h.ia, common, model.h.cr, model.h.cd)]


def too_fine(model: Model, command: str, *numbers: float) -> UdecError:
    """The error of a command that is refused and changes nothing."""
    before = memory(model)
    with pytest.raises(UdecError) as caught:
        getattr(model, command)(*numbers)
    assert memory(model) == before
    return caught.value


SQUARE = (100, 100, 100, 110, 110, 110, 110, 100)


@pytest.mark.parametrize("times", [1.01, 0.99])
def test_a_rounding_length_must_be_resolved(times: float) -> None:
    """32-bit reals resolve 2^-23 of |x| + |y|, at most 220 here; 64-bit reals take the same length easily."""
    least = ROUNDING_DIGITS * 220 * 2.0**-23
    for build in ("i32r32", "i32r64"):
        model = Model(build)
        model.block(*SQUARE)
        if times > 1 or build == "i32r64":
            model.round(times * least)
            assert model.check() == []
            continue
        error = too_fine(model, "round", times * least)
        assert error.number == 28
        assert f"32-bit reals resolve {220 * 2.0**-23:g}" in error.detail
        assert f"at least {least:g}" in error.advice


def test_a_block_must_fit_the_rounding_length_given_before() -> None:
    model = Model("i32r32")
    model.round(0.005)  # there is no block yet, so nothing is known about its coordinates
    error = too_fine(model, "block", *SQUARE)
    assert error.number == 28
    assert "a rounding length 0.005" in error.detail
    model.block(0, 0, 0, 10, 10, 10, 10, 0)
    assert model.check() == []


def test_an_edge_must_be_resolved() -> None:
    """A line that would leave an edge too fine is refused by name; a little farther on it cuts."""
    least = EDGE_DIGITS * 220 * 2.0**-23
    for build in ("i32r32", "i32r64"):
        model = Model(build)
        model.block(*SQUARE)
        x = 100 + 0.9 * least
        if build == "i32r64":
            assert model.split(x, 99, x, 111) == 1
            continue
        error = too_fine(model, "split", x, 99, x, 111)
        assert error.number == 27
        assert f"shorter than {least:g}, the finest for 32-bit reals" in error.detail
        x = 100 + 1.1 * least
        assert model.split(x, 99, x, 111) == 1
        assert model.check() == []


@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_a_cut_leaves_what_the_reals_resolve_of_the_longest_edge(build: str) -> None:
    """Unit blocks are cut from a slab 1,100 long; so are slivers of 10,000 digits, and those of less are not.

    Around them the model is sound, before and after some cycles in which every sliver falls by its width.
    """
    slab = (-550, -5, -550, 5, 550, 5, 550, -5)
    least = EDGE_DIGITS * last_digit(Model(build).array, 555)
    for width in (1.0, 1.01 * least):
        model = Model(build)
        model.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5)
        model.block(*slab)
        for x in (-550 + width, 550 - width):
            inwards = 0.02 * least if x < 0 else -0.02 * least
            if width < 1:
                error = too_fine(model, "split", x - inwards, -6, x - inwards, 6)
                assert error.number == 27
                assert (
                    f"shorter than {least:g}, the finest for {model.array.scheme.real_bits}-bit"
                    in error.detail
                )
            assert model.split(x, -6, x, 6) == 1
        assert model.check() == []
        model.fix(-540, 540, -5, 5)
        model.gravity(0, -10)
        model.cycle(20)
        assert model.check() == []


def test_a_slab_of_1100_by_900_unit_blocks_can_be_cut_from_one_block() -> None:
    """One row and one column of it, at either end; the origin stands at a corner."""
    model = Model()
    model.block(0, 0, 0, 900, 1100, 900, 1100, 0)
    assert model.split(1, -1, 1, 901) == 1
    assert model.split(1099, -1, 1099, 901) == 1
    assert model.split(-1, 1, 1101, 1) == 3
    assert model.split(-1, 899, 1101, 899) == 3
    assert model.check() == []
    assert model.table("block")["KBRO"].min() == pytest.approx(0.5**0.5)


def test_lines_that_end_in_a_sliver() -> None:
    """Three lines that leave edges of less than a millimetre on a block of 10 m.

    With 32-bit reals the last one is refused: its edges would be a few hundred digits long.
    """
    lines = [(8.362, 3.133, 2.554, 4.64), (8.081, -2.387, 8.345, 9.61), (0.982, 1.934, 12.793, 4.055)]
    for build, cuts in (("i32r64", [1, 2, 3]), ("i32r32", [1, 2])):
        model = Model(build)
        model.block(0, 0, 5, 9, 10, 0)
        for line, parts in zip(lines, cuts, strict=False):
            assert model.split(*line) == parts
            assert model.check() == []
    assert too_fine(model, "split", *lines[2]).number == 27


@pytest.mark.parametrize(("x", "y"), [(1e8, 1e8), (153178294.3, 354265489.4), (-3e8, 2e8)])
def test_clockwise_is_told_far_from_the_origin(x: float, y: float) -> None:
    """Where the area of a unit square is below the last digit of the products of its coordinates."""
    square = ((x, y), (x, y + 1), (x + 1, y + 1), (x + 1, y))
    model = Model()
    model.block(*(number for corner in square for number in corner))
    assert model.check() == []
    with pytest.raises(UdecError, match=r"error 6: .* its corners are in anticlockwise order"):
        Model().block(*(number for corner in reversed(square) for number in corner))


@pytest.mark.parametrize(
    ("outline", "what"),
    [
        ((0, 0, 0, 10, 10, 0, 10, 10), "its outline crosses itself"),
        ((0, 0, 1, 1, 2, 2), "it turns back on itself"),
    ],
)
def test_an_outline_that_has_no_direction_is_not_called_anticlockwise(
    outline: tuple[float, ...], what: str
) -> None:
    with pytest.raises(UdecError, match=f"error 6: .*{what}"):
        Model().block(*outline)


def circles(model: Model) -> dict[int, tuple[float, float]]:
    """Centres of the circles, by corner."""
    rows = model.table("corner")
    return {int(row["address"]): (float(row["KXCP"]), float(row["KYCP"])) for row in rows}


@pytest.mark.parametrize("build", ["i16r32", "i32r32"])
def test_circles_follow_their_corners(build: str) -> None:
    """Blocks creep by parts of a last digit in a cycle: circles that went their own way were off by 1000."""
    model = Model(build)
    model.property(1, density=2000, kn=1e8, ks=1e8)
    model.block(-30.3, 26.2, -30.1, 27.1, -29.4, 26.9, -29.3, 26.3)
    model.split(-31, 26.55, -29, 26.9)
    model.round(0.00775)
    model.cycle(1)
    step, which = float(model.h.cr[g.TDEL]), model.array.scheme.ratio >> 1
    for ib in groups(model.h, "block"):
        for offset, move in ((g.KXD, 2e-6), (g.KYD, 4e-6), (g.KTD, 3e-5)):
            model.rset(move / step, ib, offset[which])
    model.cycle(2000 + KEEP - 1)
    there = circles(model)
    for ib in groups(model.h, "block"):
        crad(model.h, ib, False)
    away = max(np.abs(np.subtract(there[ip], at)).max() for ip, at in circles(model).items())
    assert away <= KEEP * np.spacing(np.float32(30))
