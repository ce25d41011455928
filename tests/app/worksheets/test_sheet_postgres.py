"""Worksheets on PostgreSQL: two servers on one database see each other's releases and never both succeed."""

from concurrent.futures import ThreadPoolExecutor

import httpx
import pytest
from patience import until
from serving import API, PATIENCE, serving
from sheets import BUSH, WIDER, drafted, edited, place, released, reviewed, step
from test_migrations import differences

from app.settings import Settings
from app.storage.engines import migrating_engine
from app.storage.migrations import migrate

INPUTS = {"radial_load": "20 kN", "bearing_diameter": "50 mm"}


@pytest.fixture(scope="module")
def both(postgres, tmp_path_factory):
    """Two servers on one database."""
    folder = tmp_path_factory.mktemp("servers")
    shared = {"database_url": postgres, "artifacts_url": f"file://{folder}/artifacts"}
    one, other = (Settings(data=folder / name, **shared) for name in ("one", "other"))
    with serving(one) as first, serving(other) as second:
        with asking(first.url) as here, asking(second.url) as there:
            yield here, there


def asking(url):
    return httpx.Client(base_url=url, timeout=PATIENCE, trust_env=False)


def test_the_migrated_schema_is_the_declared_one(postgres):
    migrate(postgres)
    engine = migrating_engine(postgres)
    assert differences(engine) == []
    engine.dispose()


@pytest.mark.slow
def test_a_release_of_one_server_is_a_template_of_the_other(both):
    here, there = both
    sheet = released(here, id="shared")
    path = f"{API}/templates/{sheet['id']}/versions/1"
    until(lambda: there.get(path), lambda answer: answer.status_code == 200)
    answer = there.post(f"{path}/evaluate", json={"inputs": INPUTS}).json()
    assert answer["outputs"]["finished_bore"]["value"] == pytest.approx(50.05)
    step(there, sheet["id"], "withdraw", reason="wrong")
    until(lambda: here.get(path).json()["status"], lambda status: status == "withdrawn")


def test_one_id_is_given_once(both):
    body = {"id": "wanted", "text": BUSH}
    with ThreadPoolExecutor(8) as pool:
        sent = [pool.submit(one.post, f"{API}/worksheets", json=body) for one in both * 4]
        statuses = sorted(answer.result().status_code for answer in sent)
    assert statuses == [201] + [409] * 7


def test_one_of_two_edits_wins(both):
    here, there = both
    sheet = drafted(here, id="raced")
    headers = {"If-Match": f'"{sheet["edit"]}"'}
    texts = [BUSH.replace("0.05", f"0.0{number}") for number in range(1, 9) if number != 5]
    with ThreadPoolExecutor(8) as pool:
        edits = [
            pool.submit(one.patch, place("raced"), json={"text": text}, headers=headers)
            for one, text in zip(both * 4, texts, strict=False)
        ]
        statuses = sorted(edit.result().status_code for edit in edits)
    assert statuses == [200] + [412] * (len(texts) - 1)
    assert there.get(place("raced")).json() == here.get(place("raced")).json()


def test_one_of_two_next_versions_wins(both):
    here, there = both
    sheet = released(here, id="next")
    headers = {"If-Match": f'"{sheet["edit"]}"'}
    with ThreadPoolExecutor(2) as pool:
        edits = [
            pool.submit(one.patch, place("next"), json={"text": WIDER + "// x" * n}, headers=headers)
            for n, one in enumerate(both)
        ]
        statuses = sorted(edit.result().status_code for edit in edits)
    assert statuses == [200, 412]
    assert len(here.get(place("next")).json()["versions"]) == 2
    again = reviewed(there, "next")
    assert edited(here, again, WIDER + "// end")["state"] == "draft"
