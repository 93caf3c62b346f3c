"""Lines in the words of UDEC 7: what they are in ours, or why there is no such command here.

A line that is none of ours is compared with the patterns below, in order. What has one meaning here is read
as one line or several of ours, which are shown; the others are answered. docs/from-udec-7.md has the table.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from typing import NamedTuple

from udec_ia.deck.deck_statements import Token

N = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[ed][-+]?\d+)?"  # a number, in lower case
RANGE = r"(?: range (?P<range>.+))?"
OF_BLOCK = re.compile(r"^(HISTORY \d+ K[XY]D?) AT")  # a history of which a grid-point has the same, as KYG
Match = re.Match[str]


class Reading(NamedTuple):
    """What a line is in our words: lines, none if it is not needed here; and a remark on it, or ""."""

    lines: tuple[str, ...]
    remark: str = ""


class Answer(NamedTuple):
    """Why a line is not understood, and what to do."""

    text: str


def read_line(tokens: Iterable[Token], has_zones: Callable[[], bool]) -> Reading | Answer | None:
    """What the line with these words is; None if it is unknown.

    has_zones: whether there are blocks with zones, so that a history of a place is that of a grid-point.
    """
    words = list(tokens)
    text = " ".join(token.text for token in words).lower()
    for pattern, make in PATTERNS:
        found = pattern.fullmatch(text)
        reading = make(found, words[0].line.text) if found is not None else None
        if isinstance(reading, Reading) and any(OF_BLOCK.match(line) for line in reading.lines):
            of_point = r"\1G AT" if has_zones() else r"\1 AT"
            return reading._replace(lines=tuple(OF_BLOCK.sub(of_point, line) for line in reading.lines))
        if reading is not None:
            return reading
    return None


Make = Callable[[Match, str], Reading | Answer | None]


def _put(*templates: str, remark: str = "") -> Make:
    """Lines of ours with the named groups of the pattern in their places."""

    def make(found: Match, _: str) -> Reading:
        groups = {name: (value or "").upper() for name, value in found.groupdict().items()}
        where = groups.get("range", "")
        groups["within"] = f" RANGE {_range(where)}" if where else " RANGE ALL"
        groups["in_range"] = f" RANGE {_range(where)}" if where else ""
        groups["range_first"] = _range(where) or "ALL"
        groups["outside"] = f" RANGE {_range(where)}" if where else " RANGE OUTSIDE"
        return Reading(tuple(template.format(**groups) for template in templates), remark)

    return make


def _range(words: str) -> str:
    """A range in our words: its materials have their full names."""
    return re.sub(r"\bMAT\b", "MATERIAL", re.sub(r"\bJMAT\b", "JMATERIAL", words))


def _behind(where: str | None) -> str:
    """RANGE and a range behind other words; "" without one."""
    return f" RANGE {_range(where.upper())}" if where else ""


def _say(text: str) -> Make:
    return lambda found, line: Answer(text)


def _file(ours: str, theirs: str) -> Make:
    """A command of ours with the name of a file, which stands behind the words `theirs`."""
    begin = re.compile(r"\s*" + theirs.replace(" ", r"\s+") + r"\s+", re.IGNORECASE)
    return lambda found, line: Reading((f"{ours} {begin.sub('', line, count=1).strip()}",))


def _ignore(remark: str) -> Make:
    return lambda found, line: Reading((), remark)


def _pairs(text: str) -> list[tuple[str, str]]:
    """Words that are followed by numbers: name, number. An empty list if there is anything else."""
    whole = re.fullmatch(rf"[a-z_]+ {N}(?: [a-z_]+ {N})*", text.strip())
    return re.findall(rf"([a-z_]+) ({N})", text) if whole else []


def _value(number: str) -> float:
    """The value of a number, whose exponent may begin with d."""
    return float(number.lower().replace("d", "e"))


JOINT_NAMES = {
    **{"jkn": "KN", "kn": "KN", "jks": "KS", "ks": "KS", "jcoh": "COHESION", "jcohesion": "COHESION"},
    **{"jten": "TENSION", "jtens": "TENSION", "jtension": "TENSION", "f": "FRICTION"},
}
ANGLES = {
    **{"jf": "FRICTION", "jfric": "FRICTION", "jfriction": "FRICTION"},
    **{"jdil": "DILATION", "jdilation": "DILATION"},
}  # in degrees
BLOCK_NAMES = {
    **{"d": "DENSITY", "dens": "DENSITY", "density": "DENSITY", "b": "BULK", "k": "BULK", "bulk": "BULK"},
    **{"g": "G", "shear": "G"},
}


def _joint_words(text: str) -> tuple[str, str]:
    """Words of JPROPERTY for the properties in a text, and a remark on angles; "" for an unknown word."""
    words, remarks = [], []
    for name, value in _pairs(text):
        angle = ANGLES.get(name, "")
        if angle:
            tangent = math.tan(math.radians(_value(value)))
            words.append(f"{angle}={tangent:.10g}")
            remarks.append(f"{value} degrees: {angle} is a tangent, {tangent:.6g}")
        elif name in JOINT_NAMES:
            words.append(f"{JOINT_NAMES[name]}={value.upper()}")
        else:
            return "", ""
    return " ".join(words), "; ".join(remarks)


def _joint_material(found: Match, _: str) -> Reading | None:
    words, remark = _joint_words(found["rest"])
    lines = f"JPROPERTY JMATERIAL={found['n']} {words}"
    return Reading((lines,), remark) if words else None


def _joint_default(found: Match, _: str) -> Reading | None:
    words, remark = _joint_words(found["rest"])
    return Reading((f"JPROPERTY JMATERIAL=1 {words} BETWEEN 1 1",), remark) if words else None


def _joint_model(found: Match, _: str) -> Reading | None:
    words, remark = _joint_words(found["rest"])
    where = _behind(found["range"]) or " RANGE ALL"
    lines = f"JPROPERTY JMATERIAL=1 {words} BETWEEN 1 1", f"CHANGE JMATERIAL=1{where}"
    return Reading(lines, remark) if words else None


def _block_material(found: Match, _: str) -> Reading | Answer | None:
    """PROPERTY: with BULK and G of Young's modulus and Poisson's ratio."""
    values = dict(_pairs(found["rest"]))
    words = [f"{BLOCK_NAMES[name]}={value.upper()}" for name, value in values.items() if name in BLOCK_NAMES]
    others = {name: value for name, value in values.items() if name not in BLOCK_NAMES}
    remark = ""
    if {*others} == {"ymod", "prat"}:
        e, nu = _value(others["ymod"]), _value(others["prat"])
        if not -1 < nu < 0.5:
            return Answer("Poisson's ratio is above -1 and below 0.5")
        words += [f"BULK={e / (3 * (1 - 2 * nu)):.10g}", f"G={e / (2 * (1 + nu)):.10g}"]
        remark = f"BULK and G of Young's modulus {e:g} Pa and Poisson's ratio {nu:g}"
    elif others:
        return None
    material = found.groupdict().get("n") or "1"
    return Reading((f"PROPERTY MATERIAL={material} {' '.join(words)}",), remark) if words else None


def _change_joints(found: Match, _: str) -> Reading | Answer:
    if found["law"] not in (None, "2"):
        return Answer(
            "the joint model is that of the joint material: JPROPERTY ... YIELDING, BARTON or CONTACT"
        )
    n, where = found["n"], found["range"]
    if where:
        return Reading((f"CHANGE JMATERIAL={n} RANGE {_range(where.upper())}",))
    return Reading((f"JPROPERTY JMATERIAL={n} BETWEEN 1 1", f"CHANGE JMATERIAL={n} RANGE ALL"))


FIELDS = {  # of HISTORY
    **{
        "xvel": "KXD",
        "yvel": "KYD",
        "xdis": "KX",
        "ydis": "KY",
        "sxx": "KZS11",
        "sxy": "KZS12",
        "syy": "KZS22",
    },
    **{"unbal": "UNBALANCED", "pp": "KPP"},
    **{"sdis": "KCS", "ndis": "KCN", "sforce": "KCFS", "nforce": "KCFN"},
}
PLACED = "|".join(name for name in FIELDS if name != "unbal")
LONG = (("velocity", "vel"), ("displacement", "dis"), ("disp", "dis"))  # endings of names of histories


def _history(found: Match, _: str) -> Reading | None:
    every, rest = found["every"] or "10", found["rest"]
    for long, short in LONG:
        rest = re.sub(rf"{long}\b", short, rest)
    parts = re.findall(rf"({PLACED}) ({N}) ({N})|(unbal)", rest)
    if " ".join(" ".join(filter(None, part)) for part in parts) != rest:
        return None
    lines = []
    for name, x, y, alone in parts:
        place = f" AT {x.upper()},{y.upper()}" if name else ""
        lines.append(f"HISTORY {every} {FIELDS[name or alone]}{place}")
    moved = any(part[0] in ("xdis", "ydis") for part in parts)
    remark = "displacements are the changes of these coordinates" if moved else ""
    return Reading(tuple(lines), remark)


DRAWN = {"block": "", "bl": "", "vel": " VELOCITIES", "dis": " DISPLACEMENTS", "disp": " DISPLACEMENTS"}
DRAWN |= {"stress": " STRESSES", "hold": "", "cont": " CONTACTS", "pp": " PPRESSURE", "boundary": ""}
DRAWN |= {"joint": "", "shear": " SLIP", "slip": " SLIP", "open": " OPENING"}


def _plot(found: Match, _: str) -> Reading | None:
    words = found["rest"].split()
    if not all(word in DRAWN for word in words):
        return None
    n = "1" if any("DISP" in DRAWN[word] for word in words) else "0"
    return Reading(("PLOT " + n + "".join(dict.fromkeys(DRAWN[word] for word in words)),))


PARTS_OF_RESET = {
    "disp": "DISPLACEMENTS",
    "jdisp": "SLIP",
    "time": "TIME",
    "hist": "",
    "displacement": "DISPLACEMENTS",
}


def _reset(found: Match, _: str) -> Reading | None:
    words = found["rest"].split()
    if not all(word in PARTS_OF_RESET for word in words):
        return None
    ours = [PARTS_OF_RESET[word] for word in words if PARTS_OF_RESET[word]]
    remark = "histories go on" if "hist" in words else ""
    return Reading((f"RESET {' '.join(ours)}",) if ours else (), remark)


def _jset(found: Match, _: str) -> Reading:
    angle, da, trace, dt, gap, dg, spacing, ds, *origin = found["rest"].upper().split()
    words = f"ANGLE {angle} {da} TRACE {trace} {dt} GAP {gap} {dg} SPACING {spacing} {ds}"
    words += f" ORIGIN {' '.join(origin)}" if origin else ""
    where, _, material = (found["range"] or "").partition(" jmat ")
    words += _behind(where)
    words += f" JMATERIAL={found['m'] or material}" if found["m"] or material else ""
    return Reading((f"JSET {words}",))


def _crack(found: Match, _: str) -> Reading:
    """SPLIT; POLYLINE if the joint gets a material, a number or GLUED."""
    xy, words = found["xy"].upper(), ""
    if not found["words"]:
        return Reading((f"SPLIT {xy}",))
    for name, value in re.findall(r"(jmat|id|join)(?: (\d+))?", found["words"]):
        words += {"jmat": f" JMATERIAL={value}", "id": f" JOINT={value}", "join": " GLUED"}[name]
    return Reading((f"POLYLINE{words} {xy}",))


def _solve(found: Match, _: str) -> Reading:
    limit = f" LIMIT={found['n']}" if found["n"] else ""
    return Reading((f"SOLVE {found['a'] or '1E-5'}{limit}",))


def _fraction(found: Match, _: str) -> Reading:
    f = min(found["one"], found["two"], key=_value)
    return Reading((f"FRACTION {f.upper()}",), "one fraction for blocks and zones, the smaller of the two")


def _voronoi(found: Match, _: str) -> Reading:
    values = dict(_pairs(found["rest"]))
    seed = f" SEED={values['seed']}" if "seed" in values else ""
    rounding = (f"ROUND {values['round']}",) if "round" in values else ()
    remark = "the number of iterations is always eight" if "iterations" in values else ""
    return Reading((f"VORONOI EDGE={found['e']}{seed}{_behind(found['range'])}", *rounding), remark)


def _polygon(found: Match, _: str) -> Reading:
    numbers = found["rest"].upper().split()
    points = [(x, y) for x, y in zip(numbers[::2], numbers[1::2], strict=True)]
    twice = sum(
        _value(a[0]) * _value(b[1]) - _value(b[0]) * _value(a[1])
        for a, b in zip(points, points[1:] + points[:1], strict=True)
    )
    clockwise = points[::-1] if twice > 0 else points
    return Reading(("BLOCK " + " ".join(f"{x},{y}" for x, y in clockwise),))


FISH = (
    "there is no FISH: loops and functions are Python (docs/python.md); arithmetic stands in braces, {2*$A}"
)
NO_STRUCTURE = "structures are BOLT, CABLE and BEAM here, with SPROPERTY: docs/structures.md"
NOT_NEEDED = "not needed here"
TABLE: tuple[tuple[str, Make], ...] = (
    (
        r".* range (?:.* )?reg(?:ion)? .*",
        _say("RANGE POLYGON x1 y1 x2 y2 x3 y3 ... takes the place of REGION"),
    ),
    (
        r".* range (?:.* )?(?:angle|orientation) .*",
        _say("a range has no angle: give the joints of a cut a number, JSET ... JOINT=n, then RANGE JOINT n"),
    ),
    (r"(?:model )?new", _put("START")),
    (
        r"(?:model )?title\b.*|heading",
        _ignore("a title is a comment here: pictures have the name of the deck"),
    ),
    (r"config.*", _ignore("all parts of the program are there")),
    (
        rf"(?:block cut )?crack (?P<xy>{N} {N} {N} {N})(?P<words>(?: jmat \d+| id \d+| join)*)",
        _crack,
    ),
    (rf"(?:set )?edge {N}", _say("cuts refuse edges below two roundings: ROUND; GEOMETRY lists short ones")),
    (rf"block create polygon (?P<rest>{N} {N}(?: {N} {N}){{2,}})", _polygon),
    (rf"jset (?P<rest>{N}(?: {N}){{7}}(?: {N} {N})?)(?: jmat (?P<m>\d+))?{RANGE}", _jset),
    (r"block cut joint-set (?P<rest>.+)", _put("JSET {rest}")),
    (r"jregion.*", _say("JSET ... RANGE POLYGON x1 y1 x2 y2 ... ends the joints at limits")),
    (rf"vor(?:onoi)? edge (?P<e>{N})(?P<rest>(?: (?:round|seed|iterations) {N})*){RANGE}", _voronoi),
    (r"jdelete", _ignore("dead ends are dropped already, unless a cut has KEEP")),
    (r"join", _say("cut with GLUED where blocks are to be joined: POLYLINE ... GLUED")),
    (rf"gen(?:erate)? (?:edge|auto) (?P<d>{N}){RANGE}", _put("GENERATE AUTOMATIC EDGE={d}{within}")),
    (r"gen(?:erate)? quad.*", _say("GENERATE ... AUTOMATIC EDGE=d MIXED takes the place of QUAD")),
    (r"zone model (?:el|elas|elastic) (?P<rest>.+)", _block_material),
    (
        r"zone model.*",
        _say("Mohr-Coulomb blocks: --constitutive mohr-coulomb and CHANGE ... CONS (docs/laws.md)"),
    ),
    (rf"joint model area (?P<rest>[a-z_]+ {N}(?: [a-z_]+ {N})*){RANGE}", _joint_model),
    (r"set jcondf joint model area (?P<rest>.+)", _joint_default),
    (r"set jmatdf (?P<n>\d+)", _put("JPROPERTY JMATERIAL={n} BETWEEN 1 1")),
    (rf"change mat (?P<n>\d+){RANGE}", _put("CHANGE MATERIAL={n}{within}")),
    (rf"change jmat (?P<n>\d+)(?: jcons (?P<law>\d+))?{RANGE}", _change_joints),
    (rf"change jcons (?P<law>\d+) jmat (?P<n>\d+){RANGE}", _change_joints),
    (rf"change jcons 2{RANGE}", _ignore("joints of a joint material have Coulomb's law with areas")),
    (r"prop(?:erty)? jmat (?P<n>\d+) (?P<rest>.+)", _joint_material),
    (r"prop(?:erty)? mat (?P<n>\d+) (?P<rest>.+)", _block_material),
    (
        rf"insitu stress (?P<a>{N} {N} {N}(?: [xy]grad {N} {N} {N})*)(?: szz {N})?(?: zgrad {N} {N})?"
        rf"(?P<g>(?: [xy]grad {N} {N} {N})*){RANGE}",
        _put("INSITU {range_first} {a}{g}", remark="the stress out of the plane follows from the moduli"),
    ),
    (rf"insitu (?P<r>{N} {N} {N} {N}) stress (?P<a>{N} {N} {N})", _put("INSITU {r} {a}")),
    (
        rf"bound(?:ary)? stress (?P<a>{N} {N} {N}(?: [xy]grad {N} {N} {N})*){RANGE}",
        _put("BOUNDARY STRESS {a}{outside}"),
    ),
    (rf"bound(?:ary)? (?P<v>[xy])vel(?:ocity)? (?P<a>{N}){RANGE}", _put("BOUNDARY {v}VEL {a}{outside}")),
    (
        rf"bound(?:ary)? (?P<v>[xy])vel(?:ocity)? (?P<a>{N}) hist(?:ory)? table (?P<t>\d+){RANGE}",
        _put("BOUNDARY {v}VEL {a} FUNCTION {t}{outside}"),
    ),
    (
        rf"bound(?:ary)? [xy]visc{RANGE}",
        _put("BOUNDARY STRESS 0 0 0 VISCOUS{outside}", remark="it absorbs waves in both directions"),
    ),
    (rf"bound(?:ary)? pp (?P<a>{N}){RANGE}", _put("BOUNDARY PPRESSURE {a}{outside}")),
    (rf"bound(?:ary)? (?P<v>[xy])load (?P<a>{N}){RANGE}", _put("BOUNDARY {v}FORCE {a}{outside}")),
    (rf"bound(?:ary)? [xy]free{RANGE}", _say("BOUNDARY ... FREE ends the conditions in x and y")),
    (r"bound(?:ary)? mat.*", _say("viscous boundaries take the impedance from the material of the block")),
    (r"bound(?:ary)? ff.*", _say("there is no free field: BOUNDARY ... VISCOUS absorbs waves")),
    (r"apply.*", _say("loads and velocities are given by BOUNDARY")),
    (rf"(?P<c>fix|free){RANGE}", _put("{c}{within}")),
    (rf"(?:set|model) grav(?:ity)? (?P<a>{N} {N})", _put("GRAVITY {a}")),
    (r"damp(?:ing)? auto", _put("DAMPING ADAPTIVE=0.8")),
    (r"damp(?:ing)? local", _put("DAMPING LOCAL=0.8")),
    (rf"frac(?:tion)? (?P<one>{N}) (?P<two>{N})", _fraction),
    (r"(?:set )?mscale.*", _say("FRACTION f SCALED scales masses; SOLVE ... STATIC does so by itself")),
    (rf"hist(?:ory)? (?:(?:n|ncyc) (?P<every>\d+) )?(?P<rest>(?:unbal|[a-z]+ {N}).*)", _history),
    (r"hist(?:ory)? interval.*", _say("each HISTORY has its interval: HISTORY 10 KYD AT 5,20")),
    (r"reset (?P<rest>.+)", _reset),
    (r"reset vel.*", _say("DAMPING KINETIC and SOLVE ... STATIC end with velocities of 0")),
    (r"(?:block )?(?:step|cycle) (?P<n>\d+)", _put("CYCLE {n}")),
    (rf"solve(?: (?:rat|ratio) (?P<a>{N}))?(?: (?:step|cycles?) (?P<n>\d+))?", _solve),
    (r"solve fos", _put("FOS")),
    (
        r"solve fos assoc.*",
        _say("FOS; for an associated flow rule JPROPERTY gets a DILATION equal to FRICTION"),
    ),
    (r"solve elas.*", _say("SOLVE with great strengths first, then give the real ones and SOLVE again")),
    (r"delete block.*", _say("DELETE takes a range: DELETE RANGE CIRCLE x y r")),
    (r"exc(?:av|avate)? range (?P<range>.+)", _put("DELETE{in_range}")),
    (r"fill.*", _say("FILL x y MATERIAL=n puts a new block into the space around a point")),
    (r"(?:zone )?relax.*", _say("DELETE range FUNCTION=n relaxes an excavated boundary by a FUNCTION")),
    (rf"table (?P<n>\d+) (?P<a>{N}(?: {N})+)", _put("FUNCTION {n} {a}")),
    (r"table.*", _say("FUNCTION n takes times and factors; a later one takes its place")),
    (r"def(?:ine)? [a-z_]\w*|.*\.fis'?\"?", _say(FISH)),
    (r"return", _ignore("the deck goes on")),
    (r"restore .+", _file("RESTART", "restore")),
    (r"model save .+", _file("SAVE", "model save")),
    (r"(?:list|print) (?P<a>cont(?:act)?|block|zone|corner|domain)s?", lambda found, _: _listed(found["a"])),
    (r"(?:print|list) max", _put("PRINT MAX")),
    (r"pl(?:ot)? hist(?!.*(?:less|against|log)).*", _put("PLOT HISTORY")),  # else it is ours, with an error
    (r"pl(?:ot)? (?P<rest>[a-z ]+)", _plot),
    (r"copy.*", _say("there is no COPY: BRICKS and JSET repeat cuts, a loop in Python repeats BLOCK")),
    (r"window.*", _say("a word of PLOT: PLOT 0 WINDOW x1 x2 y1 y2")),
    (r"pause", _ignore("a deck runs to its end; at the terminal each command waits")),
    (r"quit|exit", _put("STOP")),
    (r"set (?:log|echo).*", _ignore("output goes to the terminal, and with > to a file")),
    (r"set (?:dscan|small|mech).*", _ignore(NOT_NEEDED)),
    (
        r"set flow.*",
        _say("FLUID begins water; FLOW STEADY, FLUID COUPLED, UNDRAINED or DRAINED choose the mode"),
    ),
    (r"set ovtol.*", _say("overlaps are limited by ROUND (error 15)")),
    (rf"pfix pressure (?P<a>{N}) range (?P<r>{N} {N} {N} {N})", _put("PPRESSURE {r} {a} HELD")),
    (rf"pp (?P<a>{N}) range (?P<r>{N} {N} {N} {N})", _put("PPRESSURE {r} {a}")),
    (rf"water density (?P<a>{N})", _put("FLUID DENSITY={a}")),
    (r"(?:struct|cable|reinforce|bolt|support).*", _say(NO_STRUCTURE)),
    (
        r"(?:hide|seek|show|mark).*",
        _say("PLOT ... WINDOW shows a part; `udec view` searches and follows groups"),
    ),
    (r"movie.*", _say("`udec run --animate` writes a moving picture")),
    (
        r"ini(?:tialize)?\b.*",
        _say("INSITU, PPRESSURE and BOUNDARY give initial values; PATCH any other word"),
    ),
)
PATTERNS = tuple((re.compile(pattern), make) for pattern, make in TABLE)
LISTED = {"cont": "CONTACTS", "contact": "CONTACTS", "block": "BLOCKS", "zone": "ZONES", "corner": "CORNERS"}


def _listed(name: str) -> Reading:
    return Reading((f"PRINT {LISTED.get(name, 'DOMAINS')}",))
