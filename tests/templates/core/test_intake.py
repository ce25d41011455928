"""How a template reads inputs: table rows by declared columns, and texts of limited length."""

import pytest

from templates.core.errors import InvalidInputs
from templates.core.language import intake
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template, table, text
from templates.oil_film.oil_film_v1 import OilFilm


class Plate(Template):
    """A plate with holes."""

    holes = table("m", "holes", "place", "width", ge=0)
    example = {"holes": {"value": [[1, 2]], "unit": "m"}}

    @text("word")
    def word(self):
        """Their number."""
        return str(len(self.holes))


def word(rows):
    raw = {"holes": {"value": rows, "unit": "m"}}
    return evaluate(Plate, raw).outputs["word"].value


@pytest.mark.parametrize("rows", [[1, 2, 3], [[1, 2, 3]], [[1]], [[[1, 2]]], [[1, 2]] * 13])
def test_another_shape_is_refused(rows):
    with pytest.raises(InvalidInputs) as refusal:
        word(rows)
    assert {fault.name for fault in refusal.value.faults} == {"holes"}


def test_a_single_row_may_stand_alone():
    assert word([1, 2]) == word([[1, 2]]) == "1"
    assert word([[1, 2], [3, 4]]) == "2"


def test_a_long_text_is_refused_and_not_kept():
    kept = intake.plain_text.cache_info().currsize
    for size in range(1000, 1010):
        with pytest.raises(InvalidInputs):
            evaluate(OilFilm, {**OilFilm.example, "speed": "1" * size + " rpm"})
    assert intake.plain_text.cache_info().currsize <= kept + len(OilFilm.inputs)
