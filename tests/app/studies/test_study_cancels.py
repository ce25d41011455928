"""A cancelled study ends its calculations and stores no further chunk."""

import pytest
from patience import until
from serving import API, problem
from study_helpers import CLEARANCE, FILM, LOSS, OUT, TWICE, begun, ended, new_design

from app.studies import repository

SAMPLE = {
    "method": "sample",
    "points": 1_000_000,
    "vary": {"length": {"between": ["0 mm", "10 mm"]}},
    "outputs": [OUT],
}
SEARCH = {
    "method": "optimise",
    "vary": {**CLEARANCE, "width": {"between": ["14 mm", "24 mm"]}},
    "minimise": [LOSS],
    "hold": ["thick_enough"],
}


def chunks(served, study):
    with served.app.state.services.database.read() as session:
        return [chunk.number for chunk in repository.chunks(session, study["id"])]


def own_calculations(served, study):
    """The calculations of a study that wait or run."""
    pool = served.app.state.services.calculations
    return [c for c in (*pool._queue, *pool._active) if c.client == f"study:{study['id']}"]


@pytest.mark.parametrize("by", ["study", "job"])
@pytest.mark.parametrize(("document", "body"), [(TWICE, SAMPLE), (FILM, SEARCH)], ids=["sample", "optimise"])
@pytest.mark.sampled(1)
def test_a_cancelled_study_keeps_no_further_chunk(served, http, document, body, by):
    study = begun(http, new_design(http, document), **body)
    place = f"{API}/studies/{study['id']}"
    until(lambda: own_calculations(served, study) and chunks(served, study))
    answer = http.delete(place if by == "study" else study["job"])
    assert answer.is_success, answer.text
    kept = chunks(served, study)  # the answer has come: from here on nothing is recorded
    assert http.get(place).json()["state"] == "cancelled"
    until(lambda: not own_calculations(served, study))
    assert chunks(served, study) == kept
    shown = http.get(place).json()
    assert (shown["state"], shown["problem"]["type"].rpartition("/")[2]) == ("cancelled", "cancelled")
    assert http.delete(place).status_code == 204
    problem(http.get(place), 404, "not-found")


@pytest.mark.slow
def test_a_study_that_waits_is_cancelled_before_it_has_rows(served, http):
    """More studies than there are threads for them: the last one waits."""
    design = new_design(http, TWICE)
    studies = [begun(http, design, **SAMPLE) for _ in range(6)]
    last = studies[-1]
    assert http.delete(f"{API}/studies/{last['id']}").json()["state"] == "cancelled"
    kept = chunks(served, last)
    for study in studies[:-1]:
        http.delete(f"{API}/studies/{study['id']}")
    until(lambda: not any(own_calculations(served, study) for study in studies))
    assert chunks(served, last) == kept


def test_a_study_whose_job_is_cancelled_is_cancelled(http):
    study = begun(http, new_design(http, TWICE), **SAMPLE)
    assert http.delete(study["job"]).status_code == 200
    now = ended(http, study)
    assert (now["state"], now["problem"]["type"]) == ("cancelled", "/problems/cancelled")
