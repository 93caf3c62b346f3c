"""What Python and notebooks show of a model: one line, and a page with facts, what is missing, and a picture.

Both only read. The line needs nothing but counts of the common block. The page reads lists that are tested
as they are followed, so that a damaged model is shown as far as it can be. What follows links without a
test, as CYCLE does, is left out if the checker finds that links are broken.
"""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Iterator
from html import escape
from typing import Any

import numpy as np

from udec_ia.advice.input_warnings import check_damping, check_input
from udec_ia.advice.water_report import check_apertures
from udec_ia.checker import check_links, in_short
from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.errors import MESSAGES, UdecError, spoilt
from udec_ia.kernels.constitutive.joint_properties import joints_of_materials
from udec_ia.kernels.drive.unbalanced_force import unbalanced_force
from udec_ia.layout import offsets as g
from udec_ia.model.model_session import Session
from udec_ia.ops.common.kernel_arguments import soft_or_loaded_in
from udec_ia.ops.common.number_limits import NMAT
from udec_ia.printable_text import counted, printable
from udec_ia.reader.group_tables import table

UNBALANCED_FORCE = InterpretWhenSmall(unbalanced_force, 1e4)
TYPES = {g.MRIG: "rigid", g.MSDEF: "simply-deformable", g.MFDEF: "fully-deformable"}
PAGE_SIZE = 4.0, 3.0  # inches that the blocks may fill
PAGE_DPI = 80
CELL = "text-align:left;vertical-align:top"
LISTED = {
    "bound": (g.IBNPNT, "boundary conditions"),
    "bolt": (g.IBTPNT, "bolts"),
    "element": (g.IELPNT, "elements of cables and beams"),
    "fracture": (g.IFRPNT, "cracks"),
}
Fact = tuple[str, str]


def one_line(session: Session) -> str:
    """The model in one line, from counts of the common block."""
    h = session.array.h
    soft = f" ({h.ci[g.NSOFT]} deformable)" if h.ci[g.NSOFT] else ""
    return (
        f"<Model {printable(session.name)!r}, {session.array.scheme.name}: "
        f"{counted(int(h.ci[g.NBLK]), 'block')}{soft}, {counted(int(h.ci[g.NCON]), 'contact')}, "
        f"cycle {h.ci[g.MCTOT]}, t = {h.cd[g.TIME]:.4g} s>"
    )


def page(session: Session) -> str:
    """The model as HTML. A part that cannot be made says why."""
    shown = _Shown(session)
    parts = [f"<p><code>{escape(one_line(session))}</code></p>"]
    for part in (shown.facts_in_html, shown.needs_in_html, shown.remarks_in_html, shown.picture_in_html):
        try:
            with np.errstate(all="ignore"):
                parts.append(part())
        except Exception as error:  # whatever a damaged array leads to
            parts.append(f"<p>{escape(_not_shown(error))}</p>")
    return f"<div>{''.join(parts)}</div>"


def facts(session: Session) -> str:
    """The same as text: facts, what is missing, and remarks. A part that cannot be made says why."""
    shown, lines = _Shown(session), [one_line(session)]
    parts: dict[str, Callable[[], list[str]]] = {
        "": lambda: [": ".join(one) for one in shown.facts()],
        "before it can run:": lambda: [what for what, _ in shown.needs()],
        "remarks:": lambda: [*shown.remarks()],
    }
    for title, part in parts.items():
        try:
            with np.errstate(all="ignore"):
                found = part()
        except Exception as error:  # whatever a damaged array leads to
            found = [_not_shown(error)]
        lines += [title] * bool(title and found) + [f"    {one}" for one in found]
    return "\n".join(lines)


def _not_shown(error: Exception) -> str:
    """Why a part cannot be made, on one line."""
    why = str(error).partition("\n")[0]
    return printable(f"not shown: {why}", 300)


def _in_list(title: str, lines: list[str]) -> str:
    """Lines under a title, or nothing."""
    items = "".join(f"<li>{escape(line)}</li>" for line in lines)
    return f"<p>{title}</p><ul>{items}</ul>" if lines else ""


def _numbers_in_words(numbers: Any) -> str:
    return ", ".join(map(str, np.unique(numbers).tolist()))


def _missing_properties(h: Any, blocks: Any, springs: Any) -> Iterator[Fact]:
    """Density, stiffness and moduli that materials in use lack, and the call that gives them.

    springs: materials that contacts have stiffnesses of.
    """
    for m in np.unique(blocks["KMAT"]).tolist():
        mine, modulus = blocks[blocks["KMAT"] == m], h.cr[g.ALAM1 + m - 1]
        if not h.cr[g.DENS + m - 1] > 0 and (mine["KBM"] == 0).any():
            yield f"material {m} has no density", f"property({m}, density=...) in kg/m3"
        if not modulus > 0 and (mine["HEAD"] != g.MRIG).any():
            yield f"material {m} of deformable blocks has no moduli", f"property({m}, bulk=..., g=...) in Pa"
    for m in np.unique(springs).tolist():
        joint, modulus = joints_of_materials(h, m), h.cr[g.ALAM1 + m - 1]
        lacks = [name for name, value in (("KN", joint.kn), ("KS", joint.ks)) if not value > 0]
        if lacks and (len(lacks) == 1 or not modulus > 0):  # else they follow from moduli
            call = ", ".join(f"{name.lower()}=..." for name in lacks)
            yield f"material {m} has no {' and '.join(lacks)}", f"property({m}, {call}) in N/m2"


class _Shown:
    """The parts of a page. Each table is made once."""

    def __init__(self, session: Session) -> None:
        self.session, self.array, self.h = session, session.array, session.array.h
        self.broken = check_links(session.array)
        self._tables: dict[str, Any] = {}

    def table(self, kind: str) -> Any:
        """The table of a kind."""
        if kind not in self._tables:
            self._tables[kind] = table(self.array, kind)
        return self._tables[kind]

    # ---- facts

    def facts_in_html(self) -> str:
        """Names and values of what is in the model."""
        rows = "".join(
            f'<tr><th style="{CELL}">{escape(name)}</th><td style="{CELL}">{escape(value)}</td></tr>'
            for name, value in self.facts()
        )
        return f"<table>{rows}</table>"

    def facts(self) -> Iterator[Fact]:
        """Names and values."""
        h, blocks, contacts = self.h, self.table("block"), self.table("contact")
        yield "blocks", self._blocks_in_words(blocks)
        virtual = int((contacts["KCCOD"] == g.VIRTUAL).sum())
        more = f", {virtual} of them virtual" if virtual else ""
        yield "contacts", f"{len(contacts)}{more}"
        if len(blocks):
            yield "materials", _numbers_in_words(blocks["KMAT"])
        if h.ci[g.LJOINT]:
            joints = self.table("joint")["KCJMAT"]
            yield "joint materials", _numbers_in_words(joints[joints > 0]) or "no contact has one"
        for kind, (head, name) in LISTED.items():
            if h.ci[head]:
                yield name, f"{len(self.table(kind))}"
        if h.ci[g.LWATER]:
            pressed = int((self.table("domain")["KPP"] != 0).sum())
            yield "water", f"with pressure in {counted(pressed, 'domain')}"
        step = f", in steps of {h.cr[g.TDEL]:.4g} s" if h.ci[g.MCTOT] else ""
        yield "time", f"{h.cd[g.TIME]:.4g} s after {counted(int(h.ci[g.MCTOT]), 'cycle')}{step}"
        if h.ci[g.MCTOT] and not self.broken:
            force = UNBALANCED_FORCE(len(blocks) + len(contacts), h, soft_or_loaded_in(h))[0]
            yield "largest unbalanced force", f"{float(force):.4g} N/m"

    def _blocks_in_words(self, blocks: Any) -> str:
        """Number of blocks by type, zones, and blocks that are fixed."""
        counts = {name: int((blocks["HEAD"] == code).sum()) for code, name in TYPES.items()}
        types = [f"{many} {name}" for name, many in counts.items() if many]
        zones = len(self.table("zone")) if self.h.ci[g.NSOFT] else 0
        if zones:
            types[-1] += f" with {counted(zones, 'zone')}"
        if fixed := int((blocks["KBFIX"] == g.FIXED).sum()):
            types.append(f"{fixed} fixed")
        return f"{len(blocks)}" + (f": {', '.join(types)}" if types else "")

    # ---- what is missing

    def needs_in_html(self) -> str:
        """What CYCLE would refuse, each with the command that provides it."""
        return _in_list("Before it can run:", [": ".join(one) for one in self.needs()])

    def needs(self) -> Iterator[Fact]:
        """What CYCLE would refuse, and what to call in Python."""
        h, blocks = self.h, self.table("block")
        if h.ci[g.NSPOIL] in MESSAGES:
            yield spoilt(int(h.ci[g.NSPOIL]), int(h.ci[g.MCSPOI])), "go back to a state before that"
        if self.broken:
            yield f"the array is damaged, {in_short(self.broken)}", "check() lists all that is wrong"
        if not len(blocks):
            yield "there is no block", "block(x1, y1, x2, y2, ...)"
            return
        yield from _missing_properties(h, blocks, self._materials_of_springs(blocks))
        empty = int((self.table("fdef")["KFZ"] == 0).sum()) if h.ci[g.NSOFT] else 0
        if empty:
            verb, what = "has" if empty == 1 else "have", counted(empty, "fully-deformable block")
            yield f"{what} {verb} no zones", "generate(x1, x2, y1, y2, edge=...)"
        own_laws = (h.ci[g.JMLAW : g.JMLAW + NMAT] >= g.JOINT_LAW2).any()
        if not self.broken and (own_laws or (blocks["KCONS"] != 1).any()):
            try:
                self.session.laws.bind(self.array)
            except UdecError as error:
                yield error.detail, "Model(constitutive=...)"

    def _materials_of_springs(self, blocks: Any) -> Any:
        """Materials that contacts have their stiffnesses of, those without a joint material.

        Without any contact the time-step follows from the first block, unless a joint material is defined.
        """
        contacts = self.table("contact")
        if self.h.ci[g.LJOINT] and len(contacts):
            return contacts["KCM"][(self.table("joint")["KCJMAT"] <= 0) & (contacts["KCCOD"] != g.VIRTUAL)]
        if len(contacts) or self.h.cr[g.JMKN : g.JMKN + NMAT].any():
            return contacts["KCM"]
        return blocks["KMAT"][:1]

    def remarks_in_html(self) -> str:
        """What does not stop a run: nothing loads the blocks, no damping, suspicious input."""
        return _in_list("Remarks:", list(self.remarks()))

    def remarks(self) -> Iterator[str]:
        """What may be an oversight."""
        array, h, blocks = self.array, self.h, self.table("block")
        if not len(blocks) or self.broken:
            return
        moves = any(blocks[name].any() for name in ("KXD", "KYD", "KTD"))
        loads = [h.cr[g.GRAVX], h.cr[g.GRAVY], h.ci[g.IBNPNT], h.ci[g.IOUPNT], h.ci[g.LWATER]]
        if not moves and not any(loads) and not self.table("contact")["KCFN"].any():
            yield "nothing loads the blocks: no gravity, no boundary condition, no stress"
        yield from check_damping(array)
        yield from check_input(array, self.session.laws.block_laws)
        yield from check_apertures(array)

    # ---- the picture

    def picture_in_html(self) -> str:
        """The blocks as a PNG, in the colours of their materials, fixed ones hatched."""
        if not len(self.table("block")):
            return ""
        from udec_ia.output.block_drawing import draw_still_blocks, limits, load_matplotlib, paper
        from udec_ia.output.drawn_outlines import State, outlines

        load_matplotlib()
        blocks = outlines(self.h)
        box = limits([State(0, 0.0, blocks)])
        inches = min(PAGE_SIZE[0] / (box[1] - box[0]), PAGE_SIZE[1] / (box[3] - box[2]))
        figure, axes = paper(box, inches)
        draw_still_blocks(axes, blocks, np.ones(len(blocks.address), bool), inches)
        image = io.BytesIO()
        figure.savefig(image, format="png", dpi=PAGE_DPI)
        content = base64.b64encode(image.getvalue()).decode()
        return f'<img alt="the blocks" src="data:image/png;base64,{content}">'
