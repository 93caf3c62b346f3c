"""A model with groups of every kind."""

from __future__ import annotations

from support.mechanics_scenes import box, model
from support.seldom_compiled import compiled_if_usual
from udec_ia import Model
from udec_ia.layout.field_table import read_table

# nothing makes extensions of domains, and CYCLE alone makes relaxations and fractures
GROUPS = [group for group in read_table().groups if group.name not in ("jointext", "relax", "fracture")]


def every_kind(build: str = "i32r64", structures: bool = True) -> Model:
    """Six blocks on a fixed base, two of each type, in a draught of boundary conditions of all kinds.

    structures: False leaves out the beam and the bolts.
    """
    with compiled_if_usual(build):
        return _every_kind(build, structures)


def _every_kind(build: str, structures: bool) -> Model:
    outline, stiffness = box(0, 6, -1, 1), (1e8, 1e8)
    m = model(*outline, d=0.05, stiffness=stiffness, friction=0.3, build=build, displacements=True)
    m.property(1, bulk=1e8, g=5e7)
    m.jproperty(1, kn=1e9, ks=1e9, friction=0.3)
    m.split(-1, 0, 7, 0)
    m.split(2, -0.5, 2, 2, joint=7, jmaterial=1)
    m.split(5.5, 0.2, 5.7, 0.4)
    m.split(5.2, 0.6, 5.4, 0.7)
    for x in (5, 1, 4, 3):
        m.split(x, -0.5, x, 2)
    m.fix(0, 6, -1, 0)
    m.change(1, 3, 0, 1, type="sdef")
    m.change(3, 5, 0, 1, type="fdef")
    for x in (4, 3):
        corners = [(x, 0), (x, 1), (x + 1, 1), (x + 1, 0), (x + 0.5, 0.5)]
        m.generate(x, x + 1, 0, 1, "manual", corners, [(1, 2, 3), (1, 3, 4), (1, 4, 5), (1, 5, 2)])
    m.function(3, 0.0, 0.0, 0.001, 1.0, 0.002, -1.0)
    m.boundary(2, 6, 0.9, 1.1, stress=(0.0, 0.0, -1e5), function=3)
    m.boundary(0, 1, 0, 1, xvel=0.01, sine=(20.0, 1.0))
    m.boundary(4.9, 6.1, -0.1, 1.1, viscous=True)
    m.history(10, "kyd", at=[(0.5, 0.5), (5.5, 0.5)])
    m.history(10, "kxdg", at=(4, 1))
    m.property(2, p1=2.0, p2=1.0, function=3)
    m.history(10, "yreaction", within=(-1, 7, -2, 2))
    m.fluid(kw=1e7)
    m.ppressure(-1, 7, -2, 2, 1e4)
    m.boundary(-0.1, 0.1, -0.1, 1.1, ppressure=2e4, function=3)
    m.boundary(5.9, 6.1, -0.1, 1.1, impermeable=True)
    if structures:
        m.sproperty(1, young=1e7, area=1e-3, inertia=1e-5, density=7800, kn=1e4, ks=1e4)
        m.beam(0.5, 0.5, 5.5, 0.5, segments=3)
        m.bolt(0.5, -0.5, 3.3, 0.3)
        m.bolt(1.5, -0.5, 4.3, 0.3)
    m.group("left", 0, 3, -1, 1)
    m.group("upper", 0, 6, 0, 1)
    m.breakage(0, 6, 0, 1, tension=1e7, smallest=0.1)
    return m
