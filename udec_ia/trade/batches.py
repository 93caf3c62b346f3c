"""In which order and in what batches settings are run, so that what they really take keeps to the budget.

Times are predicted, and predictions fail: most of all those of a word scheme that has not run yet, and of
runs that do not come to rest. So settings run in batches, and after each of them what is left of the budget,
and what the others will take, is seen anew.
"""

from __future__ import annotations

from collections.abc import Sequence

from udec_ia.trade.judge import Row

SLICE = 0.05  # of the budget: what a batch is predicted to take, unless that is less than one run a process
WRONG = 2.0  # times what was predicted, from which on the others of a word scheme are predicted anew
COARSE = "the last digit of coordinates"  # how the warning of reals that allow no small ratio begins
UNREST = "NOT REACHED"


def turn(row: Row) -> tuple[bool, float]:
    """When its turn comes: STATIC first, which most often takes the fewest cycles, then the cheapest."""
    return not row.setting.static, row.predicted


def batch(ahead: Sequence[Row], build: str, seconds: float, processes: int, tried: bool) -> list[Row]:
    """The rows of a word scheme to be run next, about `seconds` of the clock of them.

    tried: the scheme has run before; else its first row is run alone if all of them take longer than that.
    """
    some = sorted((row for row in ahead if row.setting.build == build), key=turn)
    if not tried and sum(row.predicted for row in some) > seconds * processes:
        return some[:1]
    taken = some[:processes]
    for row in some[processes:]:
        if sum(one.predicted for one in [*taken, row]) > seconds * processes:
            break
        taken.append(row)
    return taken


def foresee(ahead: Sequence[Row], done: Sequence[Row]) -> None:
    """Predict rows of a word scheme anew, if those that are done have taken far longer than was predicted."""
    thought = sum(row.predicted for row in done)
    times = sum(row.result.seconds for row in done if row.result) / thought if thought else 1.0
    for row in ahead:
        if times > WRONG and row.setting.build == done[0].setting.build:
            row.predicted *= times


def hopeless(ahead: Sequence[Row], done: Sequence[Row], own: str) -> tuple[list[Row], str]:
    """Rows that cannot come to rest, as the words of a row that is done allow no smaller ratio; and why.

    own: what SOLVE says in the deck as it is.
    """
    for row in done:
        said = row.result.message if row.result else ""
        coarse = row.result and any(one.startswith(COARSE) for one in row.result.warnings)
        if coarse and UNREST in said and UNREST not in own:
            setting = row.setting
            alike = [
                one
                for one in ahead
                if one.setting.build == setting.build and one.setting.ratio <= setting.ratio
            ]
            return alike, f"{setting.name} ends with {said}: its reals allow no smaller ratio"
    return [], ""
