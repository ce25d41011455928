"""A plain request to evaluate is answered past the framework; answers and errors are the same."""

import pytest
from serving import API

from app.calculations.bodies import OIL_FILM

EVALUATE = f"{API}/templates/oil_film/versions/1/evaluate"
GENERAL = {"units": "si"}
"""A query that means nothing here: such a request goes the general way."""


def both(http, body, path=EVALUATE, **options):
    """The answers of the two ways, without the time that each took."""
    answers = [http.post(path, json=body, **options), http.post(path, json=body, params=GENERAL, **options)]
    return [(one.status_code, _lasting(one), one.json() | {"seconds": 0}) for one in answers]


def _lasting(answer):
    changing = {"date", "x-request-id", "content-length"}
    return {name: value for name, value in answer.headers.items() if name.lower() not in changing}


@pytest.fixture
def served_generally(monkeypatch):
    """Count the requests that FastAPI's router answers."""
    from app.calculations.routes.evaluate import LargeRoute

    seen = []
    shortcut = LargeRoute.shortcut

    async def counted(self, request):
        seen.append(request.url.path)
        return await shortcut(self, request)

    monkeypatch.setattr(LargeRoute, "shortcut", counted)
    return seen


@pytest.mark.parametrize(
    "body",
    [
        {"inputs": OIL_FILM},
        {"inputs": OIL_FILM, "outputs": ["minimum_film_thickness"]},
        {"inputs": {**OIL_FILM, "radial_load": {"value": [10, 25, 1e5], "unit": "kN"}}},
        {"inputs": {**OIL_FILM, "speed": "5000 ± 10 rpm"}, "units": {"minimum_film_thickness": "inch"}},
    ],
)
def test_same_answers(http, body):
    express, general = both(http, body)
    assert express == general
    assert express[0] == 200


@pytest.mark.parametrize(
    "body",
    [
        {"inputs": {}},
        {"inputs": {**OIL_FILM, "radial_load": "25 mm"}},
        {"inputs": {**OIL_FILM, "bearing_width": "-1 mm"}, "outputs": ["none"]},
        {"inputs": OIL_FILM, "outputs": "minimum_film_thickness"},
        {"inputs": OIL_FILM, "more": 1},
        {"inputs": {**OIL_FILM, "radial_load": "25\0kN"}},
        [],
    ],
)
def test_same_refusals(http, body):
    ways = [http.post(EVALUATE, json=body, params=query) for query in ({}, GENERAL)]
    assert [way.status_code for way in ways] == [422, 422]
    first, second = (way.json() for way in ways)
    assert first.get("errors") == second.get("errors")
    assert (first["type"], first["detail"]) == (second["type"], second["detail"])


def test_a_plain_request_does_not_reach_the_router(http, served_generally):
    assert http.post(EVALUATE, json={"inputs": OIL_FILM}).status_code == 200
    assert served_generally == []


@pytest.mark.parametrize(
    ("headers", "query"),
    [
        ({"Content-Type": "application/json; charset=utf-8"}, {}),
        ({"Content-Type": "application/json", "Accept": "application/x-npy"}, {}),
        ({"Content-Type": "application/json"}, GENERAL),
    ],
)
def test_what_is_not_plain_goes_the_general_way(http, served_generally, headers, query):
    body = b'{"inputs": {"radial_load": "25 kN"}}'
    assert http.post(EVALUATE, content=body, headers=headers, params=query).status_code == 422
    assert served_generally == ["/api/v1/templates/oil_film/versions/1/evaluate"]


def test_a_body_in_pieces_goes_the_general_way(http, served_generally):
    pieces = iter([b'{"inp', b'uts": {}}'])
    answer = http.post(EVALUATE, content=pieces, headers={"Content-Type": "application/json"})
    assert answer.status_code == 422
    assert len(served_generally) == 1


def test_counted_by_its_route(http):
    def count():
        lines = http.get("/metrics").text.splitlines()
        route = 'route="/api/v1/templates/{id}/versions/{number}/evaluate"'
        figures = [line for line in lines if "_count" in line or "_total" in line]
        return sum(float(line.split()[-1]) for line in figures if route in line)

    before = count()
    http.post(EVALUATE, json={"inputs": OIL_FILM})
    assert count() > before


def test_other_methods_and_versions_are_as_before(http):
    assert http.get(EVALUATE).status_code == 405
    missing = http.post(f"{API}/templates/oil_film/versions/999/evaluate", json={"inputs": OIL_FILM})
    assert missing.status_code == 404
    assert missing.json()["type"].endswith("unknown-template")


def test_without_a_key_nothing_is_evaluated(team):
    with team.http() as http:
        assert http.post(EVALUATE, json={"inputs": OIL_FILM}).status_code == 401


def test_the_same_bytes_both_ways(http):
    body = {"inputs": OIL_FILM, "outputs": ["minimum_film_thickness"]}
    ways = [http.post(EVALUATE, json=body, params=query).content for query in ({}, GENERAL)]
    first, second = (way.partition(b',"seconds":')[0] for way in ways)
    assert first == second
    assert b'"minimum_film_thickness":{"value":3.24' in first


def test_a_plain_answer_is_put_together_from_prepared_parts(http, monkeypatch, served_generally):
    def unwanted(*given):
        raise AssertionError("not prepared")  # the router would answer then

    monkeypatch.setattr("app.api.express.run_evaluate", unwanted)
    assert http.post(EVALUATE, json={"inputs": OIL_FILM}).status_code == 200
    assert served_generally == []
