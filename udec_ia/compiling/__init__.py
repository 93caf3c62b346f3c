"""Compilation of kernels by numba. All that relies on the inner parts of numba is in this package."""
