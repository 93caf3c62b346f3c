"""What all tests share: where compiled kernels are kept, what warnings are errors, and Ctrl-C.

The kernels are compiled once and kept in the checkout, so that a second test run does not compile again.
The directory is named before anything imports the package, which looks at it once.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

ROOT = Path(__file__).parent.parent
os.environ.setdefault("UDEC_CACHE", str(ROOT / ".udec_cache"))
os.environ["UDEC_AHEAD"] = "0"  # the tests have several processes anyway

# The first example of a test may compile kernels for a minute: neither it nor the data before it is slow.
settings.register_profile("udec_ia", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("udec_ia")

# A shell that starts the tests in the background has them ignore Ctrl-C, and every process that they start.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_configure(config: pytest.Config) -> None:
    """Warnings that Python attributes to a module of the checkout, by name or path, are errors."""
    loose = {path.stem for folder in ("tests", "tools") for path in (ROOT / folder).rglob("*.py")}
    ours = "|".join(sorted({"udec_ia", "offsets", "naive", "support", "speed", "trials", "damage"} | loose))
    config.addinivalue_line("filterwarnings", rf"error:::(.*[/\\])?({ours})([./\\]|$)")
    config.addinivalue_line("filterwarnings", "ignore::udec_ia.UdecWarning")  # models give them by design


@pytest.fixture(autouse=True, scope="session")
def _nothing_is_written_here() -> Iterator[None]:
    """A test that runs a model with pictures or histories gives it a folder of its own."""
    before = _files_of_runs()
    yield
    assert _files_of_runs() == before


def _files_of_runs() -> dict[str, int]:
    """Files of the names that a run without a folder writes, and when each was written."""
    return {path.name: path.stat().st_mtime_ns for path in Path.cwd().glob("udec-*")}
