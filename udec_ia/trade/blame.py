"""Which fields the lost digits come from: noise is put into some of them only, and their set is halved.

A set explains the loss if the spread of a quantity with noise in it alone is at least SHARE of that with
noise in all fields. Of sets that do, a least one is looked for by delta debugging (A. Zeller, R.
Hildebrandt, Simplifying and isolating failure-inducing input, IEEE Trans. Software Eng. 28, 2002), as
Verrou does it for lines of a program: first among passes, then among the fields of those. Where each of two
sets without a common field explains all of it, as in chaos, there is nobody to blame, and that is said.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from udec_ia.study.runs import ENDED
from udec_ia.trade.digits import Ensemble, perturbed
from udec_ia.trade.significant import digits

RUNS = 6  # of an ensemble
SHARE = 0.5  # of the spread; four equal and independent sources have so much each
PASSES = {
    "motion": ("block.KXD", "block.KYD", "block.KTD", "gridpoint.KXDG", "gridpoint.KYDG"),
    "places": ("block.KX", "block.KY", "gridpoint.KXG", "gridpoint.KYG"),
    "corners": ("corner.KXP", "corner.KYP", "corner.KXDP", "corner.KYDP"),
    "outlines": ("corner.KXCP", "corner.KYCP", "corner.KRAD"),
    "overlaps": ("contact.KCN", "contact.KCS"),
    "contact forces": ("contact.KCFN", "contact.KCFS"),
    "contact places": ("contact.KXC", "contact.KYC", "contact.KXDC", "contact.KYDC"),
    "domains": ("domain.KUMAX",),
    "stresses": ("zone.KZS11", "zone.KZS12", "zone.KZS22"),
    "block strains": (
        *(f"sdef.{name}" for name in ("KED11", "KED12", "KED21", "KED22")),
        *(f"sdef.{name}" for name in ("KS111", "KS112", "KS121", "KS122")),
    ),
}
COLUMNS = ("pass", "field", "spread", "share")


class Blame:
    """Narrows down what the spread of a quantity of an ensemble comes from. tests: ensembles that were
    run."""

    def __init__(self, found: Ensemble, quantity: str = "") -> None:
        self.found = found
        self.build, *_ = found.results
        measured = {name: found.digits(self.build, name) for name in found.names}
        known = {name: one for name, one in measured.items() if one is not None and one.spread > 0}
        self.quantity = quantity or min(known, key=lambda name: known[name].digits, default="")
        self.whole = known[self.quantity].spread if self.quantity in known else 0.0
        self.cycles = sum(one.done for one in found.shop.survey)
        self.tests: dict[tuple[str, ...], float] = {}

    def spread(self, fields: Sequence[str]) -> float:
        """The spread with noise in some fields only."""
        key = tuple(sorted(fields))
        if key not in self.tests:
            label = f"noise{len(self.tests)}"
            results = perturbed(self.found.shop, self.build, self.cycles, range(1, RUNS + 1), key, label)
            values = [one.quantities[self.quantity] for one in results if one.status == ENDED]
            one = digits(values, 52)
            self.tests[key] = one.spread if one else float("inf")
        return self.tests[key]

    def explains(self, fields: Sequence[str]) -> bool:
        """True if noise in these fields alone is enough."""
        return bool(fields) and self.spread(fields) >= SHARE * self.whole

    def search(self) -> tuple[list[str], list[tuple[object, ...]]]:
        """What is to be said, and a line for each field that is to blame."""
        if not self.quantity or self.whole == 0:
            return ["no digit is lost, so no field is to blame"], []
        passes = minimal([*PASSES], lambda names: self.explains(_fields(names)))
        others = [name for name in PASSES if name not in passes]
        if self.explains(_fields(others)):
            said = (
                f"{self.quantity}: noise in {' and '.join(passes)} explains the loss, and so does noise in "
                "all other passes: the digits are lost in the motion itself, whatever is perturbed"
            )
            return [said], self._rows(passes, _fields(passes))
        fields = minimal([*_fields(passes)], self.explains)
        said = (
            f"{self.quantity}: noise in these fields alone explains the loss; noise in other passes does not"
        )
        return [said], self._rows(passes, fields)

    def _rows(self, passes: Sequence[str], fields: Sequence[str]) -> list[tuple[object, ...]]:
        rows: list[tuple[object, ...]] = []
        for name in passes:
            for one in PASSES[name]:
                if one in fields:
                    spread = self.spread([one]) if len(fields) <= len(PASSES) else float("nan")
                    rows.append((name, one, spread, spread / self.whole))
        return rows


def _fields(passes: Sequence[str]) -> list[str]:
    return [field for name in passes for field in PASSES[name]]


def minimal(items: list[str], enough: Callable[[list[str]], bool]) -> list[str]:
    """A least part of `items` that is enough: none of the parts that were tried within it is (ddmin).

    All of them are taken to be enough.
    """
    parts = 2
    while len(items) > 1:
        size = -(-len(items) // parts)
        chunks = [items[k : k + size] for k in range(0, len(items), size)]
        rests = [[one for one in items if one not in chunk] for chunk in chunks] if len(chunks) > 2 else []
        better = next((one for one in [*chunks, *rests] if enough(one)), None)
        if better is not None:
            parts = 2 if better in chunks else max(parts - 1, 2)
            items = better
        elif parts >= len(items):
            break
        else:
            parts = min(2 * parts, len(items))
    return items
