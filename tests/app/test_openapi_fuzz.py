"""Random designs never give a 5xx; test_interface_at_length.py tests the whole interface."""

import json

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from seeds import examples
from serving import API, HANG, created

QUICK = settings(
    max_examples=examples(60),
    database=None,
    phases=[Phase.explicit, Phase.generate],
    suppress_health_check=list(HealthCheck),
)
NAMES = st.sampled_from(["a", "b", "film", "model", "x", "__class__", "pi"])
UNITS = st.sampled_from(["mm", "kN", "1", "degC", "rpm", "m**9**9", "kg", "", "mm ** 2", "N*m"])
NUMBERS = st.one_of(
    st.integers(), st.floats(), st.sampled_from(["1", "-1", "1e999", "0", "1e-320", "NaN", "1.", ".5", "1_0"])
)
QUANTITIES = st.one_of(
    st.builds("{} {}".format, NUMBERS, UNITS),
    st.fixed_dictionaries({"value": NUMBERS, "unit": UNITS}),
    st.fixed_dictionaries({"value": st.lists(NUMBERS, max_size=3), "unit": UNITS}),
)
PIECES = ["a", "b", "film.speed", "model.mass", "model.size", "1", "48 mm", "2 kN", "+", "-", "*", "/", "**",
          "(", ")", "sqrt(", "exp(", "max(", ",", "pi", " ", "20 degC", "9", "m", "film.density",
          "model.torsion.stiffness", "model.bending.maximum_stress", "model.torsion.mass"]  # fmt: skip
RELATIONS = st.lists(st.sampled_from(PIECES), max_size=12).map(lambda pieces: "= " + " ".join(pieces))
JUNK = st.recursive(
    st.none() | st.booleans() | NUMBERS | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=6,
)
VALUES = st.one_of(
    QUANTITIES, RELATIONS, RELATIONS, JUNK, st.lists(st.one_of(QUANTITIES, RELATIONS), max_size=3)
)
INPUTS = ["radial_load", "diametral_clearance", "bearing_diameter", "speed", "temperature_1", "nothing"]
STEPS = st.fixed_dictionaries(
    {
        "template": st.sampled_from(["oil_film", "nothing"]),
        "inputs": st.dictionaries(st.sampled_from(INPUTS), VALUES),
    },
    optional={
        "version": st.sampled_from([1, "latest", 0, None]),
        "outputs": st.lists(st.sampled_from(["density"])),
    },
)
ANALYSES = st.dictionaries(
    st.sampled_from(["torsion", "bending", "twist"]),
    st.one_of(
        JUNK,
        st.fixed_dictionaries(
            {},
            optional={
                "level": st.sampled_from(["coarse", "fine", "none", None]),
                "tolerance": st.one_of(NUMBERS, st.none()),
                "boundary": st.sampled_from(["free_end", "guided_end", "welded"]),
            },
        ),
    ),
)
SIZES = st.sampled_from(["size", "wall", "inner_diameter", "diameter", "length"])
MODELS = st.fixed_dictionaries(
    {"id": st.sampled_from(["moody", "plain_bearing", "bar", "nothing"])},
    optional={"parameters": st.dictionaries(SIZES, VALUES), "analyses": st.one_of(ANALYSES, JUNK)},
)
THROUGH = st.sampled_from(["model.mass", "film.speed", "model.torsion.stiffness"])
DOCUMENTS = st.fixed_dictionaries(
    {},
    optional={
        "name": st.text(max_size=5),
        "parameters": st.one_of(st.dictionaries(NAMES, VALUES, max_size=4), JUNK),
        "steps": st.one_of(st.dictionaries(st.sampled_from(["film", "a"]), STEPS, max_size=2), JUNK),
        "model": st.one_of(MODELS, JUNK),
        "iterations": st.one_of(
            st.lists(
                st.fixed_dictionaries(
                    {
                        "through": st.sampled_from(["model.mass", "film.speed", "model.torsion.stiffness"]),
                        "start": VALUES,
                    }
                ),
                max_size=2,
            ),
            JUNK,
        ),
        "note": JUNK,
    },
)


def dumped(document):
    """JSON as loose as Python writes it, NaN and infinities included; surrogates escaped."""
    return json.dumps(document).encode("ascii")


def a_problem_or_fine(answer):
    assert answer.status_code < 500, answer.text
    if answer.status_code >= 400:
        content = answer.json()
        assert answer.headers["content-type"] == "application/problem+json"
        assert content["status"] == answer.status_code
        for fault in content.get("errors", ()):
            assert fault["name"]
            assert fault["code"]
            assert fault["detail"]


def try_design(http, patched, document):
    headers = {"Content-Type": "application/json", "Prefer": "respond-async", "If-Match": "*"}
    named = {"name": "random", **document}
    for method, path, body in (
        ("POST", f"{API}/designs", named),
        ("PATCH", f"{API}/designs/{patched}", document),
        ("POST", f"{API}/designs/{patched}/preview", document),
    ):
        answer = http.request(method, path, content=dumped(body), headers=headers, timeout=HANG)
        a_problem_or_fine(answer)
        if answer.status_code == 202:  # a solid that really can be built: seen, and taken away
            http.delete(answer.headers["location"])


@pytest.fixture(scope="module")
def target(http):
    document = {"name": "target", "parameters": {"a": "1"}, "model": {"id": "moody"}}
    return created(http, document)["id"]


@QUICK
@given(document=DOCUMENTS)
def test_designs(http, target, document):
    try_design(http, target, document)


@pytest.mark.slow
@settings(QUICK, max_examples=5000)
@given(document=DOCUMENTS)
def test_designs_at_length(http, target, document):
    try_design(http, target, document)
