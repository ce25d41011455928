"""Every JSON answer in the OpenAPI document has a short example that is valid by its schema."""

import json

import pytest
from jsonschema import Draft202012Validator

from app.http.answer_examples import EXAMPLES

LONGEST = 8000  # letters of one example
SHARE = 0.15  # largest share of the examples in the document


@pytest.fixture(scope="module")
def document(http):
    return http.get("/openapi.json").json()


@pytest.fixture(scope="module")
def answers(document):
    """The JSON answers to requests that succeed at once, by operation and status."""
    return {
        f"{method.upper()} {path} {status}": content
        for path, item in document["paths"].items()
        for method, operation in item.items()
        for status in ("200", "201")
        for media, content in operation["responses"].get(status, {}).get("content", {}).items()
        if media == "application/json"
    }


def test_every_json_answer_has_an_example(answers):
    assert len(answers) > 80
    assert [name for name, content in answers.items() if not content.get("examples")] == []


def test_every_example_is_valid_by_the_schema_of_its_answer(document, answers):
    checked = 0
    for name, content in answers.items():
        whole = {"components": document["components"], **content["schema"]}
        validator = Draft202012Validator(whole)
        for example in content["examples"].values():
            value = document["components"]["examples"][example["$ref"].rpartition("/")[2]]["value"]
            faults = [f"{list(fault.path)}: {fault.message}" for fault in validator.iter_errors(value)]
            assert faults == [], name
            checked += 1
    assert checked >= len(answers)


def test_examples_are_short_and_none_is_left_over(document):
    examples = document["components"]["examples"]
    assert {name for name, one in examples.items() if len(json.dumps(one)) > LONGEST} == set()
    assert len(json.dumps(examples)) < SHARE * len(json.dumps(document))
    assert set(json.loads(EXAMPLES.read_text(encoding="utf-8"))) == set(examples)
