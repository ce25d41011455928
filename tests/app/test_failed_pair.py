"""If the second of two solids of a revision fails, the first is built but not served."""

from serving import API, created, patched, revision


def block(size, mood="good"):
    return {"id": "moody", "version": 1, "parameters": {"size": size, "mood": mood}}


def size_of(http, place, model):
    return http.get(f"{place}/measurements").json()[model]["dimensions"]["size"]["value"]


def test_a_solid_of_a_failed_revision_is_not_the_last_good_one(http):
    document = {"name": "pair", "models": {"a": block("23 mm"), "b": block("24 mm")}}
    design = created(http, document)
    assert design["state"] == "current", design["problem"]
    place = f"{API}/designs/{design['id']}"
    before = http.get(f"{place}/models/a/model.step")
    changes = {"a": {"parameters": {"size": "25 mm"}}, "b": {"parameters": {"mood": "raises"}}}
    failed = patched(http, design, {"models": changes})
    assert (failed["state"], failed["revision"]) == ("failed", 2)

    own = http.get(f"{place}/revisions/2/models/a/model.step")
    assert own.status_code == 200, "the first solid is built before the second: else this test says nothing"
    assert own.content != before.content

    served = http.get(f"{place}/models/a/model.step")
    assert served.headers["design-revision"] == "1"
    assert served.content == before.content
    assert size_of(http, place, "a") == 23
    assert size_of(http, place, "b") == 24
    assert revision(http, failed)["models"]["a"]["build"] != revision(http, failed, 1)["models"]["a"]["build"]
