"""STEP files from clients are read in linear time and little memory."""

import time
import tracemalloc

import pytest

from cad import statements
from cad.statements import read_statements

LENGTH = 200_000
"""Of the hostile files [bytes]: with a quadratic reader each takes minutes."""

MANY = ",".join(9000 * ["#3"])
DATUMS = f"#2=DATUM_SYSTEM('',{MANY});#3=DATUM_REFERENCE_COMPARTMENT('',{MANY.replace('3', '4')});"
TOLERANCES = "".join(f"#{n}=PERPENDICULARITY_TOLERANCE('bore','',#9,#8,#2);" for n in range(10, 1500))
ITEMS = f"#2=REPRESENTATION('',({MANY}),#1);#3=DESCRIPTIVE_REPRESENTATION_ITEM('a','b');"
PROPERTIES = "".join(
    f"#{n}=PROPERTY_DEFINITION('material property','density',#1);"
    f"#{n + 1}=PROPERTY_DEFINITION_REPRESENTATION(#{n},#2);"
    for n in range(10, 3000, 2)
)
HOSTILE = {
    "blanks before a word that is none": "#1=" + LENGTH * " " + "!;",
    "blanks between brackets": "#1= (" + LENGTH * " " + "!;",
    "blanks before a number": LENGTH * " " + "!;",
    "digits": "#1=DATUM(" + LENGTH * "1" + ");",
    "a string without an end": "#1=DATUM('" + LENGTH * "a",
    "quotes": "#1=DATUM(" + LENGTH * "'" + ");",
    "semicolons": LENGTH * ";",
    "datums by the million": DATUMS + "#4=DATUM('','',#1,.F.,'A');" + TOLERANCES,
    "items that all properties share": ITEMS + PROPERTIES,
}


@pytest.mark.parametrize("text", HOSTILE.values(), ids=HOSTILE)
def test_the_time_is_linear_whatever_is_sent(text):
    begun = time.process_time()
    read_statements(text.encode())
    assert time.process_time() - begun < 2


def test_the_entities_of_a_file_are_bounded(monkeypatch):
    monkeypatch.setattr(statements, "MOST", 1000)
    text = "".join(f"#{n}=DATUM('','',#1,.F.,'A');" for n in range(1, 20_000)).encode()
    tracemalloc.start()
    assert len(read_statements(text)) == 1000
    assert tracemalloc.get_traced_memory()[1] < 5 * len(text)
    tracemalloc.stop()


def test_an_entity_of_other_sorts_is_not_kept():
    text = "".join(f"#{n}=(BOUNDED_SURFACE()SURFACE());" for n in range(1, 100))
    assert statements._entities(text.encode()) == {}


def test_a_property_of_a_kind_that_we_do_not_write_is_left_out():
    text = (
        "#1=PROPERTY_DEFINITION('material property','colour',#9);#2=MEASURE_REPRESENTATION_ITEM('x',1.5);"
        "#3=REPRESENTATION('',(#2),#8);#4=PROPERTY_DEFINITION_REPRESENTATION(#1,#3);"
    )
    assert read_statements(text.encode()) == []
    (stated,) = read_statements(text.replace("colour", "density").encode())
    assert (stated.kind, stated.values) == ("density", (1.5,))
