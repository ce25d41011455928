"""Every request to `evaluate` gets an answer or a problem, never a server error."""

import json

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from serving import API, HANG

from app.calculations.bodies import OIL_FILM
from app.calculations.schemas.evaluations import Evaluation
from app.schemas.problems import MEDIA_TYPE, Problem

PLAIN, AS_JSON = f"{API}/templates/oil_film/versions/1/evaluate", {"Content-Type": "application/json"}

RAW = [
    b"", b" ", b"null", b"[]", b"{}", b"0", b'"x"', b"{", b'{"inputs": {}} x', b'\xef\xbb\xbf{"inputs": {}}',
    b'{"inputs": {"speed": "\xff"}}', b'{"inputs": {"speed": "\xed\xa0\x80"}}', b'{"inputs": {"\\ud800": 1}}',
    b'{"inputs": {"speed": "\\u0000"}}', b'{"inputs": {"speed": "\\\\u0000"}}',
    b'{"inputs": {"a\\u0000": 1}}',
    b'{"inputs": {"speed": NaN}}', b'{"inputs": {"speed": {"value": Infinity, "unit": "rpm"}}}',
    b'{"inputs": {"speed": {"value": -Infinity, "unit": "rpm"}}}', b'{"inputs": {}, "tolerance": NaN}',
    b'{"inputs": {"speed": {"value": 1e999, "unit": "rpm"}}}', b'{"inputs": {}, "tolerance": 1e-999}',
    b'{"inputs": {"speed": {"value": ' + b"9" * 400 + b', "unit": "rpm"}}}',
    b'{"inputs": {"speed": ' + b"9" * 5000 + b"}}", b'{"inputs": {"speed": 1}, "inputs": {}}',
    b'{"inputs": {"speed": "1 rpm", "speed": "2 rpm"}}', b'{"inputs": {}, "level": "none"}',
    b'{"inputs": ' + b"[" * 100 + b"]" * 100 + b"}", b'{"inputs": ' + b"[" * 5000 + b"]" * 5000 + b"}",
    b'{"a":' * 300 + b"1" + b"}" * 300, b'{"inputs": {}, "outputs": ["' + b"a" * 200 + b'"]}',
    b'{"inputs": {' + b",".join(b'"a%d": 1' % n for n in range(2500)) + b"}}", b"{" + b" " * 65_600 + b"}",
    b"'{}'", b"{'inputs': {}}", b'{"inputs": {"speed": "5000 rpm",}}', b"\x00", b"\x1f\x8b\x08\x00",
]  # fmt: skip
NUMBERS = st.integers() | st.floats() | st.sampled_from([0, -0.0, 1e308, 5e-324, 10**400, True])
TEXTS = st.sampled_from(
    ["25 kN", "0.05 mm", "5000 rpm", "80 degC", "-1 mm", "1e999 kN", "48 mm H7", "1 ± 2 rpm", ""]
)
JUNK = st.none() | st.booleans() | NUMBERS | TEXTS | st.text(max_size=6)
VALUES = st.recursive(
    JUNK | st.fixed_dictionaries({"value": NUMBERS | st.lists(NUMBERS, max_size=3), "unit": TEXTS}),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    max_leaves=5,
)
NAMES = st.sampled_from([*OIL_FILM, "nothing", "", "__class__"])
CHANGED = st.dictionaries(NAMES, VALUES, max_size=2)
INPUTS = st.builds(lambda some: {**OIL_FILM, **some}, CHANGED) | CHANGED
OUTPUTS = ["minimum_film_thickness", "density", "nothing"]
ASKED = st.fixed_dictionaries(
    {"inputs": st.just(OIL_FILM) | INPUTS},
    optional={
        "outputs": st.lists(st.sampled_from(OUTPUTS), max_size=3) | JUNK,
        "level": st.sampled_from(["numeric", "nothing"]) | JUNK,
        "tolerance": NUMBERS,
        "units": st.dictionaries(st.sampled_from(OUTPUTS), st.sampled_from(["um", "kN", ""])) | JUNK,
        "per_point": st.booleans() | JUNK,
        "limits": st.dictionaries(st.sampled_from(OUTPUTS), VALUES, max_size=1) | JUNK,
        "more": JUNK,
    },
)
RIGHT = json.dumps({"inputs": OIL_FILM}).encode()
BODIES = st.one_of(
    st.just(RIGHT),
    ASKED.map(lambda asked: json.dumps(asked).encode()),
    ASKED.map(lambda asked: json.dumps(asked, ensure_ascii=False).encode("utf-8", "surrogatepass")),
    st.sampled_from(RAW),
    st.binary(max_size=30),
)
OTHERS = ["transient_film", "nothing", "Oil_film", "oil%5ffilm", "o" * 65, "%00", "a%2fb"]
TEMPLATES = [*(7 * ["oil_film"]), *OTHERS]
VERSIONS = [*(10 * ["1"]), "01", "0", "-1", "999999", "1000000", "1.0", "latest", "%31", "1\u0661"]
ENDS = ["", "/", "?", "?units=us", "?units=none", "%20", "//"]
ODD_PATHS = st.builds(
    "{}/templates/{}/versions/{}/evaluate{}".format,
    st.just(API),
    st.sampled_from(TEMPLATES),
    st.sampled_from(VERSIONS),
    st.sampled_from(ENDS),
)
PATHS = st.integers(0, 9).flatmap(lambda number: ODD_PATHS if number == 0 else st.just(PLAIN))
TYPES = ["application/json", "Application/JSON", "application/json; charset=utf-8", "text/plain", ""]
NPY = "application/x-npy"
ACCEPTS = ["*/*", "application/json", NPY, f"text/html, {NPY}", NPY.upper(), "image/png", ""]
HEADERS = st.fixed_dictionaries(
    {"Content-Type": st.sampled_from([*(9 * TYPES[:1]), *TYPES])},
    optional={
        "Accept": st.sampled_from(ACCEPTS),
        "Prefer": st.sampled_from(["wait=5", "respond-async", "wait=x", "wait=-1"]),
        "Expect": st.just("100-continue"),
        "Accept-Encoding": st.sampled_from(["gzip", "identity", "*;q=0"]),
        "If-None-Match": st.just("*"),
        "Range": st.just("bytes=0-3"),
        "Origin": st.just("http://elsewhere.example"),
        "Idempotency-Key": st.just("once"),
        "X-Request-Id": st.sampled_from(["mine", "a b", "x" * 300]),
        "X-HTTP-Method-Override": st.just("DELETE"),
    },
)
OTHER_METHODS = ["GET", "HEAD", "OPTIONS", "PUT", "post", "TRACE"]
METHODS = st.sampled_from([*(60 * ["POST"]), *OTHER_METHODS])


def check(http, method, path, body, headers, in_pieces=False):
    """Send a request; its answer is an evaluation, an array, a job, or a problem."""
    content = iter([body[:7], body[7:]]) if in_pieces else body
    answer = http.request(method, path, content=content, headers=headers, timeout=HANG)
    assert answer.status_code < 500
    kind = answer.headers.get("Content-Type", "")
    if answer.status_code == 200 and kind == "application/json" and method == "POST":
        Evaluation.model_validate(answer.json())
    elif answer.status_code >= 400 and method != "HEAD":
        assert kind == MEDIA_TYPE
        assert Problem.model_validate(answer.json()).status == answer.status_code
    return answer


def search(count):
    return settings(
        max_examples=count,
        deadline=None,
        database=None,
        phases=[Phase.explicit, Phase.generate, Phase.shrink],
        suppress_health_check=list(HealthCheck),
    )


CASES = given(METHODS, PATHS, BODIES, HEADERS, st.integers(0, 9).map(lambda number: number == 0))


@search(60)
@CASES
def test_any_request(http, method, path, body, headers, in_pieces):
    check(http, method, path, body, headers, in_pieces)


@pytest.mark.slow
@search(2000)
@CASES
def test_any_request_at_length(http, method, path, body, headers, in_pieces):
    check(http, method, path, body, headers, in_pieces)


@pytest.mark.parametrize("body", RAW, ids=range(len(RAW)))
def test_hostile_bodies_are_refused(http, body):
    assert 400 <= check(http, "POST", PLAIN, body, AS_JSON).status_code < 500


VARIED = [
    *((PLAIN, {"Content-Type": kind}) for kind in TYPES),
    *((PLAIN, {**AS_JSON, "Accept": accept}) for accept in ACCEPTS),
    *((PLAIN + end, AS_JSON) for end in ENDS),
    *((PLAIN.replace("/1/", f"/{version}/"), AS_JSON) for version in VERSIONS[9:]),
    *((PLAIN.replace("oil_film", template), AS_JSON) for template in OTHERS),
]
STATUSES = [
    *(200, 200, 200, 415, 415),
    *(7 * [200]),
    *(200, 307, 200, 200, 200, 404, 307),
    *(200, 200, 422, 422, 404, 404, 200, 422, 200, 422),
    *(404, 404, 404, 200, 422, 404, 404),
]


@pytest.mark.parametrize("in_pieces", [False, True])
def test_a_right_request_but_for_one_thing(http, in_pieces):
    for (path, headers), status in zip(VARIED, STATUSES, strict=True):
        assert check(http, "POST", path, RIGHT, headers, in_pieces).status_code == status, (path, headers)
