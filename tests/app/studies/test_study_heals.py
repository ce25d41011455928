"""Rows of a study whose files are lost or damaged are recalculated to the same bytes."""

import httpx
import pytest
from click.testing import CliRunner
from patience import until
from serving import API, problem, serving
from study_helpers import CLEARANCE, FILM, LOSS, OUT, TWICE, content, done, new_design, rows

from app.cli.main import main
from app.settings import Settings
from app.studies import repository

LENGTHS = {"length": {"between": ["0 mm", "10 mm"]}}
SAMPLE = {"method": "sample", "points": 30_000, "vary": LENGTHS, "outputs": [OUT]}
CONFIRMED = {
    "method": "sample",
    "points": 64,
    "vary": CLEARANCE,
    "minimise": [LOSS],
    "hold": ["thick_enough"],
    "explore": {"tolerance": 0.05},
    "confirm": {"tolerance": 0.001},
    "build": "best",
}
SEARCH = {"method": "optimise", "vary": LENGTHS, "minimise": [OUT], "hold": ["long_enough"]}
HELD = {**TWICE, "criteria": {"long_enough": {"require": f"{OUT} >= 5 mm"}}}
STUDIES = [(TWICE, SAMPLE), (FILM, CONFIRMED), (HELD, SEARCH)]


def files(served, study):
    """The files of a study's chunks, in their order."""
    services = served.app.state.services
    with services.database.read() as session:
        hashes = [chunk.sha256 for chunk in repository.chunks(session, study["id"])]
    return [services.store.folder / sha[:2] / sha for sha in hashes]


def damage(path):
    path.write_bytes(path.read_bytes()[:-1] + b"?")


def read_again(http, study, kind):
    """The answer once the rows are there again, after at least one that says that they are not."""
    place = f"{API}/studies/{study['id']}/{kind}"
    first = http.get(place)
    lost = problem(first, 503, "rebuilding")
    assert first.headers["retry-after"] == "2"
    job = until(lambda: http.get(lost["job"]).json(), lambda now: now["state"] not in ("queued", "running"))
    assert job["state"] == "done", job
    answer = http.get(place)
    assert answer.status_code == 200, answer.text
    return answer.content


@pytest.mark.parametrize(("document", "body"), STUDIES, ids=["sample", "confirmed", "optimise"])
@pytest.mark.sampled(1)
def test_lost_and_damaged_rows_are_calculated_again(served, http, document, body):
    study = done(http, new_design(http, document), **body)
    whole, paths = content(http, study, "npz"), files(served, study)
    assert len(paths) > 1
    before = [path.read_bytes() for path in paths]
    paths[0].unlink()
    damage(paths[-1])
    assert read_again(http, study, "rows.npz") == whole
    assert [path.read_bytes() for path in paths] == before
    shown = http.get(f"{API}/studies/{study['id']}").json()
    assert (shown["state"], shown["result"]) == ("done", study["result"])


@pytest.mark.parametrize("kind", ["rows", "rows.csv", "rows.xlsx"])
@pytest.mark.sampled(1)
def test_every_way_to_read_rows_has_them_calculated_again(served, http, kind):
    study = done(http, new_design(http, TWICE), method="grid", steps=5, vary=LENGTHS, outputs=[OUT])
    before = rows(http, study)
    (path,) = files(served, study)
    path.unlink()
    assert read_again(http, study, kind)
    assert rows(http, study) == before


def test_a_row_is_chosen_after_its_file_was_lost(served, http):
    design = new_design(http, TWICE)
    study = done(http, design, method="grid", steps=5, vary=LENGTHS, outputs=[OUT])
    files(served, study)[0].unlink()
    choose = lambda: http.post(  # noqa: E731
        f"{API}/studies/{study['id']}/choose", json={"row": 3}, headers={"If-Match": '"1"'}
    )
    problem(choose(), 503, "rebuilding")
    answer = until(choose, lambda answer: answer.status_code != 503)
    assert answer.is_success, answer.text


def test_lost_rows_whose_table_is_lost_too_are_gone(served, http):
    study = done(
        http, new_design(http, TWICE), method="table", rows={"length": ["1 mm", "2 mm"]}, outputs=[OUT]
    )
    services = served.app.state.services
    with services.database.read() as session:
        table = repository.get(session, study["id"]).table_sha256
    (path,) = files(served, study)
    path.unlink()
    (services.store.folder / table[:2] / table).unlink()
    ask = lambda: http.get(f"{API}/studies/{study['id']}/rows")  # noqa: E731
    gone = until(ask, lambda answer: answer.status_code != 503)
    assert "start the study again" in problem(gone, 410, "artifact-gone")["detail"]


@pytest.mark.slow
def test_check_reports_lost_rows_and_the_service_makes_them_again(tmp_path):
    settings = Settings(data=tmp_path / "data")
    body = {"method": "grid", "steps": 5, "vary": CLEARANCE, "outputs": [LOSS]}
    with serving(settings) as server, httpx.Client(base_url=server.url, timeout=90, trust_env=False) as http:
        study = done(http, new_design(http, FILM), **body)
        before, (path,) = rows(http, study), files(server, study)
    path.unlink()
    result = CliRunner().invoke(main, ["check", "--repair", "--data", str(settings.data)])
    assert result.exit_code == 1, result.output
    assert "not repaired: rows of" in result.output
    assert "the service calculates the rows again" in result.output
    with serving(settings) as server, httpx.Client(base_url=server.url, timeout=90, trust_env=False) as http:
        assert read_again(http, study, "rows")
        assert rows(http, study) == before
    assert CliRunner().invoke(main, ["check", "--data", str(settings.data)]).exit_code == 0


@pytest.mark.parametrize("harm", [lambda path: path.unlink(), damage], ids=["lost", "damaged"])
@pytest.mark.parametrize(("document", "body"), [STUDIES[0], STUDIES[2]], ids=["sample", "optimise"])
@pytest.mark.sampled(1)
def test_a_study_that_meets_its_own_lost_rows_calculates_them_again(
    served, http, monkeypatch, document, body, harm
):
    """Its first chunk goes just before the study concludes from what is stored."""
    design = new_design(http, document)
    body = {**body, **({"minimise": [OUT]} if body is SAMPLE else {})}
    reference = done(http, design, **body)
    handler = served.app.state.services.jobs._dispatcher.kinds["study"].handler
    conclude, harmed = handler._conclude, []

    def concluded(run):
        result = conclude(run)
        if not harmed:
            harmed.append(run.row.id)
            harm(files(served, {"id": run.row.id})[0])
            return conclude(run)
        return result

    monkeypatch.setattr(handler, "_conclude", concluded)
    study = done(http, design, **body)
    assert harmed == [study["id"]]
    assert study["result"] == reference["result"]
    assert content(http, study, "npz") == content(http, reference, "npz")
