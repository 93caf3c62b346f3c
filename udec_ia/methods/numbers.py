"""Commands that change numbers of the common block: materials, gravity, damping, time-step, energy."""

from __future__ import annotations

from typing import Unpack

from udec_ia.errors import UdecError
from udec_ia.kernels.drive.damping_modes import MODES
from udec_ia.keywords import takes
from udec_ia.layout.material import Properties
from udec_ia.methods.state import State
from udec_ia.ops.commands import model_settings
from udec_ia.ops.commands.energy_account import Balance, balance, switch
from udec_ia.ops.run.remarks import on_fraction, on_properties
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
        model_settings.set_property(self.array, material, **values)
        self.remark(on_properties(self.array, material, dict[str, float | None](**values)))

    @numbers
    def gravity(self, gx: float, gy: float) -> None:
        """GRAVITY: accelerations in the x and y directions."""
        self._ready(sound=False)
        model_settings.set_gravity(self.array, gx, gy)

    @numbers
    @takes(type("Modes", (), {"__annotations__": {one.argument: float | None for one in MODES}}))
    def damping(
        self,
        /,
        fcrit: float | None = None,
        freq: float | None = None,
        only: str | None = None,
        **modes: float | None,
    ) -> None:
        """DAMPING: Rayleigh damping; only "mass", only "stiffness", or "internal" (see set_damping).

        Or one of the modes that lead to rest: local=f, combined=f, kinetic=True, adaptive=f
        (kernels.drive.damping_modes).
        """
        self._ready(sound=False)
        asked = {one: modes.get(one.argument) for one in MODES}
        given = {one: f for one, f in asked.items() if f is not None and f is not False}
        if len(given) + (fcrit is not None or freq is not None or only is not None) != 1:
            advice = "fcrit and freq, or one of " + ", ".join(one.name for one in MODES)
            raise UdecError(7, "DAMPING takes one kind of damping", advice, parameter="fcrit")
        for mode, f in given.items():
            model_settings.set_damping_mode(self.array, mode, float(f))
        if not given:
            if fcrit is None or freq is None:
                raise UdecError(7, "freq" if fcrit is not None else "fcrit", parameter="fcrit")
            model_settings.set_damping(self.array, fcrit, freq, only.lower() if only else None)

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
        model_settings.set_fraction(self.array, f, safe, scaled)
        self.remark(on_fraction(f))

    @steady
    def scale(self, s: float) -> None:
        """SCALE: plot scale."""
        self._ready(sound=False)
        model_settings.set_scale(self.array, s)
