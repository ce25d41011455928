"""The life of a worksheet: draft → tested → reviewed → released → withdrawn, and all refused steps."""

import pytest
from serving import API, faults, pages, problem
from sheets import BUSH, FAULTY, WIDER, drafted, edited, fresh, place, released, reviewed, step

NOBODY = "0" * 64
"""A digest that no text has."""


def test_a_new_worksheet_is_a_draft(http):
    id = fresh()
    answer = http.post(f"{API}/worksheets", json={"id": id, "text": BUSH, "author": "A. Weber"})
    assert answer.status_code == 201
    assert answer.headers["location"] == place(id)
    sheet = answer.json()
    assert answer.headers["etag"] == f'"{sheet["edit"]}"'
    assert (sheet["state"], sheet["version"], sheet["title"]) == ("draft", 1, "Bush duty")
    assert (sheet["author"], sheet["reviewer"], sheet["review_verified"]) == ("A. Weber", None, False)
    assert sheet["text"] == BUSH
    assert sheet["faults"] == []
    assert sheet["import"] is None
    assert http.get(place(id)).json() == sheet


def test_a_draft_keeps_its_faults(http):
    sheet = drafted(http, FAULTY)
    assert sheet["digest"] is None
    first = sheet["faults"][0]
    assert (first["line"], first["code"]) == (8, "unit_mismatch")
    refusal = problem(http.post(place(sheet["id"], "test")), 409, "tests-failed")
    assert "line 8" in refusal["errors"][0]["detail"]
    assert http.get(place(sheet["id"])).json()["state"] == "draft"


def test_every_step_comes_in_its_order(http):
    id = drafted(http)["id"]
    review = {"reviewer": "B. Klein", "digest": http.get(place(id)).json()["digest"]}
    for name, body in (("review", review), ("release", None), ("withdraw", {"reason": "wrong"})):
        refusal = problem(http.post(place(id, name), json=body), 409, "out-of-order")
        assert "is draft" in refusal["detail"]
    tested = step(http, id, "test")
    assert tested["state"] == "tested"
    assert [(test["line"], test["passed"]) for test in tested["tests"]] == [(13, True)]
    problem(http.post(place(id, "release")), 409, "out-of-order")
    assert step(http, id, "review", **review)["reviewer"] == "B. Klein"
    problem(http.post(place(id, "test")), 409, "out-of-order")
    ended = step(http, id, "release")
    assert (ended["state"], ended["review_verified"]) == ("released", False)
    assert ended["released"]
    for name, body in (("test", None), ("review", review), ("release", None)):
        problem(http.post(place(id, name), json=body), 409, "out-of-order")
    withdrawn = step(http, id, "withdraw", reason="the clearance is wrong")
    assert (withdrawn["state"], withdrawn["withdrawn"]) == ("withdrawn", "the clearance is wrong")
    problem(http.post(place(id, "withdraw"), json={"reason": "again"}), 409, "out-of-order")


@pytest.mark.parametrize("name", ["A. Weber", "a. weber", "  A.   WEBER ", "Ａ. Weber"])
def test_authors_do_not_review_their_own_worksheet(http, name):
    id = drafted(http, author="A. Weber")["id"]
    digest = step(http, id, "test")["digest"]
    answer = http.post(place(id, "review"), json={"reviewer": name, "digest": digest})
    problem(answer, 403, "own-review")


def test_a_review_is_of_one_text(http):
    id = drafted(http)["id"]
    step(http, id, "test")
    body = {"reviewer": "B. Klein", "digest": NOBODY}
    problem(http.post(place(id, "review"), json=body), 409, "other-text")


@pytest.mark.parametrize("steps", [("test",), ("test", "review")])
def test_an_edit_returns_to_draft(http, steps):
    sheet = drafted(http, author="A. Weber")
    sheet = step(http, sheet["id"], "test")
    if "review" in steps:
        sheet = step(http, sheet["id"], "review", reviewer="B. Klein", digest=sheet["digest"])
    after = edited(http, sheet, WIDER)
    assert (after["state"], after["version"], after["reviewer"]) == ("draft", 1, None)
    assert after["tests"] == []
    assert after["digest"] != sheet["digest"]
    assert after["author"] == "A. Weber"


def test_an_edit_that_changes_nothing_keeps_the_state(http):
    sheet = reviewed(http, drafted(http)["id"])
    assert edited(http, sheet, BUSH)["state"] == "reviewed"


def test_prose_is_no_statement(http):
    sheet = drafted(http)
    after = edited(http, sheet, BUSH.replace("Steady", "Constant"))
    assert after["digest"] == sheet["digest"]


def test_an_edit_of_a_release_begins_the_next_version(http):
    first = released(http)
    second = edited(http, first, WIDER)
    assert (second["version"], second["state"]) == (2, "draft")
    assert [(one["version"], one["state"]) for one in second["versions"]] == [(1, "released"), (2, "draft")]
    old = http.get(place(first["id"], "versions", 1)).json()
    assert (old["state"], old["text"]) == ("released", BUSH)
    withdrawn = step(http, first["id"], "withdraw", reason="superseded")
    assert (withdrawn["version"], withdrawn["state"]) == (1, "withdrawn")
    assert http.get(place(first["id"])).json()["state"] == "draft"


def test_a_release_fails_if_its_tests_fail(http):
    sheet = drafted(http, BUSH.replace("21.7 MPa", "22.7 MPa"))
    refusal = problem(http.post(place(sheet["id"], "test")), 409, "tests-failed")
    assert "line 13" in refusal["detail"]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ('given x [m] "length" (example 1 m)\n', "write a formula"),
        ('given x [m] "length"\ny [m] = x "twice"\n', "length has no example"),
        ('given x [m] "length" (example 0 m)\ny [1] = 1 m / x "ratio" (<= 5)\n', "ratio"),
    ],
)
def test_what_cannot_be_used_is_not_tested(http, text, reason):
    refusal = problem(http.post(place(drafted(http, text)["id"], "test")), 409, "tests-failed")
    assert reason in refusal["detail"]


def test_a_change_needs_the_etag_of_what_was_read(http):
    sheet = drafted(http)
    problem(http.patch(place(sheet["id"]), json={"text": WIDER}), 428, "precondition-required")
    edited(http, sheet, WIDER)
    stale = {"If-Match": f'"{sheet["edit"]}"'}
    answer = http.patch(place(sheet["id"]), json={"text": BUSH}, headers=stale)
    problem(answer, 412, "stale-worksheet")
    for name in ("test", "release"):
        problem(http.post(place(sheet["id"], name), headers=stale), 412, "stale-worksheet")
    problem(http.delete(place(sheet["id"]), headers=stale), 412, "stale-worksheet")


def test_a_repeated_request_makes_one_worksheet(http):
    body, headers = {"id": fresh(), "text": BUSH}, {"Idempotency-Key": fresh("key")}
    first, second = (http.post(f"{API}/worksheets", json=body, headers=headers) for _ in range(2))
    assert (first.status_code, second.status_code) == (201, 201)
    assert first.json() == second.json()
    other = http.post(f"{API}/worksheets", json={**body, "text": WIDER}, headers=headers)
    problem(other, 422, "idempotency-key-reused")


def test_a_repeated_edit_makes_one_version(http):
    sheet = released(http)
    headers = {"If-Match": f'"{sheet["edit"]}"', "Idempotency-Key": fresh("key")}
    for _ in range(2):
        answer = http.patch(place(sheet["id"]), json={"text": WIDER}, headers=headers)
        assert (answer.status_code, answer.json()["version"]) == (200, 2)


@pytest.mark.parametrize("id", ["oil_film", "ball_bearing", "double"])
def test_files_and_worksheets_share_their_ids(http, id):
    refusal = problem(http.post(f"{API}/worksheets", json={"id": id, "text": BUSH}), 409, "id-taken")
    assert "choose another" in refusal["detail"]


def test_an_id_belongs_to_one_worksheet(http):
    id = drafted(http)["id"]
    problem(http.post(f"{API}/worksheets", json={"id": id, "text": WIDER}), 409, "id-taken")


@pytest.mark.parametrize("id", ["Bush", "1st", "a b", "", "x" * 65, "ä", "a\x00", "../x", None, 5])
def test_an_id_is_a_name_in_snake_case(http, id):
    assert set(faults(http.post(f"{API}/worksheets", json={"id": id, "text": BUSH}))) == {"id"}


@pytest.mark.parametrize("id", ["bush_v2", "new", "check", "import"])
def test_some_words_are_no_ids(http, id):
    answer = http.post(f"{API}/worksheets", json={"id": id, "text": BUSH})
    assert faults(answer) == {"id": "name"}
    assert "choose another, such as `bush_duty`" in answer.json()["errors"][0]["detail"]


def test_a_draft_can_be_deleted_and_a_release_not(http):
    sheet = drafted(http)
    problem(http.delete(place(sheet["id"])), 428, "precondition-required")
    assert http.delete(place(sheet["id"]), headers={"If-Match": "*"}).status_code == 204
    problem(http.get(place(sheet["id"])), 404, "not-found")
    first = released(http)
    problem(http.delete(place(first["id"]), headers={"If-Match": "*"}), 409, "out-of-order")
    edited(http, first, WIDER)
    assert http.delete(place(first["id"]), headers={"If-Match": "*"}).status_code == 204
    assert http.get(place(first["id"])).json()["state"] == "released"


def test_the_text_comes_as_it_was_written(http):
    text = BUSH.replace("\n", "\r\n") + "// ends without a line end, ünïcödé"
    id = drafted(http, text)["id"]
    answer = http.get(place(id, "text"))
    assert answer.content == text.encode()
    assert answer.headers["content-type"] == "text/plain; charset=utf-8"
    assert http.get(place(id, "text"), params={"version": 1}).content == text.encode()
    problem(http.get(place(id, "text"), params={"version": 2}), 404, "not-found")


def test_worksheets_are_listed_in_pages(http):
    ids = {drafted(http)["id"] for _ in range(3)}
    listed = [item["id"] for item in pages(http, f"{API}/worksheets", 2, 500)]
    assert ids <= set(listed)
    assert listed == sorted(set(listed))


@pytest.mark.parametrize("path", ["", "/text", "/versions/1"])
def test_what_is_not_there_is_not_found(http, path):
    problem(http.get(place("nothing_here") + path), 404, "not-found")
