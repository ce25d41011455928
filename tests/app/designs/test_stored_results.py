"""Stored results are parsed once for equal texts; answers and digests are the same as without that."""

import hashlib

import pytest
from serving import API, created, patched

from app.calculations.bodies import OIL_FILM
from app.designs import repository, result_records
from app.designs.result_records import Results, results_of
from app.storage.tables import canonical_json


@pytest.fixture(scope="module")
def film(http):
    step = {"template": "oil_film", "version": 1, "inputs": OIL_FILM}
    return created(http, {"name": "a film", "steps": {"film": step}})


def answer(http, film, place):
    return http.get(f"{API}/designs/{film['id']}/{place}").raise_for_status().json()


def test_an_answer_is_the_same_from_what_is_kept(http, film):
    kept = answer(http, film, "revisions/1")
    result_records._kept.clear()
    assert answer(http, film, "revisions/1") == kept
    assert kept["steps"]["film"]["outputs"]["minimum_film_thickness"]["value"] > 0


def test_a_changed_design_has_its_own_results(http, film):
    change = {"steps": {"film": {"inputs": {"radial_load": "31 kN"}}}}
    newer = patched(http, film, change)
    old, new = (answer(http, film, f"revisions/{n}") for n in (newer["revision"] - 1, newer["revision"]))
    assert new["steps"]["film"]["inputs"]["radial_load"]["value"] == 31
    assert old["steps"]["film"]["outputs"] != new["steps"]["film"]["outputs"]


def test_the_digest_to_sign_is_that_of_the_stored_results(served, http, film):
    with served.app.state.services.database.read() as session:
        row = repository.lean(session, film["id"], 1)
        kept = results_of(session, row).digest
        assert kept == hashlib.sha256(canonical_json(row.results).encode()).hexdigest()
    assert answer(http, film, "revisions/1/approvals")["present"]["results"] == kept


def test_equal_texts_are_read_once(served, film, monkeypatch):
    with served.app.state.services.database.read() as session:
        row = repository.lean(session, film["id"], 1)
        first = results_of(session, row)
        assert first.steps["film"].outputs
        monkeypatch.setattr(result_records, "_read", lambda text: pytest.fail("it was read again"))
        assert results_of(session, row) is first


def test_what_is_kept_is_bounded():
    size = result_records._kept.getsizeof
    assert size(Results("x" * 100, {}, {}, [], {})) == 100
    assert result_records._kept.maxsize == result_records.KEPT


def test_revisions_are_listed_without_their_steps(http, film):
    whole = answer(http, film, "revisions")["items"]
    short = answer(http, film, "revisions?steps=false")["items"]
    assert len(short) == len(whole)
    for one, other in zip(short, whole, strict=True):
        assert one["steps"] == one["models"] == {}
        assert "criteria" not in one
        heading = {name: value for name, value in other.items() if name in one}
        assert {**heading, "steps": {}, "models": {}, "iterations": []} == one
