"""What a client downloads is signed, and is verified with the keys that the service publishes."""

import io
import json
import zipfile

import pytest
from bare_shells import BUSH
from serving import API

from app.signing.keys import public_keys_in
from app.signing.verification import verify
from cad.face_marks import parameters_in

WAIT = {"Prefer": "wait=30"}


@pytest.fixture(scope="module")
def design(http):
    """A bush whose bore a parameter of the design sets, with a variant."""
    model = {"id": "plain_bearing", "version": 1, "parameters": {**BUSH, "inner_diameter": "= bore"}}
    document = {
        "name": "signed */ bush",
        "parameters": {"bore": "48.25 mm"},
        "models": {"shell": model},
        "variants": {"wide": {"shell.width": "26 mm"}},
    }
    answer = http.post(f"{API}/designs", json=document, headers=WAIT)
    assert answer.status_code == 201, answer.text
    return answer.json()


@pytest.fixture
def judged(http, tmp_path):
    """The verdict on bytes with the published keys."""
    keys = public_keys_in(http.get(f"{API}/stamp-keys").text)
    assert keys

    def judge(data):
        (tmp_path / "file").write_bytes(data)
        return verify(tmp_path / "file", keys)

    return judge


@pytest.mark.parametrize("name", ["model.step", "models/shell/model.glb", "model.validated.step"])
def test_a_download_is_valid_and_names_design_revision_and_relations(http, design, judged, name):
    answer = http.get(f"{API}/designs/{design['id']}/{name}", headers=WAIT)
    assert answer.status_code == 200
    verdict = judged(answer.content)
    assert verdict.kind == "valid", verdict
    claims = verdict.claims
    assert claims["design"] == {"id": design["id"], "name": "signed */ bush"}
    assert (claims["revision"], claims["model"]) == (1, "shell")
    assert claims["relations"]["inner_diameter"] == "shell.inner_diameter"
    assert sorted(claims["relations"]) == parameters_in(answer.content, name.rpartition(".")[2])
    explained = http.get(
        f"{API}/designs/{design['id']}/explain/{claims['relations']['inner_diameter']}"
    ).json()
    assert explained["relation"] == "= bore"
    stored = http.get(f"{API}/artifacts/{claims['build']['sha256']}")
    assert judged(stored.content).kind == "unsigned"
    again = http.get(answer.url, headers={"If-None-Match": answer.headers["etag"]})
    assert again.status_code == 304
    assert judged(answer.content.replace(b"shell.inner", b"shell.outer", 1)).kind == "tampered"


def test_the_service_knows_a_signed_file_again(http, design):
    step = http.get(f"{API}/designs/{design['id']}/model.step").content
    answer = http.post(f"{API}/verify", content=step, headers={"Content-Type": "model/step"})
    assert answer.status_code == 200, answer.text
    assert answer.json()["intact"] is True


def test_files_of_one_part_and_of_variants_are_signed(http, design, judged):
    place = f"{API}/designs/{design['id']}"
    part = judged(http.get(f"{place}/model.step", params={"part": "full_back"}, headers=WAIT).content)
    assert (part.kind, part.claims["part"], part.claims["kind"]) == ("valid", "full_back", "step#full_back")
    packed = http.get(f"{place}/variants.zip", headers=WAIT)
    with zipfile.ZipFile(io.BytesIO(packed.content)) as archive:
        (name,) = archive.namelist()
        verdict = judged(archive.read(name))
    assert (verdict.kind, verdict.claims["variant"]) == ("valid", "wide")


def test_a_new_key_signs_at_once_and_changes_the_etag(http, served, design, judged):
    place = f"{API}/designs/{design['id']}/model.step"
    before, tags = http.get(place), []
    old = judged(before.content).key
    served.app.state.services.stamp_keys.rotate()
    after = http.get(place, headers={"If-None-Match": before.headers["etag"]})
    assert after.status_code == 200
    listed = http.get(f"{API}/stamp-keys").json()["items"]
    assert [one["public"] for one in listed[1:]].count(old.public) == 1
    assert listed[0]["until"] is None
    keys = public_keys_in(json.dumps(listed))
    for answer, key in ((before, old), (after, keys[0])):
        tags.append(answer.headers["etag"])
        path = served_file(answer.content, served)
        assert verify(path, keys).key.public == key.public
    assert len(set(tags)) == 2


def served_file(data, served):
    path = served.app.state.services.settings.data.parent / "downloaded"
    path.write_bytes(data)
    return path
