"""Which warnings fail a test: those of our own modules, not what others deprecate among themselves."""

from __future__ import annotations

import warnings
from types import ModuleType

import pytest


def warn(name: str, category: type[Warning]) -> None:
    """A warning that Python attributes to the module `name`."""
    module = ModuleType(name)
    exec("def calls(f):\n    f()\n", module.__dict__)
    module.calls(lambda: warnings.warn("deprecated", category, stacklevel=2))


@pytest.mark.parametrize(
    "name", ["udec_ia", "udec_ia.running.run_cycles", "offsets", "naive.shape", __name__, "bench"]
)
def test_a_warning_of_ours_is_an_error(name: str) -> None:
    for category in (DeprecationWarning, UserWarning, RuntimeWarning):
        with pytest.raises(category):
            warn(name, category)


@pytest.mark.parametrize("name", ["matplotlib.fontconfig", "benchmark", "numba.core"])
def test_a_warning_of_others_is_none(name: str) -> None:
    with warnings.catch_warnings(record=True) as seen:
        warn(name, DeprecationWarning)
    assert [warning.category for warning in seen] == [DeprecationWarning]


def test_a_compiler_that_names_a_file_of_ours_is_heard() -> None:
    with pytest.raises(UserWarning):
        warnings.warn_explicit("slow", UserWarning, "/home/user/udec_ia/kernels/contact/ford.py", 1)
    with pytest.raises(ResourceWarning):
        warn("gc", ResourceWarning)
