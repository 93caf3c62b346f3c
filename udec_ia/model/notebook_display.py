"""What Python and notebooks show of a model: one line, and a page with facts, what is missing, and a picture.

Both only read. The line needs nothing but counts of the common block. The page reads lists that are tested
as they are followed, so that a damaged model is shown as far as it can be. What follows links without a
test, as CYCLE does, is left out while the state is not proved sound.
"""

from __future__ import annotations

import base64
import io
from collections.abc import Iterator
from html import escape
from typing import Any

import numpy as np

from udec_ia.advice.input_warnings import check_damping, check_input
from udec_ia.advice.water_report import check_apertures
from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.errors import MESSAGES, spoilt
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.unbalanced_force import unbalanced_force
from udec_ia.layout import offsets as g
from udec_ia.model.model_session import Session
from udec_ia.ops.common.kernel_arguments import soft_or_loaded_in
from udec_ia.printable_text import counted, printable
from udec_ia.reader.group_tables import table

FORCE = InterpretWhenSmall(unbalanced_force, 1e4)
TYPES = {g.MRIG: "rigid", g.MSDEF: "simply-deformable", g.MFDEF: "fully-deformable"}
FIT = 4.0, 3.0  # inches that the blocks may fill
DPI = 80
CELL = "text-align:left;vertical-align:top"
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
    parts = [f"<p><code>{escape(one_line(session))}</code></p>"]
    for part in (_facts_in_html, _needs_in_html, _remarks_in_html, _picture_in_html):
        try:
            with np.errstate(all="ignore"):
                parts.append(part(session))
        except Exception as error:  # whatever a damaged array leads to
            why = str(error).partition("\n")[0]
            parts.append(f"<p>{escape(printable(f'not shown: {why}', 300))}</p>")
    return f"<div>{''.join(parts)}</div>"


def _is_proved(session: Session) -> bool:
    """True if commands would follow the links of the array without a proof."""
    return not (session.written or session.unproved or session.writes.pending)


def _in_list(title: str, lines: list[str]) -> str:
    """Lines under a title, or nothing."""
    items = "".join(f"<li>{escape(line)}</li>" for line in lines)
    return f"<p>{title}</p><ul>{items}</ul>" if lines else ""


# ---- facts


def _facts_in_html(session: Session) -> str:
    rows = "".join(
        f'<tr><th style="{CELL}">{escape(name)}</th><td style="{CELL}">{escape(value)}</td></tr>'
        for name, value in _facts(session)
    )
    return f"<table>{rows}</table>"


def _facts(session: Session) -> Iterator[Fact]:
    """Names and values of what is in the model."""
    array, h = session.array, session.array.h
    blocks, contacts = table(array, "block"), table(array, "contact")
    yield "blocks", _blocks_in_words(array, blocks)
    virtual = int((contacts["KCCOD"] == g.VIRTUAL).sum())
    more = f", {virtual} of them virtual" if virtual else ""
    yield "contacts", f"{len(contacts)}{more}"
    if len(blocks):
        yield "materials", _numbers_in_words(blocks["KMAT"])
    if h.ci[g.LJOINT]:
        joints = table(array, "joint")["KCJMAT"]
        yield "joint materials", _numbers_in_words(joints[joints > 0]) or "no contact has one"
    for kind, name in (("bound", "boundary conditions"), ("bolt", "bolts"), ("fracture", "cracks")):
        if many := len(table(array, kind)):
            yield name, f"{many}"
    if many := len(table(array, "element")):
        yield "elements of cables and beams", f"{many}"
    if h.ci[g.LWATER]:
        pressed = int((table(array, "domain")["KPP"] != 0).sum())
        yield "water", f"with pressure in {counted(pressed, 'domain')}"
    step = f", in steps of {h.cr[g.TDEL]:.4g} s" if h.ci[g.MCTOT] else ""
    yield "time", f"{h.cd[g.TIME]:.4g} s after {counted(int(h.ci[g.MCTOT]), 'cycle')}{step}"
    if h.ci[g.MCTOT] and _is_proved(session):
        force = FORCE(len(blocks) + len(contacts), h, soft_or_loaded_in(h))[0]
        yield "largest unbalanced force", f"{float(force):.4g} N/m"


def _blocks_in_words(array: MainArray, blocks: Any) -> str:
    """Number of blocks by type, zones, and blocks that are fixed."""
    counts = {name: int((blocks["HEAD"] == code).sum()) for code, name in TYPES.items()}
    types = [f"{many} {name}" for name, many in counts.items() if many]
    zones = len(table(array, "zone"))
    if zones:
        types[-1] += f" with {counted(zones, 'zone')}"
    if fixed := int((blocks["KBFIX"] == g.FIXED).sum()):
        types.append(f"{fixed} fixed")
    return f"{len(blocks)}" + (f": {', '.join(types)}" if types else "")


def _numbers_in_words(numbers: Any) -> str:
    return ", ".join(map(str, np.unique(numbers).tolist()))


# ---- what is missing


def _needs_in_html(session: Session) -> str:
    return _in_list("Before it can run:", list(_needs(session)))


def _needs(session: Session) -> Iterator[str]:
    """What CYCLE would refuse, each with the command that provides it."""
    array, h = session.array, session.array.h
    if h.ci[g.NSPOIL] in MESSAGES:
        yield f"{spoilt(int(h.ci[g.NSPOIL]), int(h.ci[g.MCSPOI]))}: go back to a state before that"
    if not _is_proved(session):
        yield "words were written, or a file was not proved: the next command proves the state"
    blocks = table(array, "block")
    if not len(blocks):
        yield "there is no block: block(x1, y1, x2, y2, ...)"
        return
    yield from _missing_properties(h, blocks, table(array, "contact"))
    empty = int((table(array, "fdef")["KFZ"] == 0).sum())
    if empty:
        verb = "has" if empty == 1 else "have"
        what = counted(empty, "fully-deformable block")
        yield f"{what} {verb} no zones: generate(x1, x2, y1, y2, edge=...)"
    for n in np.setdiff1d(blocks["KCONS"], [1]).tolist():
        if not {f"cl{n}", f"clj{n}"} & {*session.laws.given}:
            yield f"constitutive number {n} has no law: Model(constitutive=...)"


def _missing_properties(h: Any, blocks: Any, contacts: Any) -> Iterator[str]:
    """Density, stiffness and moduli that materials in use lack."""
    for m in np.unique(blocks["KMAT"]).tolist():
        mine, modulus = blocks[blocks["KMAT"] == m], h.cr[g.ALAM1 + m - 1]
        if not h.cr[g.DENS + m - 1] > 0 and (mine["KBM"] == 0).any():
            yield f"material {m} has no density: property({m}, density=...) in kg/m3"
        if not modulus > 0 and (mine["HEAD"] != g.MRIG).any():
            yield f"material {m} of deformable blocks has no moduli: property({m}, bulk=..., g=...) in Pa"
    if h.ci[g.LJOINT]:  # a joint material has its stiffnesses
        return
    for m in np.unique([*contacts["KCM"], blocks["KMAT"][0]]).tolist():
        kn, ks, modulus = (h.cr[k + m - 1] for k in (g.AKN, g.AKS, g.ALAM1))
        if not min(kn, ks) > 0 and (max(kn, ks) > 0 or not modulus > 0):  # else they follow from moduli
            yield f"material {m} has no KN and KS: property({m}, kn=..., ks=...) in N/m2"


def _remarks_in_html(session: Session) -> str:
    return _in_list("CYCLE or SOLVE would remark:", list(_remarks(session)))


def _remarks(session: Session) -> Iterator[str]:
    """What does not stop a run: nothing that moves or loads the blocks, no damping, suspicious input."""
    array, h = session.array, session.array.h
    if not h.ci[g.NBLK] or not _is_proved(session):
        return
    blocks = table(array, "block")
    moves = any(blocks[name].any() for name in ("KXD", "KYD", "KTD"))
    loads = [h.cr[g.GRAVX], h.cr[g.GRAVY], h.ci[g.IBNPNT], h.ci[g.IOUPNT], h.ci[g.LWATER]]
    if not moves and not any(loads) and not table(array, "contact")["KCFN"].any():
        yield "nothing loads the blocks: gravity(gx, gy), boundary(...) or insitu(...)"
    yield from check_damping(array)
    yield from check_input(array, session.laws.block_laws)
    yield from check_apertures(array)


# ---- the picture


def _picture_in_html(session: Session) -> str:
    image = base64.b64encode(_picture(session.array)).decode() if session.array.h.ci[g.NBLK] else ""
    return f'<img alt="the blocks" src="data:image/png;base64,{image}">' if image else ""


def _picture(array: MainArray) -> bytes:
    """The blocks as a PNG, in the colours of their materials, fixed ones hatched."""
    from udec_ia.output.block_drawing import draw_still_blocks, limits, paper
    from udec_ia.output.drawn_outlines import State

    state = State(int(array.h.ci[g.MCTOT]), float(array.h.cd[g.TIME]), _outlines(array))
    box = limits([state])
    inches = min(FIT[0] / (box[1] - box[0]), FIT[1] / (box[3] - box[2]))
    figure, axes = paper(box, inches)
    draw_still_blocks(axes, state.outlines, np.ones(len(state.outlines.address), bool), inches)
    image = io.BytesIO()
    figure.savefig(image, format="png", dpi=DPI)
    return image.getvalue()


def _outlines(array: MainArray) -> Any:
    """The outlines of all blocks, from tables: of 50,000 blocks in a second."""
    from udec_ia.output.drawn_outlines import Outlines

    blocks, corners = table(array, "block"), table(array, "corner")
    owners = np.flatnonzero(np.diff(corners["KNB"], prepend=0))

    def place(rows: Any, x: str, y: str) -> Any:
        return np.stack([rows[x], rows[y]], axis=-1).astype(np.float64)

    return Outlines(
        corner=place(corners, "KXP", "KYP"),
        centre=place(corners, "KXCP", "KYCP"),
        radius=corners["KRAD"].astype(np.float64),
        rounding=float(array.h.cr[g.DTOL]),
        corner_address=corners["address"],
        first=np.append(owners, len(corners)),
        centroid=place(blocks, "KX", "KY"),
        fixed=blocks["KBFIX"] != 0,
        material=blocks["KMAT"],
        address=blocks["address"],
        kind=blocks["HEAD"],
    )
