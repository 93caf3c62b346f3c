"""From lines to calls: what decks mean, and that spacing, case and continuation lines do not change it."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_deck_language import SHARED, abbreviations

from udec_ia.deck.command_forms import SEVERAL, Command, Word
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import statements
from udec_ia.deck.lines_and_calls import INTEGER_NAMES, Call, parse
from udec_ia.errors import UdecError


def call(text: str) -> Call:
    (statement,) = statements(text.split("\n"), "deck.dat")
    return parse(statement)


@pytest.mark.parametrize(
    ("text", "positional", "named"),
    [
        ("P B", ["blocks"], {}),
        ("print c cor d dl l", ["contacts", "corners", "domains", "dlist", "list"], {}),
        ("BLOCK 0.,-2.  0.,10.5", [0.0, -2.0, 0.0, 10.5], {}),
        ("B M 2 C=3 0 0 1 1", [0.0, 0.0, 1.0, 1.0], {"material": 2, "constitutive": 3}),
        ("PROP MAT=1 KN=1.E08 K=2 F=.5", [], {"material": 1, "kn": 1e8, "bulk": 2.0, "friction": 0.5}),
        ("prop m 50 bulk 1D3 g 5.", [], {"material": 50, "bulk": 1000.0, "g": 5.0}),
        ("CHANGE 0 60 30 40 MATERIAL=2", [0.0, 60.0, 30.0, 40.0], {"material": 2}),
        ("CH,0,60,20,30,SDEF", [0.0, 60.0, 20.0, 30.0], {"type": "sdef"}),
        ("DAMP 0.5 16. MASS", [0.5, 16.0], {"only": "mass"}),
        ("DAMP -1 +2", [-1.0, 2.0], {}),
        ("PLOT", [], {}),
        ("PLOT 1", [1], {}),
        ("PLOT 0 CONT ADDR", [0], {"contacts": True, "addresses": True}),
        ("PLOT D", [], {"domains": True}),
        ("RSET 1.5 100 -2", [1.5, 100, -2], {}),
        ("SAVE", [], {}),
        ("SAVE  out/run 1.h5 ", [], {"path": "out/run 1.h5"}),
        ("SAVE='a=b.h5'", [], {"path": "a=b.h5"}),
        ("RESTART /tmp/run.h5", [], {"path": "/tmp/run.h5"}),
        ("PLOT 0;CONT", [0], {}),
        ("PLOT 0 CONT SINCE My stage", [0], {"contacts": True, "since": "My stage"}),
        ("PLOT # 0", [], {}),
        ("DAMP -1 ! half\n; a comment\n # and\n! more\n+ ;\n+ +2 # one", [-1.0, 2.0], {}),
        ("SAVE ; where", [], {}),
        ("SAVE run#1;2!.h5 ! the third", [], {"path": "run#1;2!.h5"}),
        ("SAVE 'my #1.h5' # quoted", [], {"path": "my #1.h5"}),
        (
            "GENERATE 10 20 10 20 M G 15,15 10,20\n+ 20,20 Z 1,2,5\n* a comment\n\n+2,3,5",
            [10.0, 20.0, 10.0, 20.0],
            {
                "mode": "manual",
                "gridpoints": [(15.0, 15.0), (10.0, 20.0), (20.0, 20.0)],
                "zones": [(1, 2, 5), (2, 3, 5)],
            },
        ),
    ],
)
def test_what_a_command_means(text: str, positional: list[Any], named: dict[str, Any]) -> None:
    parsed = call(text)
    assert (parsed.positional, parsed.named) == (positional, named)
    assert [type(value) for value in parsed.positional] == [type(value) for value in positional]


@pytest.mark.parametrize(
    ("text", "number", "line", "column", "advice"),
    [
        ("PROPS MAT=1", 2, 1, 1, "did you mean PROPERTY?"),
        ("++", 2, 1, 1, "there is no command before this line to continue"),
        ("exit", 2, 1, 1, "did you mean STOP?"),
        ("QUIT", 2, 1, 1, "did you mean STOP?"),
        ("STEP 100", 2, 1, 1, "did you mean CYCLE?"),
        ("steps 100", 2, 1, 1, "did you mean CYCLE?"),
        ("RUN 9", 2, 1, 1, "did you mean CYCLE?"),
        ("SET GRAV 0 -10", 2, 1, 1, "did you mean GRAVITY?"),
        ("CRACK 0 1 2 1", 2, 1, 1, "did you mean SPLIT?"),
        ("EN", 2, 1, 1, "did you mean END?"),
        ("100 200", 2, 1, 1, "a line begins with a command"),
        ("HISTORY 1 XVEL", 10, 1, 11, "did you mean KXD or KXDG?"),
        ("PROP 1 DENS=1", 10, 1, 6, "the form is: PROperty Material n"),
        ("FIX some", 10, 1, 5, "the form is: Fix x1 x2 y1 y2"),
        ("FUNCTION 1 0", 8, 1, 13, "t and f must be on one line"),
        ("CYCLE 1 * a lot", 10, 1, 9, "a comment after a command begins with ; # or !"),
        ("FIX 0 1 0", 7, 1, 10, "the form is: Fix x1 x2 y1 y2"),
        ("CHANGE 0 1 0 SDEF", 7, 1, 13, "the form is: Change"),
        ("CYCLE", 7, 1, 6, "the form is: CYcle n | TIME t"),
        ("PRINT", 7, 1, 6, "the form is: Print"),
        ("PROP MAT=1 DENS", 7, 1, 16, "the form is"),
        ("PROP MAT=1 DENS\n+ KN=1", 7, 1, 16, "the form is"),
        ("GEN 0 1 0 1 M G Z 1 2 3", 7, 1, 16, "the form is"),
        ("GEN 0 1 0 1", 7, 1, 12, "the form is"),
        ("BLOCK", 7, 1, 6, "the form is"),
        ("BLOCK 1 2\n+ 3", 8, 2, 4, "x and y"),
        ("BLOCK 1 2 3\n+ 4", 8, 1, 12, "x and y"),
        ("GEN 0 1 0 1 M G 1 2 3 Z", 8, 1, 22, "x and y"),
        ("GEN 0 1 0 1 M Z 1 2", 26, 1, 20, "three grid-points"),
        ("GEN 0 1 0 1 M Z 1 2\n+3", 26, 1, 20, "three grid-points"),
        ("GEN 0 1 0 1 G 0 0", 22, 1, 13, "the form is"),
        ("GEN 0 1 0 1 5 M", 22, 1, 13, "the form is"),
        ("GEN 0 1 0 1 MANUEL", 22, 1, 13, "did you mean MANUAL?"),
        ("PRINT BLOKS", 10, 1, 7, "did you mean BLOCKS?"),
        ("PROP DENS=1", 7, 1, 5, "the form is: PROperty Material n"),
        ("PROP DENS=1 MAT=1", 7, 1, 5, "the form is: PROperty Material n"),
        ("PROP 5 MAT=1", 10, 1, 6, "the form is: PROperty Material n"),
        ("PROP MAT=1 DENSITEE=1", 10, 1, 12, "did you mean DENSITY?"),
        ("PROP MAT=1 K=1 BULK=1", 10, 1, 16, ""),
        ("CHANGE 0 1 0 1 SDEF FDEF", 10, 1, 21, ""),
        ("DAMP 0.1 10 5", 10, 1, 13, "the form is"),
        ("FIX 0 1 0 1\n+\n+ 5", 10, 3, 3, "the form is"),
        ("CYCLE 10.5", 10, 1, 7, "n must be an integer"),
        ("CYCLE 1E3", 10, 1, 7, "n must be an integer"),
        ("CYCLE ten", 10, 1, 7, ""),
        ("FIX 0 1 0 1.2.3", 10, 1, 11, ""),
        ("FIX 0 nan 0 1", 10, 1, 7, ""),
        ("FIX 0 1 -inf 1", 10, 1, 9, ""),
        ("FIX 0 1 0 1_0", 10, 1, 11, ""),
        ("FIX 0 1 0 \u0661", 10, 1, 11, ""),
        ("FIX 0 1 0 " + "9" * 400, 28, 1, 11, ""),
        ("CYCLE 1234567890123456789", 28, 1, 7, ""),
        ("SAVE a\n+b", 10, 1, 6, ""),
        ("SAVE a\x00b", 10, 1, 6, ""),
        ('SAVE "my file ; not closed', 10, 1, 6, "put the whole name in quotes"),
        ("SAVE 'a'b", 10, 1, 6, "put the whole name in quotes"),
    ],
)
def test_where_and_why_a_command_is_refused(
    text: str, number: int, line: int, column: int, advice: str
) -> None:
    with pytest.raises(UdecError) as caught:
        call(text)
    error = caught.value
    assert (error.number, error.file, error.line, error.column) == (number, "deck.dat", line, column)
    assert advice in error.advice
    assert error.advice


def test_the_message_points_at_the_word() -> None:
    with pytest.raises(UdecError) as caught:
        call("PROP\tMAT=1 DENSITEE=2000")
    assert str(caught.value).split("\n") == [
        'deck.dat:1:12: error 10: unrecognised parameter: "DENSITEE"',
        "    PROP MAT=1 DENSITEE=2000",
        "               ^",
        "did you mean DENSITY? the form is: PROperty Material n [Bulk b | K b] [Cohesion c] [Density d] "
        "[KN sn] [Friction f] [KS ss] [G g] [DIlation a] [RFriction f] [RCohesion c] [CRitical u] "
        "[BFriction f] [BCohesion c] [BTension t] [BDilation a] [P1 v] [P2 v] [P3 v] [P4 v] "
        "[FUNCTION n]",
    ]
    assert caught.value.token == "DENSITEE"


@pytest.mark.parametrize(
    ("text", "column", "detail"),
    [
        ("FIX 0 1 0 1 5", 13, '"5" is one number too many'),
        ("BLOCK 0 0 0 1O 10", 13, '"1O" is not a number'),
        ("BLOCK 0 0 0 10 1O 10", 16, '"1O" is not a number'),
        ("BLOCK 0 0 0 10 10 0 MAT=2", 21, '"MAT" must stand before the list x y ...'),
    ],
)
def test_what_stands_behind_the_end_of_a_command(text: str, column: int, detail: str) -> None:
    with pytest.raises(UdecError) as caught:
        call(text)
    error = caught.value
    assert (error.number, error.column, error.detail) == (10, column, detail)
    assert error.advice


@pytest.mark.parametrize("text", ["FIX " + "x" * 100_000, "BLOCK " + "1 2 " * 30_000 + "x", "x" * 100_000])
def test_the_message_about_a_very_long_line_is_short(text: str) -> None:
    with pytest.raises(UdecError) as caught:
        call(text)
    assert len(str(caught.value)) < 500


def test_digits_without_end_are_a_number_while_they_are_zeros() -> None:
    assert call("CYCLE " + "0" * 10_000 + "7").positional == [7]


# Round trip: any command with any arguments, written in any of the ways that mean the same.

finite = st.floats(allow_nan=False, allow_infinity=False)
separator = st.text(" =(),/\t", min_size=1, max_size=3).filter(lambda s: s.strip("+*"))
line_break = st.sampled_from(["\n+", "\n + ", "\n* a comment\n+,", "\n\n+ ("])


@st.composite
def numbers(draw: st.DrawFn, names: str) -> tuple[str, list[int | float]]:
    """Values for the numbers `names`, and one way to write them on one line."""
    texts, values = [], []
    for name in names.split():
        if name.strip("[]")[0] in INTEGER_NAMES:
            value: int | float = draw(st.integers(-(10**18) + 1, 10**18 - 1))
            texts.append(draw(st.sampled_from([f"{value}", f"{value:+}", f"{value:025}"])))
        else:
            value = draw(finite | st.integers(-(10**6), 10**6).map(float))
            forms = [repr(value), repr(value).replace("e", "D"), f"{value:+.17E}"]
            texts.append(draw(st.sampled_from(forms + ([f"{value:.0f}"] if value.is_integer() else []))))
        values.append(value)
    return "".join(text + draw(separator) for text in texts), values


@st.composite
def words(draw: st.DrawFn, command: Command) -> tuple[list[str], list[Any], dict[str, Any]]:
    """Some words of `command`: their pieces of text, and the arguments that they set."""
    chosen: dict[str, Word] = {}
    pieces, positional, named = [], [], {}
    usual = [word for word in command.words if not word.replaces and not word.text]
    for word in draw(st.permutations(usual)):
        needed = word.argument == command.first and word.argument not in chosen
        if word.argument not in chosen and (needed or draw(st.booleans())):
            chosen[word.keyword if word.argument == SEVERAL else word.argument] = word
    for word in sorted(chosen.values(), key=lambda word: word.argument != command.first):
        pieces.append(draw(st.sampled_from(abbreviations(word.keyword))) + draw(separator))
        if word.argument == SEVERAL:
            positional.append(word.keyword.lower())
        elif word.values:
            read = [
                draw(numbers(word.values)) for _ in range(draw(st.integers(1, 3 if word.repeated else 1)))
            ]
            pieces += [text for text, _ in read]
            tuples = [tuple(values) for _, values in read]
            one = tuples[0] if len(tuples[0]) > 1 else tuples[0][0]
            named[word.argument] = tuples if word.repeated else one
        else:
            named[word.argument] = word.keyword.lower() if word.sets else True
    return pieces, positional, named


@st.composite
def written(draw: st.DrawFn) -> tuple[str, Command, list[Any], dict[str, Any]]:
    """A command: its text, and what it must be parsed to."""
    command = draw(st.sampled_from([command for command in COMMANDS if not command.text]))
    spellings = [typed for typed in abbreviations(command.keyword) if typed.upper() not in SHARED]
    pieces, positional = [draw(st.sampled_from(spellings)) + draw(separator)], []
    optional = command.optional if draw(st.booleans()) else ""
    for name in f"{command.numbers} {optional}".split():
        text, values = draw(numbers(name))
        pieces.append(text)
        positional += values
    more, several, named = draw(words(command))
    pieces, positional = pieces + more, positional + several
    if command.list:
        for text, values in draw(st.lists(numbers(command.list), min_size=1, max_size=5)):
            pieces.append(text)
            positional += values
    text = draw(st.sampled_from(["", "  "])) + pieces[0]
    for piece in pieces[1:]:
        text += draw(st.just("") | line_break) + piece
    case = draw(st.sampled_from([str.upper, str.lower, str]))
    return case(text), command, positional, named


@given(written())
def test_spacing_case_and_continuation_do_not_matter(
    example: tuple[str, Command, list[Any], dict[str, Any]],
) -> None:
    text, command, positional, named = example
    parsed = call(text)
    assert parsed.command is command
    assert (parsed.positional, parsed.named) == (positional, named)
    for place in (parsed.head, *parsed.places.values()):
        assert place.line.text[place.column - 1 : place.end - 1] == place.text
