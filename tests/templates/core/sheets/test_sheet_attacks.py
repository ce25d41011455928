"""Hostile worksheets: each is refused with its line and column, before anything is calculated."""

import pytest

from templates.core.errors import MOST_SUGGESTED
from templates.core.sheets import SheetRefused, read

SHEET = """# Hostile
given F [N] "load" (> 0; example 1 kN)
given W [mm] "width" (> 0; example 10 mm)
given x [1] "ratio" (example 1)
given T [degC] "temperature" (example 20 degC)
given g [bar] over cycle "pressure" (example [1, 2] * 1 bar)
choice law = a "law" (a | b)
"""
FIRST = SHEET.count("\n") + 1
DOUBLING = "f0(x [1]) [1] = x + x\n" + "\n".join(
    f"f{n}(x [1]) [1] = f{n - 1}(x) + f{n - 1}(x)" for n in range(1, 30)
)
MULTIPLYING = "f(x [1]) [1] = x*x*x*x\np [1] = " + "f(" * 12 + "x" + ")" * 12 + ' "p"'
MANY = "f(x [1]) [1] = x*x*x*x\n" + "\n".join(f'p{n} [1] = f(f(f(f(f(x))))) "p{n}"' for n in range(9))
CHAINED = "if 1 < (" * 40 + "x" + ") < 9 then 2 else 3" * 40
DEFAULTS = "\n".join(f'given d{n} [mm] = d{n - 1} + 1 mm "d{n}"' for n in range(300, 0, -1))

ATTACKS = {
    "import": ('p [MPa] = __import__("os") "x"', "syntax"),
    "attribute of a value": ('p [m] = W.__class__ "x"', "syntax"),
    "attribute without dunder": ('p [m] = W.real "x"', "unknown_name"),
    "getattr": ('p [1] = getattr(W, x) "x"', "unknown_function"),
    "eval": ('p [1] = eval(x) "x"', "unknown_function"),
    "open": ('p [1] = open(x) "x"', "unknown_function"),
    "exec with text": ('p [1] = exec("1") "x"', "syntax"),
    "lambda": ('p [1] = lambda: 1 "x"', "syntax"),
    "method": ('p [1] = W.conjugate() "x"', "syntax"),
    "walrus": ('p [1] = (y := 1) "x"', "syntax"),
    "keyword argument": ('p [1] = max(x, key=x) "x"', "syntax"),
    "star": ('p [1] = max(*x) "x"', "syntax"),
    "subscript by text": ('p [1] = g["__class__"] "x"', "syntax"),
    "dunder name": ('__init__ [1] = 1 "x"', "syntax"),
    "name of the language": ('from_quantities [1] = 1 "x"', "name"),
    "level": ('level [1] = 1 "x"', "name"),
    "ledger": ('ledger [1] = 1 "x"', "name"),
    "type": ('mro [1] = 1 "x"', "name"),
    "huge exponent of a unit": ('p [mm] = W ** 1000000 "x"', "unit_mismatch"),
    "exponent that is not a number": ('p [mm] = W ** x "x"', "unit_mismatch"),
    "unit bomb": ('p [m**9**9**9] = W "x"', "unknown_unit"),
    "unit in a quantity": ('p [1] = 1 m**9**9 "x"', "unit_mismatch"),
    "powers of powers": ('p [1] = (((W**12)**12)**12)**12 "x"', "unit_mismatch"),
    "long unit": (f'p [{"m*" * 29}m] = W "x"', "unit_mismatch"),
    "unit too long": (f'p [{"m*" * 40}m] = W "x"', "syntax"),
    "huge number": ('p [1] = 1e9999 "x"', "not_finite"),
    "huge digits": (f'p [1] = {"9" * 1900} "x"', "not_finite"),
    "parentheses": (f'p [1] = {"(" * 3000} "x"', "too_large"),
    "open parentheses": (f'p [1] = {"(" * 1500} "x"', "syntax"),
    "signs": (f'p [1] = {"-" * 1900}1 "x"', "too_large"),
    "powers": (f'p [1] = {"**".join("9" * 300)} "x"', "too_large"),
    "sum": (f'p [1] = {"+".join(["x"] * 401)} "x"', "too_large"),
    "list": (f'p [1] = sum([{",".join(["1"] * 900)}]) "x"', "too_large"),
    "function of itself": ('f(x [1]) [1] = f(x)', "unknown_function"),
    "functions of each other": ('f(x [1]) [1] = h(x)\nh(x [1]) [1] = f(x)', "unknown_function"),
    "doubling functions": (DOUBLING, "too_large"),
    "arguments that multiply": (MULTIPLYING, "too_large"),
    "arguments that multiply in many lines": (MANY, "too_large"),
    "chained comparisons in each other": (f'p [1] = {CHAINED} "p"', "too_large"),
    "formula of itself": ('p [m] = p "x"', "loop"),
    "formulas of each other": ('p [m] = q "a"\nq [m] = p "b"', "loop"),
    "defaults in a row": (f'given d0 [mm] "d0"\n{DEFAULTS}', "too_large"),
    "format string": ('p [1] = f"{x}" "x"', "syntax"),
    "percent format": ('p [1] = "%s" % x "x"', "syntax"),
    "look-alike letter": ('р [1] = x "x"', "syntax"),  # Cyrillic er
    "look-alike in a formula": ('p [1] = х "x"', "syntax"),  # Cyrillic ha
    "look-alike digit": ('p [1] = １ "x"', "syntax"),
    "right to left in words": ('p [1] = x "a\u202eb"', "syntax"),
    "right to left in a remark": ("// a\u2066b", "syntax"),
    "line that is none": ("// a\u2028p", "syntax"),
    "right to left": ('p [1] = \u202ex "x"', "syntax"),
    "no-break space": ('p\u00a0[1] = x "x"', "syntax"),
    "lone surrogate": ('p [1] = x "a\ud800"', "syntax"),
    "NUL": ('p [1] = x\x00 "x"', "syntax"),
    "escape sequence": ('p [1] = x "\x1b[2J"', "syntax"),
    "symbol with a link": (r'p [1] = x "y" (symbol "\href{javascript:1}{y}")', "clause"),
    "symbol with a macro": (r'p [1] = x "y" (symbol "\def\a{\a\a}\a")', "clause"),
    "sum of temperatures": ('p [degC] = T + T "x"', "unit_mismatch"),
    "difference as temperature": ('p [degC] = T - T "x"', "unit_mismatch"),
    "condition as quantity": ('p [1] = x > 1 "x"', "no_truth"),
    "quantity as condition": ('p [1] = if x then 1 else 2 "x"', "no_truth"),
    "choice as quantity": ('p [1] = law + 1 "x"', "no_truth"),
    "option that is none": ('p [1] = if law is c then 1 else 2 "x"', "unknown_name"),
    "list as a single value": ('p [bar] = g "x"', "axis_mismatch"),
    "single value as a list": ('p [1] over cycle = x "x"', "axis_mismatch"),
    "lists over two axes": ('given h [bar] over inertias "y"\np [bar] = max(g + h) "x"', "axis_mismatch"),
    "bound that is not a number": ('given y [1] "y" (> x)', "limit"),
    "bound by ==": ('given y [1] "y" (== 1)', "limit"),
    "words that are others'": ('p [N] = F "load"', "name"),
    "words without letters": ('p [N] = F "…"', "name"),
    "tolerance below nothing": ('p [1] = x "p"\ntest "t" gives p = 2 within -50 %', "limit"),
    "tolerance that is a list": ('p [1] = x "p"\ntest "t" gives p = 2 within [1, 2]', "limit"),
    "tolerance that is infinite": ('p [1] = x "p"\ntest "t" gives p = 5000 within 1e308 %', "limit"),
    "statement that ends": ("p [N] =", "syntax"),
    "statement that is none": ("hello", "syntax"),
}  # fmt: skip


def faults(text):
    with pytest.raises(SheetRefused) as refused:
        read(text)
    return refused.value.faults


@pytest.mark.parametrize("attack", ATTACKS)
def test_an_attack_is_refused_at_its_place(attack):
    text, code = ATTACKS[attack]
    listed = faults(SHEET + text)
    assert code in [fault.code for fault in listed], listed
    lines = (SHEET + text).split("\n")
    for fault in listed:
        assert FIRST <= fault.line <= len(lines)
        assert 1 <= fault.column <= len(lines[fault.line - 1]) + 1
        assert fault.message.isprintable()
        assert len(fault.sentence) < 1000


def test_the_sheet_beneath_is_accepted():
    assert read(SHEET).template("hostile", 1).inputs.keys() >= {"load", "width"}


def test_all_faults_are_reported_at_once():
    text = (
        SHEET
        + 'p [MPa] = F + W "p"\nq [mm] = zz "q"\nr [furlongg] = 1 "r"\ns = 3\nt [N] = 2 * p * W**2 "t"\n'
    )
    codes = {fault.line - FIRST: fault.code for fault in faults(text)}
    assert codes == {0: "unit_mismatch", 1: "unknown_name", 2: "unknown_unit", 3: "syntax"}


def test_what_follows_from_a_faulty_statement_is_no_fault_of_its_own():
    (fault,) = faults(SHEET + 'p [MPa] = F / \nq [MPa] = 2 * p "q"\nr [MPa] = q + p "r"')
    assert (fault.line, fault.code) == (FIRST, "syntax")


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("> prose\n" * 9000, 1),
        ("é" * 40_000, 1),
        ("\n".join(f'a{n} [1] = 1 "a{n}"' for n in range(401)), 401),
        (f'a [1] = 1 "{"x" * 2000}"', 1),
    ],
)
def test_a_worksheet_is_bounded(text, line):
    (fault,) = faults(text)
    assert (fault.code, fault.line) == ("too_large", line)


def test_a_long_chain_in_any_order_is_calculated():
    chain = [f'a{n} [mm] = a{n - 1} + 1 mm "a{n}"' for n in range(390, 0, -1)]
    text = "\n".join(['require a390 > 0 mm "It is long"', *chain, 'given a0 [mm] "a0" (example 1 mm)'])
    film = read(text).template("chain", 1)
    assert film.from_quantities({"a0": "1 mm"}).a390 == pytest.approx(0.391)


@pytest.mark.parametrize(
    ("text", "column", "remedy"),
    [
        ("F = 25 kN", 3, "the unit is missing here"),
        ("given F [kN] load", 14, "words between quotation marks are missing"),
        ('given F [kN] "x" (exmple 25 kN)', 19, "clauses are"),
        ('Given F [kN] "x"', 7, "write given in small letters"),
        ('p [MPa] = 25kN "x"', 13, "put a blank between a number and its unit"),
        ('p [mm] = 2,5 mm "x"', 11, "decimals take a point"),
        ('p [mm**2] = W^2 "x"', 14, "a power is written `**`"),
        ('p [mm] = if x > 1 then W "x"', 26, "every `if` needs an `else`"),
        ('p [mm] = W + "x"', 14, "write it like `p [MPa]"),
    ],
)
def test_a_slip_of_the_pen_is_met_with_what_would_be_right(text, column, remedy):
    fault = faults(SHEET + text)[0]
    assert (fault.code, fault.column) == ("syntax", column)
    assert fault.remedy.startswith(remedy)


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ('choice other = a "of two" (a | a)', "a | a"),
        ('curve mu(T [degC]) [mPa*s] "v" (held): 40 -> 80 30 -> 9', "30 -> 9"),
        ('given y [mm] "y" (>= 0; >= 1 mm)', ">= 1 mm"),
    ],
)
def test_a_fault_of_meaning_has_the_column_of_its_part(text, part):
    assert faults(SHEET + text)[0].column == text.index(part) + 1


def test_a_check_that_is_too_long_by_the_names_of_its_inputs_is_refused():
    words = "width of the bearing between its inner edges " * 3
    text = f'given q [mm] "{words.strip()}" (example 1 mm)\ncheck {" + ".join(["q"] * 40)} <= 2 m "x"'
    (fault,) = faults(SHEET + text)
    assert (fault.code, fault.line) == ("check", FIRST + 1)
    assert "at most 2000 characters" in fault.message


def test_the_nearest_names_are_sought_for_the_first_unknown_ones_only(monkeypatch):
    """A text of near misses took 8.5 s: all names were compared with each of them."""
    sought = []
    monkeypatch.setattr("templates.core.errors.nearest", lambda name, declared: sought.append(name) or [])
    names = [f"{'ab' * 22}{number:03}" for number in range(100)]
    lines = ["# Near misses", 'given F [kN] "load" (example 25 kN)']
    lines += [f'{name} [kN] = F "v {name[-3:]}"' for name in names]
    lines += [f'z{name[-3:]} [kN] = {name}x "w {name[-3:]}"' for name in names]
    lines += [f'test "t {name[-3:]}" with F = 25 kN gives {name}y = 25 kN within 0.2 %' for name in names]
    with pytest.raises(SheetRefused) as refused:
        read("\n".join(lines))
    assert [fault.code for fault in refused.value.faults] == ["unknown_name"] * 200
    assert len(sought) == MOST_SUGGESTED
