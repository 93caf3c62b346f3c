r"""Factor of safety of columns that topple (Goodman and Bray)

Sixteen columns stand on a stepped base that dips out of a slope 92.5 m high. The upper ones stand by
themselves, those in the middle topple and push the lowest three, which slide. With the same friction phi in
all joints, from the uppermost column n = 16 down, the force on column n - 1 is the greatest of 0 and

    toppling   (P_n (M_n - d tan phi) + W_n/2 (y_n sin a - d cos a))/L_n       where y_n > d cot a, or P_n > 0
    sliding    P_n - W_n (cos a tan phi - sin a)/(1 - tan^2 phi)

a: dip of the base, d, y_n, W_n: width, height and weight of a column, M_n, L_n: heights of P_n and P_(n-1)
above its base. At the limit no force is left at the toe: tan phi = 0.7855. The factor of safety is tan phi
over that.

Tolerance. The solution assumes that friction is fully mobilised on the sides of the columns that slide.
There is no slip there, so statics does not determine it: with a quarter of it the factor is 4.5 % less. The
published results of distinct elements are 1 % lower as well. 2 % is allowed for that.

Source: R. E. Goodman and J. W. Bray, Toppling of rock slopes (1976), example with 16 columns.
"""

from math import cos, radians, sin, tan

from udec_ia.studies.verification import Answer

BLOCKS = ("rigid",)
REALS = 64
COLUMNS, CREST, WIDTH, STEP, RISE, FALL = 16, 10, 10.0, 1.0, 5.0, 5.0
DIP, WEIGHT, KN, KS, ROUNDING = radians(30), 25e3, 2e9, 1e9, 0.02
HEIGHTS = [(RISE - STEP) * n for n in range(1, CREST + 1)]
HEIGHTS += [HEIGHTS[-1] - (FALL + STEP) * n for n in range(1, COLUMNS - CREST + 1)]


def force_at_toe(friction):
    """The force that must hold the lowest column."""
    p = 0.0
    for n in range(COLUMNS, 0, -1):
        y = HEIGHTS[n - 1]
        weight = WEIGHT * WIDTH * y
        m = y if n < CREST else y - FALL
        low = y if n > CREST else y - RISE
        slides = p - weight * (cos(DIP) * friction - sin(DIP)) / (1 - friction**2)
        topples = 0.0
        if low > 0:
            topples = p * (m - WIDTH * friction) + weight / 2 * (y * sin(DIP) - WIDTH * cos(DIP))
            topples /= low
        p = max(slides, topples, 0.0)
    return p


def limit_friction():
    """tan phi without a force at the toe, by bisection."""
    low, high = 0.6, 0.9
    while high - low > 1e-12:
        middle = (low + high) / 2
        low, high = (low, middle) if force_at_toe(middle) == 0 else (middle, high)
    return high


def turned(along, across):
    """A point on the base in x and y."""
    return along * cos(DIP) - across * sin(DIP), along * sin(DIP) + across * cos(DIP)


def slope(case):
    """The columns at rest, with much friction."""
    base, top, sides = [], [], []
    for n, y in enumerate(HEIGHTS, 1):
        left, right, low = (n - 1) * WIDTH, n * WIDTH, n * STEP
        base += [turned(left, low), turned(right, low)]
        top += [turned(left, low + y), turned(right, low + y)]
        if n < COLUMNS:
            sides.append((turned(right, low + STEP), turned(right, min(low + y, low + STEP + HEIGHTS[n]))))
    (x, y), m = base[-1], case.model()
    m.gravity(0, -10)
    m.property(1, density=WEIGHT / 10)
    m.jproperty(1, kn=KN, ks=KS, friction=5.0)
    outline = [(-20, 0), (0, 0), base[0], *top, base[-1], (x + 20, y), (x + 20, -20), (-20, -20)]
    m.block(*[number for point in outline for number in point])
    m.polyline(*[number for point in base for number in point], joint=1, jmaterial=1)
    for low, high in sides:
        m.polyline(*low, *high, joint=2, jmaterial=1)
    m.round(ROUNDING)
    m.fix("NOT AREA < 1000")
    m.solve(1e-6, static=True)
    return m


def solve(case):
    limit = limit_friction()
    yield Answer("friction at the limit, closed form", "", limit, 0.78554, {"printed digits": 1e-5})
    for friction in (tan(radians(38.15)), 0.9):
        m = slope(case)
        m.jproperty(1, friction=friction)
        found = m.fos(joints=True, tolerance=0.005, picture=False)
        exact = friction / limit
        within = {"friction of columns that slide": 0.02 * exact}
        yield Answer(f"factor of safety, tan phi = {friction:.4g}", "", found.factor, exact, within)
    case.draw(m, contacts=True)
