"""Comments on revisions are stored with audit rows in the same transaction as the change."""

import pytest
from approving import Room
from patience import until
from serving import API, created, faults, moody, pages, paper, patched, problem


@pytest.fixture(scope="module")
def room(team):
    with Room.of(team) as room:
        yield room


@pytest.fixture(scope="module")
def design(room):
    return created(room.author, paper(name="commented"))


def commented(http, design, text, number=1, **more):
    place = f"{API}/designs/{design['id']}/revisions/{number}/comments"
    return http.post(place, json={"text": text, **more})


def audited(room, place, **wanted):
    rows = room.admin.get(f"{API}/audit", params={"object": place, "limit": 500, **wanted}).json()["items"]
    return [(row["action"], row["name"], row["object"].removeprefix(place)) for row in reversed(rows)]


def test_a_comment_is_plain_text_of_somebody(room, design):
    text = "Why 22 mm?\n<script>alert(1)</script>"
    answer = commented(room.checker, design, text, subject="film.bearing_width").json()
    assert (answer["name"], answer["text"], answer["subject"]) == ("checker", text, "film.bearing_width")
    listed = room.viewer.get(f"{API}/designs/{design['id']}/revisions/1/comments").json()["items"]
    assert answer in listed


def test_viewers_read_comments_and_write_none(room, design):
    problem(commented(room.viewer, design, "no"), 403, "role-needed")


@pytest.mark.parametrize(
    ("body", "wrong"),
    [
        ({"text": "  \n "}, "text"),
        ({"text": "x" * 4001}, "text"),
        ({"text": "\x00"}, "text"),
        ({"text": "x", "subject": "film.bearing_widht"}, "subject"),
        ({"text": "x", "subject": ""}, "subject"),
        ({"text": "x", "author": "Eve"}, "author"),
    ],
)
def test_what_is_no_comment_is_refused_by_name(room, design, body, wrong):
    answer = room.author.post(f"{API}/designs/{design['id']}/revisions/1/comments", json=body)
    assert set(faults(answer)) == {wrong}


def test_a_name_that_is_nearly_right_is_offered(room, design):
    answer = commented(room.author, design, "x", subject="film.bearing_widht")
    assert "near it: film.bearing_width" in answer.json()["detail"]


@pytest.mark.parametrize("subject", ["scale", "film", "film.minimum_film_thickness", "model.inner_diameter"])
def test_parameters_blocks_and_values_are_names(room, design, subject):
    assert commented(room.author, design, "x", subject=subject).status_code == 201


def test_a_comment_is_resolved_once(room, design):
    comment = commented(room.author, design, "to be resolved").json()
    place = f"{API}/designs/{design['id']}/revisions/1/comments/{comment['id']}/resolve"
    first, again = room.checker.post(place).json(), room.author.post(place).json()
    assert first == again
    assert first["resolved_by"] == "checker"
    problem(room.author.post(place.replace("/revisions/1/", "/revisions/2/")), 404, "not-found")


def test_comments_are_listed_page_by_page_over_all_revisions(room):
    design = created(room.author, moody("14 mm"))
    newer = patched(room.author, design, {"models": {"model": {"parameters": {"size": "15 mm"}}}})
    texts = [f"comment {n}" for n in range(5)]
    for n, text in enumerate(texts):
        commented(room.author, newer, text, 1 + n % 2)
    listed = [one["text"] for one in pages(room.author, f"{API}/designs/{design['id']}/comments", 2, 10)]
    assert listed == texts[::-1]
    assert len(room.author.get(f"{API}/designs/{design['id']}/revisions/2/comments").json()["items"]) == 2


def test_every_change_of_a_design_leaves_a_row(room):
    design = created(room.author, moody("10 mm"))
    place = f"designs/{design['id']}"
    patched(room.author, design, {"models": {"model": {"parameters": {"size": "11 mm"}}}})
    room.author.patch(f"{API}/{place}", json={"name": "another"}, headers={"If-Match": "*"})
    room.author.post(f"{API}/{place}/revisions/1/restore")
    room.author.post(f"{API}/{place}/labels", json={"add_tags": ["x"], "archived": True})
    room.author.post(f"{API}/{place}/labels", json={"add_tags": ["x"], "archived": True})  # changes nothing
    room.author.delete(f"{API}/{place}", headers={"If-Match": "*"})
    assert audited(room, place) == [
        ("design.create", "author", "/revisions/1"),
        ("design.change", "author", "/revisions/2"),
        ("design.rename", "author", "/revisions/3"),
        ("design.restore", "author", "/revisions/4"),
        ("design.tag", "author", ""),
        ("design.archive", "author", ""),
        ("design.delete", "author", ""),
    ]
    assert audited(room, place, action="design.delete", principal="author") == [
        ("design.delete", "author", "")
    ]


def test_a_refused_change_leaves_no_row(room):
    design = created(room.author, moody("10 mm"))
    place = f"designs/{design['id']}"
    before = audited(room, place)
    assert room.author.patch(f"{API}/{place}", json={"x": 1}, headers={"If-Match": '"1"'}).status_code == 422
    stale = room.author.patch(f"{API}/{place}", json={"name": "x"}, headers={"If-Match": '"9"'})
    assert stale.status_code == 412
    assert commented(room.author, design, "x", subject="nothing").status_code == 422
    assert room.viewer.delete(f"{API}/{place}", headers={"If-Match": "*"}).status_code == 403
    assert audited(room, place) == before


def test_the_audit_is_for_administrators(room):
    for path in (f"{API}/audit", f"{API}/audit/head", "/audit"):
        assert room.checker.get(path).status_code == 403
        assert room.admin.get(path).status_code == 200


def test_the_head_is_that_of_the_newest_sealed_row(team, room):
    room.author.post(f"{API}/designs", json={"name": "sealed"})
    head = until(lambda: room.admin.get(f"{API}/audit/head").json(), lambda head: head["seq"] > 0)
    rows = pages(room.admin, f"{API}/audit", 500, 100)
    assert [row["hash"] for row in rows if row["seq"] == head["seq"]] == [head["hash"]]
