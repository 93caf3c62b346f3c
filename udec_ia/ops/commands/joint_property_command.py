"""JPROPERTY, and the joint materials that CHANGE and SPLIT give (report 2.4).

A joint material has a joint model, and stiffness and strength per length, or per contact as in 1980. Which
contacts have it follows from the rules in kernels/constitutive/joint_materials.py. `update_all_joints`
applies them after each command that may change what they give.
"""

from __future__ import annotations

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr, iget
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_materials import JOINTS, set_flag
from udec_ia.kernels.constitutive.joint_models import begin_model, set_stresses
from udec_ia.kernels.contact.joint_lengths import (
    forces_of_stresses,
    keep_force,
    set_joint_material,
    update_joints,
)
from udec_ia.kernels.links.longer_groups import joint_at, joints_at
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.commands.function_command import check_followed, set_numbers
from udec_ia.ops.commands.joint_model_numbers import (
    FREE,
    MODELS,
    check_model,
    closure_numbers,
    zero_stress_aperture,
)
from udec_ia.ops.commands.joint_stress_at_cuts import StressedParts, stress_new_contacts
from udec_ia.ops.common.array_growth import find_room, lengthen_groups
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.ops.common.number_limits import NMAT, finite, material_number, not_negative, whole
from udec_ia.reader.group_ranges import Range, holds
from udec_ia.reader.group_tables import table

JPROPERTIES = {one.argument: getattr(g, one.array) for one in read_table().joint_properties}
FROM_PEAK = ("residual_friction", "residual_cohesion")  # -1: as the peak strength
UNITS = ("length", "contact", "ends")  # by their codes
MAY_FOLLOW = {  # a FUNCTION: strength, and what only laws of the user have
    "friction",
    "cohesion",
    "tension",
    "residual_friction",
    "residual_cohesion",
    *FREE,
}
Between = tuple[int, int]


def update_all_joints(array: MainArray, parts: StressedParts | None = None) -> None:
    """Give all contacts the joint material that the rules require, their lengths and forces. Error 1.

    parts: of joints that were stressed before the command; contacts that it made there get their stress.
    """
    if array.h.ci[g.LJOINT]:
        contacts = list_of(array.h, "contact")
        new = contacts[joints_at(array.h, contacts) == 0]
        while not update_joints(array.h, True):
            find_room(array)
        if parts is not None:
            stress_new_contacts(array, new, parts)
        if forces_of_stresses(array.h):
            renew_forces(array)


def add_joints(array: MainArray) -> None:
    """Give each contact a joint and each corner an edge behind it. Error 1, and nothing is changed."""
    lengthen_groups(array, "LJOINT")


def jmaterial_number(array: MainArray, jmaterial: int) -> int:
    """`jmaterial` if it is a joint material that JPROPERTY has defined, else error 4."""
    if not 1 <= whole(jmaterial=jmaterial) <= NMAT:
        raise UdecError(4, f"{jmaterial}", f"joint materials run from 1 to {NMAT}", parameter="jmaterial")
    if array.h.ci[g.JMLAW + jmaterial - 1] == 0:
        advice = f"first define it: JPROPERTY JMATERIAL={jmaterial} KN=... KS=..."
        raise UdecError(4, f"joint material {jmaterial} is not defined", advice, parameter="jmaterial")
    return jmaterial


def set_joint_property(
    array: MainArray,
    jmaterial: int,
    model: str | None = None,
    unit: str | None = None,
    between: Between | None = None,
    function: int | None = None,
    **values: float | None,
) -> None:
    """JPROPERTY: define a joint material; what is not given stays. Stresses of its joints stay.

    model: of MODELS. unit: of UNITS. between: block
    materials between which joints have it. function: number of a FUNCTION whose factor multiplies the values
    from now on. values: as in the table. Error 4, 10, 26 or 28, and nothing is changed.
    """
    if not 1 <= whole(jmaterial=jmaterial) <= NMAT:
        raise UdecError(4, f"{jmaterial}", f"joint materials run from 1 to {NMAT}", parameter="jmaterial")
    ci, cr, i = array.h.ci, array.h.cr, jmaterial - 1  # they stay when the array grows
    given = {name: value for name, value in values.items() if value is not None}
    finite(array, **{name: value for name, value in given.items() if name in FREE})
    withdrawn = {name for name in FROM_PEAK if given.get(name) == -1}
    not_negative(array, **{name: value for name, value in given.items() if name not in {*FREE, *withdrawn}})
    chosen, code = _chosen("model", model, tuple(MODELS)), _chosen("unit", unit, UNITS)
    before = int(ci[g.JMLAW + i])
    law = before or g.COULOMB_JOINT if chosen is None else [*MODELS.values()][chosen]
    whole_set = {name: float(given.get(name, cr[k + i])) for name, k in JPROPERTIES.items()}
    check_model(law, jmaterial, whole_set)
    unit_code = int(ci[g.JMUNIT + i]) if code is None else code
    if law != g.COULOMB_JOINT and unit_code != g.PER_LENGTH:
        blamed = "model" if code is None else "unit"
        raise UdecError(
            10, f"{UNITS[unit_code].upper()} is for COULOMB", "other models have LENGTH", parameter=blamed
        )
    pair = [material_number(n) for n in between] if between is not None else None
    if function is not None:
        check_followed(array, function, given, MAY_FOLLOW, "give it in a JPROPERTY without FUNCTION")
    add_joints(array)
    if not before:
        cr[g.JMRMU + i], cr[g.JMRCO + i] = -1, -1
    ci[g.JMLAW + i] = law
    has_other_unit = (ci[g.JMUNIT + i] == g.PER_CONTACT) != (unit_code == g.PER_CONTACT)
    ci[g.JMUNIT + i] = unit_code
    if pair is not None:
        ci[g.JMB1 + i], ci[g.JMB2 + i] = pair
    set_numbers(array, {JPROPERTIES[name] + i: v for name, v in given.items()}, function)
    cr[g.JMHAP + i] = zero_stress_aperture(whole_set, law)
    if law == g.BARTON_BANDIS:
        cr[g.JMKNI + i], cr[g.JMUM1 + i], cr[g.JMUM3 + i] = closure_numbers(whole_set)
    _keep_stresses(array, jmaterial, law != before, has_other_unit)


def _chosen(name: str, value: str | None, choices: tuple[str, ...]) -> int | None:
    """Place of `value` among `choices`, None for None. Error 10 if it is none of them."""
    if value is None:
        return None
    if str(value).lower() not in choices:
        raise UdecError(10, f"{value}", " or ".join(choices), parameter=name)
    return choices.index(str(value).lower())


def _keep_stresses(array: MainArray, jmaterial: int, has_another_model: bool, has_other_unit: bool) -> None:
    """Stresses of joints of that material stay as its stiffness changes, and forces as its unit does."""
    h = array.h
    contacts = list_of(h, "contact")
    for ic, ix in zip(contacts.tolist(), joints_at(h, contacts).tolist(), strict=True):
        if ix and iget(h, ix, g.KCJMAT) == jmaterial:
            if has_another_model:
                begin_model(h, ix)
            if has_other_unit:
                keep_force(h, ic, ix)
            set_stresses(h, ic, ix, getr(h, ix, g.KCJSN), getr(h, ix, g.KCJTS))


def change_joints(array: MainArray, where: Range, jmaterial: int) -> int:
    """CHANGE ... JMATERIAL: the contacts in the range have that joint material from now on.

    Returns their number. Error 4 for a joint material that is not defined.
    """
    jmaterial_number(array, jmaterial)
    contacts = table(array, "contact")
    places, blocks = (contacts["KXC"], contacts["KYC"]), (contacts["KB1"], contacts["KB2"])
    inside = holds(array, where, *places, *blocks, contacts=contacts["address"])
    inside &= contacts["KCCOD"] != g.VIRTUAL
    found = contacts["address"][inside].tolist()
    for ic in found:
        set_joint_material(array.h, ic, jmaterial, True)
        set_flag(array.h, joint_at(array.h, ic), g.JOINT_GIVEN)
    return len(found)


def joint_number(joint: int | None) -> int:
    """`joint` as the number of a joint, 0 for None. Error 4."""
    if joint is None:
        return 0
    if not 1 <= whole(joint=joint) <= JOINTS:
        raise UdecError(4, f"{joint}", f"joints are numbered from 1 to {JOINTS}", parameter="joint")
    return joint
