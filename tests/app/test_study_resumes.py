"""A study goes on after its server stopped or was killed: no row is lost or doubled, same bytes."""

import json
import os
import random

import httpx
import pytest
from patience import patient, until
from serving import API, ServerProcess, folder_of_models, serving
from sqlalchemy import create_engine, text
from study_helpers import OUT, TWICE, begun, content, done, ended, new_design

from app.settings import Settings

DESIGN = {**TWICE, "criteria": {"long_enough": {"require": f"{OUT} >= 5 mm"}}}
VARY = {"length": {"between": ["0 mm", "10 mm"]}}
SAMPLE = {"method": "sample", "points": 800_000, "vary": VARY, "outputs": [OUT]}
KILLS = int(os.environ.get("CRANKWRIGHT_TEST_KILLS", "10"))
SEARCH = {"method": "optimise", "vary": VARY, "minimise": [OUT], "hold": ["long_enough"]}


def chunks(data, study):
    """The chunks as they were recorded: (number, rows, sha256)."""
    engine = create_engine(f"sqlite:///{data}/crankwright.sqlite")
    query = "SELECT number, rows, sha256 FROM study_chunk WHERE study_id = :id ORDER BY number"
    with engine.connect() as connection:
        recorded = [tuple(row) for row in connection.execute(text(query), {"id": study["id"]})]
    engine.dispose()
    return recorded


def connected(url):
    return httpx.Client(base_url=url, timeout=90, trust_env=False)


def test_a_stopped_study_goes_on_with_the_same_bytes(tmp_path):
    settings = Settings(data=tmp_path / "data", template_folders=(folder_of_models(tmp_path / "own"),))
    hasty = settings.model_copy(update={"drain_seconds": 0.5})  # the stop lets no job end
    with serving(hasty) as server, connected(server.url) as http:
        design = new_design(http, DESIGN)
        undisturbed, searched = done(http, design, **SAMPLE), done(http, design, **SEARCH)
        searching, disturbed = begun(http, design, **SEARCH), begun(http, design, **SAMPLE)
        until(lambda: http.get(f"{API}/studies/{disturbed['id']}").json()["done"], bool, patient(60))
    before = chunks(settings.data, disturbed)
    assert 0 < len(before) < len(chunks(settings.data, undisturbed))
    with serving(settings) as server, connected(server.url) as http:
        again, found = ended(http, disturbed), ended(http, searching)
        assert again["state"] == "done"
        assert content(http, again, "npz") == content(http, undisturbed, "npz")
        assert found["result"] == searched["result"]
    after = chunks(settings.data, disturbed)
    assert after[: len(before)] == before
    assert after == chunks(settings.data, undisturbed)
    assert sum(rows for _, rows, _ in after) == SAMPLE["points"]
    assert len(chunks(settings.data, searching)) > 1
    assert chunks(settings.data, searching) == chunks(settings.data, searched)


@pytest.mark.slow
def test_kill_9_at_random_moments(tmp_path):
    moments, data = random.Random(14), tmp_path / "data"
    folders = json.dumps([str(folder_of_models(tmp_path / "own"))])
    server = ServerProcess(data, CRANKWRIGHT_TEMPLATE_FOLDERS=folders).start().ready()
    with connected(server.url) as http:
        design = new_design(http, DESIGN)
        references = done(http, design, **SAMPLE), done(http, design, **SEARCH)
        studies = begun(http, design, **SAMPLE), begun(http, design, **SEARCH)
        most = len(chunks(data, references[0]))
        for _ in range(KILLS):
            wanted = min(most, len(chunks(data, studies[0])) + moments.randint(0, 5))
            until(lambda least=wanted: len(chunks(data, studies[0])) >= least, bool, patient(120))
            server.kill()
            server.start().ready()
        ends = [ended(http, study) for study in studies]
        for end, reference in zip(ends, references, strict=True):
            assert end["state"] == "done", end
            assert end.get("result") == reference.get("result")
            assert content(http, end, "npz") == content(http, reference, "npz")
    assert server.stop() == 0
    for study, reference in zip(studies, references, strict=True):
        recorded = chunks(data, study)
        assert recorded == chunks(data, reference)
        assert [number for number, _, _ in recorded] == list(range(len(recorded)))
