"""Problems with exact or published answers, run and judged: `udec verify`.

The problems are files of plain Python, in examples/verify of the checkout and in the folder `problems` here
when the program is installed. One such file has

    a docstring   its title; the problem, its formula and why the tolerance is what it is; its source
    BLOCKS        the types of blocks that it makes sense for: "rigid", "sdef", "fdef"
    REALS         64, if what it measures is lost in reals of 32 bits; it may be left out
    solve(case)   builds and runs models, and yields an Answer for each number that is known

A file of one's own is run by its path: `udec verify mine.py`.

case.py      what a problem is given: word scheme, type of blocks, paper to draw on
answer.py    a computed number beside the exact one, with a tolerance that is the sum of named parts
scenes.py, grids.py, measure.py    what problems share: to build, to mesh, to measure
catalogue.py, run.py, page.py      the files, their runs, and the page that is written of them
"""

from udec_ia.verify.answer import Answer
from udec_ia.verify.case import Case

__all__ = ["Answer", "Case"]
