"""Every wrong request is answered by a problem that names the cause: no 500, no hang."""

import json

import numpy as np
import pytest
from serving import API, HANG, created, faults, paper, problem

from app.calculations.bodies import OIL_FILM

DESIGNS = f"{API}/designs"
FILM = f"{API}/templates/oil_film/versions/1"
JSON = {"Content-Type": "application/json"}

LENGTHS = {
    "negative": '"-4 um"',
    "a pressure": '"40 MPa"',
    "a text NaN": '"NaN"',
    "a text NaN with its unit": '"nan mm"',
    "a bare NaN": "NaN",
    "a bare infinity": "-Infinity",
    "too large": "1e999",
    "too large a text": '"1e999 mm"',
    "an exponent of many digits": '"1e99999999999 mm"',
    "true": "true",
    "a power tower": '"m**9**9**9"',
    "a value with a power tower": '"1 m**9**9**9"',
    "powers and products": '"1 ' + "m*" * 90 + 'm"',
    "a text of a megabyte": '"' + "9" * 2**20 + ' mm"',
    "no text": '""',
    "blanks": '"   "',
    "no unit": '"48"',
    "a bare number": "48",
    "a giant integer": "9" * 4000,
    "a giant text integer": '"' + "9" * 150 + 'e300 mm"',
    "null": "null",
    "an empty list": "[]",
    "an empty object": "{}",
    "a list of nothing": "[[], []]",
    "an uneven list": '{"value": [[1, 2], [3]], "unit": "mm"}',
    "a list of words": '{"value": ["a"], "unit": "mm"}',
    "a nested object": '{"value": {"value": 1}, "unit": "mm"}',
    "an unknown key": '{"value": 1, "unit": "mm", "x": 1}',
    "a unit that is a list": '{"value": 1, "unit": ["mm"]}',
    "a tolerance that is true": '{"value": 1, "unit": "mm", "plus": true}',
    "a tolerance that is NaN": '{"value": 1, "unit": "mm", "plus": NaN}',
    "a relation": '"= 48 mm"',
    "a null byte": '"48 mm\\u0000"',
    "another script's digits": '"٤٨ mm"',
    "a full-width unit": '"48 ｍｍ"',
    "a function": "\"__import__('os').system('true') mm\"",
    "an enzyme unit": '"48 U"',
    "a deep list": "[" * 150 + "1" + "]" * 150,
}
PLACE_OF_NUL = {LENGTHS["a null byte"]: "inputs.bearing_diameter"}
"""U+0000 is refused as the body is read, by its place in it."""
BODIES = {
    "nothing": b"",
    "half a document": b'{"name": "x"',
    "10^5 brackets": b"[" * 10**5,
    "10^5 nested brackets": b"[" * 10**5 + b"]" * 10**5,
    "10^5 nested objects": b'{"a":' * 10**5 + b"1" + b"}" * 10**5,
    "a lone surrogate": b'{"name": "\\ud800"}',
    "a lone surrogate in a key": b'{"name": "x", "parameters": {"\\udfff": "1"}}',
    "not UTF-8": b'{"name": "\xff\xfe"}',
    "UTF-16": '{"name": "x"}'.encode("utf-16"),
    "a null byte": b'{"name": "x"}\x00',
    "an integer of 10^5 digits": b'{"name": "x", "parameters": {"a": ' + b"9" * 10**5 + b"}}",
    "a list": b"[]",
    "a text": b'"x"',
    "null": b"null",
    "two documents": b'{"name": "x"}{"name": "y"}',
    "a comment": b'{"name": "x" /* y */}',
}
DOCUMENTS = {
    "name": {"name": 5},
    "name as a list": {"name": ["x"]},
    "no name": {},
    "an empty name": {"name": ""},
    "a long name": {"name": "x" * 201},
    "parameters as a list": {"name": "x", "parameters": []},
    "a parameter named as nothing can be": {"name": "x", "parameters": {"a b": "1"}},
    "a parameter with a dot": {"name": "x", "parameters": {"a.b": "1"}},
    "a long parameter name": {"name": "x", "parameters": {"a" * 65: "1"}},
    "many parameters": {"name": "x", "parameters": {f"a{i}": "1" for i in range(501)}},
    "steps as text": {"name": "x", "steps": "film"},
    "a step as text": {"name": "x", "steps": {"a": "film"}},
    "a template as number": {"name": "x", "steps": {"a": {"template": 1}}},
    "a template with a path": {"name": "x", "steps": {"a": {"template": "../oil_film"}}},
    "a version as text": {"name": "x", "steps": {"a": {"template": "oil_film", "version": "1"}}},
    "a version of zero": {"name": "x", "steps": {"a": {"template": "oil_film", "version": 0}}},
    "a version as float": {"name": "x", "steps": {"a": {"template": "oil_film", "version": 1.5}}},
    "a version as true": {"name": "x", "steps": {"a": {"template": "oil_film", "version": True}}},
    "a giant version": {"name": "x", "steps": {"a": {"template": "oil_film", "version": 10**30}}},
    "a level that does not exist": {"name": "x", "steps": {"a": {"template": "oil_film", "level": "x"}}},
    "a level as number": {"name": "x", "steps": {"a": {"template": "oil_film", "level": 1}}},
    "a tolerance of zero": {"name": "x", "steps": {"a": {"template": "oil_film", "tolerance": 0}}},
    "a tolerance as text": {"name": "x", "steps": {"a": {"template": "oil_film", "tolerance": "1"}}},
    "inputs as list": {"name": "x", "steps": {"a": {"template": "oil_film", "inputs": []}}},
    "outputs as text": {"name": "x", "steps": {"a": {"template": "oil_film", "outputs": "all"}}},
    "an unknown output": {"name": "x", "steps": {"a": {"template": "oil_film", "outputs": ["all"]}}},
    "a model as text": {"name": "x", "model": "ball_bearing"},
    "a model without id": {"name": "x", "model": {}},
    "models as list": {"name": "x", "models": []},
    "parameters of a model as list": {"name": "x", "model": {"id": "ball_bearing", "parameters": []}},
    "a choice as number": {"name": "x", "model": {"id": "moody", "parameters": {"size": "1 mm", "mood": 1}}},
    "an unknown choice": {"name": "x", "model": {"id": "moody", "parameters": {"size": "1 mm", "mood": "x"}}},
    "an array for a model": {"name": "x", "model": {"id": "moody", "parameters": {"size": ["1 mm"]}}},
    "iterations as object": {"name": "x", "iterations": {}},
    "an iteration through nothing": {"name": "x", "iterations": [{"through": "", "start": "1"}]},
    "an iteration without a limit": {
        "name": "x",
        "iterations": [{"through": "model.mass", "start": "1 kg", "limit": 10**9}],
    },
    "an unknown field": {"name": "x", "colour": "red"},
    "an id": {"name": "x", "id": "mine"},
    "one name twice": {"name": "x", "parameters": {"a": "1"}, "steps": {"a": {"template": "oil_film"}}},
    "a note as number": {"name": "x", "note": 1},
}
RELATIONS = {
    "a deep one": "= " + "abs(" * 390 + "1" + ")" * 390,
    "a deep one that ends too early": "= " + "(" * 1500 + "1",
    "a long one": "= 1" + " + 1" * 1000,
    "of many parts": "= 1" + " + 1" * 450,
    "signs": "= " + "-" * 1500 + "1",
    "a power tower": "= 9**9**9**9",
    "an overflow": "= exp(exp(exp(9)))",
    "a unit tower": "= 1 m**9**9**9",
    "a hidden name": "= __import__",
    "an attribute": "= a.__class__",
    "an index": "= a[0]",
    "a call": "= print(1)",
    "a lambda": "= (lambda: 1)()",
    "a text": "= 'x'",
    "a null byte": "= 1\x00",
    "nothing": "=",
    "an exponent with a unit": "= 2 ** (1 mm)",
    "added temperatures": "= 20 degC + 20 degC",
    "a giant exponent": "= 1e99999999",
    "itself": "= b",
}


def post(http, path, content):
    return http.post(path, content=content, headers=JSON, timeout=HANG)


class TestEvaluate:
    @pytest.mark.parametrize("typed", LENGTHS.values(), ids=LENGTHS)
    def test_a_length(self, http, typed):
        inputs = json.dumps({**OIL_FILM, "bearing_diameter": "@"}).replace('"@"', typed)
        answer = post(http, f"{FILM}/evaluate", f'{{"inputs": {inputs}}}')
        assert list(faults(answer)) == [PLACE_OF_NUL.get(typed, "bearing_diameter")]

    def test_all_of_them_at_once(self, http):
        names = ["radial_load", "diametral_clearance", "bearing_diameter", "bearing_width", "speed"]
        wrong = ['"-4 kN"', "NaN", "1e999", "true", '"m**9**9**9"']
        pairs = ", ".join(f'"{name}": {typed}' for name, typed in zip(names, wrong, strict=True))
        listed = faults(post(http, f"{FILM}/evaluate", f'{{"inputs": {{{pairs}, "unheard_of": "1"}}}}'))
        assert listed.keys() >= {*names, "unheard_of", "oil_inlet_temperature"}

    @pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
    def test_a_body(self, http, body):
        assert faults(post(http, f"{FILM}/evaluate", body))

    @pytest.mark.parametrize(
        "change",
        [
            {"inputs": []},
            {"inputs": None},
            {"outputs": "all"},
            {"outputs": [1]},
            {"outputs": ["x" * 10**5]},
            {"outputs": ["density"] * 201},
            {"level": 1},
            {"level": "finest"},
            {"tolerance": 0},
            {"tolerance": 1e-400},
            {"tolerance": "1"},
            {"units": {"density": "m**9**9**9"}},
            {"units": {"density": 1}},
            {"units": ["kg"]},
            {"extra": 1},
        ],
    )
    def test_a_question(self, http, change):
        assert faults(post(http, f"{FILM}/evaluate", json.dumps({"inputs": OIL_FILM, **change})))

    def test_the_last_of_two_equal_keys_counts(self, http):
        inputs = json.dumps(OIL_FILM)[:-1] + ', "radial_load": "-1 N"}'
        assert list(faults(post(http, f"{FILM}/evaluate", f'{{"inputs": {inputs}}}'))) == ["radial_load"]

    def test_many_unknown_names(self, http):
        body = json.dumps({"inputs": {f"name_{i}": "1" for i in range(2000)}})
        assert len(faults(post(http, f"{FILM}/evaluate", body))) >= 2000

    def test_solve(self, http):
        body = {"inputs": OIL_FILM, "unknown": "bearing_width", "between": [], "target": {"density": []}}
        assert faults(post(http, f"{FILM}/solve", json.dumps(body)))


def axis(number, length, axes=4):
    """An array whose only long axis is this one."""
    shape = [1] * axes
    shape[number] = length
    return np.ones(shape).tolist()


class TestArrays:
    """Arrays that are small each, and would fill any memory together."""

    @pytest.mark.parametrize(("axes", "length"), [(2, 100_000), (4, 20_000)])
    def test_evaluate(self, http, axes, length):
        names = ("radial_load", "diametral_clearance", "bearing_diameter", "bearing_width")[:axes]
        units = ("N", "um", "m", "m")
        arrays = {n: {"value": axis(i, length, axes), "unit": units[i]} for i, n in enumerate(names)}
        answer = post(http, f"{FILM}/evaluate", json.dumps({"inputs": {**OIL_FILM, **arrays}}))
        assert "values" in problem(answer, 413, "too-many-values")["detail"]

    def test_evaluate_of_arrays_hidden_in_lists(self, http):
        inner = [{"value": [1.0] * 20_000, "unit": "N"}]
        inputs = {**OIL_FILM, "radial_load": inner}
        inputs["bearing_width"] = {"value": [[[0.018]]] * 20_000, "unit": "m"}
        answer = post(http, f"{FILM}/evaluate", json.dumps({"inputs": inputs}))
        problem(answer, 413, "too-many-values")

    @pytest.mark.parametrize(
        "body",
        [
            b'{"inputs": {"speed": [' + b"[]," * 10**6 + b"[]]}}",
            b'{"inputs": {' + b",".join(b'"name_%d": "1"' % i for i in range(150_000)) + b"}}",
        ],
        ids=["brackets", "names"],
    )
    def test_bodies_that_only_keep_the_parser_busy(self, http, body):
        problem(post(http, f"{FILM}/evaluate", body), 413, "body-too-intricate")

    def test_shapes_that_do_not_fit(self, http):
        arrays = {
            "radial_load": {"value": [1, 2], "unit": "kN"},
            "speed": {"value": [1, 2, 3], "unit": "rpm"},
        }
        answer = post(http, f"{FILM}/evaluate", json.dumps({"inputs": {**OIL_FILM, **arrays}}))
        assert {"radial_load", "speed"} & faults(answer).keys()

    @pytest.mark.parametrize("axes", [2, pytest.param(4, marks=pytest.mark.slow)])
    def test_a_relation(self, http, axes):
        parameters = {f"a{i}": {"value": axis(i, 20_000), "unit": "mm"} for i in range(axes)}
        parameters["b"] = "= " + " + ".join(parameters)
        answer = post(http, DESIGNS, json.dumps({"name": "x", "parameters": parameters}))
        assert faults(answer) == {"b": "too_many_values"}

    def test_a_step(self, http):
        document = paper(name="wide")
        del document["model"]
        document["steps"]["film"]["inputs"] |= {
            "radial_load": {"value": axis(0, 3000), "unit": "N"},
            "bearing_width": {"value": axis(1, 3000), "unit": "m"},
        }
        assert faults(post(http, DESIGNS, json.dumps(document))) == {"film.inputs": "too_many_values"}

    def test_a_step_through_a_relation(self, http):
        document = paper(name="wide")
        del document["model"]
        document["parameters"]["loads"] = {"value": axis(0, 3000), "unit": "N"}
        document["steps"]["film"]["inputs"] |= {
            "radial_load": "= loads",
            "bearing_width": {"value": axis(1, 3000), "unit": "m"},
        }
        assert faults(post(http, DESIGNS, json.dumps(document))) == {"film.inputs": "too_many_values"}


class TestDesigns:
    @pytest.mark.parametrize("document", DOCUMENTS.values(), ids=DOCUMENTS)
    def test_a_document(self, http, document):
        assert faults(post(http, DESIGNS, json.dumps(document)))

    @pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
    def test_a_body(self, http, body):
        assert faults(post(http, DESIGNS, body))

    @pytest.mark.parametrize("relation", RELATIONS.values(), ids=RELATIONS)
    def test_a_relation(self, http, relation):
        document = {"name": "x", "parameters": {"a": "1", "b": relation}}
        name = "parameters.b" if "\0" in relation else "b"
        assert list(faults(post(http, DESIGNS, json.dumps(document)))) == [name]

    @pytest.mark.parametrize("typed", LENGTHS.values(), ids=LENGTHS)
    def test_a_model_parameter(self, http, typed):
        document = {"name": "x", "model": {"id": "moody", "parameters": {"size": "@"}}}
        if typed == LENGTHS["a relation"]:
            pytest.skip("a relation is welcome here")
        name = "model.parameters.size" if typed in PLACE_OF_NUL else "model.size"
        assert faults(post(http, DESIGNS, json.dumps(document).replace('"@"', typed))).keys() == {name}

    def test_a_chain_of_500_relations_is_no_attack(self, http):
        parameters = {"p0": "1", **{f"p{i}": f"= p{i - 1} + 1" for i in range(1, 500)}}
        design = created(http, {"name": "chain", "parameters": parameters})
        assert design["state"] == "current"

    def test_a_ring_of_500_relations(self, http):
        parameters = {f"p{i}": f"= p{(i + 1) % 500} + 1" for i in range(500)}
        answer = post(http, DESIGNS, json.dumps({"name": "ring", "parameters": parameters}))
        assert "loop" in faults(answer).values()

    @pytest.mark.parametrize("body", [body for name, body in BODIES.items() if name != "nothing"])
    @pytest.mark.parametrize("action", ["", "/preview"])
    def test_a_patch_body(self, http, any_design, action, body):
        method = "POST" if action else "PATCH"
        place = f"{DESIGNS}/{any_design}{action}"
        answer = http.request(method, place, content=body, headers={**JSON, "If-Match": "*"}, timeout=HANG)
        assert faults(answer)

    @pytest.mark.parametrize("document", [d for d in DOCUMENTS.values() if set(d) - {"name"}])
    @pytest.mark.parametrize("action", ["", "/preview"])
    def test_a_patch(self, http, any_design, action, document):
        patch = {key: value for key, value in document.items() if key != "name"}
        method = "POST" if action else "PATCH"
        place = f"{DESIGNS}/{any_design}{action}"
        headers = {**JSON, "If-Match": "*"}
        assert faults(http.request(method, place, json=patch, headers=headers, timeout=HANG))

    @pytest.mark.parametrize("name", ["a\u0000b", "\u0000", "line\nbreak", "\u001b[31m"])
    def test_names_and_notes_have_no_control_characters(self, http, name):
        assert list(faults(post(http, DESIGNS, json.dumps({"name": name})))) == ["name"]


@pytest.fixture(scope="module")
def any_design(http):
    return created(http, {"name": "any", "parameters": {"a": "1"}})["id"]


class TestPaths:
    @pytest.mark.parametrize(
        "path",
        [
            "designs/%00",
            "designs/%ff",
            "designs/%ed%a0%80",
            "designs/" + "x" * 65,
            "designs/..%2f..%2fetc",
            "designs?limit=0",
            "designs?limit=501",
            "designs?limit=x",
            "designs?limit=99999999999999999999",
            "designs?cursor=" + "x" * 201,
            "jobs?limit=-1",
            "jobs/%00",
            "jobs/" + "x" * 5000,
            "builds/%00",
            "templates/%00",
            "templates/oil_film/versions/0",
            "templates/oil_film/versions/-1",
            "templates/oil_film/versions/1e3",
            "templates/oil_film/versions/99999999999999999999",
            "templates/oil_film/versions/x",
            "models/ball_bearing/versions/0x1",
            "models/moody/versions/" + "9" * 5000,
            "designs/x/revisions/0",
            "designs/x/revisions/" + "9" * 30,
            "designs/x/revisions?cursor=x",
            "designs/x/explain/" + "x" * 65,
            "designs/x/model.%00",
        ],
    )
    def test_out_of_range(self, http, path):
        answer = http.get(f"{API}/{path}", timeout=HANG)
        assert answer.status_code in (404, 422), answer.text
        assert answer.headers["content-type"] == "application/problem+json"

    @pytest.mark.parametrize("cursor", ["x", "-1", "%00", "9" * 200, "٣", "1e9"])
    @pytest.mark.parametrize("path", ["designs", "jobs", "templates", "models"])
    def test_a_strange_cursor(self, http, path, cursor):
        answer = http.get(f"{API}/{path}?cursor={cursor}", timeout=HANG)
        assert answer.status_code in (200, 422)

    @pytest.mark.parametrize(
        "headers",
        [
            {"If-Match": "\xff"},
            {"If-Match": "x" * 10_000},
            {"Idempotency-Key": "\xff\xfe"},
            {"Prefer": "wait=" + "9" * 5000},
            {"Accept": "/" * 5000},
        ],
    )
    def test_strange_headers(self, http, any_design, headers):
        raw = {"If-Match": "*", **headers}
        sent = {key: value.encode("latin-1") for key, value in raw.items()}
        answer = http.patch(f"{DESIGNS}/{any_design}", json={"name": "any"}, headers=sent, timeout=HANG)
        assert answer.status_code in (200, 412, 422)
