"""Patterns of texts mean the same in pydantic and in JSON Schema, for every character."""

import sys

import jsonschema_rs
import pytest
from pydantic import TypeAdapter, ValidationError

from app.approvals.schemas import Text
from app.identity.schemas.principals import Name

LETTERS = [chr(code) for code in range(sys.maxunicode + 1) if code < 0x3100 or code in (0xFEFF, 0x1F600)]


def accepts(adapter, text):
    try:
        adapter.validate_python(text)
    except ValidationError:
        return False
    return True


@pytest.mark.parametrize("kind", [Name, Text])
def test_both_judge_each_letter_alike(kind):
    adapter = TypeAdapter(kind)
    valid = jsonschema_rs.validator_for(adapter.json_schema()).is_valid
    taken = [letter for letter in LETTERS if accepts(adapter, letter)]
    assert taken == [letter for letter in LETTERS if valid(letter)]
    assert "a" in taken
    assert taken == [letter for letter in taken if letter.strip()]


@pytest.mark.parametrize(
    ("text", "reason"),
    [("\t\n", "the text needs at least one letter"), ("a\x01", "remove the control characters")],
)
def test_a_refusal_says_what_would_be_right(text, reason):
    with pytest.raises(ValidationError, match=reason):
        TypeAdapter(Text).validate_python(text)
