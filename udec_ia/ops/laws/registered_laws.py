"""The laws of a model: those of its user, and the names of those that its restart file was made with."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from udec_ia.compiling.interpreted_kernels import mode
from udec_ia.compiling.law_calls import FIRST, LAST, Laws
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, iget
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.block_laws import AT_JOINTS, IN_BLOCKS, numbers_in_use
from udec_ia.kernels.constitutive.joint_properties import material_of
from udec_ia.kernels.links.longer_groups import joint_at
from udec_ia.layout import offsets as g
from udec_ia.layout.material import ARRAYS, JOINT_ARRAYS, JointMaterial, Material
from udec_ia.ops.common.kernel_arguments import soft
from udec_ia.ops.common.number_limits import NCONS, NMAT
from udec_ia.ops.laws.law_file import NUMBERS, RESULTS, Given, read_laws
from udec_ia.printable_text import printable

Record = dict[str, tuple[str, str]]  # name of a law: name of its file, SHA-256 of the text of the file


class Bound(NamedTuple):
    """The laws in the form for kernels.

    blocks: None if all blocks are rigid. joints: None if no contact has a law of its own
    (kernels.constitutive.joint_laws) or a joint material. own_blocks: True if a deformable block follows a
    user's law.
    """

    blocks: Laws | None
    joints: Laws | None
    book: LawBook
    own_blocks: bool


class LawBook:
    """The laws of one model, by name. recorded: those of the restart file that the model comes from."""

    def __init__(self, given: Given | Iterable[Given] | None = None) -> None:
        single = given is None or isinstance(given, str | Path | Mapping)
        self._sources: Any = given if single else list(given)  # type: ignore[arg-type]
        self.given = read_laws(self._sources)
        self.recorded: Record = {}
        self._calls = np.zeros(len(RESULTS), np.int64)
        self._materials = np.zeros((NMAT, len(ARRAYS)))
        self._joint_materials = np.zeros((NMAT, len(JOINT_ARRAYS)))

    def __getstate__(self) -> tuple[Any, ...]:
        """For pickle: the sources of the laws, as their machine code belongs to this process."""
        return self._sources, self.recorded, self.record()

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        sources, recorded, record = state
        self.__init__(sources)  # type: ignore[misc]
        if self.note(record):
            detail = "a file of laws has changed since the model was pickled"
            raise UdecError(34, detail, "use the former file")
        self.recorded = recorded

    def __deepcopy__(self, _: Any) -> LawBook:
        other = LawBook()
        other.given, other._sources, other.recorded = self.given, self._sources, dict(self.recorded)
        return other

    @property
    def block_laws(self) -> list[int]:
        """Constitutive numbers for which a block law is given."""
        return [n for n in NUMBERS if f"cl{n}" in self.given]

    def record(self) -> Record:
        """The laws for a restart file."""
        return self.recorded | {name: (law.origin, law.digest) for name, law in self.given.items()}

    def note(self, recorded: Mapping[str, tuple[str, str]]) -> list[str]:
        """Store the laws of a restart file. Returns a warning for each that has changed since."""
        self.recorded = dict(recorded)
        return [
            f"{name} of {self.given[name].origin} differs from {name} of {printable(origin)}, "
            "which the restart file was made with"
            for name, (origin, digest) in recorded.items()
            if name in self.given and self.given[name].digest != digest
        ]

    def bind(self, array: MainArray) -> Bound:
        """The laws and materials for a CYCLE of the model in `array`; see `pack`.

        Error 9 if a constitutive number in use has no law, or not the law of the restart file.
        """
        user = np.zeros((2, NCONS + 1), np.int64)
        numbers_in_use(array.h, user)
        wanted = [
            (f"{law}{n}", n, int(user[where, n]))
            for where, law in ((AT_JOINTS, "clj"), (IN_BLOCKS, "cl"))
            for n in NUMBERS
            if user[where, n]
        ]
        # laws of the restart file first: their error names the file that is missing
        for law, n, group in sorted(wanted, key=lambda one: one[0] not in self.recorded):
            who = f"{'contact' if iget(array.h, group, HEAD) == g.MCON else 'block'}@{group}"
            self._demand(law, {f"cl{n}", f"clj{n}"}, who, f"number {n}", group)
        for i, code in enumerate(array.h.ci[g.JMLAW : g.JMLAW + NMAT].tolist()):
            if code >= g.JOINT_LAW2:
                law = joint_law(code)
                self._demand(law, {law}, f"joint material {i + 1}", f"model {law.upper()}", 0)
        laws = self.pack(array)
        own = [n for n in range(FIRST, NCONS + 1) if n > LAST or f"clj{n}" in self.given]
        followed = user[AT_JOINTS, own].any() or array.h.ci[g.LJOINT]
        for one in self.given.values():
            one.failed_at[:] = np.nan
        own_blocks = any(user[IN_BLOCKS, n] for n in self.block_laws)
        return Bound(laws if soft(array.h) else None, laws if followed else None, self, own_blocks)

    def pack(self, array: MainArray) -> Laws:
        """The laws with the present materials of `array`, for kernels; valid until the next call."""
        rows, joint_rows = _materials(array, ARRAYS), _joint_materials(array)
        given = [self.given.get(name) for name in RESULTS]
        if mode.python:
            calls = tuple(law.python if law else 0 for law in given)
            return Laws(calls, [Material(*row) for row in rows], [JointMaterial(*row) for row in joint_rows])
        self._calls[:], self._materials[:] = [law.address if law else 0 for law in given], rows
        self._joint_materials[:] = joint_rows
        return Laws(*(one.ctypes.data for one in (self._calls, self._materials, self._joint_materials)))

    def _demand(self, law: str, instead: set[str], who: str, choice: str, group: int) -> None:
        """Error 9 if `law`, which `who` follows by its `choice`, is missing.

        instead: laws of which one is enough. group: address of the block or contact, 0 for others.
        """
        if law in self.given:
            return
        if law in self.recorded:
            origin = self.recorded[law][0]
            detail = f"{who} follows {law} of {origin}, which is not given"
            raise UdecError(9, detail, f"give it again: --constitutive {origin}", group=group)
        if not instead & self.given.keys():
            detail = f"{who} has {choice}, for which there is no law"
            advice = f"use another one, or give a file with a function {law}: --constitutive law.py"
            raise UdecError(9, detail, advice, group=group)

    def failure(self, array: MainArray, group: int) -> UdecError:
        """Error 35 for the law of block or contact `group`."""
        h, name, rows = array.h, "material", _materials(array, ARRAYS)
        kind: type[Material] | type[JointMaterial] = Material
        if iget(h, group, HEAD) != g.MCON:
            who, law, m = f"block@{group}", f"cl{iget(h, group, g.KCONS)}", iget(h, group, g.KMAT)
        elif ix := joint_at(h, group):
            rows, kind, name = _joint_materials(array), JointMaterial, "joint material"
            m = iget(h, ix, g.KCJMAT)
            who, law = f"contact@{group}", joint_law(int(h.ci[g.JMLAW + m - 1]))
        else:
            who, law, m = f"contact@{group}", f"clj{iget(h, group, g.KCC)}", material_of(h, group)
        detail = f"{law}, for {who} of {name} {m} in cycle {int(h.ci[g.MCTOT])}"
        if law not in self.given:  # a law of the program
            return UdecError(35, detail, f"check the properties of {name} {m}", group=group)
        raised, advice = self.given[law].raised(kind(*rows[m - 1]))
        return UdecError(35, detail + raised, advice, group=group)


def joint_law(code: int) -> str:
    """Name of the function of joint model `code`, JOINT_LAW2 ... JOINT_LAW5."""
    return f"jl{code - g.JOINT_LAW2 + FIRST}"


def _joint_materials(array: MainArray) -> NDArray[np.float64]:
    """The fields of JointMaterial, one row for each number; residual strength not given is the peak one."""
    rows = _materials(array, JOINT_ARRAYS)
    for residual, peak in (("residual_friction", "friction"), ("residual_cohesion", "cohesion")):
        at, of = (JointMaterial._fields.index(name) for name in (residual, peak))
        rows[:, at] = np.where(rows[:, at] < 0, rows[:, of], rows[:, at])
    return rows


def _materials(array: MainArray, arrays: tuple[int, ...]) -> NDArray[np.float64]:
    """The fields of Material or JointMaterial, by `arrays` of the common block, one row for each number."""
    return np.asarray(array.h.cr[np.add.outer(np.arange(NMAT), arrays)], np.float64)
