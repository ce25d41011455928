"""The typed clients and the command line handle worksheets as text files."""

import asyncio
import inspect

import bare_shells
import pytest
from click.testing import CliRunner
from serving import API, created
from sheets import BUSH, FAULTY, WIDER, drafted, edited, fresh, released

from app.cli.main import main
from app.client import AsyncClient, Client, Problem

OPERATIONS = (
    "worksheets", "read_worksheet", "worksheet_text", "check_worksheet", "create_worksheet",
    "change_worksheet", "test_worksheet", "review_worksheet", "release_worksheet", "withdraw_worksheet",
    "delete_worksheet",
)  # fmt: skip


@pytest.fixture
def run(served):
    """Run a command of worksheets on the served service."""

    def command(*arguments, code=0):
        words = ["worksheet", *map(str, arguments), "--url", served.url]
        result = CliRunner().invoke(main, words)
        assert result.exit_code == code, result.output
        return result.output

    return command


@pytest.fixture
def folder(tmp_path):
    """A folder with one file, and its id."""
    id = fresh()
    (tmp_path / f"{id}.sheet").write_bytes(BUSH.encode())
    return tmp_path, id


def test_the_client_takes_a_worksheet_to_its_release(client):
    id = fresh()
    assert client.check_worksheet(FAULTY).faults
    assert client.check_worksheet(BUSH, id).template.id == id
    sheet = client.create_worksheet(id, BUSH, author="A. Weber")
    sheet = client.change_worksheet(sheet, WIDER)
    assert client.worksheet_text(id) == WIDER
    sheet = client.test_worksheet(sheet)
    sheet = client.review_worksheet(sheet, "B. Klein")
    sheet = client.release_worksheet(sheet)
    assert sheet.state == "released"
    answer = client.evaluate(id, 1, {"radial_load": "20 kN", "bearing_diameter": "50 mm"})
    assert answer.outputs["finished_bore"].value == pytest.approx(50.06)
    described = client.template(id, 1)
    assert (described.worksheet.reviewer, described.worksheet.review_verified) == ("B. Klein", False)
    draft = client.change_worksheet(sheet, BUSH)
    client.delete_worksheet(draft)
    assert client.withdraw_worksheet(id, "superseded").state == "withdrawn"
    assert client.read_worksheet(id, 1).withdrawn == "superseded"
    assert id in {one.id for one in client.worksheets()}


def test_the_client_changes_only_what_it_read(client):
    sheet = client.create_worksheet(fresh(), BUSH)
    client.change_worksheet(sheet, WIDER)
    with pytest.raises(Problem) as stale:
        client.change_worksheet(sheet, BUSH)
    assert stale.value.status == 412


def test_the_other_client_does_the_same(served):
    async def life():
        async with AsyncClient(served.url) as client:
            sheet = await client.create_worksheet(fresh(), BUSH)
            sheet = await client.review_worksheet(await client.test_worksheet(sheet), "B. Klein")
            return await client.release_worksheet(sheet)

    assert asyncio.run(life()).state == "released"
    for name in OPERATIONS:
        one, other = getattr(Client, name).operation, getattr(AsyncClient, name).operation
        assert one is other
        assert inspect.getdoc(one)


def test_commands_take_a_file_to_its_release(run, folder, http):
    place, id = folder
    file = place / f"{id}.sheet"
    checked = run("check", file)
    assert "test passed" in checked
    digest = checked.split("digest ")[1].strip()
    assert f"{id} version 1: draft" in run("import-text", file, "--author", "A. Weber")
    assert f"digest {digest}" in run("test", id)
    assert "is the author" in run("review", id, "--reviewer", "A. Weber", "--digest", digest[:12], code=1)
    assert "read its current text first" in run("review", id, "--reviewer", "B", "--digest", "0" * 12, code=1)
    assert "review not verified" in run("review", id, "--reviewer", "B. Klein", "--digest", digest[:12])
    assert "released" in run("release", id)
    listed = next(line for line in run("list").splitlines() if line.startswith(f"{id} "))
    assert listed == f"{id} 1  (released, reviewed by B. Klein, review not verified)  Bush duty"
    assert run("export", id) == BUSH
    assert "withdrawn" in run("withdraw", id, "--reason", "wrong")
    assert http.get(f"{API}/worksheets/{id}").json()["withdrawn"] == "wrong"


def test_a_faulty_file_is_checked_and_not_tested(run, folder):
    place, id = folder
    file = place / f"{id}.sheet"
    file.write_text(FAULTY)
    checked = run("check", file, code=1)
    assert f"{file}:8:" in checked
    assert "faults" in run("import-text", file)
    assert "line 8" in run("test", id, code=1)


def test_files_come_back_byte_by_byte(run, folder):
    place, id = folder
    text = BUSH.replace("\n", "\r\n").replace("duty", "düty").encode() + b"// no line end"
    (place / f"{id}.sheet").write_bytes(text)
    run("import-text", place / f"{id}.sheet")
    (place / "out").mkdir()
    run("export", place / "out")
    assert (place / "out" / f"{id}.sheet").read_bytes() == text
    assert run("import-text", place / "out" / f"{id}.sheet") == f"{id} version 1: draft\n"


def test_versions_have_files_of_their_own(run, folder, http):
    place, id = folder
    edited(http, released(http, BUSH, id), WIDER)
    run("export", place)
    assert (place / f"{id}_v1.sheet").read_text() == BUSH
    assert (place / f"{id}_v2.sheet").read_text() == WIDER


def test_a_version_does_not_replace_the_draft_before_it(run, folder):
    place, id = folder
    for number, text in ((1, BUSH), (2, WIDER)):
        (place / f"{id}_v{number}.sheet").write_text(text)
    refused = run("import-text", place / f"{id}_v1.sheet", place / f"{id}_v2.sheet", code=1)
    assert "would become version 1, not 2" in refused
    assert run("export", id) == BUSH


@pytest.mark.parametrize("name", ["Bush.sheet", "bush.txt", "bush"])
def test_a_file_is_named_by_its_id(run, tmp_path, name):
    (tmp_path / name).write_text(BUSH)
    assert "<id>.sheet" in run("import-text", tmp_path / name, code=1)


def test_a_file_is_text(run, tmp_path):
    (tmp_path / "bush.sheet").write_bytes(b"\xff\xfe")
    assert "UTF-8" in run("check", tmp_path / "bush.sheet", code=1)


def test_the_story_from_the_text_to_the_solid(client, http):
    """Write, check, create, test, review, release; a design drives a bush with it; withdraw."""
    id = fresh("story")
    assert not client.check_worksheet(BUSH).faults
    sheet = client.test_worksheet(client.create_worksheet(id, BUSH, author="A. Weber"))
    sheet = client.release_worksheet(client.review_worksheet(sheet, "B. Klein"))
    inputs = {"radial_load": "20 kN", "bearing_diameter": "= size"}
    shell = {
        **bare_shells.BUSH,
        "inner_diameter": "= duty.finished_bore",
        "wall": "3 mm",
        "width": "= duty.bearing_width",
    }
    design = created(
        http,
        {
            "name": "bush by a worksheet",
            "parameters": {"size": "50 mm"},
            "steps": {"duty": {"template": id, "version": 1, "inputs": inputs}},
            "model": {"id": "plain_bearing", "version": 1, "parameters": shell},
        },
    )
    bore = client.measurements(design["id"])["model"].dimensions["inner_diameter"]
    assert (bore.value, bore.unit) == (pytest.approx(50.05, abs=1e-6), "mm")
    step = client.model(design["id"])
    assert client.verify(step).model.id == "plain_bearing"
    changed = client.change(client.design(design["id"]), {"parameters": {"size": "60 mm"}})
    measured = client.measurements(changed.id)["model"].dimensions
    assert measured["inner_diameter"].value == pytest.approx(60.05, abs=1e-6)
    assert measured["width"].value == pytest.approx(30, abs=1e-6)
    client.withdraw_worksheet(id, "the clearance is too small")
    report = http.get(f"{API}/designs/{changed.id}/report", headers={"Accept": "text/html"}).text
    assert "review not verified" in report
    assert "withdrawn: the clearance is too small" in report
    assert client.measurements(changed.id)["model"].dimensions == measured


def test_a_draft_stays_a_draft_under_a_command_out_of_order(run, http):
    id = drafted(http)["id"]
    assert "test it first" in run("release", id, code=1)
    assert "not released" in run("withdraw", id, "--reason", "wrong", code=1)
