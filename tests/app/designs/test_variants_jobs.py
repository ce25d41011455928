"""Variants whose revision is completed by a job: deferred steps, refusals in the job, kill -9, retention."""

import io
import random
import time
import zipfile

import httpx
import pytest
from patience import until
from serving import API, ServerProcess, created, folder_of_models, moody, patched, serving, settled
from sleeping import folder_of_sleeper

from app.designs import repository
from app.designs.repository import StoredRevision
from app.designs.results import ModelState
from app.retention import rows
from app.settings import Settings
from app.solids import rows as solids
from app.storage.clock import DAY
from cad.inspect import look_at
from cad.step import read_step
from cad.surfaces import Z

DESIGNS = f"{API}/designs"
AT_ONCE = {"Prefer": "respond-async"}


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    folder = tmp_path_factory.mktemp("variants")
    own = folder_of_models(folder / "models")
    folder_of_sleeper(own / "sleeper")
    settings = Settings(
        data=folder / "data", template_folders=(own,), calculation_processes=1, calculation_deadline=1.5
    )
    with serving(settings) as server:
        server.app.state.services.calculations.submit("tests", time.monotonic).future.result(60)
        yield server


@pytest.fixture(scope="module")
def http(served):
    with httpx.Client(base_url=served.url, timeout=90, trust_env=False) as http:
        yield http


def table(http, design):
    out = http.get(f"{DESIGNS}/{design['id']}/variants", params={"output": "s.process"}).json()
    return {row["name"]: row for row in out["rows"]}


def sleeping(**variants):
    step = {"template": "sleeper", "version": 1, "inputs": {"duration": "0.01 s"}}
    return {"name": "sleeping", "steps": {"s": step}, "variants": variants}


class TestDeferredSteps:
    def test_a_save_that_does_not_wait_is_completed_by_a_job(self, http):
        variants = {f"v{number}": {"s.duration": f"0.0{number} s"} for number in range(2, 9)}
        answer = http.post(DESIGNS, json=sleeping(**variants), headers=AT_ONCE)
        assert answer.status_code == 202, answer.text
        assert answer.json()["state"] == "regenerating"
        design = settled(http, answer.json()["id"])
        assert design["state"] == "current"
        for row in table(http, design).values():
            assert row["state"] == "current"
            assert row["outputs"]["s.process"]["value"] > 0

    def test_a_refusal_in_the_job_is_that_variants_own(self, http):
        document = sleeping(good={"s.duration": "0.02 s"}, bad={"s.mood": "refuses"})
        answer = http.post(DESIGNS, json=document, headers=AT_ONCE)
        design = settled(http, answer.json()["id"])
        assert design["state"] == "current"
        out = table(http, design)
        assert {name: row["state"] for name, row in out.items()} == {"bad": "failed", "good": "current"}
        assert out["bad"]["problem"]["errors"][0]["name"] == "variants.bad.s.mood"


class TestPreview:
    def test_its_verdict_is_that_of_the_worst_variant(self, http):
        variants = {"large": {"model.size": "20 mm"}}
        criteria = {"small": {"require": "model.size <= 15 mm"}}
        design = created(http, moody("11 mm", variants=variants, criteria=criteria))
        ask = lambda patch: http.post(f"{DESIGNS}/{design['id']}/preview", json=patch)  # noqa: E731
        assert ask({}).json()["criteria"][0]["where"] == {"variant": "large"}
        fits = ask({"variants": {"large": {"model.size": "12 mm"}}}).json()
        assert fits["verdict"]["verdict"] == "met"
        wrong = ask({"variants": {"large": {"model.size": "12"}}})
        assert [fault["name"] for fault in wrong.json()["errors"]] == ["variants.large.model.size"]

    def test_a_comparison_names_what_was_overridden(self, http):
        design = created(http, moody("11 mm", variants={"a": {"model.size": "12 mm"}}))
        changed = patched(http, design, {"variants": {"a": {"model.size": "13 mm"}}})
        compared = http.get(f"{DESIGNS}/{changed['id']}/compare").json()
        assert compared["parameters"] == [{"name": "variants.a.model.size", "old": "12 mm", "new": "13 mm"}]


def side_of(step):
    """The height of a block in a STEP file [mm]."""
    (seen,) = look_at(read_step(step)).values()
    return seen.length(Z)


@pytest.mark.slow
@pytest.mark.parametrize("kills", [1, 4])
def test_kills_lose_no_solid_and_build_none_twice(tmp_path, kills):
    """A server is killed while it builds the variants of a design; the next one completes the revision."""
    environment = {"CRANKWRIGHT_TEMPLATE_FOLDERS": f'["{folder_of_models(tmp_path)}"]'}
    sizes = {f"block_{number}": 10 + number // 2 for number in range(12)}  # two and two share a solid
    variants = {name: {"model.size": f"{size} mm"} for name, size in sizes.items()}
    chance = random.Random(5)
    server = ServerProcess(tmp_path / "data", **environment).start().ready()
    try:
        with httpx.Client(base_url=server.url, timeout=30, trust_env=False) as http:
            document = moody("30 mm", variants=variants)
            design = http.post(DESIGNS, json=document, headers=AT_ONCE).json()
            for _ in range(kills):
                time.sleep(chance.uniform(0.05, 1.0))  # a moment by chance; nothing waits for it
                server.kill()
                server.start().ready()
            assert settled(http, design["id"], 120)["state"] == "current"
            out = http.get(f"{DESIGNS}/{design['id']}/variants").json()
            builds = {row["models"]["model"]["build"] for row in out["rows"]}
            assert {row["state"] for row in out["rows"]} == {"current"}
            assert len(builds) == 6
            content = http.get(f"{DESIGNS}/{design['id']}/variants.zip").content
            archive = zipfile.ZipFile(io.BytesIO(content))
            for name, size in sizes.items():
                step = archive.read(f"block_{name}_r1.step")
                assert side_of(step) == pytest.approx(size, abs=1e-9), name
            jobs = http.get(f"{API}/jobs", params={"limit": 500}).json()["items"]
            assert [job["state"] for job in jobs] == ["done"]
    finally:
        server.kill()


def test_a_cancelled_job_leaves_no_half_of_a_table(http):
    variants = {f"v{number}": {"model.size": f"{40 + number} mm"} for number in range(20)}
    answer = http.post(DESIGNS, json=moody("39 mm", variants=variants), headers=AT_ONCE)
    http.delete(answer.headers["location"])
    design = until(
        lambda: http.get(f"{DESIGNS}/{answer.json()['id']}").json(), lambda d: d["state"] != "regenerating"
    )
    out = http.get(f"{DESIGNS}/{design['id']}/variants").json()
    assert design["state"] == out["state"] == "failed"
    assert {row["state"] for row in out["rows"]} == {"failed"}
    assert all(row["criteria"] == [] for row in out["rows"] if "criteria" in row)


def test_solids_of_variants_are_kept(database):
    """A build that only a variant uses is wanted."""

    def unit(session):
        for key in ("used", "unused"):
            solids.add_build(session, key, "moody", 1, {}, {}, "recipe 3")
        model = ModelState("a.model", "moody", 1, {}, {}, (), "used")
        document = {"name": "x", "models": {"model": {}}}
        repository.create(session, "x", StoredRevision(document, None, [model], "current", None))

    database.write(unit)
    with database.read() as session:
        assert rows.unwanted_builds(session, -10 * DAY, "", 10) == ["unused"]
