"""Constitutive laws that come with the program, each in a file such as users write.

Such a file is plain Python and defines any of cl2 ... cl5, for the stress in zones and blocks, and of
clj2 ... clj5, for the forces in contacts: the laws of constitutive numbers 2 to 5 (Appendix IV-4).

    def cl2(s11, s12, s22, de11, de12, de22, m): return ds11, ds12, ds22
    def clj2(fn, fs, dun, dus, un, us, m): return dfn, dfs

docs/laws.md explains these names and gives the rules for laws.
"""
