"""Random worksheets made of pieces of the language are read, or refused with lines and columns.

`CRANKWRIGHT_TEST_FUZZ` says how many, 10⁵ at night.
"""

import os
from contextlib import suppress

import numpy as np
import pytest
from seeds import seeded

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.paper import report
from templates.core.paper.schema import describe
from templates.core.sheets import SheetRefused, read, run_tests

COUNT = int(os.environ.get("CRANKWRIGHT_TEST_FUZZ", "2000"))
LINES = """given F [N] "load" (>= 0; example 25 kN; also "force")
given D [mm] = 48 mm "bore" (> 0; <= 2 m)
given B [mm] = D / 2 "width" (> 0; example 18 mm)
given T [degC] = 80 degC "temperature" (> -100)
given g [bar] over cycle "gas pressure" (example [1, 2, 3] * 1 bar)
choice law = a "viscosity law" (a | b; example b)
curve mu(T [degC]) [mPa*s] "viscosity" (source "sheet"; held): 40 -> 80 100 -> 9
f(x [mm], y [N]) [MPa] = y / x**2
p [MPa] = F / (D * B) "pressure" (published 1 to 40; source "DIN 31652")
q [MPa] = f(D, F) "another pressure"
eta [mPa*s] = if law is a then mu(T) else 0.9 * mu(T) "stiffness"
s [bar] over cycle = g - mean(g) "swing"
solve x [mm] from 1 mm to 2 m so that F / (x * B) == 10 MPa "diameter"
solve u [N] "left", v [kN] "right" (source "statics") so that u + v == F and u * D == 2 * B * v
require B <= 2 * D and not F < 0 N "The bush is not too wide" (remedy "use two")
check p <= 30 MPa "white metal carries it" (source "catalogue")
test "paper" with F = 25 kN gives p = 57 MPa within 1 %
# Title
> Prose, **bold**
// remark""".split("\n")
PIECES = """
given choice curve solve require check test from to so that over with gives within if then else and or not
is published example source symbol remedy also held whole min( max( sum( mean( count( sqrt( log10( f( mu( g[
[ ] ( ) { } + - * / ** < <= > >= == != = := -> : ; , . | " ' ` # > // \\ % $ & ~ ^ @ ! ? _ pi F D B T g law
p q eta s x y cycle 1 2.5 1e308 1e-320 -7 0 9 10**10 mm N MPa degC K 1/K mm**2/s [mm] [N] [1] [degC] [MPa]
"words" "" "a" over cycle in inch é 名 \u202e \u2028 \ud800 \x00 \x1b \u00a0
""".split()


def sheet(random):
    """A worksheet: lines of the language, some of them with pieces exchanged, taken out or put in."""
    count = len(LINES) if random.integers(3) else random.integers(1, len(LINES))
    lines = [LINES[place] for place in random.permutation(len(LINES))[:count]]
    for _ in range(random.choice([0, 1, 1, 1, 2, 5])):
        place = random.integers(len(lines))
        lines[place] = changed(lines[place], random)
    return "\n".join(lines)


def changed(line, random):
    words = line.split(" ")
    place, piece = random.integers(len(words)), PIECES[random.integers(len(PIECES))]
    match random.integers(6):
        case 0:
            words[place] = piece
        case 1:
            words.insert(place, piece)
        case 2:
            del words[place]
        case 3:
            words[place] += piece
        case 4:
            words.insert(place, "\n ")
        case 5:
            cut = random.integers(len(line) + 1)
            return line[:cut] + piece + line[cut + random.integers(3) :]
    return " ".join(words)


def try_sheet(text):
    """Read a worksheet and use it as the service does; whether it was accepted."""
    try:
        sheet = read(text)
    except SheetRefused as refused:
        lines = text.replace("\r\n", "\n").split("\n")
        for fault in refused.faults:
            assert 1 <= fault.line <= len(lines), (text, fault)
            assert 1 <= fault.column <= len(lines[fault.line - 1]) + 2, (text, fault)
            assert fault.remedy, (text, fault)
            fault.sentence.encode("utf-8")
        return False
    assert read(text).digest() == sheet.digest()
    cls = sheet.template("fuzzed", 1)
    assert len(sheet.statements) >= len(cls.declarations) - 1  # a system declares two
    describe(cls)
    run_tests(cls)
    with suppress(InvalidInputs):
        for row in report.rows(evaluate(cls, cls.example).template):
            assert row.mathml
    return True


def fuzz(count, number):
    random = np.random.default_rng(seeded(number))
    accepted = sum(try_sheet(sheet(random)) for _ in range(count))
    assert accepted >= count // 10, "the pieces make hardly any worksheet"


def test_random_worksheets():
    fuzz(200, 1)


@pytest.mark.slow
def test_many_random_worksheets():
    fuzz(COUNT, 2)
