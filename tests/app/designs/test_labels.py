"""Tags, archive and names of designs select designs and change no result."""

from uuid import uuid4

import pytest
from serving import API, created, faults, paper, patched, problem, revision

DESIGNS = f"{API}/designs"


@pytest.fixture
def word():
    return uuid4().hex


@pytest.fixture
def design(http, word):
    return created(http, {"name": word})


def label(http, design, **change):
    answer = http.post(f"{DESIGNS}/{design['id']}/labels", json=change)
    assert answer.status_code == 200, answer.text
    return answer.json()


def listed(http, **query):
    answer = http.get(DESIGNS, params=query)
    assert answer.status_code == 200, answer.text
    return [item["id"] for item in answer.json()["items"]]


class TestTags:
    def test_they_are_added_and_removed_in_any_spelling(self, http, design):
        assert label(http, design) == {"tags": [], "archived": False}
        assert label(http, design, add_tags=["V8", " main  bearing "])["tags"] == ["main bearing", "V8"]
        assert label(http, design, add_tags=["v8"])["tags"] == ["main bearing", "v8"], "as written last"
        assert label(http, design, remove_tags=["MAIN BEARING", "none"])["tags"] == ["v8"]
        assert http.get(f"{DESIGNS}/{design['id']}/labels").json() == {"tags": ["v8"], "archived": False}

    def test_they_make_no_revision(self, http, design):
        before = http.get(f"{DESIGNS}/{design['id']}")
        label(http, design, add_tags=["V8"], archived=True)
        after = http.get(f"{DESIGNS}/{design['id']}")
        assert (after.json(), after.headers["etag"]) == (before.json(), before.headers["etag"])

    def test_a_list_holds_designs_with_all_the_tags(self, http, word):
        one, both = (created(http, {"name": f"{word} {n}"}) for n in (1, 2))
        label(http, one, add_tags=[f"a{word}"[:40]])
        label(http, both, add_tags=[f"A{word}"[:40], f"b{word}"[:40]])
        first, second = f"a{word}"[:40], f"B{word}"[:40]
        assert listed(http, tag=first) == [both["id"], one["id"]]
        assert listed(http, tag=[first, second]) == [both["id"]]
        assert listed(http, tag=first, name=f"{word} 1") == [one["id"]]
        assert listed(http, tag=first[:-1]) == []
        item = http.get(DESIGNS, params={"tag": second}).json()["items"][0]
        assert (sorted(item["tags"]), item["archived"]) == (sorted([f"A{word}"[:40], f"b{word}"[:40]]), False)

    def test_the_tags_in_use_are_counted(self, http, word):
        tag = word[:40]
        designs = [created(http, {"name": f"{word} {n}"}) for n in range(3)]
        for each in designs:
            label(http, each, add_tags=[tag])
        uses = lambda: {item["tag"]: item["designs"] for item in http.get(f"{API}/tags").json()["items"]}  # noqa: E731
        assert uses()[tag] == 3
        label(http, designs[0], archived=True)
        http.delete(f"{DESIGNS}/{designs[1]['id']}", headers={"If-Match": "*"})
        assert uses()[tag] == 1

    @pytest.mark.parametrize(
        ("change", "name"),
        [
            ({"add_tags": [""]}, "add_tags.0"),
            ({"add_tags": ["  "]}, "add_tags.0"),
            ({"add_tags": ["a,b"]}, "add_tags.0"),
            ({"add_tags": ["a\x00"]}, "add_tags.0"),
            ({"add_tags": ["a" * 41]}, "add_tags.0"),
            ({"add_tags": [1]}, "add_tags.0"),
            ({"add_tags": [str(n) for n in range(21)]}, "add_tags"),
            ({"tags": ["a"]}, "tags"),
            ({"archived": "yes"}, "archived"),
        ],
    )
    def test_wrong_labels_are_refused(self, http, design, change, name):
        answer = http.post(f"{DESIGNS}/{design['id']}/labels", json=change)
        assert name in faults(answer)

    def test_a_design_has_at_most_twenty(self, http, design):
        label(http, design, add_tags=[f"t{n}" for n in range(20)])
        answer = http.post(f"{DESIGNS}/{design['id']}/labels", json={"add_tags": ["one more"]})
        assert faults(answer) == {"add_tags": "too_many"}
        assert len(http.get(f"{DESIGNS}/{design['id']}/labels").json()["tags"]) == 20
        assert len(label(http, design, add_tags=["one more"], remove_tags=["t3"])["tags"]) == 20

    def test_an_unknown_design_has_none(self, http):
        problem(http.get(f"{DESIGNS}/none/labels"), 404, "not-found")
        problem(http.post(f"{DESIGNS}/none/labels", json={"archived": True}), 404, "not-found")


class TestArchive:
    def test_lists_leave_archived_designs_out(self, http, word, design):
        other = created(http, {"name": f"{word} other"})
        label(http, design, archived=True)
        assert listed(http, name=word) == [other["id"]]
        assert listed(http, name=word, archived="true") == [design["id"]]
        assert listed(http, name=word, archived="any") == [other["id"], design["id"]]
        assert faults(http.get(DESIGNS, params={"archived": "maybe"})).keys() == {"archived"}
        label(http, design, archived=False)
        assert listed(http, name=word) == [other["id"], design["id"]]

    def test_an_archived_design_is_read_and_changed(self, http, design):
        label(http, design, archived=True)
        assert patched(http, design, {"parameters": {"scale": "2"}})["revision"] == 2
        assert http.get(f"{DESIGNS}/{design['id']}/labels").json()["archived"] is True


class TestNames:
    def test_a_new_name_keeps_every_result(self, served, http, monkeypatch):
        """Nothing is calculated, and no job is queued."""
        design = created(http, paper(name="old name"))
        before = revision(http, design)
        jobs = http.get(f"{API}/jobs").json()["items"]
        monkeypatch.setattr(
            served.app.state.services.designs, "prepare", lambda raw: pytest.fail("it was calculated")
        )
        renamed = patched(http, design, {"name": "new name"})
        after = revision(http, renamed)
        assert (renamed["name"], renamed["revision"], renamed["state"]) == ("new name", 2, "current")
        for part in ("parameters", "steps", "models", "iterations", "state"):
            assert after[part] == before[part], part
        assert (before["name"], after["note"]) == ("old name", "renamed from old name")
        assert http.get(f"{API}/jobs").json()["items"] == jobs
        assert design["id"] in listed(http, name="new name")
        assert http.get(f"{DESIGNS}/{design['id']}/model.step").headers["design-revision"] == "2"

    def test_it_takes_the_revision_that_was_read(self, http, design):
        patched(http, design, {"name": "second"})
        place = f"{DESIGNS}/{design['id']}"
        problem(http.patch(place, json={"name": "third"}, headers={"If-Match": '"1"'}), 412, "stale-revision")
        problem(http.patch(place, json={"name": "third"}), 428, "precondition-required")
        for name in ("", "a\x00", "a" * 201, None, 5):
            answer = http.patch(place, json={"name": name}, headers={"If-Match": '"2"'})
            assert "name" in faults(answer), name
        assert http.get(place).json()["revision"] == 2

    def test_it_is_done_once_under_one_key(self, http, design):
        place, headers = f"{DESIGNS}/{design['id']}", {"If-Match": '"1"', "Idempotency-Key": uuid4().hex}
        answers = [http.patch(place, json={"name": "once"}, headers=headers).json() for _ in range(2)]
        assert answers[0] == answers[1]
        assert http.get(place).json()["revision"] == 2

    def test_the_same_name_makes_no_revision(self, http, design):
        assert patched(http, design, {"name": design["name"]})["revision"] == 1
