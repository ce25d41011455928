"""Files of a design name it: outside, in Content-Disposition, and inside, by a stamp that `verify` skips."""

import hashlib
import io
import re
from urllib.parse import quote

import ezdxf
import pytest
from serving import API, created, paper, patched, revision

from cad.part21 import plain
from cad.step import read_step

DESIGNS = f"{API}/designs"
NAME = "Käfig 'A' 轴承"
STEM = "Kafig_A_shell_r1"
WIDE = "Käfig_A_轴承_shell_r1"
SHELL = {"id": "plain_bearing", "version": 1, "parameters": {"inner_diameter": "31.25 mm"}}
WAIT = {"Prefer": "wait=60"}


@pytest.fixture(scope="module")
def design(http):
    return created(http, {"name": NAME, "models": {"shell": SHELL}})


def get(http, design, tail="models/shell/model.step", **headers):
    answer = http.get(f"{DESIGNS}/{design['id']}/{tail}", headers={**WAIT, **headers})
    assert answer.status_code < 300, answer.text
    return answer


def verified(http, content):
    answer = http.post(f"{API}/verify", content=content, headers={"Content-Type": "model/step"})
    assert answer.status_code == 200, answer.text
    return answer.json()


def products(step):
    """Id, name and description of every product."""
    string = r"('(?:[^']|'')*')"
    pattern = re.compile(rf"PRODUCT\(\s*{string},\s*{string},\s*{string}")
    return [tuple(map(plain, strings)) for strings in pattern.findall(step.decode("latin-1"))]


@pytest.mark.parametrize("kind", ["step", "stl", "svg", "png", "glb", "dxf", "drawing.svg"])
def test_a_download_is_named_by_design_model_and_revision(http, design, kind):
    answer = get(http, design, f"models/shell/model.{kind}")
    wide = quote(f"{WIDE}.{kind}", safe="")
    assert answer.headers["content-disposition"] == (
        f"attachment; filename=\"{STEM}.{kind}\"; filename*=UTF-8''{wide}"
    )


def test_the_step_file_says_whose_it_is_and_opens(http, design):
    step = get(http, design).content
    ((id, name, description),) = products(step)
    assert (id, name) == (STEM, WIDE)
    assert all(word in description for word in (NAME, "model shell", "revision 1", "steel (7850 kg/m³)"))
    (body,) = read_step(step)
    assert body.name == WIDE
    made = revision(http, design)["created"][:19]
    assert f"'{made}'".encode() in step
    assert b"PRODUCT_DEFINITION_FORMATION('1'" in step


@pytest.mark.parametrize("kind", ["dxf", "drawing.svg"])
def test_the_drawing_says_whose_it_is(http, design, kind):
    text = get(http, design, f"models/shell/model.{kind}").text
    made = revision(http, design)["created"][:10]
    if kind == "dxf":
        drawing = ezdxf.read(io.StringIO(text))
        assert not drawing.audit().errors
        lines = {entity.dxf.text for entity in drawing.modelspace().query("TEXT")}
        assert {
            f"design: {NAME}",
            f"part: shell, revision 1, {made}",
            "material: steel (7850 kg/m³)",
        } <= lines
    else:
        assert "design: Käfig &#x27;A&#x27; 轴承</text>" in text
        assert f"part: shell, revision 1, {made}</text>" in text


def test_builds_and_artifacts_are_shared_and_stay(http, design):
    other = created(http, {"name": "another", "models": {"shell": SHELL}})
    one, two = (revision(http, which)["models"]["shell"]["artifacts"]["step"] for which in (design, other))
    assert one == two
    stored = http.get(f"{API}/artifacts/{one}").content
    assert hashlib.sha256(stored).hexdigest() == one
    assert {get(http, which).content for which in (design, other)}.isdisjoint({stored})
    assert get(http, design).headers["etag"] != get(http, other).headers["etag"]


def test_verify_ignores_the_stamp_and_nothing_else(http, design):
    step = get(http, design).content
    stored = http.get(
        f"{API}/artifacts/{revision(http, design)['models']['shell']['artifacts']['step']}"
    ).content
    for content in (step, stored):
        answer = verified(http, content)
        assert answer["intact"] is True
        assert {"design": design["id"], "revision": 1, "current": True} in answer["revisions"]
    for wrong in (
        step + b" ",
        step[:-1],
        re.sub(rb"CARTESIAN_POINT\('',\(0", b"CARTESIAN_POINT('',(1", step, count=1),
    ):
        assert verified(http, wrong)["intact"] is False
    assert verified(http, step.replace(b"steel", b"stool"))["intact"] is True


def test_a_tag_of_its_own_conditions_and_ranges(http, design):
    whole = get(http, design)
    etag = whole.headers["etag"]
    assert etag == f'"{hashlib.sha256(whole.content).hexdigest()}"'
    again = http.get(whole.url, headers={"If-None-Match": f'"x", {etag}'})
    assert (again.status_code, again.content, again.headers["etag"]) == (304, b"", etag)
    part = http.get(whole.url, headers={"Range": "bytes=10-29", "If-Range": etag})
    assert (part.status_code, part.content) == (206, whole.content[10:30])
    assert part.headers["content-range"] == f"bytes 10-29/{len(whole.content)}"
    other = http.get(whole.url, headers={"Range": "bytes=10-29", "If-Range": '"other"'})
    assert (other.status_code, other.content) == (200, whole.content)
    picture = get(http, design, "models/shell/model.png")
    assert http.get(picture.url, headers={"If-None-Match": picture.headers["etag"]}).status_code == 304


def test_a_later_revision_has_its_own_name(http):
    first = created(http, {"name": "first", "models": {"shell": SHELL}})
    second = patched(http, first, {"name": "second/../x"})
    assert (
        'filename="first_shell_r1.step"'
        in get(http, first, "revisions/1/models/shell/model.step").headers["content-disposition"]
    )
    newest = get(http, second)
    assert 'filename="second_.._x_shell_r2.step"' in newest.headers["content-disposition"]
    assert newest.headers["design-revision"] == "2"


def test_a_file_that_is_not_made_yet_has_no_name(http):
    design = created(
        http, {"name": "slow", "models": {"shell": {**SHELL, "parameters": {"inner_diameter": "31.5 mm"}}}}
    )
    answer = get(http, design, "models/shell/model.dxf", Prefer="respond-async")
    assert answer.status_code == 202
    assert answer.headers["content-type"] == "application/json"
    assert "content-disposition" not in answer.headers
    assert get(http, design, "models/shell/model.dxf").content.startswith(b"  0\nSECTION")


def test_single_part_models_are_one_part(http, design):
    step = get(http, design).content
    assert len(products(step)) == 1
    assert b"NEXT_ASSEMBLY_USAGE_OCCURRENCE" not in step
    bearing = created(http, paper(name="Ball"))
    assembly = get(http, bearing, "model.step").content
    assert [name for _, name, _ in products(assembly)] == [
        "Ball_model_r1",
        "inner_ring",
        "outer_ring",
        "ball",
    ]
    assert [id for id, _, _ in products(assembly)][1] == "Ball_model_r1_inner_ring"
    assert verified(http, assembly)["intact"] is True
