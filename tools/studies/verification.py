"""Problems with exact solutions: `python tools/studies/verification.py [NAME ...]` prints both figures.

The tests run the same problems and hold each figure to its tolerance. A problem is a function that builds a
model, runs it and returns figures; its comment says what the exact value is. Units are SI.
"""

from __future__ import annotations

import argparse
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
    parser = argparse.ArgumentParser(description="Computed beside exact, for each figure of the problems.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="one of: " + ", ".join(PROBLEMS))
    names = parser.parse_args().names or list(PROBLEMS)
    unknown = [name for name in names if name not in PROBLEMS]
    if unknown:
        parser.error(f"there is no problem {unknown[0]!r}: choose from {', '.join(PROBLEMS)}")
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
