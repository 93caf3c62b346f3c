"""How much memory a process has needed at most, since it was asked to count anew."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

STATUS, CLEAR = Path("/proc/self/status"), Path("/proc/self/clear_refs")
PEAK = "5"  # what to write to CLEAR for the peak to begin anew (Linux, proc(5))


def restart_peak() -> None:
    """Count anew, where the system can do that."""
    with suppress(OSError):
        CLEAR.write_text(PEAK)


def peak_memory() -> int:
    """The most memory in bytes that the process has had since then, or since it began; 0 if nobody knows."""
    with suppress(OSError, ValueError, IndexError):
        for line in STATUS.read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024
    try:
        import resource
    except ImportError:
        return 0
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
