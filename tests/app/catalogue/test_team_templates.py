"""Files of a team's folder are checked when loaded, quarantined if faulty, and read again if changed."""

import json
import os
import threading
from contextlib import contextmanager
from textwrap import dedent
from types import SimpleNamespace

import httpx
import pytest
from click.testing import CliRunner
from patience import patient, until
from serving import API, DOUBLE, MOODY, created, faults, moody, patched, problem, revision, serving
from sleeping import ALARM, folder_of_sleeper

from app.catalogue.catalogues import loaded
from app.cli.main import main
from app.jobs.service import JobFailed
from app.settings import Settings
from app.solids.models import ModelBuild

TWICE, ENDLESS = dedent(DOUBLE).lstrip(), "import time\ntime.sleep(3600)\n"
BROKEN = TWICE.replace("return 2 * self.a", "return 2 * self.c")
LONGEST = patient(5.0)  # in which a file is checked here [s]
FAULTS = f"{API}/catalogue/faults"
DOUBLED = f"{API}/templates/double/versions"


@contextmanager
def server_on(folder, data, **options):
    settings = Settings(data=data, template_folders=(folder,), wait_seconds=20, **options)
    with serving(settings) as server:
        with httpx.Client(base_url=server.url, timeout=90, trust_env=False) as http:
            yield http


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    return tmp_path_factory.mktemp("team")


@pytest.fixture(scope="module")
def http(place):
    """A server that begins with a folder of one good file and many bad ones."""
    own = place / "own"
    own.mkdir()
    for name, text in {
        "double_v1": TWICE,
        "double_v2": TWICE,
        "double_v3": BROKEN,
        "double_v4": ENDLESS,
        "double_v5": "import os\nos._exit(7)\n",
        "double_v6": "import no_such_module\n",
        "double_v7": "def (",
        "oil_film_v2": TWICE,
        "moody_v1": dedent(MOODY).lstrip(),
        "Double_v8": TWICE,
    }.items():
        (own / f"{name}.py").write_text(text)
    (own / "again").mkdir()
    (own / "again" / "double_v2.py").write_text(TWICE)
    folder_of_sleeper(own / "sleeper")
    with server_on(own, place / "data", template_seconds=LONGEST, calculation_processes=1) as http:
        yield http


@pytest.fixture
def own(place):
    return place / "own"


def faulty(http):
    """The faults of each file, by its name."""
    items = http.get(FAULTS, params={"limit": 500}).json()["items"]
    return {item["file"]: item for item in items}


def doubled(http, version=1, length="3 mm"):
    return http.post(f"{DOUBLED}/{version}/evaluate", json={"inputs": {"length": length}})


def value(http, version=1):
    """The template's result for 3 mm; None while it cannot be used."""
    answer = doubled(http, version)
    return answer.json()["outputs"]["twice_the_length"]["value"] if answer.is_success else None


class TestQuarantine:
    @pytest.mark.parametrize(
        ("file", "code", "line", "words"),
        [
            ("own/double_v3.py", "unknown_attribute", 15, "self.c"),
            ("own/double_v4.py", "too_long", None, f"within {LONGEST:g} s"),
            ("own/double_v5.py", "crashed", None, "exit code 7"),
            ("own/double_v6.py", "import", 1, "no_such_module"),
            ("own/double_v7.py", "syntax", 1, "SyntaxError"),
            ("own/double_v2.py", "duplicate", None, "own/again/double_v2.py"),
            ("own/oil_film_v2.py", "shipped", None, "that of this program"),
            ("own/Double_v8.py", "file_name", None, "Double_v8"),
        ],
    )
    def test_a_faulty_file_is_listed_with_its_faults(self, http, file, code, line, words):
        item = faulty(http)[file]
        assert item["quarantined"] is True
        (fault,) = item["faults"]
        assert (fault["code"], fault["line"]) == (code, line)
        assert words in fault["what"]
        assert fault["remedy"]

    def test_the_others_work(self, http):
        assert value(http) == 6
        assert value(http, 2) == 6, "the first of two files that claim a version"
        film = http.get(f"{API}/templates/oil_film/versions/2").json()
        assert "radial_load" in film["inputs"]["properties"], "the shipped version"
        assert "moody" in {item["id"] for item in http.get(f"{API}/models").json()["items"]}
        assert len(faulty(http)) == 8

    def test_a_quarantined_version_says_why(self, http):
        for answer in (http.get(f"{DOUBLED}/3"), doubled(http, 3)):
            refusal = problem(answer, 404, "quarantined")
            assert "own/double_v3.py has faults: line 15: " in refusal["detail"]
        listed = http.get(f"{API}/templates/double").json()["items"]
        assert [item["version"] for item in listed] == [1, 2]
        assert listed[-1]["latest"]

    def test_the_list_has_pages(self, http):
        first = http.get(FAULTS, params={"limit": 3}).json()
        rest = http.get(FAULTS, params={"limit": 500, "cursor": first["next"]}).json()
        assert [item["file"] for item in (*first["items"], *rest["items"])] == list(faulty(http))

    def test_the_page_shows_them(self, http):
        page = http.get("/templates/faults").text
        for words in ("own/double_v3.py", "which does not exist", "quarantined"):
            assert words in page
        assert 'href="/templates/faults"' in http.get("/").text


class TestDesigns:
    def test_a_design_of_a_quarantined_version_is_read_and_not_calculated(self, http, own):
        file = own / "double_v1.py"
        document = moody("= twice.twice_the_length")
        document["steps"] = {"twice": {"template": "double", "version": 1, "inputs": {"length": "4 mm"}}}
        design = created(http, document)
        before = revision(http, design)
        file.write_text(BROKEN)
        try:
            until(lambda: value(http) is None)
            place = f"{API}/designs/{design['id']}"
            assert http.get(place).json() == design
            assert revision(http, design) == before
            for path in ("/worksheet.json", "/worksheet.csv", "/report.html", "/measurements", "/model.step"):
                assert http.get(f"{place}{path}").status_code == 200, path
            change = {"steps": {"twice": {"inputs": {"length": "5 mm"}}}}
            headers = {"If-Match": '"1"'}
            assert faults(http.patch(place, json=change, headers=headers)) == {"steps.twice": "quarantined"}
            assert faults(http.post(f"{place}/preview", json=change)) == {"steps.twice": "quarantined"}
            for path in (f"/designs/{design['id']}", f"/designs/{design['id']}/revisions/1"):
                page = http.get(path, headers={"Accept": "text/html"})
                assert page.status_code == 200
                assert "cannot be calculated now" in page.text
                assert "own/double_v1.py has faults: line 15" in page.text
                assert "Twice the length" in page.text
        finally:
            file.write_text(TWICE)
        until(lambda: value(http) == 6)
        assert patched(http, design, change)["state"] == "current"
        assert "cannot be calculated" not in http.get(f"/designs/{design['id']}").text

    @pytest.mark.slow
    def test_a_design_of_a_quarantined_model_is_read_and_its_jobs_say_why(self, http, own):
        file = own / "moody_v1.py"
        text = file.read_text()
        design = created(http, moody("9 mm"))
        body = {"parameters": {"size": "5 mm"}}
        build = f"{API}/models/moody/versions/1/build"
        file.write_text(f"{text}\n)")
        try:
            until(lambda: http.get(f"{API}/models/moody").status_code == 404)
            place = f"{API}/designs/{design['id']}"
            for path in ("", "/revisions/1", "/report.html", "/worksheet.json", "/model.step", "/model.png"):
                answer = http.get(f"{place}{path}", headers={"Prefer": "wait=60"})
                assert answer.status_code == 200, path
            page = http.get(f"/designs/{design['id']}", headers={"Accept": "text/html"})
            assert (page.status_code, "cannot be calculated now" in page.text) == (200, True)
            problem(http.post(build, json=body), 404, "quarantined")
            change = {"models": {"model": {"parameters": {"size": "6 mm"}}}}
            refused = http.patch(place, json=change, headers={"If-Match": '"1"'})
            assert faults(refused) == {"models.model": "quarantined"}
        finally:
            file.write_text(text)
        until(lambda: http.get(f"{API}/models/moody").status_code == 200)
        assert patched(http, design, change)["state"] == "current"

    def test_a_job_whose_model_was_quarantined_meanwhile_says_so(self, tmp_path):
        """As after a restart: the row names a version that cannot be used any more."""
        (tmp_path / "slab_v1.py").write_text("def (")
        catalogues = loaded((tmp_path,))
        job = SimpleNamespace(payload={"model": "slab", "version": 1, "parameters": {}, "kinds": []})
        with pytest.raises(JobFailed) as failure:
            ModelBuild(None, catalogues)(job, None)
        assert "slab version 1 is quarantined" in str(failure.value.__cause__)


class TestReload:
    def test_a_file_is_read_again_when_it_changes_comes_and_goes(self, http, own):
        file = own / "double_v9.py"
        problem(doubled(http, 9), 404, "unknown-template")
        file.write_text(TWICE)
        until(lambda: value(http, 9) == 6)
        digest = http.get(f"{DOUBLED}/9").json()["digest"]
        file.write_text(TWICE.replace("2 * self.a", "5 * self.a"))
        until(lambda: value(http, 9) == 15)
        assert http.get(f"{DOUBLED}/9").json()["digest"] != digest
        file.unlink()
        until(lambda: value(http, 9) is None)
        problem(doubled(http, 9), 404, "unknown-template")

    @pytest.mark.slow
    def test_a_worksheet_does_not_show_another_code_than_that_of_its_results(self, http, own):
        file = own / "double_v10.py"
        file.write_text(TWICE)
        until(lambda: value(http, 10) == 6)
        step = {"template": "double", "version": 10, "inputs": {"length": "4 mm"}}
        design = created(http, {"name": "edited", "steps": {"twice": step}})
        sheet = f"{API}/designs/{design['id']}/revisions/1/worksheet"
        assert len(http.get(sheet).json()["steps"]["twice"]["formulas"]) == 1
        file.write_text(TWICE.replace("2 * self.a", "5 * self.a"))
        until(lambda: value(http, 10) == 15)
        shown = http.get(sheet).json()["steps"]["twice"]
        assert (shown["outputs"]["twice_the_length"]["value"], shown["formulas"]) == (8, [])

    @pytest.mark.slow
    def test_a_running_calculation_ends_with_the_code_it_began_with(self, http, own, tmp_path, monkeypatch):
        log = tmp_path / "log"
        monkeypatch.setenv("SLEEPER_LOG", str(log))
        file = own / "sleeper" / "sleeper_v1.py"
        file.write_text(file.read_text().replace('os.environ.get("SLEEPER_LOG", os.devnull)', repr(str(log))))
        sleeper = f"{API}/templates/sleeper/versions/1"

        def process(duration, version=sleeper):
            answer = http.post(f"{version}/evaluate", json={"inputs": {"duration": duration}})
            return answer.json()["outputs"]["process"]["value"]

        until(lambda: process("1 ms") and log.exists())
        begun = len(log.read_text().split())
        answers = []
        thread = threading.Thread(target=lambda: answers.append(process("60 s")))
        thread.start()
        until(lambda: len(log.read_text().split()) > begun)
        digest = http.get(sleeper).json()["digest"]
        file.write_text(file.read_text().replace("return np.float64(os.getpid())", "return np.float64(-1)"))
        until(lambda: http.get(sleeper).json()["digest"] != digest)
        assert not answers, "it still runs"
        alarm = own / "sleeper" / ALARM
        alarm.touch()
        thread.join()
        alarm.unlink()
        assert answers[0] > 0
        assert answers[0] != os.getpid()
        assert process("1 ms") == -1, "a process that calculated by the old file calculates by the new one"

    @pytest.mark.slow
    def test_an_edited_model_makes_another_build(self, http, own):
        parameters = {"parameters": {"size": "7 mm"}}
        build = f"{API}/models/moody/versions/1/build"
        old = http.post(build, json=parameters, headers={"Prefer": "wait=60"}).json()
        file = own / "moody_v1.py"
        text = file.read_text()
        digest = http.get(f"{API}/models/moody/versions/1").json()["digest"]
        file.write_text(
            text.replace('Part("block"', 'Part("brick"').replace('seen["block"]', 'seen["brick"]')
        )
        until(lambda: http.get(f"{API}/models/moody/versions/1").json()["digest"] != digest)
        new = http.post(build, json=parameters, headers={"Prefer": "wait=60"}).json()
        assert new["build"] != old["build"]
        assert new["artifacts"]["step"] != old["artifacts"]["step"]
        file.write_text(text)
        until(lambda: http.get(f"{API}/models/moody/versions/1").json()["digest"] == digest)
        again = http.post(build, json=parameters, headers={"Prefer": "wait=60"}).json()
        assert again["artifacts"] == old["artifacts"]

    @pytest.mark.slow
    def test_an_import_without_end_holds_up_nobody_for_long(self, http, own):
        """The service answers while the file is checked; then the file is quarantined."""
        file = own / "double_v11.py"
        file.write_text(ENDLESS)
        try:
            seen = until(lambda: value(http) == 6 and faulty(http).get("own/double_v11.py"))
            assert seen["faults"][0]["code"] == "too_long"
        finally:
            file.unlink()


def test_a_folder_that_is_missing_is_a_fault(tmp_path):
    with server_on(tmp_path / "none", tmp_path / "data") as http:
        (item,) = http.get(FAULTS).json()["items"]
        assert (item["file"].split("/")[-1], item["faults"][0]["code"]) == ("none", "folder")
        assert http.get("/templates/faults").status_code == 200


class TestCommands:
    def run(self, *arguments):
        return CliRunner().invoke(main, [str(argument) for argument in arguments])

    def test_a_sound_file(self, tmp_path):
        (tmp_path / "double_v1.py").write_text(TWICE)
        result = self.run("check-template", tmp_path / "double_v1.py")
        assert result.exit_code == 0, result.output
        for words in ("double version 1", "No fault", "1 inputs", "length", "twice_the_length", "mm"):
            assert words in result.output

    def test_a_faulty_file(self, tmp_path):
        (tmp_path / "double_v1.py").write_text(BROKEN)
        result = self.run("check-template", tmp_path / "double_v1.py", "--json")
        assert result.exit_code == 1
        report = json.loads(result.output)
        assert (report["sound"], report["faults"][0]["line"]) == (False, 15)

    @pytest.mark.slow
    def test_an_endless_file(self, tmp_path):
        (tmp_path / "double_v1.py").write_text(ENDLESS)
        result = self.run("check-template", tmp_path / "double_v1.py", "--seconds", "1")
        assert (result.exit_code, "within 1 s" in result.output) == (1, True)

    def test_a_missing_file(self, tmp_path):
        assert self.run("check-template", tmp_path / "double_v1.py").exit_code == 2
