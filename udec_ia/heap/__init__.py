"""The heap: IA(), FIND and LOSE, and the accessors.

Kernels read and write groups by the accessors alone. Tables and proofs also index the array itself.
"""
