"""A study loses and doubles nothing if its service is killed at random moments, and its bytes stay the same.

The moments are uniform over what the studies have to do: solids that are built and chunks that are recorded.
So the last kill, like the first, meets a study that runs.
"""

import json
import os
import random

import pytest
from click.testing import CliRunner
from patience import patient, until
from serving import ServerProcess, folder_of_models
from study_helpers import (
    OUT,
    TWICE,
    begun,
    chunks,
    connected,
    content,
    done,
    ended,
    new_design,
    queried,
)

from app.cli.main import main

KILLS = int(os.environ.get("CRANKWRIGHT_TEST_KILLS", "10"))
SEED = int(os.environ.get("CRANKWRIGHT_TEST_SEED", "14"))
VARY = {"length": {"between": ["0 mm", "10 mm"]}}
SAMPLE = {"method": "sample", "points": 1_000_000, "vary": VARY, "outputs": [OUT]}
SAMPLES = [{**SAMPLE, "seed": seed} for seed in range(5)]
SEARCH = {"method": "optimise", "vary": VARY, "minimise": [OUT], "hold": ["long_enough"]}
HELD = {**TWICE, "criteria": {"long_enough": {"require": f"{OUT} >= 5 mm"}}}
CUBES = {
    **TWICE,
    "parameters": {"size": "9 mm", "extra": "1 mm", "length": "= size + extra + cube.mass * 1 mm/kg"},
    "models": {"cube": {"id": "moody", "version": 1, "parameters": {"size": "= size"}}},
}
SIZES = [10 + number / 8 for number in range(max(160, 3 * KILLS))]
SOLIDS = {
    "method": "grid",
    "vary": {
        "size": {"values": [f"{size} mm" for size in SIZES]},
        "extra": {"between": ["0 mm", "1 mm"]},
    },
    "steps": 400,
    "outputs": [OUT, "cube.mass"],
}
REST = {"template": "double", "version": 1, "inputs": {"length": "= 10 mm - length"}}
PAIR = {**HELD, "steps": {**TWICE["steps"], "rest": REST}}
FRONT = {**SEARCH, "minimise": [OUT, "rest.twice_the_length"]}
STUDIES = {"rows": (HELD, [*SAMPLES, SEARCH]), "front": (PAIR, [FRONT]), "solids": (CUBES, [SOLIDS])}


def work_done(data):
    """How many solids are built and chunks recorded."""
    (count,) = queried(data, "SELECT (SELECT count(*) FROM build) + (SELECT count(*) FROM study_chunk)")[0]
    return count


def unfinished(data):
    query = "SELECT count(*) FROM study WHERE state IN ('queued', 'running')"
    return queried(data, query)[0][0]


def served(data, own):
    return ServerProcess(data, CRANKWRIGHT_TEMPLATE_FOLDERS=json.dumps([str(own)])).start().ready()


def undisturbed(data, own, document, bodies):
    """The results of the studies without a kill, and the work before and after them."""
    server = served(data, own)
    with connected(server.url) as http:
        design = new_design(http, document)
        until(lambda: http.get(f"/api/v1/designs/{design['id']}").json()["state"], lambda s: s == "current")
        before = work_done(data)
        studies = [done(http, design, **body) for body in bodies]
        results = [(study.get("result"), content(http, study, "npz")) for study in studies]
    assert server.stop() == 0
    return results, [chunks(data, study) for study in studies], before, work_done(data)


@pytest.mark.slow
@pytest.mark.parametrize("name", STUDIES)
def test_kill_9_at_random_moments(tmp_path, name):
    document, bodies = STUDIES[name]
    own = folder_of_models(tmp_path / "own")
    references, recorded, before, after = undisturbed(tmp_path / "reference", own, document, bodies)
    chance, data = random.Random(SEED), tmp_path / "data"
    moments = sorted(chance.randrange(before, after) for _ in range(KILLS))
    server, met = served(data, own), 0
    with connected(server.url) as http:
        design = new_design(http, document)
        until(lambda: http.get(f"/api/v1/designs/{design['id']}").json()["state"], lambda s: s == "current")
        studies = [begun(http, design, **body) for body in bodies]
        for moment in moments:
            until(lambda moment=moment: work_done(data) >= moment, bool, patient(120))
            met += unfinished(data) > 0
            server.kill()
            server.start().ready()
        ends = [ended(http, study) for study in studies]
        for end, (result, npz) in zip(ends, references, strict=True):
            assert end["state"] == "done", end
            assert end.get("result") == result
            assert content(http, end, "npz") == npz
    assert server.stop() == 0
    # between two looks, the last rows may be recorded
    assert met >= 0.9 * KILLS, f"{met} of {KILLS}, seed {SEED}"
    assert [chunks(data, study) for study in studies] == recorded
    assert work_done(data) == after
    assert CliRunner().invoke(main, ["check", "--data", str(data)]).exit_code == 0
