"""Revisions are immutable, copied, restored and paged; patches; the last good model of a failed one."""

import hashlib

import pytest
from designing import build_of, created_by, size_of
from serving import API, created, faults, moody, pages, paper, patched, problem, revision

from cad.stamp import is_copy

DESIGNS = f"{API}/designs"


@pytest.fixture(scope="module")
def good(http):
    return created(http, moody("21 mm"))


class TestRevisions:
    def test_notes_and_immutable_inputs(self, http, bearing, tied):
        listed = http.get(f"{DESIGNS}/{tied['id']}/revisions").json()["items"]
        assert [item["number"] for item in listed] == [2, 1]
        assert listed[0]["note"] == "the relation of the paper"
        first = revision(http, tied, 1)
        assert first["models"]["model"]["parameters"]["inner_diameter"]["value"] == 50
        assert first["models"]["model"]["relations"] == {}
        assert listed[0]["models"]["model"]["relations"] == {"inner_diameter": "= film.bearing_diameter"}
        assert http.put(f"{DESIGNS}/{tied['id']}/revisions/1", json={}).status_code == 405
        assert http.delete(f"{DESIGNS}/{tied['id']}/revisions/1").status_code == 405

    def test_a_revision_shows_its_artifacts_by_hash(self, http, tied):
        sha = revision(http, tied)["models"]["model"]["artifacts"]["step"]
        answer = http.get(f"{API}/artifacts/{sha}")
        assert hashlib.sha256(answer.content).hexdigest() == sha
        assert is_copy(http.get(f"{DESIGNS}/{tied['id']}/revisions/2/model.step").content, answer.content)

    def test_restore_makes_a_revision_equal_to_the_old_one(self, http, tied):
        copy = created_by(http.post(f"{DESIGNS}/{tied['id']}/copy"))
        changed = patched(http, copy, {"parameters": {"scale": "1.07"}})
        place = f"{DESIGNS}/{copy['id']}/revisions/1/restore"
        problem(http.post(place, headers={"If-Match": '"1"'}), 412, "stale-revision")
        answer = http.post(place, headers={"If-Match": '"2"', "Prefer": "wait=60"})
        assert answer.status_code == 200, answer.text
        restored = answer.json()
        assert restored["revision"] == 3
        assert restored["parameters"] == copy["parameters"] != changed["parameters"]
        assert revision(http, restored)["note"] == "as revision 1"
        assert build_of(http, restored) == build_of(http, copy)
        assert revision(http, restored, 2)["parameters"] == {"scale": "1.07"}
        noted = http.post(f"{DESIGNS}/{copy['id']}/revisions/2/restore", json={"note": "back"})
        assert revision(http, noted.json())["note"] == "back"

    def test_a_copy_is_independent(self, http, tied):
        copy = created_by(http.post(f"{DESIGNS}/{tied['id']}/copy"))
        assert copy["name"] == f"{tied['name']} (copy)"
        assert copy["id"] != tied["id"]
        assert copy["revision"] == 1
        assert tied["id"] in revision(http, copy)["note"]
        patched(http, copy, {"parameters": {"scale": "1.5"}})
        assert http.get(f"{DESIGNS}/{tied['id']}").json()["parameters"] == {"scale": "1"}

    def test_a_deleted_design_is_gone_from_lists_and_its_revisions_are_kept(self, http):
        design = created(http, moody("11 mm"))
        place = f"{DESIGNS}/{design['id']}"
        assert http.delete(place, headers={"If-Match": '"1"'}).status_code == 204
        problem(http.get(place), 404, "not-found")
        problem(http.delete(place, headers={"If-Match": '"1"'}), 404, "not-found")
        problem(http.patch(place, json={}, headers={"If-Match": "*"}), 404, "not-found")
        listed = http.get(DESIGNS, params={"limit": 500}).json()["items"]
        assert design["id"] not in {item["id"] for item in listed}

    def test_a_deletion_names_the_revision_that_was_read(self, http):
        design = created(http, moody("11 mm"))
        place = f"{DESIGNS}/{design['id']}"
        problem(http.delete(place), 428, "precondition-required")
        patched(http, design, {"note": "by somebody else", "parameters": {"more": "1 mm"}})
        problem(http.delete(place, headers={"If-Match": '"1"'}), 412, "stale-revision")
        assert http.get(place).json()["revision"] == 2

    def test_a_deleted_design_is_listed_and_restored_with_all_its_revisions(self, http):
        design = patched(http, created(http, moody("12 mm")), {"parameters": {"more": "1 mm"}})
        place = f"{DESIGNS}/{design['id']}"
        http.delete(place, headers={"If-Match": '"2"'}).raise_for_status()
        deleted = http.get(DESIGNS, params={"limit": 500, "deleted": True}).json()["items"]
        [own] = [item for item in deleted if item["id"] == design["id"]]
        assert own["deleted"].startswith("20")
        assert all("deleted" in item for item in deleted)
        for _ in range(2):  # a repetition changes nothing
            back = http.post(f"{place}/restore")
            assert (back.status_code, back.headers["etag"]) == (200, '"2"')
            assert back.json()["parameters"] == http.get(place).json()["parameters"] == design["parameters"]
        assert len(http.get(f"{place}/revisions").json()["items"]) == 2
        assert "deleted" not in http.get(DESIGNS).json()["items"][0]
        problem(http.post(f"{DESIGNS}/{'0' * 24}/restore"), 404, "not-found")
        assert revision(http, design)["models"]["model"]["build"]
        assert http.get(f"{place}/revisions/1/model.step").status_code == 200

    def test_paging(self, http):
        new = [created(http, {"name": f"page {i}"})["id"] for i in range(3)]
        whole = http.get(DESIGNS, params={"limit": 500}).json()["items"]
        listed = [item["id"] for item in pages(http, DESIGNS, 2, len(whole) // 2 + 1)]
        assert listed[:3] == new[::-1]
        assert len(listed) == len(set(listed))

    def test_paging_of_revisions(self, http):
        design = created(http, {"name": "many", "parameters": {"a": "0"}})
        for i in range(1, 5):
            design = patched(http, design, {"parameters": {"a": str(i)}})
        place = f"{DESIGNS}/{design['id']}/revisions"
        first = http.get(place, params={"limit": 3}).json()
        second = http.get(place, params={"limit": 3, "cursor": first["next"]}).json()
        assert [item["number"] for item in first["items"] + second["items"]] == [5, 4, 3, 2, 1]
        assert second["next"] is None


class TestPatch:
    @pytest.fixture
    def plain(self, http):
        document = paper(parameters={"scale": "1", "other": "2 mm"})
        del document["model"]
        return created(http, document)

    def test_null_removes(self, http, plain):
        changed = patched(http, plain, {"parameters": {"other": None}})
        assert changed["parameters"] == {"scale": "1"}

    def test_a_quantity_is_replaced_whole(self, http, plain):
        load = {"value": 25, "unit": "kN", "plus": 1}
        first = patched(http, plain, {"steps": {"film": {"inputs": {"radial_load": load}}}})
        second = patched(
            http, first, {"steps": {"film": {"inputs": {"radial_load": {"value": 26, "unit": "kN"}}}}}
        )
        assert second["steps"]["film"]["inputs"]["radial_load"] == {"value": 26, "unit": "kN"}
        headers = {"If-Match": "*"}
        partial = {"steps": {"film": {"inputs": {"radial_load": {"value": 26}}}}}
        refused = http.patch(f"{DESIGNS}/{plain['id']}", json=partial, headers=headers)
        assert faults(refused) == {"film.radial_load": "missing_unit"}

    @pytest.mark.parametrize("field", ["id", "state", "revision", "problem", "created", "nonsense"])
    def test_what_the_service_decides_is_refused(self, http, plain, field):
        refused = http.patch(f"{DESIGNS}/{plain['id']}", json={field: "x"}, headers={"If-Match": "*"})
        assert list(faults(refused)) == [field]

    @pytest.mark.parametrize(
        "patch", [{}, {"parameters": {"scale": "1"}}, {"note": "nothing"}, {"steps": {}}]
    )
    def test_a_patch_that_changes_nothing_makes_no_revision(self, http, plain, patch):
        assert patched(http, plain, patch)["revision"] == 1

    def test_both_media_types(self, http, plain):
        for i, media in enumerate(("application/json", "application/merge-patch+json"), start=1):
            answer = http.patch(
                f"{DESIGNS}/{plain['id']}",
                content=f'{{"parameters": {{"scale": "1.0{i}"}}}}',
                headers={"If-Match": f'"{i}"', "Content-Type": media},
            )
            assert answer.json()["revision"] == i + 1

    def test_a_name_can_change(self, http, plain):
        patched(http, plain, {"name": "renamed"})
        listed = http.get(DESIGNS).json()["items"]
        assert next(item["name"] for item in listed if item["id"] == plain["id"]) == "renamed"

    def test_model_and_models_at_once_are_refused(self, http, plain):
        for models in ([1], {}, {"shell": {"id": "plain_bearing"}}):
            body = {"model": {"id": "moody"}, "models": models}
            refused = http.patch(f"{DESIGNS}/{plain['id']}", json=body, headers={"If-Match": "*"})
            assert "not both" in problem(refused, 422, "invalid-inputs")["detail"]
            assert problem(http.post(DESIGNS, json={"name": "x", **body}), 422, "invalid-inputs")

    @pytest.mark.parametrize("note", [{"a": 1}, 5, True, ["x"], "x" * 1001])
    def test_a_note_is_a_short_text(self, http, plain, note):
        body = {"note": note, "parameters": {"scale": "3"}}
        refused = http.patch(f"{DESIGNS}/{plain['id']}", json=body, headers={"If-Match": "*"})
        assert list(faults(refused)) == ["note"]

    def test_the_latest_version_is_pinned(self, http):
        document = paper()
        del document["model"]
        document["steps"]["film"]["version"] = "latest"
        assert isinstance(created(http, document)["steps"]["film"]["version"], int)


class TestFailingRebuild:
    """The last good model stays served under its own revision, and the revision says why."""

    @pytest.mark.parametrize(
        ("mood", "slug", "code"),
        [
            ("raises", "geometry", "kernel"),
            ("two_solids", "geometry", "not_one_solid"),
            ("wrong_volume", "geometry", "volume"),
            ("dies", "crashed", None),
        ],
    )
    @pytest.mark.sampled(1)
    def test_the_last_good_model_stays_served(self, http, good, mood, slug, code):
        design = created_by(http.post(f"{DESIGNS}/{good['id']}/copy", headers={"Prefer": "wait=60"}))
        place = f"{DESIGNS}/{design['id']}"
        before = http.get(f"{place}/model.step")
        failed = patched(http, design, {"models": {"model": {"parameters": {"mood": mood}}}})
        assert (failed["state"], failed["revision"]) == ("failed", 2)
        assert failed["problem"]["type"] == f"/problems/{slug}"
        if code:
            assert {fault["code"] for fault in failed["problem"]["errors"]} == {code}
            assert "model.mood" in {fault["name"] for fault in failed["problem"]["errors"]}
        served = http.get(f"{place}/model.step")
        assert served.content == before.content
        assert served.headers["design-revision"] == "1"
        assert size_of(http, design) == pytest.approx(21)
        kept = revision(http, failed)
        assert (kept["state"], kept["problem"]) == ("failed", failed["problem"])
        assert revision(http, failed, 1)["state"] == "current"
        refusal = problem(http.get(f"{place}/revisions/2/model.step"), 404, "not-found")
        assert failed["problem"]["detail"][:40] in refusal["detail"]
        corrected = patched(
            http, failed, {"models": {"model": {"parameters": {"mood": "good", "size": "22 mm"}}}}
        )
        assert corrected["state"] == "current"
        assert http.get(f"{place}/model.step").headers["design-revision"] == "3"
