"""A restart file is read, changed by a tool, and written again, with all that stands beside the array.

Its heap may be in any state: tools are there to repair it, too. Only the histories must be such that one can
tell whose numbers were recorded.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from udec_ia.heap.main_array import MainArray
from udec_ia.ops.commands.history_definitions import definitions
from udec_ia.restart.reader import Restored, opened, read_deck, read_front, read_laws, read_state
from udec_ia.restart.recorded import are_told, recall
from udec_ia.restart.refusal import RefusedError, refusing
from udec_ia.restart.writer import save


def load_to_change(path: str | Path) -> Restored:
    """All that the restart file `path` holds, its heap in whatever state it is.

    Raises UdecError 29 if the file is not what `save` wrote, or if its histories cannot be told.
    """
    path = Path(path)
    with refusing(path), opened(path) as file:
        seen = read_state(file, read_front(file))
        if not are_told(seen.array):
            raise RefusedError("does not say what its histories have recorded: the list of them is broken")
        series = recall(file, seen.array, bool(seen.mark))
        return Restored(seen.array, read_deck(file), read_laws(file), series, seen.said, seen.mark)


def save_changed(
    state: Restored, array: MainArray, path: str | Path, line: str, unsound: Sequence[str] = ()
) -> Path:
    """Write `array`, which was made of that of `state`, with all else of `state` to the file `path`.

    line: what the deck is to say of it, a command or a comment. unsound: what is wrong with it, with which
    the file is marked. Raises UdecError 31 as `save` does.
    """
    if are_told(array):
        for series, definition in zip(state.series, definitions(array), strict=False):
            series.follow(definition)
    return save(array, path, [*state.deck, line], state.laws, state.series, unsound)
