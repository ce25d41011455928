"""A study continues after its server stopped: no row is lost or doubled, and the bytes are equal."""

import pytest
from patience import patient, until
from serving import API, folder_of_models, serving
from study_helpers import OUT, TWICE, begun, chunks, connected, content, done, ended, new_design

from app.settings import Settings

DESIGN = {**TWICE, "criteria": {"long_enough": {"require": f"{OUT} >= 5 mm"}}}
VARY = {"length": {"between": ["0 mm", "10 mm"]}}
SAMPLE = {"method": "sample", "points": 800_000, "vary": VARY, "outputs": [OUT]}
SEARCH = {"method": "optimise", "vary": VARY, "minimise": [OUT], "hold": ["long_enough"]}


@pytest.mark.slow
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
