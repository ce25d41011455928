"""Typed names of people: invisible differences do not make a different person of an author."""

import pytest
from pydantic import ValidationError

from app.worksheets.bodies import ReviewIn
from app.worksheets.names import is_same_person


@pytest.mark.parametrize(
    "other",
    [
        "ann weber",
        " Ann  WEBER ",
        "Ann\u00a0Weber",
        "\uff21nn Weber",
        "Ann\u200b Weber",
        "Ann Weber\u200f",
        "A\u00adnn Weber",
    ],
)
def test_the_author_is_recognised(other):
    assert is_same_person("Ann Weber", other)


@pytest.mark.parametrize("other", ["Anna Weber", "A. Weber", "AnnWeber"])
def test_others_are_other_people(other):
    assert not is_same_person("Ann Weber", other)


@pytest.mark.parametrize("nobody", ["\u200b", "\u202e", " \u00ad ", "…"])
def test_a_name_can_be_read(nobody):
    with pytest.raises(ValidationError, match="letter or a digit"):
        ReviewIn(reviewer=nobody, digest="0" * 64)
