"""Problems with exact solutions: `python tools/verification.py [NAME ...]` prints computed beside exact.

The tests run the same problems and hold each figure to its tolerance. A problem is a function that builds a
model, runs it and returns figures; its comment says what the exact value is. Units are SI.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

from continua import bar, footing, hole, mode, period, pulse
from figure import Figure
from planes import column, incline, toppling

PROBLEMS: dict[str, Callable[[], list[Figure]]] = {
    problem.__name__: problem
    for problem in (incline, column, toppling, mode, period, pulse, hole, footing, bar)
}


def main() -> int:
    """Run the problems named on the command line, or all; 0 if every figure is within its tolerance."""
    names = sys.argv[1:] or list(PROBLEMS)
    wrong = 0
    print(f"{'':60} {'computed':>12} {'exact':>12} {'off by':>10} {'allowed':>8}")
    for name in names:
        start = time.perf_counter()
        for figure in PROBLEMS[name]():
            wrong += not figure.holds
            print(
                f"{figure.what:60} {figure.computed:12.6g} {figure.exact:12.6g} {100 * figure.error:8.3f} % "
                f"{100 * figure.within:6.2f} %{'' if figure.holds else '  <- too much'}"
            )
        print(f"{'':4}({name}, {time.perf_counter() - start:.1f} s)", file=sys.stderr)
    return min(wrong, 1)


if __name__ == "__main__":
    sys.exit(main())
