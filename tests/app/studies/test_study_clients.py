"""The typed clients, the command line and files of rows run studies."""

import asyncio
import csv
import io
import json

import pytest
from click.testing import CliRunner
from openpyxl import Workbook
from serving import API, faults
from study_helpers import OUT, TWICE, asked, ended, new_design, rows

from app.cli.main import main
from app.cli.studies import _varied
from app.client import AsyncClient, Problem

LENGTHS = {"length": {"between": ["0 mm", "10 mm"]}}


@pytest.fixture(scope="module")
def twice(http):
    return new_design(http, TWICE)


def test_the_client_waits_lists_and_chooses(client, http):
    design = new_design(http, TWICE)
    study = client.study(design["id"], method="grid", vary=LENGTHS, steps=601, outputs=[OUT])
    seen = []
    assert study.wait(lambda fraction, text: seen.append(fraction)).state == "done"
    listed = study.rows(sort=f"-{OUT}")
    assert len(listed) == 601
    assert listed[0].values[OUT] == pytest.approx(20)
    assert study.file("csv", [OUT]).name == f"study_{study.id}.csv"
    chosen = study.choose(listed[0].row)
    assert chosen.revision == 2
    assert [one.id for one in client.studies(design["id"])] == [study.id]
    assert client.open_study(study.id).study.state == "done"
    assert study.end() is None
    with pytest.raises(Problem, match="no study"):
        client.open_study(study.id)


def test_the_client_says_why_a_study_failed(client, twice):
    pytest.importorskip("SALib")
    vary = {"length": {"between": ["-10 mm", "10 mm"]}}
    study = client.study(twice["id"], method="sensitivity", kind="morris", vary=vary, outputs=[OUT])
    with pytest.raises(Problem, match="no value"):
        study.wait()


def test_the_other_client(served, twice):
    async def found():
        async with AsyncClient(served.url) as client:
            study = await client.study(twice["id"], method="grid", vary=LENGTHS, steps=3, outputs=[OUT])
            await study.wait()
            return await study.rows(where=None, sort="length"), await study.end()

    listed, removed = asyncio.run(found())
    assert [row.values[OUT] for row in listed] == pytest.approx([0, 10, 20])
    assert removed is None


@pytest.mark.parametrize(
    ("text", "varied"),
    [
        ("c=0.03..0.09mm/41", ("c", ({"between": ["0.03 mm", "0.09 mm"]}, 41))),
        ("c=30 um .. 0.09 mm/3", ("c", ({"between": ["30 um", "0.09 mm"]}, 3))),
        ("film.rho=800..900 kg/m**3/5", ("film.rho", ({"between": ["800 kg/m**3", "900 kg/m**3"]}, 5))),
        ("n=1..2/2", ("n", ({"between": ["1", "2"]}, 2))),
        ("w=18,20mm", ("w", ({"values": ["18 mm", "20 mm"]}, 0))),
        ("w=1.8cm,20 mm", ("w", ({"values": ["1.8 cm", "20 mm"]}, 0))),
    ],
)
def test_what_a_sweep_varies(text, varied):
    assert _varied(text) == varied


def run(*arguments):
    return CliRunner().invoke(main, list(map(str, arguments)))


def test_a_sweep_writes_its_rows(served, twice, tmp_path):
    out = tmp_path / "film.csv"
    result = run("sweep", twice["id"], "length=0..10mm/5", "--out", out, "--url", served.url)
    assert result.exit_code == 0, result.output
    table = list(csv.reader(out.read_text().splitlines()))
    assert table[1][:3] == ["row", "length", OUT]
    assert [float(line[2]) for line in table[2:]] == pytest.approx([0, 5, 10, 15, 20])
    printed = run("sweep", twice["id"], "length=1,2cm", "--url", served.url)
    assert list(csv.reader(io.StringIO(printed.stdout)))[3][2] == "40.0"


def test_a_sweep_says_what_is_wrong(served, twice):
    wrong = run("sweep", twice["id"], "length=1..2kg/3", "--url", served.url)
    assert wrong.exit_code == 1
    assert "kg measures a mass" in wrong.output
    assert run("sweep", twice["id"], "length", "--url", served.url).exit_code == 2
    assert run("sweep", twice["id"], "length=1,2mm", "--out", "x.pdf", "--url", served.url).exit_code == 2


def test_a_study_from_a_file(served, twice, tmp_path):
    file, out = tmp_path / "study.json", tmp_path / "rows.npz"
    body = {"design": twice["id"], "method": "sensitivity", "vary": LENGTHS, "outputs": [OUT]}
    file.write_text(json.dumps(body))
    result = run("study", file, "--out", out, "--url", served.url)
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["result"]["indices"][OUT]["length"]["slope"]["unit"] == "mm/mm"
    assert out.stat().st_size > 100
    file.write_text("[]")
    assert run("study", file, "--url", served.url).exit_code == 1


def sheet():
    book = Workbook()
    for row in (["length [cm]"], [1], [2]):
        book.active.append(row)
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


@pytest.mark.parametrize(
    ("kind", "content"),
    [
        ("text/csv", b"length\nmm\n10\n20\n"),
        ("application/vnd.openxmlformats-officedocument.spreadsheetml.sheet", sheet()),
    ],
)
def test_rows_come_from_a_file(http, twice, kind, content):
    query = {"design": twice["id"], "outputs": OUT, "build": "1"}
    answer = http.post(f"{API}/studies", params=query, content=content, headers={"Content-Type": kind})
    assert answer.status_code == 202, answer.text
    study = ended(http, answer.json())
    assert [row["values"][OUT] for row in rows(http, study)["items"]] == pytest.approx([20, 40])
    assert http.get(f"{API}/designs/{study['result']['design']}").json()["variants"].keys() == {"row_1"}


def test_faulty_cells_of_a_file_are_named(http, twice):
    query = {"design": twice["id"], "outputs": OUT}
    csv_file = {"Content-Type": "text/csv"}
    answer = http.post(f"{API}/studies", params=query, content=b"length\nmm\n1\nx\n", headers=csv_file)
    assert faults(answer) == {"row 4, column length": "not_a_number"}
    answer = http.post(f"{API}/studies", params=query, content=b"length\n1\n", headers=csv_file)
    assert faults(answer) == {"row 1, column length": "missing_unit"}
    answer = http.post(f"{API}/studies", params=query, content=b"width,length\nmm,s\n1,x\n", headers=csv_file)
    assert faults(answer) == {
        "row 1, column width": "unknown_name",
        "row 1, column length": "wrong_unit",
        "row 3, column length": "not_a_number",
    }


def test_every_faulty_cell_of_a_list_of_rows_is_named(http, twice):
    given = [{"length": "1 mm"}, {"length": "2"}, {"length": "3 s"}, {"length": ["1 mm", "2 mm"]}]
    answer = asked(http, twice, method="table", rows=given, outputs=[OUT])
    wrong = {"rows.1.length": "missing_unit", "rows.2.length": "wrong_unit", "rows.3.length": "not_a_number"}
    assert faults(answer) == wrong
    uneven = [{"length": "1 mm"}, {}, {"length": "1 mm", "x": "1 mm"}]
    answer = asked(http, twice, method="table", rows=uneven, outputs=[OUT])
    assert faults(answer) == {"rows.1": "uneven", "rows.2": "uneven"}


def test_an_evaluation_by_an_address(http):
    path = f"{API}/templates/double/versions/1/evaluate.csv"
    one = http.get(path, params={"length": "1 cm", "outputs": "twice_the_length"})
    assert one.headers["content-type"] == "text/csv; charset=utf-8"
    assert list(csv.reader(io.StringIO(one.text))) == [["twice_the_length"], ["mm"], ["20.0"]]
    several = http.get(path, params={"length": ["1 mm", "2 mm"]}).text.splitlines()
    assert several[2:] == ["2.0", "4.0"]
    assert faults(http.get(path, params={"length": "1 kg"})) == {"length": "wrong_unit"}
    assert faults(http.get(path)) == {"length": "missing"}
    assert faults(http.get(path, params={"length": "1 mm", "x": "1"})) == {"x": "unknown_name"}
    twice = {
        "length": "1 mm",
        "outputs": ["twice_the_length", "twice_the_length"],
        "tolerance": ["0.1", "0.2"],
    }
    assert faults(http.get(path, params=twice)) == {"outputs": "named_twice", "tolerance": "named_twice"}
    assert http.get(f"{API}/templates/double/versions/9/evaluate.csv").status_code == 404
