"""Import over REST: a job, a draft, its regions; what forbids a release, and what is refused."""

import asyncio

import pytest
from mathcad_files import apply, call, define, math, name, packed, parts_of, prime, real, scale, shown, united
from serving import ended, faults

from app.client import Problem
from app.retention.rows import referenced_files
from app.worksheets.imports import service
from app.worksheets.imports.record import unresolved
from app.worksheets.names import RESERVED

BINARY = {"Content-Type": "application/octet-stream"}
SOUND = prime(
    math(define("x", scale(500, "mm"))),
    math(define("y", apply("mult", real(2), name("x"))), united(real(1), meter=1)),
)
FAULTY = prime(
    math(define("x", scale(500, "mm"))),
    math(shown(apply("mult", real(2), name("x"))), united(real(3), meter=1)),
    math(define("z", call("rnorm", real(1), real(0), real(1)))),
    math(define("w", apply("mult", real(2), name("z")))),
)


def post(http, id, content, **query):
    return http.post("/api/v1/worksheets/import", params={"id": id, **query}, content=content, headers=BINARY)


def test_a_sheet_becomes_a_draft_with_its_regions(http):
    job = ended(http, post(http, "import_sound", SOUND, file="C:\\sheets\\Träger 1.mcdx"))
    assert (job["state"], job["result"]) == ("done", "/api/v1/worksheets/import_sound")
    sheet = http.get(job["result"]).json()
    assert (sheet["state"], sheet["faults"]) == ("draft", [])
    assert sheet["import"]["file"] == "Träger 1.mcdx"
    assert sheet["import"]["regions"]["verified"] == 1
    report = http.get(f"{job['result']}/import").json()
    assert [item["state"] for item in report["items"]] == ["unverified", "verified"]
    assert report["items"][1]["line"] == sheet["text"].split("\n").index('y [mm] = 2 * x "y"') + 1
    original = http.get(f"{job['result']}/import/original")
    assert original.content == SOUND
    assert report["sha256"] in original.headers["ETag"]


def test_the_original_is_kept_by_retention(http, served):
    ended(http, post(http, "import_kept", SOUND))
    sha = http.get("/api/v1/worksheets/import_kept/import").json()["sha256"]
    services = served.app.state.services
    with services.database.read() as session:
        assert sha in referenced_files(session)
    assert services.store.exists(sha)


def test_unresolved_regions_forbid_a_release_until_their_lines_are_changed(client, http):
    sheet = client.import_worksheet("import_faulty", FAULTY, "faulty.mcdx")
    report = client.read_import(sheet.id)
    assert [item.state for item in report.items] == ["unverified", "differs", "refused", "blocked"]
    assert [item.is_unresolved for item in report.items] == [False, True, True, True]
    sheet = client.review_worksheet(client.test_worksheet(sheet), "A. Weber")
    with pytest.raises(Problem, match="3 regions of the import unresolved") as caught:
        client.release_worksheet(sheet)
    assert caught.value.status == 409
    kept = [line for line in sheet.text.split("\n") if not line.startswith("//")]
    text = "\n".join(kept).replace("= 2 * x", "= 6 * x")
    sheet = client.change_worksheet(sheet, text)
    assert sheet.import_.unresolved == 0
    sheet = client.review_worksheet(client.test_worksheet(sheet), "A. Weber")
    assert client.release_worksheet(sheet).state == "released"


def test_blanks_resolve_nothing():
    region = {"state": "refused", "lines": ["// refused: matrix (region 1)"]}
    for text, left in (
        ("// refused: matrix (region 1)", 1),
        ("//  refused:\tmatrix (region 1)  ", 1),
        ("// refused: matrix", 0),
        ("", 0),
    ):
        assert len(unresolved({"regions": [region]}, text)) == left


@pytest.mark.parametrize(
    ("content", "slug"),
    [
        (b"no sheet", "unreadable-sheet"),
        (packed({**parts_of(), "mathcad/worksheet.xml": "<!DOCTYPE a><a/>"}), "unreadable-sheet"),
        (packed({**parts_of(), "mathcad/worksheet.xml": b"<a>" + b" " * 2**26}), "unreadable-sheet"),
    ],
)
def test_a_file_that_is_not_taken_fails_its_job_and_leaves_nothing(http, content, slug):
    job = ended(http, post(http, "import_none", content))
    assert job["state"] == "failed"
    assert job["problem"]["type"] == f"/problems/{slug}"
    assert http.get("/api/v1/worksheets/import_none").status_code == 404
    assert http.get(f"/problems/{slug}").json()["remedy"]


def test_what_can_be_refused_at_once_is(http):
    ended(http, post(http, "import_taken", SOUND))
    assert post(http, "import_taken", SOUND).status_code == 409
    assert post(http, "oil_film", SOUND).status_code == 409
    assert post(http, "No Id", SOUND).status_code == 422
    for id in sorted(RESERVED):
        assert faults(post(http, id, SOUND)) == {"id": "name"}
    assert post(http, "import_empty", b"").status_code == 422
    other = http.post("/api/v1/worksheets/import?id=import_other", json={"a": 1})
    assert other.status_code == 415
    assert http.get("/api/v1/worksheets/import_other/import").status_code == 404


def test_a_typed_worksheet_has_no_import(http):
    http.post("/api/v1/worksheets", json={"id": "import_typed", "text": 'y [1] = 2 "y"\n'}).raise_for_status()
    assert http.get("/api/v1/worksheets/import_typed").json()["import"] is None
    assert http.get("/api/v1/worksheets/import_typed/import").status_code == 404
    assert http.get("/api/v1/worksheets/import_typed/import/original").status_code == 404


def test_one_key_makes_one_import(http):
    headers = {**BINARY, "Idempotency-Key": "import once"}
    places = {
        http.post("/api/v1/worksheets/import?id=import_once", content=SOUND, headers=headers).headers[
            "Location"
        ]
        for _ in range(3)
    }
    assert len(places) == 1


def test_a_job_is_bounded_in_time_and_memory():
    assert (service.LIMITS.deadline, service.LIMITS.memory_mb) == (20.0, 512)
    assert not asyncio.iscoroutinefunction(service.imported)
