"""Limits of a principal where they apply: queued jobs, and everything that counts as stored."""

import sys
from pathlib import Path

import pytest
from patience import until
from serving import API, created, problem
from sheets import BUSH, WIDER, drafted, edited, fresh
from study_helpers import OUT, TWICE, done

from app.client import Client
from app.identity.principal import Principal, acting_as
from app.identity.service import Changes

sys.path.append(str(Path(__file__).parents[1] / "worksheet_import"))  # mathcad_files
from mathcad_files import define, math, prime, scale

BAR = {"parameters": {"diameter": "27 mm", "length": "43 mm"}, "level": "coarse", "outputs": ["surface"]}
WAIT = {"Prefer": "wait=60"}
MIB = 2**20


class Person:
    """An author with a key, who has used nothing yet."""

    def __init__(self, team):
        self.team, self.name = team, fresh("limited")
        self.id = team.identity.add(self.name, ["author"]).id
        self.key = team.identity.add_key(self.id)[0].text

    def http(self):
        return self.team.http(headers={"Authorization": f"Bearer {self.key}"})

    def limited(self, **limits):
        self.team.identity.change(self.id, Changes(limits=limits))

    @property
    def stored(self):
        return self.team.identity.usage(self.id)[0].bytes


@pytest.fixture
def person(team):
    with acting_as(Principal("test", "test", "service", frozenset({"admin"}))):
        yield Person(team)


@pytest.fixture
def http(person):
    with person.http() as http:
        yield http


def wait_for_nothing(person, count):
    """Jobs of a person, of a kind that nothing runs."""
    services = person.team.server.app.state.services
    client = f"principal:{person.id}"
    return [
        services.database.write(
            lambda session, n=n: services.jobs.enqueue(session, "of_no_kind", {"n": n}, client=client)
        )
        for n in range(count)
    ]


def test_jobs_that_wait_are_limited_by_principal_and_the_answer_says_what_to_do(person, http):
    person.limited(queued_jobs=2)
    waiting = wait_for_nothing(person, 2)
    build = {"parameters": {"inner_diameter": "46.5 mm"}}
    place = f"{API}/models/plain_bearing/versions/1/build"
    answer = http.post(place, json=build)
    refused = problem(answer, 429, "queue-full")
    assert int(answer.headers["retry-after"]) > 0
    assert "2 jobs of yours" in refused["detail"]
    assert "cancel some" in refused["detail"]
    with Client(person.team.server.url, key=person.key) as client:
        usage = client.me().usage
    assert (usage.queued_jobs, usage.limits.queued_jobs) == (2, 2)
    for job in waiting:
        assert http.delete(f"{API}/jobs/{job}").is_success
    assert http.post(place, json=build, headers=WAIT).is_success


def test_the_page_of_the_account_shows_what_waits_and_what_counts(person, http):
    [job] = wait_for_nothing(person, 1)
    page = http.get("/account", headers={"Accept": "text/html"}).text
    assert '<tr><th scope="row">Waiting jobs</th><td>1</td><td>50</td></tr>' in page
    assert "rows of studies" in page
    http.delete(f"{API}/jobs/{job}")


def test_the_text_of_a_worksheet_counts_with_what_edits_add(person, http):
    sheet = drafted(http, BUSH)
    assert person.stored == len(BUSH.encode())
    longer = WIDER + "# said at more length\n"
    sheet = edited(http, sheet, longer)
    assert person.stored == len(longer.encode())
    edited(http, sheet, BUSH)  # what is deleted stays counted
    assert person.stored == len(longer.encode())


def test_an_imported_file_counts(person, http):
    content = prime(math(define("x", scale(321, "mm"))))
    query, kind = {"id": fresh("counted"), "file": "x.mcdx"}, {"Content-Type": "application/octet-stream"}
    job = http.post(f"{API}/worksheets/import", params=query, content=content, headers=kind)
    until(lambda: http.get(job.headers["location"]).json()["state"] == "done")
    text = http.get(f"{API}/worksheets/{query['id']}/text").content
    assert person.stored == len(content) + len(text)


def test_rows_of_a_study_and_the_table_that_is_given_count(person, http):
    design = created(http, TWICE)
    done(http, design, method="grid", vary={"length": {"between": ["1 mm", "3 mm"]}}, steps=4, outputs=[OUT])
    of_rows = person.stored
    assert of_rows > 0
    rows = {"length": [f"{n} mm" for n in range(1, 6)]}
    done(http, design, method="table", rows=rows, outputs=[OUT])
    assert person.stored > 2 * of_rows  # the table, and its rows


@pytest.mark.slow
def test_a_surface_counts_once(person, http):
    place = f"{API}/models/bar/versions/1/analyses/torsion"
    answer = http.post(place, json=BAR, headers=WAIT).json()
    build = http.get(f"{API}/builds/{answer['build']}").json()
    files = sum(len(http.get(f"{API}/artifacts/{sha}").content) for sha in build["artifacts"].values())
    assert person.stored == files + answer["outputs"]["surface"]["size"]
    http.post(place, json=BAR, headers=WAIT)
    assert person.stored == files + answer["outputs"]["surface"]["size"]


def test_whoever_has_used_all_storage_is_refused_without_a_time_to_wait(person, http):
    drafted(http, BUSH)
    person.limited(storage_mb=len(BUSH.encode()) / MIB)
    build = {"parameters": {"inner_diameter": "46.25 mm"}}
    answer = http.post(f"{API}/models/plain_bearing/versions/1/build", json=build)
    refused = problem(answer, 429, "limit-reached")
    assert "retry-after" not in answer.headers
    assert "neither waiting nor deleting files frees it" in refused["detail"]
    assert "an administrator may raise the limit" in refused["detail"]
