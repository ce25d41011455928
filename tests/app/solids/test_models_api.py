"""CAD models over REST: parameters, builds, every kind of file, artifacts, verification; health."""

import hashlib
import xml.etree.ElementTree as ElementTree

import pytest
from serving import API, created, faults, moody, paper, patched, problem, revision

DESIGNS = f"{API}/designs"
BALL = f"{API}/models/ball_bearing/versions/1"
KINDS = {
    "step": ("model/step", b"ISO-10303-21;"),
    "glb": ("model/gltf-binary", b"glTF"),
    "stl": ("model/stl", None),
    "svg": ("image/svg+xml", None),
    "png": ("image/png", b"\x89PNG\r\n\x1a\n"),
}


@pytest.fixture(scope="module")
def design(http):
    return created(http, moody("27.5 mm"))


@pytest.fixture(scope="module")
def built(http):
    body = {"parameters": {"inner_diameter": "40 mm"}, "artifacts": ["step", "stl"]}
    answer = http.post(f"{BALL}/build", json=body, headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text
    return answer.json()


def place(design, tail):
    return f"{DESIGNS}/{design['id']}/{tail}"


class TestCatalogue:
    def test_list(self, http):
        listed = http.get(f"{API}/models").json()["items"]
        assert {"ball_bearing", "plain_bearing", "moody"} <= {item["id"] for item in listed}
        assert "oil_film" not in {item["id"] for item in listed}

    def test_show(self, http):
        answer = http.get(BALL).json()
        assert answer["parameters"]["required"] == ["inner_diameter"]
        assert answer["parameters"]["properties"]["inner_diameter"]["unit"] == "mm"
        assert answer["measures"]["mass"] == "kg"
        picture = http.get(answer["picture"], headers={"Prefer": "wait=60"})
        assert picture.headers["content-type"] == "image/png"
        assert picture.content.startswith(KINDS["png"][1])

    def test_versions(self, http):
        assert [item["version"] for item in http.get(f"{API}/models/ball_bearing").json()["items"]] == [1]

    @pytest.mark.parametrize("path", ["none", "none/versions/1", "ball_bearing/versions/99"])
    def test_unknown(self, http, path):
        problem(http.get(f"{API}/models/{path}"), 404, "unknown-template")


class TestBuild:
    def test_measures_what_was_asked_for(self, built):
        dimensions = built["measurements"]["dimensions"]
        assert dimensions["inner_diameter"] == {"value": pytest.approx(40, abs=1e-6), "unit": "mm"}
        assert built["measurements"]["mass"]["value"] > 0
        assert built["artifacts"].keys() == {"step", "stl"}

    def test_equal_parameters_are_one_build(self, http, built):
        body = {"parameters": {"inner_diameter": "4 cm"}, "artifacts": ["step"]}
        again = http.post(f"{BALL}/build", json=body).json()
        assert again["build"] == built["build"]
        assert again["artifacts"]["step"] == built["artifacts"]["step"]

    def test_its_name_finds_it(self, http, built):
        assert http.get(f"{API}/builds/{built['build']}").json()["measurements"] == built["measurements"]
        problem(http.get(f"{API}/builds/{'0' * 64}"), 404, "not-found")

    def test_respond_async(self, http):
        body = {"parameters": {"size": "28.5 mm"}, "artifacts": []}
        place = f"{API}/models/moody/versions/1/build"
        answer = http.post(place, json=body, headers={"Prefer": "respond-async"})
        assert answer.status_code == 202
        job = http.get(answer.headers["location"]).json()
        assert job["kind"] == "build"
        done = http.post(place, json=body, headers={"Prefer": "wait=60"}).json()
        assert done["build"] == answer.json()["build"]

    def test_wrong_parameters(self, http):
        body = {
            "parameters": {"inner_diameter": "-4 um", "colour": "1", "balls": "2.5"},
            "artifacts": ["step"],
        }
        assert faults(http.post(f"{BALL}/build", json=body)).keys() == {"inner_diameter", "colour", "balls"}
        assert faults(http.post(f"{BALL}/build", json={"parameters": {}, "artifacts": ["doc"]}))

    def test_a_failing_kernel_is_a_problem(self, http):
        body = {"parameters": {"size": "28 mm", "mood": "raises"}, "artifacts": ["step"]}
        answer = http.post(f"{API}/models/moody/versions/1/build", json=body, headers={"Prefer": "wait=60"})
        refusal = problem(answer, 422, "geometry")
        assert "mood" in {fault["name"] for fault in refusal["errors"]}


class TestFiles:
    @pytest.mark.parametrize("kind", KINDS)
    @pytest.mark.sampled(2)
    def test_every_kind_by_its_ending(self, http, design, kind):
        media, magic = KINDS[kind]
        answer = http.get(place(design, f"model.{kind}"), headers={"Prefer": "wait=60"})
        assert answer.status_code == 200, answer.text[:500]
        assert answer.headers["content-type"].partition(";")[0] == media
        assert answer.headers["design-revision"] == "1"
        assert answer.headers["etag"] == f'"{hashlib.sha256(answer.content).hexdigest()}"'
        assert f".{kind}" in answer.headers["content-disposition"]
        if magic:
            assert answer.content.startswith(magic)
        if kind == "svg":
            assert ElementTree.fromstring(answer.text).tag.endswith("svg")
        if kind == "stl":
            triangles = int.from_bytes(answer.content[80:84], "little")
            assert len(answer.content) == 84 + 50 * triangles

    @pytest.mark.parametrize("kind", KINDS)
    def test_every_kind_by_accept(self, http, design, kind):
        headers = {"Accept": f"text/html;q=0.1, {KINDS[kind][0]}", "Prefer": "wait=60"}
        answer = http.get(place(design, "model"), headers=headers)
        assert answer.headers["content-type"].partition(";")[0] == KINDS[kind][0]
        assert "Accept" in answer.headers["vary"]

    @pytest.mark.parametrize(
        ("accept", "media"),
        [
            ("model/stl, model/gltf-binary", "model/stl"),
            ("model/stl;q=0.5, model/gltf-binary;q=0.9", "model/gltf-binary"),
            ("image/svg+xml;q=0.2,model/step", "model/step"),
            ("IMAGE/PNG", "image/png"),
            ("model/stl;q=x", "model/stl"),
        ],
    )
    def test_the_kind_liked_best_is_sent(self, http, design, accept, media):
        answer = http.get(place(design, "model"), headers={"Accept": accept, "Prefer": "wait=60"})
        assert answer.headers["content-type"].partition(";")[0] == media

    @pytest.mark.parametrize("accept", ["*/*", "application/json", "", "nonsense"])
    def test_step_is_the_default(self, http, design, accept):
        answer = http.get(place(design, "model"), headers={"Accept": accept})
        assert answer.headers["content-type"] == "model/step"

    def test_every_path_to_it(self, http, design):
        tails = ("model", "model.step", "models/model/model", "models/model/model.step")
        paths = [*tails, *(f"revisions/1/{tail}" for tail in tails)]
        assert len({http.get(place(design, path)).content for path in paths}) == 1

    def test_a_kind_that_does_not_exist(self, http, design):
        assert "step" in problem(http.get(place(design, "model.exe")), 404, "not-found")["detail"]

    @pytest.mark.parametrize("path", ["model", "model.step", "measurements"])
    def test_a_design_that_does_not_exist(self, http, path):
        problem(http.get(f"{DESIGNS}/none/{path}"), 404, "not-found")

    def test_a_design_without_a_model(self, http):
        bare = created(http, {"name": "bare"})
        problem(http.get(place(bare, "model")), 404, "not-found")
        assert http.get(place(bare, "measurements")).json() == {}


class TestArtifacts:
    def test_they_match_their_hash_and_never_change(self, http, design):
        for sha in revision(http, design)["models"]["model"]["artifacts"].values():
            answer = http.get(f"{API}/artifacts/{sha}")
            assert hashlib.sha256(answer.content).hexdigest() == sha
            assert "immutable" in answer.headers["cache-control"]
            assert answer.headers["etag"] == f'"{sha}"'

    @pytest.mark.parametrize(
        "name", ["0" * 64, "x", "..%2f..%2fcrankwright.sqlite", "%2e%2e", "F" * 64, "0" * 63 + "%0a", "%00"]
    )
    def test_nothing_else_is_found(self, http, name):
        answer = http.get(f"{API}/artifacts/{name}")
        assert answer.status_code == 404
        assert answer.headers["content-type"] == "application/problem+json"


class TestVerify:
    def verify(self, http, content, media="model/step"):
        return http.post(f"{API}/verify", content=content, headers={"Content-Type": media})

    def test_a_step_file_tells_its_revisions(self, http):
        first = created(http, moody("29.5 mm"))
        step = http.get(place(first, "model.step")).content
        patched(http, first, {"models": {"model": {"parameters": {"size": "29.6 mm"}}}})
        origin = self.verify(http, step).json()
        assert origin["model"] == {"id": "moody", "version": 1}
        assert origin["build"] == revision(http, first, 1)["models"]["model"]["build"]
        assert origin["revisions"] == [{"design": first["id"], "revision": 1, "current": False}]
        assert origin["intact"] is True

    def test_a_changed_file_is_reported(self, http, design):
        step = http.get(place(design, "model.step")).content
        assert self.verify(http, step + b"\n/* edited */").json()["intact"] is False

    @pytest.mark.parametrize("content", [b"", b"\x00" * 100, b"ISO-10303-21;", b"\xff\xfe", b"x" * 100_000])
    def test_another_file_is_404(self, http, content):
        problem(self.verify(http, content), 404, "not-found")

    def test_a_build_that_is_not_known(self, http, design):
        step = http.get(place(design, "model.step")).content
        key = revision(http, design)["models"]["model"]["build"].encode()
        assert key in step
        problem(self.verify(http, step.replace(key, b"0" * 64)), 404, "not-found")

    @pytest.mark.parametrize(
        "media", ["application/json", "text/plain", "model/step+zip", "", "model/", "step"]
    )
    def test_another_type(self, http, media):
        refusal = problem(self.verify(http, b"{}", media), 415, "not-step")
        assert "model/step" in refusal["detail"]

    def test_no_type(self, http):
        problem(http.post(f"{API}/verify", content=b"ISO-10303-21;"), 415, "not-step")

    @pytest.mark.parametrize("media", ["application/step", "application/p21", "Model/STEP; charset=us-ascii"])
    def test_other_names_of_the_type(self, http, design, media):
        step = http.get(place(design, "model.step")).content
        assert self.verify(http, step, media).json()["intact"] is True


class TestHealth:
    def test_health(self, http):
        assert http.get("/healthz").json() == {"status": "ok"}

    def test_metrics_count(self, http):
        def requests():
            text = http.get("/metrics").text
            lines = [line for line in text.splitlines() if line.startswith("crankwright_requests_total{")]
            return sum(float(line.rpartition(" ")[2]) for line in lines)

        before = requests()
        http.get("/healthz")
        assert requests() == before + 2
        text = http.get("/metrics").text
        assert "crankwright_jobs_queued 0.0" in text
        assert "crankwright_request_seconds_bucket" in text


def test_the_paper_and_its_model_by_one_client(client):
    design = client.create(paper(name="by the client"))
    assert design.state == "current", design.problem
    assert client.model(design.id, "step").startswith(b"ISO-10303-21;")
