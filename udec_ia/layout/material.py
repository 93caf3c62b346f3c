"""AUTO-GENERATED from offsets/groups.table by `python -m offsets`; do not edit."""

from __future__ import annotations

from typing import NamedTuple, TypedDict

from udec_ia.layout import offsets as g


class Material(NamedTuple):
    """The material that a law is called with: the numbers of PROPERTY. Frictions are tangents."""

    bulk: float  # bulk modulus, Pa
    cohesion: float  # joint cohesion, a force, N/m
    density: float  # density of blocks, kg/m3
    kn: float  # normal stiffness of joints, N/m2
    friction: float  # joint friction, a tangent
    ks: float  # shear stiffness of joints, N/m2
    shear: float  # shear modulus, Pa
    alam1: float  # bulk + 4 shear/3, Pa
    alam2: float  # bulk - 2 shear/3, Pa
    dilation: float  # joint dilation, a tangent
    residual_friction: float  # residual joint friction, a tangent
    residual_cohesion: float  # residual joint cohesion, a force, N/m
    critical_slip: float  # slip that leads to residual strength, m
    block_friction: float  # friction inside blocks, a tangent
    block_cohesion: float  # cohesion inside blocks, Pa
    block_tension: float  # tensile strength inside blocks, Pa
    block_dilation: float  # dilation inside blocks, a tangent
    p1: float  # for laws of your own
    p2: float  # for laws of your own
    p3: float  # for laws of your own
    p4: float  # for laws of your own


class Properties(TypedDict, total=False):
    """What PROPERTY sets."""

    bulk: float | None
    cohesion: float | None
    density: float | None
    kn: float | None
    friction: float | None
    ks: float | None
    g: float | None
    dilation: float | None
    residual_friction: float | None
    residual_cohesion: float | None
    critical_slip: float | None
    block_friction: float | None
    block_cohesion: float | None
    block_tension: float | None
    block_dilation: float | None
    p1: float | None
    p2: float | None
    p3: float | None
    p4: float | None


class JointMaterial(NamedTuple):
    """The joint material that a joint model is called with: the numbers of JPROPERTY."""

    kn: float  # normal stiffness, Pa/m
    ks: float  # shear stiffness, Pa/m
    friction: float  # friction, a tangent
    cohesion: float  # cohesion, Pa
    tension: float  # tensile strength, Pa
    dilation: float  # dilation, a tangent
    critical_slip: float  # slip at which dilation ends; 0: never, m
    residual_friction: float  # friction after the first slip or opening, a tangent; -1: as before
    residual_cohesion: float  # cohesion after the first slip or opening; -1: as before, Pa
    normal_exponent: float  # YIELDING: exponent of KN
    shear_exponent: float  # YIELDING: exponent of KS
    kn_min: float  # YIELDING: least normal stiffness, Pa/m
    kn_max: float  # YIELDING, BARTON: greatest normal stiffness, Pa/m
    ks_min: float  # YIELDING: least shear stiffness, Pa/m
    ks_max: float  # YIELDING: greatest shear stiffness, Pa/m
    initial_friction: float  # YIELDING: initial friction, a tangent
    roughness: float  # YIELDING: roughness, a length, m
    jrc: float  # BARTON: joint roughness coefficient
    jcs: float  # BARTON: compressive strength of the walls, Pa
    sigmac: float  # BARTON: compressive strength of the rock, Pa
    aperture: float  # aperture without stress; with BARTON it follows from JRC, JCS and SIGMAC if it is 0, m
    residual_aperture: float  # least aperture, m
    greatest_aperture: float  # greatest aperture for flow, m
    permeability_factor: float  # flow by pressure at a corner, m2/(Pa.s)
    p1: float  # for laws of your own
    p2: float  # for laws of your own
    p3: float  # for laws of your own
    p4: float  # for laws of your own


class JointProperties(TypedDict, total=False):
    """What JPROPERTY sets."""

    kn: float | None
    ks: float | None
    friction: float | None
    cohesion: float | None
    tension: float | None
    dilation: float | None
    critical_slip: float | None
    residual_friction: float | None
    residual_cohesion: float | None
    normal_exponent: float | None
    shear_exponent: float | None
    kn_min: float | None
    kn_max: float | None
    ks_min: float | None
    ks_max: float | None
    initial_friction: float | None
    roughness: float | None
    jrc: float | None
    jcs: float | None
    sigmac: float | None
    aperture: float | None
    residual_aperture: float | None
    greatest_aperture: float | None
    permeability_factor: float | None
    p1: float | None
    p2: float | None
    p3: float | None
    p4: float | None


class StructuralProperties(TypedDict, total=False):
    """What SPROPERTY sets."""

    young: float | None
    area: float | None
    inertia: float | None
    density: float | None
    kn: float | None
    ks: float | None
    yield_force: float | None
    shear_strength: float | None
    break_strain: float | None
    yield_moment: float | None
    friction: float | None
    cohesion: float | None
    tension: float | None


# Where the fields of Material and of JointMaterial stand in the common block, for number 1.
ARRAYS = (
    g.BULK,
    g.COH,
    g.DENS,
    g.AKN,
    g.AMU,
    g.AKS,
    g.SHEAR,
    g.ALAM1,
    g.ALAM2,
    g.JDIL,
    g.RMU,
    g.RCOH,
    g.UCRIT,
    g.BMU,
    g.BCOH,
    g.BTEN,
    g.BDIL,
    g.PAR1,
    g.PAR2,
    g.PAR3,
    g.PAR4,
)
JOINT_ARRAYS = (
    g.JMKN,
    g.JMKS,
    g.JMMU,
    g.JMCOH,
    g.JMTEN,
    g.JMDIL,
    g.JMCRIT,
    g.JMRMU,
    g.JMRCO,
    g.JMEN,
    g.JMES,
    g.JMKN1,
    g.JMKN2,
    g.JMKS1,
    g.JMKS2,
    g.JMIMU,
    g.JMR,
    g.JMJRC,
    g.JMJCS,
    g.JMSC,
    g.JMAPER,
    g.JMRAP,
    g.JMMAP,
    g.JMKC,
    g.JMP1,
    g.JMP2,
    g.JMP3,
    g.JMP4,
)
