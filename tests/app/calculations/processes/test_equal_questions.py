"""An equal request finds the job, or the stored answer, of the earlier one."""

import os
from pathlib import Path

from serving import API
from sleepers import FILM, SLEEPER, begun, ended, sleep_exactly
from test_workers import eventually

LATER = {"Prefer": "respond-async"}


def place(answer):
    assert answer.status_code == 202, answer.text
    return answer.headers["Location"]


def test_an_equal_question_finds_the_job_that_answers_it(http, log):
    first = place(sleep_exactly(http, "1.501 s", **LATER))
    begun(log)
    assert place(sleep_exactly(http, "1.501 s", **LATER)) == first
    waited = sleep_exactly(http, "1.501 s", Prefer="wait=30")
    assert waited.status_code == 200, "who waits has the answer of the job"
    assert waited.json()["outputs"]["process"]["value"] == begun(log)[0]
    assert ended(http, first)["state"] == "done"
    assert len(begun(log)) == 1


def test_an_equal_question_finds_the_kept_answer(http, log):
    job = ended(http, place(sleep_exactly(http, "2.001 ms", **LATER)))
    kept = http.get(job["result"]).content
    for headers in ({}, LATER):
        again = sleep_exactly(http, "2.001 ms", **headers)
        assert (again.status_code, again.content) == (200, kept), "with the time of the first calculation"
    assert len(begun(log)) == 1


def test_another_question_has_a_job_of_its_own(http):
    first = place(sleep_exactly(http, "3.001 ms", **LATER))
    assert place(sleep_exactly(http, "3.002 ms", **LATER)) != first
    body = {"inputs": {"duration": "3.001 ms", "mood": "good"}}
    written = place(http.post(f"{SLEEPER}/worksheet", json=body, headers=LATER))
    assert written != first
    in_inches = http.post(f"{SLEEPER}/worksheet", json=body, params={"units": "us"}, headers=LATER)
    assert place(in_inches) not in (first, written)


def test_a_question_is_calculated_again_after_a_cancelled_job(http, log):
    job = place(sleep_exactly(http, "60.001 s", **LATER))
    begun(log)
    http.delete(job).raise_for_status()
    again = place(sleep_exactly(http, "60.001 s", **LATER))
    assert again != job
    http.delete(again).raise_for_status()


def test_a_lost_answer_is_no_answer(http, settings, log):
    job = ended(http, place(sleep_exactly(http, "4.001 ms", **LATER)))
    sha = job["result"].rpartition("sha256=")[2]
    (settings.data / "artifacts" / sha[:2] / sha).unlink()
    assert sleep_exactly(http, "4.001 ms").status_code == 200
    assert len(begun(log)) == 2


def test_another_code_of_a_template_answers_anew(http, settings, log):
    job = ended(http, place(sleep_exactly(http, "5.001 ms", **LATER)))
    file = Path(settings.template_folders[0]) / "sleeper_v1.py"
    before = file.read_text()
    file.write_text(before.replace("np.float64(os.getpid())", "np.float64(os.getpid() + 0.5)"))
    os.utime(file, (1, 1))

    def value():
        return sleep_exactly(http, "5.001 ms").json()["outputs"]["process"]["value"]

    try:
        assert eventually(lambda: value() % 1 == 0.5, 20)
    finally:
        file.write_text(before)
    assert http.get(job["result"]).json()["outputs"]["process"]["value"] % 1 == 0
    assert eventually(lambda: value() % 1 == 0, 20)


def test_an_equal_question_about_a_design_finds_the_answer_until_it_is_saved(http):
    width = {"value": 18, "unit": "mm", "plus": 0.2, "minus": 0.2}
    step = {"template": "oil_film", "version": 2, "inputs": {**FILM.example, "bearing_width": width}}
    saved = http.post(f"{API}/designs", json={"name": "equal", "steps": {"film": step}})
    design = f"{API}/designs/{saved.json()['id']}"

    def asked(points=1024, **headers):
        return http.post(f"{design}/tolerance", json={"points": points}, headers=headers)

    first = place(asked(**LATER))
    kept = http.get(ended(http, first)["result"]).content
    again = asked(**LATER)
    assert (again.status_code, again.content) == (200, kept)
    assert place(asked(2048, **LATER)) != first
    change = {"steps": {"film": {"inputs": {"bearing_width": {**width, "plus": 0.1}}}}}
    http.patch(design, json=change, headers={"If-Match": "*"}).raise_for_status()
    other = place(asked(**LATER))
    assert other != first
    assert http.get(ended(http, other)["result"]).json()["analysis"]["revision"] == 2
