"""Methods of Model that set numbers: of materials, damping, time-step, energy, cracking, single words."""

from __future__ import annotations

from functools import partial
from typing import Unpack

from udec_ia.advice.input_warnings import check_joint_properties, check_properties
from udec_ia.errors import UdecError
from udec_ia.heap_tools import patch_words
from udec_ia.kernels.drive.damping_modes import MODES
from udec_ia.layout import offsets as g
from udec_ia.layout.material import JointProperties, Properties
from udec_ia.model.method_wrappers import takes_keywords
from udec_ia.model.model_session import Session
from udec_ia.ops.commands import model_settings
from udec_ia.ops.commands.breakage_command import break_blocks, joint_of_cracks, keep_whole
from udec_ia.ops.commands.energy_account import switch
from udec_ia.ops.commands.joint_property_command import (
    Between,
    add_joints,
    jmaterial_number,
    set_joint_property,
)
from udec_ia.ops.commands.model_settings import set_damping, set_damping_mode
from udec_ia.ops.cuts.joint_of_cut import free_joint
from udec_ia.reader.group_ranges import range_of


@takes_keywords(Properties)
def property(
    session: Session, material: int, *, function: int | None = None, **values: Unpack[Properties]
) -> None:
    """PROPERTY: set properties of a material; those not given stay as they are.

    Parameters
    ----------
    material
        Its number, 1 to 50.
    function
        Number of a FUNCTION that multiplies the given values from now on, of any property but density and
        stiffness.
    values
        Properties by name: `density` (kg/m3), `kn`, `ks` (N/m2, of a contact), `friction` (a tangent),
        `cohesion` (N/m), `bulk`, `g` (Pa) ... From `dilation` on they are for the laws of constitutive
        numbers 2 to 5 (udec_ia.laws).

    Raises
    ------
    UdecError
        4, 10, 26 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.property(2, density=2600, kn=1e9, ks=5e8, friction=0.6)
    """
    session.ensure_ready()
    model_settings.set_property(
        session.array, material, function, partial(session.undo.save_words, session.array), **values
    )
    session.report_remarks(check_properties(session.array, material, dict[str, float | None](**values)))


@takes_keywords(JointProperties)
def jproperty(
    session: Session,
    jmaterial: int,
    model: str | None = None,
    unit: str | None = None,
    between: Between | None = None,
    *,
    function: int | None = None,
    **values: Unpack[JointProperties],
) -> None:
    """JPROPERTY: define a joint material; what is not given stays as it is.

    Parameters
    ----------
    jmaterial
        Its number, 1 to 50.
    model
        "coulomb", "yielding", "barton", or "jl2" to "jl5" for your own law.
    unit
        "length" (Pa/m, Pa), "ends" (the same, in the form of the report) or "contact" (N/m2, N/m) as in 1980.
    between
        Numbers of two block materials; joints between them have it.
    function
        Number of a FUNCTION that multiplies the given values from now on, of strengths only.
    values
        Properties by name (docs/joints.md).

    Raises
    ------
    UdecError
        4, 10, 26 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.jproperty(1, kn=1e10, ks=1e10, friction=0.6, between=(1, 1))  # Pa/m
    """
    session.ensure_ready()
    set_joint_property(session.array, jmaterial, model, unit, between, function, **values)
    session.report_remarks(check_joint_properties(session.array, jmaterial, values))


class _Modes:
    """The keywords of `damping` that lead to rest: one of each mode."""

    __annotations__ = {one.argument: float | None for one in MODES}


@takes_keywords(_Modes)
def damping(
    session: Session,
    /,
    fcrit: float | None = None,
    freq: float | None = None,
    only: str | None = None,
    **modes: float | None,
) -> None:
    """DAMPING: Rayleigh damping, or one of the modes that lead to rest.

    Parameters
    ----------
    fcrit, freq
        Fraction of critical damping at a frequency in Hz.
    only
        "mass", "stiffness", or "internal" for the strain rates of simply-deformable blocks.
    modes
        Instead of these one of local=f, combined=f, kinetic=True, adaptive=f (docs/rest.md).

    Raises
    ------
    UdecError
        7, 10 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.damping(0.5, 8, "mass")
    >>> m.damping(local=0.8)
    """
    session.ensure_ready(sound=False)
    asked = {one: modes.get(one.argument) for one in MODES}
    given = {one: f for one, f in asked.items() if f is not None and f is not False}
    if len(given) + (fcrit is not None or freq is not None or only is not None) != 1:
        advice = "fcrit and freq, or one of " + ", ".join(one.name for one in MODES)
        raise UdecError(7, "DAMPING takes one kind of damping", advice, parameter="fcrit")
    for mode, f in given.items():
        set_damping_mode(session.array, mode, float(f))
    if not given:
        if fcrit is None or freq is None:
            raise UdecError(7, "freq" if fcrit is not None else "fcrit", parameter="fcrit")
        set_damping(session.array, fcrit, freq, only.lower() if only else None)


def fraction(session: Session, f: float, *, safe: bool = False, scaled: bool = False) -> None:
    """FRACTION: fraction of the critical time-step to be used.

    Parameters
    ----------
    f
        The fraction, above 0; 0.1 at first.
    safe
        Of a bound on all modes in place of the estimate.
    scaled
        The same with inertial masses that make all degrees of freedom as quick as the quickest one.

    Raises
    ------
    UdecError
        26 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.fraction(0.5, safe=True)
    """
    session.ensure_ready(sound=False)
    model_settings.set_fraction(session.array, f, safe, scaled)


def energy(session: Session, state: str = "on") -> None:
    """ENERGY: an account of the energy begins or ends.

    Parameters
    ----------
    state
        "on": it begins, and `balance` shows it; "off": it ends.

    Raises
    ------
    UdecError
        10 or 26. Nothing is changed then.

    Examples
    --------
    >>> m.energy("on")
    """
    session.ensure_ready()
    if state.lower() not in ("on", "off"):
        raise UdecError(10, f"ENERGY {state}", "ON or OFF", parameter="state")
    switch(session.array, state.lower() == "on")


def scale(session: Session, s: float) -> None:
    """SCALE: the scale of plots.

    Parameters
    ----------
    s
        Inches of the picture per metre; 0 lets the blocks fill it.

    Raises
    ------
    UdecError
        10 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.scale(2.5)
    """
    session.ensure_ready(sound=False)
    model_settings.set_scale(session.array, s)


def rset(session: Session, v: float, ia: int, ioff: int) -> None:
    """RSET: write a real value into a group. The state is proved before the next command that follows links.

    Parameters
    ----------
    v
        The value.
    ia
        Address of the group.
    ioff
        Offset of the real in it, from 1.

    Raises
    ------
    UdecError
        28 or 30. Nothing is changed then.

    Examples
    --------
    >>> from udec_ia.layout import offsets as g
    >>> upper = int(m.table("block")["address"][0])
    >>> m.rset(0.5, upper, 6)  # KXD, its x velocity, in i32r64
    >>> float(m.table("block")["KXD"][0])
    0.5
    """
    session.ensure_ready(sound=False)
    model_settings.rset(session.array, v, ia, ioff)
    session.forget_boxes()
    session.written = True


def patch(session: Session, assignments: str) -> None:
    """PATCH: change words of the array by name; all of them, and only if the state is sound with them.

    Parameters
    ----------
    assignments
        One or several, as in "block@88.KXD = 0.5, FRAC = 0.1".

    Raises
    ------
    UdecError
        10, 28 or 30. Nothing is changed then.

    Examples
    --------
    >>> m.patch("FRAC = 0.05")
    """
    session.ensure_ready(sound=False)
    patch_words.patch(session.array, assignments)
    session.forget_boxes()
    session.written = session.unproved = False


def breakage(
    session: Session,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
    state: str = "on",
    *,
    tension: float | None = None,
    cohesion: float | None = None,
    friction: float | None = None,
    smallest: float | None = None,
    jmaterial: int | None = None,
) -> int:
    """BREAKAGE: the blocks in the range may crack from now on, or not any more.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m of centroids, or words.
    state
        "on" or "off".
    tension, cohesion, friction
        Strength in Pa, and a tangent. What is not given does not break a block. Rigid blocks break by tension
        between two contact forces, deformable ones also by their stress.
    smallest
        Area in m2 of the smallest part that a crack may leave.
    jmaterial
        Joint material of cracks; without it they have that of the contacts between two such blocks.

    Returns
    -------
    int
        The number of blocks.

    Raises
    ------
    UdecError
        1, 4, 7, 10 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.breakage("ALL", tension=1e6, smallest=0.1)
    2
    """
    session.ensure_ready(shapes=True)
    array, where = session.array, range_of(x1, x2, y1, y2)
    strength = {"tension": tension, "cohesion": cohesion, "friction": friction}
    if state.lower() not in ("on", "off"):
        raise UdecError(10, f"BREAKAGE {state}", "ON or OFF", parameter="state")
    if state.lower() == "off":
        if {*strength.values(), smallest, jmaterial} != {None}:
            raise UdecError(10, "a strength with OFF", "give OFF alone", parameter="state")
        return keep_whole(array, where)
    joint = 0
    if jmaterial is not None:
        joint = joint_of_cracks(array, jmaterial_number(array, jmaterial)) or free_joint(array)
        add_joints(array)
    done = break_blocks(array, where, joint, smallest, **strength)
    if done and jmaterial is not None:
        array.h.ci[g.JLINE + joint - 1] = jmaterial
    return done
