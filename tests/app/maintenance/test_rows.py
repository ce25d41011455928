"""A backup contains, and a check verifies, the files to which rows refer."""

import json
import sqlite3

import pytest

from app.maintenance.rows import NamedFile, named_files


@pytest.fixture
def rows():
    connection = sqlite3.connect(":memory:")
    connection.execute("CREATE TABLE artifact (sha256, size, build_key, kind)")
    connection.execute("CREATE TABLE job (id, kind, payload, result)")
    yield connection
    connection.close()


@pytest.mark.parametrize("kind", ["calculation", "preview", "decision", "solution", "tolerance", "impact"])
def test_a_job_names_its_question_and_its_answer(rows, kind):
    job = ("7", kind, json.dumps({"body": "aa"}), "/api/v1/evaluations/7?sha256=bb")
    rows.execute("INSERT INTO job VALUES (?, ?, ?, ?)", job)
    assert list(named_files(rows)) == [
        NamedFile("aa", None, "7", "body"),
        NamedFile("bb", None, "7", "answer"),
    ]


def test_a_job_without_a_question_names_none(rows):
    job = ("7", "regeneration", json.dumps({"build": "key"}), "/api/v1/designs/7")
    rows.execute("INSERT INTO job VALUES (?, ?, ?, ?)", job)
    assert list(named_files(rows)) == []
