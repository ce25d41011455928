"""When a study is cancelled, the process of its build is killed and the job is cancelled."""

import httpx
import pytest
from patience import until
from serving import API, alive, serving

from app.settings import Settings

ENDLESS = """
\"\"\"A block whose build says which process it is in, and never ends.\"\"\"

import os
from pathlib import Path

from cad.model import Box, CadModel, mm
from templates.core.language.template import Array, given


class Endless(CadModel):
    \"\"\"A block whose build says which process it is in, and never ends.\"\"\"

    example = {{"size": "10 mm"}}

    a: Array = given("mm", "size", gt=0, le=1000)

    def build(self):
        (Path({folder!r}) / str(os.getpid())).touch()
        while True:
            pass

    def bounding_box(self):
        return Box((0, 0, 0), (mm(self.a),) * 3)

    def dimensions(self, seen):
        return {{}}
"""
DEADLINE = 3600.0  # of a build, far beyond the patience of this test [s]
ROWS = {"part.size": {"value": [11, 12, 13], "unit": "mm"}}


@pytest.fixture(scope="module")
def begun_builds(tmp_path_factory):
    """The folder in which builds leave the ids of their processes."""
    return tmp_path_factory.mktemp("begun")


@pytest.fixture(scope="module")
def http(tmp_path_factory, begun_builds):
    folder = tmp_path_factory.mktemp("cancelled")
    (folder / "own").mkdir()
    (folder / "own" / "endless_v1.py").write_text(ENDLESS.format(folder=str(begun_builds)).lstrip())
    settings = Settings(data=folder / "data", template_folders=(folder,), job_deadline=DEADLINE)
    with serving(settings) as served, httpx.Client(base_url=served.url, timeout=90, trust_env=False) as http:
        yield http


def processes(folder):
    """The processes in which builds have begun."""
    return {int(path.name) for path in folder.iterdir()}


@pytest.fixture
def design(http, begun_builds):
    """A design of a block; the build of its own block was cancelled."""
    before = processes(begun_builds)
    part = {"id": "endless", "version": 1, "parameters": {"size": "10 mm"}}
    document = {"name": "endless", "models": {"part": part}}
    answer = http.post(f"{API}/designs", json=document, headers={"Prefer": "respond-async"})
    assert answer.status_code == 202, answer.text
    (own,) = until(lambda: processes(begun_builds) - before)
    http.delete(answer.headers["Location"]).raise_for_status()
    until(lambda: not alive(own))
    return answer.json()


@pytest.mark.parametrize("by", ["study", "job"])
@pytest.mark.sampled(1)
def test_the_build_of_a_cancelled_study_is_killed(http, begun_builds, design, by):
    before = processes(begun_builds)
    body = {"design": design["id"], "method": "table", "rows": ROWS, "outputs": ["part.mass"]}
    answer = http.post(f"{API}/studies", json=body)
    assert answer.status_code == 202, answer.text
    study = answer.json()
    (builder,) = until(lambda: processes(begun_builds) - before)
    assert alive(builder)
    place = f"{API}/studies/{study['id']}"
    assert http.delete(place if by == "study" else study["job"]).is_success
    until(lambda: not alive(builder))
    job = until(lambda: http.get(study["job"]).json(), lambda job: job["state"] != "running")
    assert job["state"] == "cancelled"
    shown = http.get(place).json()
    assert (shown["state"], shown["done"]) == ("cancelled", 0)
    assert processes(begun_builds) - before == {builder}, "no further solid is begun"
