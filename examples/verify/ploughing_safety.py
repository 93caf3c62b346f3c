r"""Factor of safety of a slab that pushes out the toe of a slope (published)

A slab of rock, 25 m high, lies on a bedding plane that is steeper than its friction. It pushes a small block
at its toe, cut off by two release joints, which it must lift and turn out:

       / /
      / /  slab
     / /
    <  > toe block
     ''

The bedding dips by 50 or 55 degrees, its friction is 30 or 25 degrees; that of the release joints 20 degrees.
There is no cohesion.

Tolerance. 2 digits of the published factors, half the bracket, and for the sharp toe block 1 %: its corners
are rounded.

Source: L. R. Alejano and others, ploughing of slabs at the toe of slopes (2011), problems 11 and 13 of the
joint verification manual of RS2, with the factors of UDEC for rigid blocks, 1.21 and 1.00. An upper bound by
linear programming for the same blocks is 1.2148 and 0.9988.
"""

from math import radians, tan

from udec_ia.studies.verification import Answer

BLOCKS = ("rigid",)
REALS = 64
KN, KS, ROUNDING, WEIGHT = 1e11, 1e10, 0.002, 25e3
SLOPES = (  # friction of bedding, toe block from the toe on clockwise, top of the slab, published factor
    (
        30,
        ((0, 0), (-1.14907, -0.96418), (-2.62114, 0.79017), (-2.43625, 2.90341)),
        (-22.9356, -20.9775),
        1.21,
    ),
    (
        25,
        ((0, 0), (-1.22852, -0.86066), (-2.42975, 0.85488), (-2.22963, 3.18425)),
        (-19.33635, -17.5052),
        1.00,
    ),
)


def slope(case, toe, top):
    """The slab and the toe block at rest, with much friction."""
    m = case.model()
    m.gravity(0, -10)
    m.property(1, density=WEIGHT / 10)
    for n in (1, 2):
        m.jproperty(n, kn=KN, ks=KS, friction=5.0)
    m.block(30, -10, -30, -10, -30, 25, top[1], 25, *toe[3], *toe[0], 0, -5, 30, -5)
    m.polyline(*toe[0], *toe[1], *toe[2], joint=2, jmaterial=2, keep=True)
    m.polyline(*toe[3], *toe[2], joint=2, jmaterial=2, keep=True)
    m.polyline(*toe[2], top[0], 25, joint=1, jmaterial=1)
    m.round(ROUNDING)
    m.fix("NOT AREA < 100")
    m.solve(1e-6, static=True)
    return m


def solve(case):
    for degrees, toe, top, published in SLOPES:
        m = slope(case, toe, top)
        m.jproperty(1, friction=tan(radians(degrees)))
        m.jproperty(2, friction=tan(radians(20)))
        found = m.fos(joints=True, tolerance=0.005, picture=False)
        within = {"printed digits": 0.005, "bracket": 0.0025 * published, "rounding": 0.01 * published}
        yield Answer(f"factor of safety, bedding {degrees} degrees", "", found.factor, published, within)
        case.draw(m, contacts=True)
