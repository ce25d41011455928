"""The cost of a worksheet is known in advance: many equations run outside the server's event loop."""

from app.pool.cost import EXPENSIVE, array_seconds, estimated_seconds, is_quick, solving_seconds
from templates.core.sheets import read

GIVEN = 'given F [1] "load" (example 2)\n'
EQUATIONS = GIVEN + "\n".join(
    f'solve x{n} [1] from 0 to 100 so that x{n}**3 + sin(x{n}) == F "root {n}"' for n in range(90)
)
PLAIN = GIVEN + 'p [1] = 2 * F "double"'


def made(text):
    return read(text).template("duty", 1)


def test_a_worksheet_of_equations_leaves_the_process():
    cls, inputs = made(EQUATIONS), {"load": 2}
    assert not is_quick(cls)
    assert estimated_seconds(cls, inputs) > EXPENSIVE
    assert array_seconds(cls, None, 1, ["root_1"], 1, 1) > EXPENSIVE
    assert solving_seconds(cls, inputs, target=["root_1"]) > 100 * EXPENSIVE


def test_a_plain_worksheet_stays():
    cls = made(PLAIN)
    assert is_quick(cls)
    assert estimated_seconds(cls, {"load": 2}) < EXPENSIVE
    assert estimated_seconds(cls, {"load": [2.0] * 10**6}) > EXPENSIVE
