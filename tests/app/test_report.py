"""The report on screen and on paper is complete, reproducible, and safe against user text."""

import hashlib
import io
import unicodedata
from html.parser import HTMLParser

import pypdf
import pytest
from bare_shells import BUSH
from serving import API, created, moody, paper, patched, problem

from app.designs.bodies import PAPER
from app.http.guard import PAGE_POLICY
from app.workers.errors import DeadlineExceeded

DESIGNS = f"{API}/designs"
HOSTILE = '#import "@preview/x:1.0.0": * ] $ \\ #read("/etc/passwd") <script>alert(1)</script> 😀 שלום "'
LONG = "W" * 90
OVERRIDE = "\u202eright to left\u202c"


@pytest.fixture(scope="module")
def bearing(http):
    """The paper's design, then made larger."""
    return patched(http, created(http, paper(name="report")), {"parameters": {"scale": "1.25"}})


def read(http, design, kind="html", number=None, **query):
    part = f"/revisions/{number}" if number else ""
    place = f"{DESIGNS}/{design['id']}{part}/report.{kind}"
    answer = http.get(place, params=query, headers={"Prefer": "wait=60"})  # for its pictures to be drawn
    assert answer.status_code == 200, answer.text[:500]
    return answer


def on_paper(http, design, **more):
    """The text of the PDF; letters of mathematics as plain ones, broken lines joined."""
    return text_of(read(http, design, "pdf", **more).content)


@pytest.fixture(scope="module")
def printed(http, bearing):
    """The PDF of the paper's design, as text and number of pages; printing it takes seconds."""
    return on_paper(http, bearing)


def text_of(pdf):
    pages = pypdf.PdfReader(io.BytesIO(pdf)).pages
    text = unicodedata.normalize("NFKC", "\n".join(page.extract_text() for page in pages))
    return " ".join(text.replace("\u200b", "").split()), len(pages)


class Page(HTMLParser):
    """The text of a page, its elements, and what it loads."""

    def __init__(self, text):
        super().__init__()
        self.pieces, self.tags, self.loaded, self.attributes = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.pieces += [] if tag == "span" else [" "]
        self.attributes += [name for name, _ in attributes]
        self.loaded += [value for name, value in attributes if name in ("src", "href")]

    def handle_data(self, data):
        self.pieces.append(data)

    @property
    def text(self):
        return " ".join("".join(self.pieces).split())


def on_screen(http, design, **more):
    return Page(read(http, design, **more).text)


class TestContents:
    def test_html_and_pdf_say_the_same(self, http, bearing, printed):
        answer = http.get(f"{DESIGNS}/{bearing['id']}/revisions/2").json()
        digest = answer["steps"]["film"]["template"]["digest"]
        step = answer["models"]["model"]["artifacts"]["step"]
        build = answer["models"]["model"]["build"]
        paper_text, _ = printed
        for text in (on_screen(http, bearing).text, paper_text):
            for wanted in (
                bearing["id"], digest, step, build, "Crankwright", "Radial load", "25", "kN", "25000",
                "= scale * 48 mm", "default", "Bhadke et al. 2015", "Minimum film thickness",
                "= film.bearing_diameter", "OUTSIDE", "Revision 1", "signature", "2.0203",
            ):  # fmt: skip
                assert wanted in text, (wanted, text[:3000])

    def test_numbers_of_formulas_and_result_stand_in_the_pdf(self, http, bearing, printed):
        outputs = http.get(f"{DESIGNS}/{bearing['id']}/revisions/2").json()["steps"]["film"]["outputs"]
        text, _ = printed
        film = f"{outputs['minimum_film_thickness']['value']:.5g}"
        assert f"Minimum film thickness h0 {film}" in text
        assert text.replace(" ", "").count(f"={film}µm") + text.replace(" ", "").count(f"={film}μm") == 1
        assert "60mm−0.055mm" in text.replace(" ", "")

    def test_mapping_tells_old_and_new_and_what_the_solid_has(self, http, bearing, printed):
        text, _ = printed
        assert "48 mm → 60 mm 60 mm" in text

    @pytest.mark.slow
    def test_mapping_of_the_first_revision_has_nothing_old(self, http, bearing):
        first, _ = on_paper(http, bearing, number=1)
        assert "→" not in first
        assert "= film.bearing_diameter 48 mm 48 mm" in first

    @pytest.mark.slow
    @pytest.mark.parametrize("units", ["si", "us"])
    def test_only_parameters_that_changed_are_marked(self, http, units):
        design = created(http, paper(name="marks"))
        loaded = patched(http, design, {"steps": {"film": {"inputs": {"radial_load": "30 kN"}}}})
        assert "changed-value" not in read(http, loaded, units=units).text
        larger = patched(http, loaded, {"parameters": {"scale": "1.02"}})
        assert "changed-value" in read(http, larger, units=units).text

    def test_pages_are_numbered(self, printed):
        text, pages = printed
        assert pages > 2
        assert [f"page {n} of {pages}" in text for n in range(1, pages + 1)] == [True] * pages

    def test_hashes_are_those_of_the_files(self, http, bearing):
        text = on_screen(http, bearing).text
        files = http.get(f"{DESIGNS}/{bearing['id']}/revisions/2").json()["models"]["model"]["artifacts"]
        for kind in ("step", "png", "drawing.svg"):
            assert hashlib.sha256(http.get(f"{API}/artifacts/{files[kind]}").content).hexdigest() in text

    def test_formulas_are_mathml_with_brackets_that_stretch(self, http, bearing):
        text = read(http, bearing).text
        assert text.count("<math") > 30
        assert 'stretchy="true"' in text

    def test_every_picture_that_the_page_loads_is_there(self, http, bearing):
        page = on_screen(http, bearing)
        pictures = [link for link in page.loaded if link.endswith((".png", ".svg", ".css"))]
        assert len(pictures) >= 4
        for link in pictures:
            assert link.startswith("/"), link
            assert http.get(link).status_code == 200, link

    @pytest.mark.slow
    def test_us_units(self, http, bearing):
        text, _ = on_paper(http, bearing, units="us")
        assert "US customary" in text
        assert "2.3622 in" in text  # 60 mm

    def test_a_check_carries_the_share_that_is_used(self, http, bearing):
        rows = on_screen(http, bearing).text
        eccentricity = http.get(f"{DESIGNS}/{bearing['id']}/revisions/2").json()["steps"]["film"]["outputs"][
            "relative_eccentricity"
        ]["value"]
        assert f"{eccentricity * 100:.2g} %" in rows  # of the limit 1


class TestEveryTemplate:
    @pytest.mark.parametrize("step", [5, pytest.param(1, marks=pytest.mark.slow)])
    def test_its_example_has_a_report(self, http, step):
        """Once a unit that one of them declares was not known to the reports. Quick: each fifth."""
        templates = http.get(f"{API}/templates", params={"limit": 500}).json()["items"]
        assert len(templates) >= 10
        for template in templates[::step]:
            path = f"{API}/templates/{template['id']}/versions/{template['version']}"
            step = {
                "template": template["id"],
                "version": template["version"],
                "inputs": http.get(path).json()["example"],
            }
            design = created(http, {"name": "example", "steps": {"one": step}})
            assert "Inputs" in Page(read(http, design).text).text
            assert (
                http.get(f"{DESIGNS}/{design['id']}/report.html", params={"units": "us"}).status_code == 200
            )


class TestConditions:
    def test_accept_chooses(self, http, bearing):
        place = f"{DESIGNS}/{bearing['id']}/report"
        for accept, media in (
            ("application/pdf", "application/pdf"),
            ("text/html;q=0.5, application/pdf", "application/pdf"),
            ("text/html,application/xhtml+xml,*/*;q=0.8", "text/html; charset=utf-8"),
            ("*/*", "text/html; charset=utf-8"),
            ("image/gif", "text/html; charset=utf-8"),
        ):
            answer = http.get(place, headers={"Accept": accept})
            assert (answer.status_code, answer.headers["content-type"]) == (200, media)
            assert "Accept" in answer.headers["vary"]

    @pytest.mark.sampled(1)
    @pytest.mark.parametrize("kind", ["html", "pdf"])
    def test_equal_each_time_and_not_sent_twice(self, http, bearing, kind):
        first, second = read(http, bearing, kind), read(http, bearing, kind)
        assert first.content == second.content
        tag = first.headers["etag"]
        again = http.get(f"{DESIGNS}/{bearing['id']}/report.{kind}", headers={"If-None-Match": f'"x", {tag}'})
        assert (again.status_code, again.content) == (304, b"")
        assert read(http, bearing, kind, number=1).headers["etag"] != tag

    def test_date_of_the_document_is_that_of_the_revision(self, http, bearing):
        answer = http.get(f"{DESIGNS}/{bearing['id']}/revisions/2").json()
        about = pypdf.PdfReader(io.BytesIO(read(http, bearing, "pdf").content)).metadata
        assert about.creation_date_raw.startswith(f"D:{answer['created'][:10].replace('-', '')}")
        assert about.title == "report, revision 2"

    def test_strict_policy(self, http, bearing):
        answer = read(http, bearing)
        assert answer.headers["content-security-policy"] == PAGE_POLICY
        page = Page(answer.text)
        assert "style" not in page.tags
        assert "script" not in page.tags
        assert not {"style", "onclick", "onload"} & set(page.attributes)

    def test_unknown_ones(self, http, bearing):
        problem(http.get(f"{DESIGNS}/nothing/report"), 404, "not-found")
        problem(http.get(f"{DESIGNS}/{bearing['id']}/revisions/9/report"), 404, "not-found")
        refusal = problem(http.get(f"{DESIGNS}/{bearing['id']}/report.docx"), 404, "not-found")
        assert "pdf" in refusal["detail"]

    def test_a_revision_of_a_deleted_design_keeps_its_report(self, http):
        design = created(http, {"name": "gone", "parameters": {"a": "1 mm"}})
        http.delete(f"{DESIGNS}/{design['id']}", headers={"If-Match": "*"})
        problem(http.get(f"{DESIGNS}/{design['id']}/report"), 404, "not-found")
        assert "gone" in on_screen(http, design, number=1).text


@pytest.fixture(scope="module")
def hostile(http):
    step = {"template": "double", "version": 1, "inputs": {"length": "= some_length * 1"}}
    return created(
        http,
        {
            "name": f"{HOSTILE} {LONG}"[:190],
            "note": f"{OVERRIDE} {HOSTILE}\x07{LONG}",
            "parameters": {"some_length": "2 mm"},
            "steps": {"Step_" + "x" * 59: step},
        },
    )


class TestWhatUsersWrite:
    def test_the_page_shows_it_and_does_nothing(self, http, hostile):
        page = on_screen(http, hostile)
        assert "<script>alert(1)</script>" in page.text
        assert "script" not in page.tags
        assert "#read" in page.text
        assert "\u202e" not in page.text

    def test_the_paper_shows_it_and_does_nothing(self, http, hostile):
        text, _ = on_paper(http, hostile)
        assert '#import "@preview/x:1.0.0": * ] $ \\ #read("/etc/passwd")' in text
        assert "<script>" in text
        assert "root:" not in text
        assert LONG in text.replace(" ", "")


class TestPaper:
    def test_a_report_that_takes_too_long_is_refused_with_a_remedy(self, http, served, bearing, monkeypatch):
        class Slow:
            def run(self, function, *args, limits):
                raise DeadlineExceeded(limits.deadline)

        monkeypatch.setattr(served.app.state.services.press, "_worker", Slow())
        answer = http.get(f"{DESIGNS}/{bearing['id']}/report.pdf")
        assert "14 formulas" in problem(answer, 422, "unprintable")["detail"]
        assert http.get(f"{DESIGNS}/{bearing['id']}/report.html").status_code == 200


class TestStates:
    def test_without_steps_and_models(self, http):
        design = created(http, {"name": "nothing"})
        assert "no warnings" in on_screen(http, design).text.lower()
        assert on_paper(http, design)[1] == 1

    def test_failed(self, http):
        design = created(http, moody("12.5 mm", "raises"))
        assert design["state"] == "failed"
        for text in (on_screen(http, design).text, on_paper(http, design)[0]):
            assert "This revision failed" in text
            assert "bad mood" in text
            assert "not built" in text.lower()

    def test_regenerating(self, http):
        answer = http.post(DESIGNS, json=moody("13.25 mm", "loops"), headers={"Prefer": "wait=0"})
        design = answer.json()
        for text in (on_screen(http, design).text, on_paper(http, design)[0]):
            assert "being regenerated" in text
        assert http.delete(answer.headers["location"]).is_success

    def test_points_without_a_value_have_their_reason(self, http):
        inputs = {
            "journal_diameter": "48 mm",
            "bearing_width": "18 mm",
            "radial_clearance": {"value": [20, -5], "unit": "um"},
            "speed": "2000 rpm",
            "dynamic_viscosity": "10 mPa*s",
        }
        step = {"template": "journal_friction", "version": 1, "inputs": inputs}
        design = created(http, {"name": "points", "steps": {"friction": step}})
        for text in (on_screen(http, design).text, on_paper(http, design)[0]):
            assert "radial_clearance must be" in text
            assert "None" not in text

    @pytest.mark.slow
    def test_several_models_and_a_measured_loop(self, http):
        film = {**PAPER["steps"]["film"], "inputs": {**PAPER["steps"]["film"]["inputs"]}}
        film["inputs"]["bearing_diameter"] = "= 40 mm + ball.mass * 10 mm/kg"
        document = {
            "name": "weighing",
            "steps": {"film": film},
            "models": {
                "ball": {**PAPER["model"]},
                "shell": {"id": "plain_bearing", "parameters": {**BUSH, "inner_diameter": "48 mm"}},
            },
            "iterations": [{"through": "ball.mass", "start": "1 kg", "tolerance": 1e-3}],
        }  # fmt: skip
        design = created(http, document)
        assert design["state"] == "current", design
        rounds = http.get(f"{DESIGNS}/{design['id']}/revisions/1").json()["iterations"]
        for text in (on_screen(http, design).text, on_paper(http, design)[0]):
            assert "Part ball" in text
            assert "Part shell" in text
            assert "Iteration" in text
            assert f"{rounds[-1]['measured']:.5g}" in text

    def test_pictures_that_are_not_made_yet_are_said_to_be_missing(self, http):
        design = created(http, moody("17.75 mm"))
        answer = http.get(f"{DESIGNS}/{design['id']}/report", headers={"Prefer": "respond-async"})
        assert answer.status_code == 202
        assert "still being made" in answer.text
        assert answer.headers["location"].startswith(f"{API}/jobs/")
        assert "etag" not in answer.headers
        assert "still being made" not in read(http, design).text
