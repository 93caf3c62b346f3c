"""What all tests share: where compiled kernels are kept, and how long a generated example may take.

The kernels are compiled once and kept in the checkout, so that a second test run does not compile again.
The directory is named before anything imports the package, which looks at it once.
"""

from __future__ import annotations

import os
from pathlib import Path

from hypothesis import HealthCheck, settings

ROOT = Path(__file__).parent.parent
os.environ.setdefault("UDEC_CACHE", str(ROOT / ".udec_cache"))

# The first example of a test may compile kernels for a minute: neither it nor the data before it is slow.
settings.register_profile("udec_ia", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("udec_ia")
