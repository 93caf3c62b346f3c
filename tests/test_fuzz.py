"""A few hundred cases of the fuzzer (tools/fuzz.py), in processes of their own."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

FUZZ = Path(__file__).parent.parent / "tools" / "fuzz.py"


@pytest.mark.parametrize(("decks", "files"), [(250, 0), (0, 150)])
def test_fuzz(decks: int, files: int) -> None:
    """Every case ends in a result or in a numbered error."""
    arguments = ["--decks", str(decks), "--files", str(files), "--seed", "1"]
    done = subprocess.run(
        [sys.executable, str(FUZZ), *arguments], capture_output=True, text=True, timeout=900, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_case_is_always_the_same() -> None:
    show = [sys.executable, str(FUZZ), "--show", "decks", "7"]
    one, two = (
        subprocess.run(show, capture_output=True, text=True, timeout=300, check=True) for _ in range(2)
    )
    assert one.stdout == two.stdout != ""
