"""Files of several builds are one job; the failure of one is reported when the others are ready."""

from bare_shells import BUSH
from patience import until
from serving import API

from cad.errors import GeometryError

PLACE = f"{API}/models/plain_bearing/versions/1/build"


def built(http, size):
    body = {"parameters": {**BUSH, "inner_diameter": size, "width": "11 mm"}, "artifacts": ["step"]}
    answer = http.post(PLACE, json=body, headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text
    return answer.json()["build"]


def ended(http, job):
    ask = lambda: http.get(f"{API}/jobs/{job}").json()  # noqa: E731
    return until(ask, lambda now: now["state"] in ("done", "failed"))


def files(http, key):
    return set(http.get(f"{API}/builds/{key}").json()["artifacts"])


def test_all_are_made_by_one_job(served, http):
    keys = [built(http, size) for size in ("71 mm", "72 mm", "73 mm")]
    models = served.app.state.services.models
    job = models.request_files_of_all(keys, ("svg",))
    end = ended(http, job)
    assert end["state"] == "done"
    assert "solid 3 of 3" in end["log"]
    assert all(files(http, key) == {"step", "svg"} for key in keys)


def test_a_failure_leaves_the_others(served, http, monkeypatch):
    first, second = built(http, "74 mm"), built(http, "75 mm")
    builds = served.app.state.services.jobs._dispatcher.kinds["build"].handler.builds
    derive = builds.derive

    def moody(key, kind, context):
        if key == first:
            raise GeometryError("kernel", "no picture today")
        derive(key, kind, context)

    monkeypatch.setattr(builds, "derive", moody)
    end = ended(http, served.app.state.services.models.request_files_of_all([first, second], ("svg",)))
    assert end["state"] == "failed"
    assert "no picture today" in end["problem"]["detail"]
    assert (files(http, first), files(http, second)) == ({"step"}, {"step", "svg"})


def test_a_drawing_of_a_build_is_made_once_and_stored(http):
    key = built(http, "76 mm")
    place = f"{API}/builds/{key}/model.drawing.pdf"
    answer = http.get(place)
    assert (answer.status_code, answer.headers["content-type"]) == (200, "application/pdf"), answer.text
    assert answer.content.startswith(b"%PDF")
    assert 'filename="plain_bearing_v1.drawing.pdf"' in answer.headers["content-disposition"]
    stored = http.get(f"{API}/builds/{key}").json()["artifacts"]["drawing.pdf"]
    assert answer.headers["etag"] == f'"{stored}"'
    again = http.get(place, headers={"If-None-Match": answer.headers["etag"]})
    assert again.status_code == 304


def test_a_file_of_no_build_or_of_no_kind_is_not_found(http):
    assert http.get(f"{API}/builds/{'0' * 64}/model.dxf").status_code == 404
    answer = http.get(f"{API}/builds/{built(http, '76 mm')}/model.dwg")
    assert answer.status_code == 404
    assert "there is no file model.dwg; there are " in answer.json()["detail"]
