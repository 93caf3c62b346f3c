"""Commands that change numbers of the common block: materials, gravity, damping, time-step, energy."""

from __future__ import annotations

from typing import Unpack

from udec_ia.advice.input_warnings import check_fraction, check_properties
from udec_ia.errors import UdecError
from udec_ia.keywords import takes
from udec_ia.layout.material import Properties
from udec_ia.methods.state import State
from udec_ia.ops.commands import settings
from udec_ia.ops.commands.energy import Balance, balance, switch
from udec_ia.transaction import looking, numbers, steady


class Numbers(State):
    """Each method does what the command of its name does."""

    @numbers
    @takes(Properties)
    def property(self, material: int, **values: Unpack[Properties]) -> None:
        """PROPERTY: set properties of a material; those not given stay as they are.

        From dilation on they are for the laws of constitutive numbers 2 to 5 (udec_ia.laws).
        """
        self._ready()
        settings.set_property(self.array, material, **values)
        self.remark(check_properties(self.array, material, dict[str, float | None](**values)))

    @numbers
    def gravity(self, gx: float, gy: float) -> None:
        """GRAVITY: accelerations in the x and y directions."""
        self._ready(sound=False)
        settings.set_gravity(self.array, gx, gy)

    @numbers
    def damping(
        self,
        fcrit: float | None = None,
        freq: float | None = None,
        only: str | None = None,
        *,
        local: float | None = None,
        combined: float | None = None,
        kinetic: bool = False,
        adaptive: float | None = None,
    ) -> None:
        """DAMPING: Rayleigh damping; only "mass", only "stiffness", or "internal" (see set_damping).

        Or one of what else leads to rest: local, combined, kinetic or adaptive (see set_relaxation).
        """
        self._ready(sound=False)
        others = {"local": local, "combined": combined, "kinetic": kinetic or None, "adaptive": adaptive}
        given = {how: f for how, f in others.items() if f is not None}
        if len(given) + (fcrit is not None or freq is not None or only is not None) != 1:
            advice = "fcrit and freq, or one of " + ", ".join(word.upper() for word in others)
            raise UdecError(7, "DAMPING takes one kind of damping", advice, parameter="fcrit")
        for how, f in given.items():
            settings.set_relaxation(self.array, how, float(f))
        if not given:
            if fcrit is None or freq is None:
                raise UdecError(7, "freq" if fcrit is not None else "fcrit", parameter="fcrit")
            settings.set_damping(self.array, fcrit, freq, only.lower() if only else None)

    @steady
    def energy(self, state: str = "on") -> None:
        """ENERGY: "on": an account of the energy begins (see `balance`); "off": it ends."""
        self._ready()
        if state.lower() not in ("on", "off"):
            raise UdecError(10, f"ENERGY {state}", "ON or OFF", parameter="state")
        switch(self.array, state.lower() == "on")

    @looking
    def balance(self) -> Balance:
        """The account of the energy that PRINT ENERGY shows, in J per m of thickness.

        Error 26 unless energy("on") began one.
        """
        self._ready()
        return balance(self.array.h)

    @numbers
    def fraction(self, f: float, *, safe: bool = False, scaled: bool = False) -> None:
        """FRACTION: fraction of the critical time-step to be used; safe: of a bound on all modes.

        scaled: the same with inertial masses that make all degrees of freedom as quick as the quickest one.
        """
        self._ready(sound=False)
        settings.set_fraction(self.array, f, safe, scaled)
        self.remark(check_fraction(f))

    @steady
    def scale(self, s: float) -> None:
        """SCALE: plot scale."""
        self._ready(sound=False)
        settings.set_scale(self.array, s)
