"""Numbers of a joint model: which of them have a meaning, and those that follow from others.

The closure of BARTON follows from JRC, JCS and the aperture aj, by the regressions of Bandis et al. (1983),
with lengths in mm, strengths in MPa and stiffness in MPa/mm:

    aj = JRC/5 (0.2 SIGMAC/JCS - 0.1)
    kni = -7.15 + 1.75 JRC + 0.02 JCS/aj
    um = A + B JRC + C (JCS/aj)^D, at most aj; in later load cycles at most the one of the first loading

Sources: Bandis, Lumsden and Barton, Int. J. Rock Mech. Min. Sci. 20 (1983) 249-268, for um in the first and
the third load cycle; Barton, Bandis and Bakhtar, same journal 22 (1985) 121-140, for aj.
"""

from __future__ import annotations

from collections.abc import Mapping

from udec_ia.compiling.law_calls import FIRST, LAST
from udec_ia.errors import UdecError
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table

MODELS = {
    "coulomb": g.COULOMB_JOINT,
    "yielding": g.CONTINUOUSLY_YIELDING,
    "barton": g.BARTON_BANDIS,
    **{f"jl{n}": g.JOINT_LAW2 + n - FIRST for n in range(FIRST, LAST + 1)},
}
FREE = tuple(f"p{k}" for k in range(1, 5))  # for laws of the user; they may be negative
OF_WATER = "aperture", "residual_aperture", "greatest_aperture", "permeability_factor"
Numbers = Mapping[str, float]  # by the arguments of Model.jproperty
KEYWORDS = {one.argument: one.keyword.upper() for one in read_table().joint_properties}
HELP = {one.argument: one.text for one in read_table().joint_properties}
MPA, MM = 1e6, 1e-3
FIRST_LOADING = -0.2960, -0.0056, 2.2410, -0.2450  # A, B, C, D
LATER_LOADING = -0.1032, -0.0074, 1.1350, -0.2510


def is_used(law: int, name: str) -> bool:
    """True if the joint model of code `law` uses the property of that argument."""
    if law >= g.JOINT_LAW2 or name in ("kn", "ks", "friction", *OF_WATER):
        return True
    models = HELP[name].split(":")[0] if ":" in HELP[name] else ""
    if law == g.COULOMB_JOINT:
        return "YIELDING" not in models and "BARTON" not in models and name not in FREE
    return ("YIELDING" if law == g.CONTINUOUSLY_YIELDING else "BARTON") in models


def check_model(law: int, jmaterial: int, numbers: Numbers) -> None:
    """Error 28 if `numbers` of joint material `jmaterial` have no meaning for its model `law`."""
    needed = {"ks": "KS=... in Pa/m"}
    if law != g.BARTON_BANDIS:
        needed = {"kn": "KN=... in Pa/m"} | needed
    if law == g.CONTINUOUSLY_YIELDING:
        needed |= {"roughness": "ROUGHNESS=... in m"}
        for exponent, k, unit in (("normal_exponent", "kn", "KNMIN"), ("shear_exponent", "ks", "KSMIN")):
            if numbers[exponent] > 0:
                needed |= {f"{k}_min": f"{unit}=... in Pa/m, the stiffness without stress"}
        if numbers["normal_exponent"] >= 1:
            needed |= {"kn_max": "KNMAX=... in Pa/m, or NEXPONENT below 1"}
    if law == g.BARTON_BANDIS:
        needed |= {"jrc": "JRC, 0 to 20", "jcs": "JCS=... in Pa"}
    for name, advice in needed.items():
        if not numbers[name] > 0:
            _refuse(name, f"{KEYWORDS[name]} of joint material {jmaterial} is 0", f"give {advice}")
    if law == g.CONTINUOUSLY_YIELDING:
        _check_yielding(numbers)
    elif law == g.BARTON_BANDIS:
        _check_barton(numbers)


def _refuse(name: str, detail: str, advice: str) -> None:
    raise UdecError(28, detail, advice, parameter=name)


def _check_yielding(numbers: Numbers) -> None:
    """Error 28 for limits in the wrong order, and for friction that would grow."""
    for k in ("kn", "ks"):
        lowest, highest = numbers[f"{k}_min"], numbers[f"{k}_max"]
        if 0 < highest < lowest:
            advice = f"it must be at least {k.upper()}MIN, which is {lowest:g}"
            _refuse(f"{k}_max", f"{k.upper()}MAX is {highest:g}", advice)
    first, final = numbers["initial_friction"], numbers["friction"]
    if first < final:
        advice = f"it must be at least FRICTION, the final one, which is {final:g}"
        _refuse("initial_friction", f"IFRICTION is {first:g}", advice)


def _check_barton(numbers: Numbers) -> None:
    """Error 28 where the regressions give no aperture, stiffness or closure above 0."""
    aperture = zero_stress_aperture(numbers, g.BARTON_BANDIS)
    if not aperture > 0:
        advice = "give SIGMAC above JCS/2, or APERTURE=... in m"
        _refuse("sigmac", "JRC, JCS and SIGMAC give no aperture", advice)
    kni, first, later = closure_numbers(numbers)
    what = f"JRC {numbers['jrc']:g}, JCS {numbers['jcs']:g} and an aperture of {aperture:g}"
    if not kni > 0:
        _refuse("kn", f"{what} give an initial stiffness of {kni:g}", "give it: KN=... in Pa/m")
    if not min(first, later) > 0:
        _refuse("aperture", f"{what} give a greatest closure of {min(first, later):g}", "change one of them")
    if 0 < numbers["kn_max"] <= kni:
        _refuse("kn_max", f"KNMAX is {numbers['kn_max']:g}", f"the initial stiffness is {kni:g}")


def zero_stress_aperture(numbers: Numbers, law: int) -> float:
    """Aperture (m) without stress; of BARTON it follows from the roughness if none is given."""
    if numbers["aperture"] > 0 or law != g.BARTON_BANDIS:
        return numbers["aperture"]
    return numbers["jrc"] / 5 * (0.2 * numbers["sigmac"] / numbers["jcs"] - 0.1) * MM


def closure_numbers(numbers: Numbers) -> tuple[float, float, float]:
    """Initial stiffness (Pa/m) of BARTON, and greatest closure (m) in its first loading and in later ones."""
    jrc, aperture = numbers["jrc"], zero_stress_aperture(numbers, g.BARTON_BANDIS)
    ratio = (numbers["jcs"] / MPA) / (aperture / MM)
    kni = numbers["kn"] or (-7.15 + 1.75 * jrc + 0.02 * ratio) * MPA / MM
    first, later = (
        min((a + b * jrc + c * ratio**d) * MM, aperture) for a, b, c, d in (FIRST_LOADING, LATER_LOADING)
    )
    return kni, first, min(first, later)
