"""A user can type the fields of a title block when downloading a drawing."""

import io

import ezdxf
import pytest
from bare_shells import BUSH
from serving import API, created, problem

from app.reports import paper
from app.reports.paper import Press

DESIGNS = f"{API}/designs"

SHELL = {"id": "plain_bearing", "version": 1, "parameters": {**BUSH, "inner_diameter": "33.25 mm"}}
TYPED = {
    "drawing_number": "4711-08",
    "drawing_title": "Half <shell> & 'co'",
    "drawing_revision": "C",
    "legal_owner": "Werke AG",
    "created_by": "Anna",
    "document_status": "preliminary",
}


@pytest.fixture(scope="module")
def place(http):
    design = created(http, {"name": "typed", "models": {"shell": SHELL}})
    return f"{DESIGNS}/{design['id']}/models/shell/model"


def texts(http, place, **typed):
    answer = http.get(f"{place}.dxf", params=typed, headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text
    drawing = ezdxf.read(io.StringIO(answer.text))
    return [entity.dxf.text for entity in drawing.modelspace().query("TEXT")]


def test_what_is_typed_stands_in_the_title_block(http, place):
    lines = texts(http, place, **TYPED)
    for text in TYPED.values():
        assert lines.count(text) == 1, text
    plain = texts(http, place, drawing_number=" ", drawing_title="")
    assert "typed_shell" in plain
    assert not {*TYPED.values()} & {*plain}


def test_a_typed_text_does_not_leave_its_field(http, place):
    svg = http.get(f"{place}.drawing.svg", params={"drawing_title": "</text><script>" * 5}).text
    assert "<script" not in svg
    (shown,) = [line for line in texts(http, place, legal_owner="W" * 80) if line.startswith("WWW")]
    assert len(shown) < 40


def test_only_an_approval_gives_its_states(http, place):
    answer = http.get(f"{place}.dxf", params={"document_status": "Released"})
    detail = problem(answer, 422, "invalid-inputs")["errors"]
    assert [one["name"] for one in detail] == ["document_status"]
    assert "only a step of the approval" in detail[0]["detail"]


@pytest.mark.parametrize("name", ["checked_by", "approved_by"])
def test_nobody_is_typed_who_has_not_signed(http, place, name):
    answer = http.get(f"{place}.dxf", params={name: "Cem", "created_by": "Anna"})
    (fault,) = problem(answer, 422, "invalid-inputs")["errors"]
    assert (fault["name"], fault["code"]) == (name, "signed_otherwise")
    assert "only a step of the approval" in fault["detail"]


@pytest.mark.parametrize(
    ("path", "name", "meant"),
    [
        ("{}.dxf", "drawing_nmber", "Did you mean drawing_number?"),
        ("{}.step", "zzzz", "deflection"),
        ("{}", "deflecton", "Did you mean deflection?"),
        (f"{API}/builds/{'0' * 64}/model.dxf", "drawing_number", "This address takes none"),
    ],
)
def test_a_misspelt_name_in_the_address_is_refused(http, place, path, name, meant):
    answer = http.get(path.format(place), params={name: "1"})
    (fault,) = problem(answer, 422, "invalid-inputs")["errors"]
    assert (fault["name"], fault["code"]) == (name, "unknown_name")
    assert meant in fault["detail"]


@pytest.mark.parametrize(
    "status", ["released\u2028", "\u200breleased", "ｒeleased", "Released.", "re\u00adleased"]
)
def test_no_sign_that_is_not_seen_makes_an_approval(http, place, status):
    answer = http.get(f"{place}.drawing.svg", params={"document_status": status})
    assert problem(answer, 422, "invalid-inputs")["errors"][0]["code"] == "signed_otherwise"


def test_a_text_of_signs_that_do_not_print_leaves_the_field_as_it_is(http, place):
    plain = http.get(f"{place}.drawing.svg", params={"drawing_title": "\u202e\x01\u2028"})
    assert plain.content == http.get(f"{place}.drawing.svg").content


def test_only_drawings_have_a_title_block(http, place):
    for kind, field in (("glb", "drawing_number"), ("step", "drawing_title")):
        answer = http.get(f"{place}.{kind}", params={field: "1"})
        assert "have a title block" in problem(answer, 422, "invalid-inputs")["errors"][0]["detail"]


def test_a_step_file_takes_the_number_of_its_part_and_its_revision(http, place):
    answer = http.get(f"{place}.step", params={"drawing_number": "PN-100", "drawing_revision": "C"})
    text = answer.content.decode()
    assert "PRODUCT('PN-100'" in "".join(text.split())
    assert "PRODUCT_DEFINITION_FORMATION('C'" in "".join(text.split())


def test_a_drawing_number_has_at_most_80_letters(http, place):
    assert http.get(f"{place}.dxf", params={"drawing_number": "x" * 81}).status_code == 422


class Counting:
    """A worker that counts what it does."""

    def __init__(self):
        self.done = []

    def run(self, call, svg, limits):
        self.done.append(svg)
        return b"pdf of " + svg


def test_a_drawing_is_typeset_once_and_the_oldest_is_forgotten(monkeypatch):
    worker = Counting()
    press = Press(worker, None, 1)
    assert press.draw(b"one") == press.draw(b"one") == b"pdf of one"
    assert worker.done == [b"one"]
    monkeypatch.setattr(paper, "KEPT", 25)
    press.draw(b"two")
    press.draw(b"one")
    press.draw(b"three")  # 32 bytes: `two` goes
    press.draw(b"one")
    assert worker.done == [b"one", b"two", b"three"]
    press.draw(b"two")
    assert worker.done[-1] == b"two"


def test_a_client_with_the_drawing_does_not_wait_for_the_press(served, http, place, monkeypatch):
    answer = http.get(f"{place}.drawing.pdf", headers={"Prefer": "wait=60"})
    assert answer.content.startswith(b"%PDF")

    def refuse(self, svg):
        raise AssertionError("it was typeset again")

    monkeypatch.setattr(Press, "draw", refuse)
    again = http.get(f"{place}.drawing.pdf", headers={"If-None-Match": answer.headers["etag"]})
    assert again.status_code == 304
    assert http.get(f"{place}.drawing.svg").headers["etag"] != answer.headers["etag"]
