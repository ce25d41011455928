"""Parts of studies work separately: archives, fronts, files of rows, jobs that yield."""

import io
import threading
import zipfile

import numpy as np
import pytest
from openpyxl import Workbook
from patience import patient, until

from app.jobs.errors import JobRests
from app.jobs.service import Jobs
from app.settings import Settings
from app.studies.archive import Archive, packed
from app.studies.front import front, ranked
from app.studies.uploads import read_rows
from app.workers.inline import Inline
from app.workers.pieces import Pieces
from templates.core.criteria.comparison import MET, NOT_MET, UNDECIDED
from templates.core.errors import InvalidInputs


def test_equal_arrays_are_equal_bytes_whatever_their_order():
    one = packed({"a": np.arange(3.0), "b": np.array([1, 2], np.int8)}, {"x": 1, "y": [2]})
    other = packed({"b": np.array([1, 2], np.int8), "a": np.arange(3.0)}, {"y": [2], "x": 1})
    assert one.joined() == other.joined()
    assert packed({"a": np.arange(4.0)}).joined() != packed({"a": np.arange(3.0)}).joined()


def test_an_archive_is_read_array_by_array():
    with Archive(packed({"a": np.array([1.5, np.nan]), "b": np.zeros(0)}, {"name": "ü"}).joined()) as archive:
        assert archive.names == ["a", "b"]
        assert "a" in archive
        assert "c" not in archive
        np.testing.assert_array_equal(archive["a"], [1.5, np.nan])
        assert archive.about() == {"name": "ü"}


def test_an_archive_is_what_numpy_reads():
    arrays = np.load(io.BytesIO(packed({"x": np.arange(5)}).joined()))
    assert arrays["x"].tolist() == [0, 1, 2, 3, 4]


def test_ranked_rows_meet_all_criteria():
    objective = np.array([1.0, 2.0, np.nan, 0.5, 0.1])
    worst = np.array([MET, MET, MET, UNDECIDED, NOT_MET], np.int8)
    assert ranked(objective, worst, 9).tolist() == [0, 1]
    assert ranked(objective, worst, 9, undecided=True).tolist() == [3, 0, 1]
    assert ranked(objective, worst, 1, undecided=True).tolist() == [3]


def test_the_front_against_comparing_all_pairs():
    objectives = np.random.default_rng(1).random((300, 3)).round(2)
    worst = np.full(300, MET, np.int8)
    worst[:50] = NOT_MET
    usable = objectives[50:]
    better = (usable[None] <= usable[:, None]).all(2) & (usable[None] < usable[:, None]).any(2)
    expected = {tuple(row) for row in usable[~better.any(1)]}
    assert {tuple(row) for row in objectives[front(objectives, worst)]} == expected


CSV = "clearance [mm],film.speed\n,rpm\n0.03,5000\n0.05,6000\n"


PLACES = {"clearance": "mm", "film.speed": "rpm", "ratio": "1", "related": None}


def test_a_csv_file_has_names_units_and_numbers():
    assert read_rows(Pieces.of(CSV.encode()), "csv", PLACES) == {
        "clearance": {"value": [0.03, 0.05], "unit": "mm"},
        "film.speed": {"value": [5000.0, 6000.0], "unit": "rpm"},
    }


def sheet(*rows):
    book = Workbook()
    for row in rows:
        book.active.append(row)
    stream = io.BytesIO()
    book.save(stream)
    return Pieces.of(stream.getvalue())


def test_an_xlsx_file_has_the_same_rows():
    content = sheet(["clearance", "film.speed"], ["mm", "rpm"], [0.03, 5000], [0.05, 6000])
    assert read_rows(content, "xlsx", PLACES)["clearance"] == {"value": [0.03, 0.05], "unit": "mm"}


@pytest.mark.parametrize(
    ("content", "kind", "code"),
    [
        (b"a,b\n1,2\n3,x\n", "csv", "not_a_number"),
        (b"a,a\n1,2\n", "csv", "twice"),
        (b"a\n=1+1\n", "csv", "formula"),
        (b"\xff\xfe", "csv", "not_utf8"),
        (b"", "csv", "empty"),
        (b"no zip", "xlsx", "damaged"),
    ],
)
def test_files_that_hold_no_rows(content, kind, code):
    with pytest.raises(InvalidInputs) as refused:
        read_rows(Pieces.of(content), kind, dict.fromkeys("ab"))
    assert refused.value.faults[0].code == code


def test_formulas_of_a_sheet_are_refused():
    with pytest.raises(InvalidInputs) as refused:
        read_rows(sheet(["a", "b"], [1, "=A2"]), "xlsx", dict.fromkeys("ab"))
    (fault,) = refused.value.faults
    assert (fault.name, fault.code) == ("row 2, column b", "formula")


def faults_of(content, kind):
    with pytest.raises(InvalidInputs) as refused:
        read_rows(Pieces.of(content), kind, PLACES)
    return {fault.name: fault.code for fault in refused.value.faults}


def test_every_faulty_cell_of_a_file_is_named_at_once():
    text = "clearance [kN],speed,ratio,ratio,related\n,rpmm,,,\n0.03,1,2,3,4\nx,1,,2,=3\n0.05,6000\n"
    wrong = {
        "row 1, column clearance": "wrong_unit",
        "row 1, column speed": "unknown_name",
        "row 1, column ratio": "twice",
        "row 2, column speed": "unknown_unit",
        "row 4, column clearance": "not_a_number",
        "row 4, column ratio": "not_a_number",
        "row 4, column related": "formula",
        "row 5": "ragged",
    }
    assert faults_of(text.encode(), "csv") == {
        name: code for name, code in wrong.items() if name != "row 1, column speed"
    }  # what a column is called is judged where its unit can be read
    assert faults_of(text.replace("rpmm", "rpm").encode(), "csv") == {
        name: code for name, code in wrong.items() if name != "row 2, column speed"
    }
    assert faults_of(b"clearance\n1\n", "csv") == {"row 1, column clearance": "missing_unit"}


@pytest.mark.slow
def test_faults_that_are_not_listed_are_counted():
    rows = "".join("x\n" for _ in range(99_999))
    with pytest.raises(InvalidInputs) as refused:
        read_rows(Pieces.of(f"ratio\n1\n{rows}".encode()), "csv", PLACES)
    assert len(refused.value.faults) == 501
    assert refused.value.faults[-1].detail.startswith("99499 further faults")
    assert "'x' is not a number; write one" in refused.value.faults[0].detail


def test_a_file_that_unpacks_to_too_much_is_refused():
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("xl/a.xml", "w") as part:
        for _ in range(201):
            part.write(b"0" * 10**6)
    with pytest.raises(InvalidInputs) as refused:
        read_rows(Pieces.of(stream.getvalue()), "xlsx", PLACES)
    assert refused.value.faults[0].code == "too_large"


def test_a_job_that_rests_lets_others_go_first(database):
    jobs = Jobs(database, Inline(), Settings(), lambda error: {"type": type(error).__name__})
    order, both_queued = [], threading.Event()

    def handler(job, context):
        both_queued.wait(patient(30))
        order.append(job.payload["name"])
        if order.count(job.payload["name"]) < 2 and jobs.others_wait("long"):
            raise JobRests
        return lambda session: None

    jobs.register("long", handler, lane="long")
    jobs.start({"long": 1})
    try:
        for name, client in (("a", "one"), ("b", "two")):
            database.write(
                lambda session, n=name, c=client: jobs.enqueue(session, "long", {"name": n}, client=c)
            )
        both_queued.set()
        jobs.wake()
        until(lambda: [job.state for job in jobs.page(9)], lambda states: states == ["done", "done"], 30)
        assert order == ["a", "b", "a"] or order == ["a", "b", "a", "b"]
        assert jobs.page(9)[1].attempt == 2
    finally:
        jobs.stop()
