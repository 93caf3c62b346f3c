"""Results as files: how they are written and read, and when one stands for a run that is to be done.

What is read is judged word by word. What the program does not write so is damaged, and its run is done again.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from udec_ia.study.folders import RESULT
from udec_ia.study.reading import read
from udec_ia.study.runs import DIED, LATE, STATUSES, Result, Run, plain

LATER = {"warnings", "of_system"}  # fields that results of earlier versions lack
UNREADABLE = "the result cannot be read"
GREATEST = 2**63  # of what a column of integers can hold, and one more
NOT_FINITE = ("nan", "inf", "-inf")  # how JSON has them


def write(result: Result, folder: Path) -> None:
    """Leave the result in the folder of its run, which is there."""
    (folder / RESULT).write_text(json.dumps(plain(asdict(result)), indent=1) + "\n", encoding="utf-8")


def kept(run: Run, folder: Path) -> tuple[Result | None, str]:
    """The result of `run` in its folder in `folder`, or None and why it is not taken, "" if there is none."""
    try:
        result = _read(folder / run.name / RESULT)
    except FileNotFoundError:
        return None, ""
    except (OSError, ValueError, OverflowError, RecursionError):
        return None, UNREADABLE
    made_of = run.made_of
    changed = [name for name in made_of if result.made_of.get(name) != made_of[name]]
    if result.status == LATE and (run.limit is None or run.limit > (result.limit or 0)):
        changed.append("limit")
    if changed:
        return None, f"{' and '.join(changed)} changed"
    if not _is_of(run, result):
        return None, UNREADABLE
    if result.of_system:
        return None, _failure(result)
    return replace(result, values=dict(run.values)), ""


def _failure(result: Result) -> str:
    """What had ended a run that its deck has not ended."""
    if result.status == DIED:
        return "the process had died"
    return f"error {result.error} was not of the deck" if result.error else "the system had failed"


def _read(path: Path) -> Result:
    """The result in a file. ValueError, OverflowError or RecursionError for what no run leaves, OSError."""
    found = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(found, dict) or not {*WRITTEN} - LATER <= {*found} <= {*WRITTEN}:
        raise ValueError("its fields are others")
    wrong = [name for name, value in found.items() if not WRITTEN[name](value)]
    if wrong:
        raise ValueError(f"its {wrong[0]} is none")
    found["quantities"] = {name: float(value) for name, value in found["quantities"].items()}
    texts = {name: tuple(found.get(name, ())) for name in ("remarks", "warnings")}
    return Result(**found | texts)


def _is_of(run: Run, result: Result) -> bool:
    """True if the result has the name, the values and the quantities of the run that it is made for."""
    names = [one.name for one in read(run.quantities)]
    values = [{name: str(one) for name, one in values.items()} for values in (run.values, result.values)]
    return result.name == run.name and [*result.quantities] == names and values[0] == values[1]


# ---- what stands in the fields


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_count(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < GREATEST


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _is_time(value: Any) -> bool:
    return _is_number(value) and value >= 0


def _is_quantity(value: Any) -> bool:
    return value in NOT_FINITE if isinstance(value, str) else isinstance(value, float) and _is_number(value)


def _texts(value: Any) -> bool:
    return isinstance(value, list) and all(map(_is_text, value))


def _named(judge: Callable[[Any], bool]) -> Callable[[Any], bool]:
    return lambda value: isinstance(value, dict) and all(map(judge, value.values()))


WRITTEN: dict[str, Callable[[Any], bool]] = {  # what each field of a Result may hold
    "name": _is_text,
    "values": _named(lambda one: _is_text(one) or _is_number(one)),
    "status": lambda value: value in STATUSES,
    "error": _is_count,
    "message": _is_text,
    "quantities": _named(_is_quantity),
    "remarks": _texts,
    "cycles": _is_count,
    "time": _is_time,
    "words": _is_count,
    "seconds": _is_time,
    "wall_seconds": _is_time,
    "peak_memory": _is_count,
    "made_of": _named(_is_text),
    "limit": lambda value: value is None or (_is_time(value) and value > 0),
    "warnings": _texts,
    "of_system": lambda value: isinstance(value, bool),
}
