"""Stresses at one point of a joint on a path of closure and slip, by the published formulas in small steps.

Signs: closure is positive when the blocks approach, normal stress is positive in compression, and shear
stress has the sign of the slip that causes it. All numbers are in SI units, per metre of thickness where
that counts. Dissipated work is the work done on the point less the elastic energy that it would return.

Sources
-------
Coulomb with residual strength and dilation: the joint model "Coulomb slip with residual strength" of UDEC
(Itasca, UDEC theory, joint constitutive models).
Continuously yielding: Cundall and Hart, Analysis of block test no. 1, RHO report 1984; Brady and Brown, Rock
mechanics for underground mining, section 4.8.3.
Barton-Bandis: Barton and Choubey, Rock Mechanics 10 (1977) 1-54 (strength); Bandis, Lumsden and Barton,
Int. J. Rock Mech. Min. Sci. 20 (1983) 249-268 (closure); Barton, Bandis and Bakhtar, same journal 22 (1985)
121-140 (hydraulic aperture); Brady and Brown, section 4.8.2 (loading and unloading are both hyperbolas).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf, log, log10, radians, tan

MEGAPASCAL, MILLIMETRE, MICROMETRE = 1e6, 1e-3, 1e-6
FIRST_LOADING = (-0.2960, -0.0056, 2.2410, -0.2450)  # A, B, C, D of the greatest closure, Bandis et al. 1983
LATER_LOADING = (-0.1032, -0.0074, 1.1350, -0.2510)  # of the third load cycle, same table
LARGEST_ANGLE = 70.0  # degrees, of the whole friction angle of Barton
LARGEST_RATIO = 0.75  # of r, continuously yielding
COUNTED_SLIP = 1e-6  # of R: a shorter slip in the other direction is no reversal


@dataclass(kw_only=True)
class JointPoint:
    """What all models share: the position, the stresses and the work done so far."""

    closure: float = 0.0
    slip: float = 0.0
    normal: float = 0.0
    shear: float = 0.0
    work: float = 0.0

    def step(self, closing: float, slipping: float) -> None:
        """Follow one small step."""
        raise NotImplementedError

    def energy(self) -> float:
        """Elastic energy, J/m2."""
        raise NotImplementedError

    def dissipated(self) -> float:
        """Work that is lost, J/m2."""
        return self.work - self.energy()

    def move(self, closing: float, slipping: float, steps: int = 1000) -> None:
        """Follow a straight path in equal steps. Work is by the trapezoid rule."""
        for _ in range(steps):
            normal, shear = self.normal, self.shear
            self.step(closing / steps, slipping / steps)
            self.work += (normal + self.normal) / 2 * closing / steps
            self.work += (shear + self.shear) / 2 * slipping / steps

    def shear_under(self, normal: float, slipping: float, steps: int = 1000) -> None:
        """Slip under a constant normal stress, which must be positive: after each step closure is corrected.

        Secants find the closure. Raises ArithmeticError if 50 of them do not.
        """
        for _ in range(steps):
            self.move(0.0, slipping / steps, 1)
            closing = 1e-9 * max(abs(self.closure), 1e-6)
            for _ in range(50):
                if abs(self.normal - normal) <= 1e-10 * normal:
                    break
                before = self.normal
                self.move(closing, 0.0, 1)
                slope = (self.normal - before) / closing
                if abs(self.normal - normal) > 1e-10 * normal:
                    closing = (normal - self.normal) / slope
            else:
                raise ArithmeticError("the normal stress was not reached")


@dataclass(kw_only=True)
class Coulomb(JointPoint):
    """Coulomb's law with stiffness, cohesion and tensile strength per area.

    Parameters
    ----------
    kn, ks: stiffness, Pa/m. friction, dilation: tangents. cohesion, tension: Pa.
    limit: plastic slip at which dilation ends, m; 0 for no limit.
    residual_friction, residual_cohesion: from the first slip or opening on; None for the same as before.

    plastic is the net plastic slip: on the way back it decreases and the joint closes. An open joint has no
    stress, and moving it is no plastic slip; when it closes, shear starts from 0.
    """

    kn: float
    ks: float
    friction: float = 0.0
    cohesion: float = 0.0
    tension: float = 0.0
    dilation: float = 0.0
    limit: float = 0.0
    residual_friction: float | None = None
    residual_cohesion: float | None = None
    plastic: float = 0.0
    broken: bool = False

    def opened(self, plastic: float) -> float:
        """What the joint dilates by a net plastic slip, m."""
        return self.dilation * min(abs(plastic), self.limit or inf)

    def normal_at(self, plastic: float) -> float:
        """Normal stress at the present closure before anything breaks."""
        return self.kn * (self.closure + self.opened(plastic))

    def strength(self, normal: float) -> float:
        """Shear strength, at least 0."""
        friction, cohesion = self.friction, self.cohesion
        if self.broken:
            friction = friction if self.residual_friction is None else self.residual_friction
            cohesion = cohesion if self.residual_cohesion is None else self.residual_cohesion
        return max(cohesion + friction * normal, 0.0)

    def open_up(self) -> None:
        """Lose all stress."""
        self.broken, self.normal, self.shear = True, 0.0, 0.0

    def step(self, closing: float, slipping: float) -> None:
        self.closure += closing
        self.slip += slipping
        normal = self.normal_at(self.plastic)
        if normal < -self.tension or (self.broken and normal <= 0):
            return self.open_up()
        trial = self.shear + self.ks * slipping
        if abs(trial) > self.strength(normal):
            self.broken = True
            if normal <= 0:  # the tensile strength is lost with the first slip
                return self.open_up()
            way = 1.0 if trial > 0 else -1.0
            low, high = 0.0, abs(trial) / self.ks  # plastic slip of this step, by bisection
            for _ in range(80):
                middle = (low + high) / 2
                strength = self.strength(max(self.normal_at(self.plastic + way * middle), 0.0))
                low, high = (middle, high) if abs(trial) - self.ks * middle > strength else (low, middle)
            self.plastic += way * high
            trial -= way * self.ks * high
            normal = self.normal_at(self.plastic)
            if normal <= 0:
                return self.open_up()
        self.normal, self.shear = normal, trial
        return None

    def energy(self) -> float:
        return self.normal**2 / (2 * self.kn) + self.shear**2 / (2 * self.ks)


@dataclass(kw_only=True)
class ContinuouslyYielding(JointPoint):
    """The continuously yielding model.

    Parameters
    ----------
    an, en, as_, es: kn = an sn^en and ks = as sn^es, sn in Pa; kn and ks are in Pa/m.
    kn_range, ks_range: least and greatest stiffness, Pa/m.
    peak, basic: initial angle phi_m and final angle phi, radians. roughness: R, m.

        tau_m = sn tan(phi_m) sign(ds) ;  F = (1 - tau/tau_m)/(1 - r), between 0 and 1
        dtau = F ks ds ;  dphi_m = -(phi_m - phi)(1 - F)|ds|/R

    r is tau/tau_m at the last reversal, at most 0.75. A slip in the other direction counts as a reversal
    when it is longer than 1e-6 R. Shear stress does not exceed the bounding strength |tau_m|: as F is at
    least 0, it would otherwise remain at its peak while the strength falls. Each step is one of the
    midpoint rule.
    """

    an: float
    en: float
    as_: float
    es: float
    peak: float
    basic: float
    roughness: float
    kn_range: tuple[float, float] = (0.0, inf)
    ks_range: tuple[float, float] = (0.0, inf)
    gap: float = 0.0
    ratio: float = 0.0
    angle: float = field(init=False)  # phi_m
    way: float = 0.0  # sign of the slip since the last reversal that counted
    back: float = 0.0  # slip against it
    turned: float = 0.0  # tau/|tau_m| where that slip began, in the new direction

    def __post_init__(self) -> None:
        self.angle = self.peak

    def kn(self, normal: float) -> float:
        """Normal stiffness, Pa/m."""
        return min(max(self.an * max(normal, 0.0) ** self.en, self.kn_range[0]), self.kn_range[1])

    def ks(self, normal: float) -> float:
        """Shear stiffness of an unloading joint, Pa/m."""
        return min(max(self.as_ * max(normal, 0.0) ** self.es, self.ks_range[0]), self.ks_range[1])

    def rates(self, way: float, normal: float, shear: float, angle: float) -> tuple[float, float]:
        """Slopes of tau and phi_m with slip |ds|."""
        bound = normal * tan(angle)
        part = 0.0
        if bound > 0:
            part = min(max((1 - way * shear / bound) / (1 - self.ratio), 0.0), 1.0)
        return part * self.ks(normal) * way, -(angle - self.basic) * (1 - part) / self.roughness

    def step(self, closing: float, slipping: float) -> None:
        before = self.normal
        self._close(closing)
        self.slip += slipping
        if self.normal <= 0:
            self.shear = 0.0
            return
        if slipping:
            self._slide((before + self.normal) / 2, slipping)
        bound = self.normal * tan(self.angle)
        self.shear = min(max(self.shear, -bound), bound)

    def _close(self, closing: float) -> None:
        self.closure += closing
        used = min(self.gap, closing) if closing > 0 else 0.0
        self.gap -= used
        closing -= used
        if self.gap > 0 or (self.normal <= 0 and closing < 0):
            self.gap += max(-closing, 0.0)
            return
        half = self.normal + self.kn(self.normal) * closing / 2
        after = self.normal + self.kn(half) * closing
        if after < 0:  # it opens within this step
            self.gap = -after / max(self.kn(half), 1e-300)
        self.normal = max(after, 0.0)

    def _slide(self, normal: float, slipping: float) -> None:
        way = 1.0 if slipping > 0 else -1.0
        if not self.way:
            self.way = way
        if way == self.way:
            self.back = 0.0
        else:
            if not self.back:
                bound = normal * tan(self.angle)
                self.turned = way * self.shear / bound if bound > 0 else 0.0
            self.back += abs(slipping)
            if self.back > COUNTED_SLIP * self.roughness:
                self.way, self.back = way, 0.0
                self.ratio = min(self.turned, LARGEST_RATIO)
        shear, angle = self.rates(way, normal, self.shear, self.angle)
        ds = abs(slipping)
        shear, angle = self.rates(way, normal, self.shear + shear * ds / 2, self.angle + angle * ds / 2)
        self.shear += shear * ds
        self.angle += angle * ds

    def normal_energy(self) -> float:
        """Integral of normal stress over closure from 0, by the midpoint rule in 20,000 steps of stress."""
        n = 20000
        width = self.normal / n
        return sum((i + 0.5) * width**2 / self.kn((i + 0.5) * width) for i in range(n)) if width else 0.0

    def energy(self) -> float:
        """Elastic energy: unloading has the stiffness ks, as F is 1 just behind a reversal."""
        if self.normal <= 0:
            return 0.0
        return self.normal_energy() + self.shear**2 / (2 * self.ks(self.normal))


@dataclass(frozen=True)
class Hyperbola:
    """The closure curve s = k u/(1 - u/greatest). Pa/m, m."""

    k: float
    greatest: float

    def stress(self, closure: float) -> float:
        """Normal stress, 0 when open. Raises OverflowError from the greatest closure on."""
        if closure >= self.greatest:
            raise OverflowError("the joint cannot close as far as that")
        return max(self.k * closure / (1 - closure / self.greatest), 0.0)

    def closure(self, stress: float) -> float:
        """Closure under a stress, m."""
        return stress / (self.k + stress / self.greatest)

    def stiffness(self, stress: float) -> float:
        """Tangent, Pa/m."""
        return self.k * (1 + stress / (self.k * self.greatest)) ** 2

    def energy(self, stress: float) -> float:
        """Work of closing from 0, J/m2: the integral of s du."""
        part = self.closure(stress) / self.greatest
        return self.k * self.greatest**2 * (-log(1 - part) - part)


@dataclass(kw_only=True)
class BartonBandis(JointPoint):
    """Barton's strength and the closure of Bandis, with memory of the largest normal stress.

    Parameters
    ----------
    jrc: joint roughness coefficient. jcs, sigma_c: strength of the joint wall and of the rock, Pa.
    residual: residual friction angle, degrees. ks: shear stiffness, Pa/m.

    First loading follows one hyperbola. Unloading and reloading below the largest stress so far follow
    another, of the same initial stiffness and of the greatest closure of later load cycles, moved along the
    axis of closure so that the curves meet at the largest stress.
    """

    jrc: float
    jcs: float
    sigma_c: float
    residual: float
    ks: float
    largest: float = 0.0
    broken: bool = False

    def aperture_at_rest(self) -> float:
        """a_j, m: aperture of the joint before it was loaded."""
        return self.jrc / 5 * (0.2 * self.sigma_c / self.jcs - 0.1) * MILLIMETRE

    def greatest_closure(self, constants: tuple[float, float, float, float]) -> float:
        """V_m, m, by the constants of a load cycle; not more than the aperture."""
        a, b, c, d = constants
        aperture = self.aperture_at_rest()
        ratio = (self.jcs / MEGAPASCAL) / (aperture / MILLIMETRE)
        return min((a + b * self.jrc + c * ratio**d) * MILLIMETRE, aperture)

    def initial_stiffness(self) -> float:
        """K_ni, Pa/m."""
        ratio = (self.jcs / MEGAPASCAL) / (self.aperture_at_rest() / MILLIMETRE)
        return (-7.15 + 1.75 * self.jrc + 0.02 * ratio) * MEGAPASCAL / MILLIMETRE

    def first(self) -> Hyperbola:
        """The curve of first loading. Raises ValueError where the relations give nothing of use."""
        found = Hyperbola(self.initial_stiffness(), self.greatest_closure(FIRST_LOADING))
        if found.k <= 0 or found.greatest <= 0:
            raise ValueError("JRC, JCS and sigma_c are outside the range of the relations")
        return found

    def later(self) -> Hyperbola:
        """The curve of unloading and reloading, with its origin at 0. Raises ValueError as `first`."""
        first = self.first()
        found = Hyperbola(first.k, min(self.greatest_closure(LATER_LOADING), first.greatest))
        if found.greatest <= 0:
            raise ValueError("JRC, JCS and sigma_c are outside the range of the relations")
        return found

    def permanent(self) -> float:
        """Closure that remains without stress, m."""
        return self.first().closure(self.largest) - self.later().closure(self.largest)

    def strength(self, normal: float) -> float:
        """Shear strength, Pa."""
        if normal <= 0:
            return 0.0
        angle = self.residual + self.jrc * max(log10(self.jcs / normal), 0.0)
        return normal * tan(radians(min(angle, LARGEST_ANGLE)))

    def stiffness(self) -> float:
        """Largest tangent of the normal stress at the present state, Pa/m: that of unloading."""
        return self.later().stiffness(self.normal)

    def aperture(self) -> float:
        """Mechanical aperture, m."""
        return self.aperture_at_rest() - self.closure

    def hydraulic_aperture(self) -> float:
        """Hydraulic aperture, m, not more than the mechanical one."""
        aperture = self.aperture()
        return min((aperture / MICROMETRE) ** 2 / self.jrc**2.5 * MICROMETRE, aperture)

    def step(self, closing: float, slipping: float) -> None:
        self.closure += closing
        self.slip += slipping
        if self.closure > self.first().closure(self.largest):
            self.normal = self.largest = self.first().stress(self.closure)
        else:
            self.normal = self.later().stress(self.closure - self.permanent())
        strength = self.strength(self.normal)
        self.shear = min(max(self.shear + self.ks * slipping, -strength), strength)

    def energy(self) -> float:
        """Elastic energy, which unloading returns."""
        return self.later().energy(self.normal) + self.shear**2 / (2 * self.ks)
