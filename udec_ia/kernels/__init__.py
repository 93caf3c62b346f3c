"""The compiled routines: lists, geometry, topology and the passes of the calculation cycle.

One source serves all five word schemes and also runs interpreted (NUMBA_DISABLE_JIT=1). Kernels do no
I/O; an error is left in the common block (NERR, IERAD) for the caller to raise.

A folder imports from those before it only: links, geometry, audit, constitutive, map, body, structures,
detect, energy, contact, water, split, crack, drive. The kernels in audit take arrays instead of the memory,
for the checker.
"""
