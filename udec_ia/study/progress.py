"""How a study is going: a bar on a terminal, a line for each run elsewhere."""

from __future__ import annotations

from typing import TextIO

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from udec_ia.printable import MESSAGE, counted, printable
from udec_ia.study.runs import DIED, ERROR, Result

KEPT = "kept"


class Told:
    """Takes the results of `total` runs as they come, and shows them on `stream`."""

    def __init__(self, stream: TextIO, total: int) -> None:
        self.stream, self.total = stream, total
        self.results: list[Result] = []
        self.kept = 0
        self.changed: dict[str, int] = {}  # results that were there and not taken: why, and how many
        columns = (
            BarColumn(None),
            MofNCompleteColumn(),
            TextColumn("{task.description}"),
            TimeRemainingColumn(),
        )
        self._bar: Progress | None = None
        if stream.isatty():
            console = Console(file=stream, highlight=False)
            self._bar = Progress(*columns, console=console, transient=True)
            self._task = self._bar.add_task("", total=total)
            self._bar.start()

    def __call__(self, result: Result, why: str) -> None:
        """A result has come. why: see many.run_all."""
        self.results.append(result)
        self.kept += why == KEPT
        if why not in ("", KEPT):
            self.changed[why] = self.changed.get(why, 0) + 1
        line = told(result) + {"": "", KEPT: " (kept)"}.get(why, f" (done again: {why})")
        if self._bar is not None:
            self._bar.update(self._task, advance=1, description=printable(line))
            if result.status in (ERROR, DIED):
                self._bar.console.print(line, markup=False)
        else:
            print(f"{len(self.results)} of {self.total}: {line}", file=self.stream, flush=True)

    def close(self) -> None:
        """Take the bar away."""
        if self._bar is not None:
            self._bar.stop()

    @property
    def said(self) -> list[str]:
        """Sentences on all of them: how many there are of each status, and what was kept or not."""
        states = dict.fromkeys(one.status for one in self.results)
        counts = (f"{sum(one.status == state for one in self.results)} {state}" for state in states)
        found = [f"{len(self.results)} of {self.total} runs: {', '.join(counts)}"]
        if self.kept:
            found.append(f"{counted(self.kept, 'run')} kept, as the input is the same")
        return found + [f"{counted(n, 'run')} done again: {why}" for why, n in self.changed.items()]


def told(result: Result) -> str:
    """A result on one line."""
    text = f"{result.name} {result.status}"
    if result.message:
        text += f", {result.message}"
    return printable(f"{text}, {counted(result.cycles, 'cycle')}, {result.seconds:.1f} s", MESSAGE)
