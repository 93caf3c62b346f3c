"""Joints that dilate and weaken as they slip: `--constitutive joint-dilation`, number 2.

Springs KN and KS, and a shear force of at most c + f Fn. The slip is the
shear displacement u less its elastic part: s = u - Fs/KS, which is 0 as long as the joint sticks. With
w = min(|s|/CRITICAL, 1)

    strength   c, f fall from COHESION, FRICTION to RCOHESION, RFRICTION, in proportion to w
    dilation   the joint opens by DILATION |s|, until |s| = CRITICAL and no farther

so that peak strength goes with full dilation, and residual strength with none. A joint that dilates against
its normal spring gains the normal force KN DILATION |ds|; free blocks move apart. With the default CRITICAL =
0 the joint neither weakens nor dilates: Coulomb's law, number 1.

Strength follows from the normal force and the slip before the step, as steps are small. The slip is the net
slip: on the way back a joint closes and regains its strength. A joint that has opened starts without slip
when it closes again.
"""


def clj2(fn, fs, dun, dus, un, us, m):
    """Increments of normal and shear force, N/m."""
    pressed, trial = fn + m.kn * dun, fs + m.ks * dus
    if pressed <= 0:
        return -fn, -fs
    slip = abs(us - fs / m.ks)
    weak = min(slip / m.critical_slip, 1) if m.critical_slip > 0 else 0
    friction = m.friction + weak * (m.residual_friction - m.friction)
    cohesion = m.cohesion + weak * (m.residual_cohesion - m.cohesion)
    strength = cohesion + friction * pressed
    held = max(-strength, min(trial, strength))
    slipped = abs(us + dus - held / m.ks)
    opened = m.dilation * (min(slipped, m.critical_slip) - min(slip, m.critical_slip))
    return pressed + m.kn * opened - fn, held - fs
