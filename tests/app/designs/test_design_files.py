"""Files of a design name it in Content-Disposition and in a stamp, which `verify` ignores."""

import hashlib
import io
import re
from urllib.parse import quote

import ezdxf
import httpx
import pytest
from bare_shells import BUSH
from click.testing import CliRunner
from pypdf import PdfReader
from serving import API, created, paper, patched, problem, revision

from app.cli.main import main
from app.client import File
from app.storage.tables import ArtifactRow, BuildRow, RevisionModelRow
from cad.file_kinds import BY_PART, MEDIA_TYPES, SHOWN
from cad.part21 import plain
from cad.stamp import is_copy
from cad.step import read_step

DESIGNS = f"{API}/designs"
NAME = "Käfig 'A' 轴承"
STEM = "Kafig_A_shell_r1"
WIDE = "Käfig_A_轴承_shell_r1"
SHELL = {"id": "plain_bearing", "version": 1, "parameters": {**BUSH, "inner_diameter": "31.25 mm"}}
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


@pytest.mark.parametrize("kind", ["step", "stl", "svg", "png", "glb", "dxf", "drawing.svg", "drawing.pdf"])
@pytest.mark.sampled(3)
def test_a_download_is_named_by_design_model_and_revision(http, design, kind):
    answer = get(http, design, f"models/shell/model.{kind}")
    wide = quote(f"{WIDE}.{kind}", safe="")
    assert answer.headers["content-disposition"] == (
        f"attachment; filename=\"{STEM}.{kind}\"; filename*=UTF-8''{wide}"
    )


def test_the_step_file_says_whose_it_is_and_opens(http, design):
    step = get(http, design).content
    ((id, name, description),) = products(step)
    assert (id, name) == (STEM.removesuffix("_r1"), WIDE.removesuffix("_r1"))
    assert all(word in description for word in (NAME, "model shell", "steel (7850 kg/m³)", "mass 0."))
    assert "revision" not in description  # the version of the product states it
    (body,) = read_step(step)
    assert body.name == name
    saved_at = revision(http, design)["created"][:19]
    assert f"'{saved_at}'".encode() in step
    assert b"PRODUCT_DEFINITION_FORMATION('1'" in step


@pytest.mark.parametrize("kind", ["dxf", "drawing.svg"])
def test_the_drawing_says_whose_it_is(http, design, kind):
    text = get(http, design, f"models/shell/model.{kind}").text
    day = revision(http, design)["created"][:10]
    if kind == "dxf":
        drawing = ezdxf.read(io.StringIO(text))
        assert not drawing.audit().errors
        lines = {entity.dxf.text for entity in drawing.modelspace().query("TEXT")}
        assert {NAME, "shell", "1", day, "steel (7850 kg/m³)", "unsigned"} <= lines
    else:
        assert ">Käfig &#x27;A&#x27; 轴承</text>" in text
        for field in ("shell", "1", day, "steel (7850 kg/m³)", "unsigned"):
            assert f">{field}</text>" in text


def test_the_drawing_on_paper_says_whose_it_is(http, design):
    answer = get(http, design, "models/shell/model.drawing.pdf")
    assert answer.headers["content-type"] == "application/pdf"
    (page,) = PdfReader(io.BytesIO(answer.content)).pages
    text = page.extract_text()
    assert "Käfig" in text
    assert "unsigned" in text
    assert get(http, design, "models/shell/model.drawing.pdf").content == answer.content
    same = http.get(answer.url, headers={"If-None-Match": answer.headers["etag"]})
    assert same.status_code == 304


def test_a_build_creates_the_kinds_that_a_page_shows_and_those_that_are_asked_for(http):
    build = f"{API}/models/plain_bearing/versions/1/build"
    body = {"parameters": {**BUSH, "inner_diameter": "31.125 mm"}}
    plain = http.post(build, json=body, headers=WAIT).json()
    assert plain["artifacts"].keys() == {*SHOWN} == {"step", "glb"}
    more = http.post(build, json={**body, "artifacts": ["brep"]}, headers=WAIT).json()
    assert more["artifacts"].keys() == {"step", "glb", "brep"}


def test_the_command_lists_every_kind_of_file():
    text = " ".join(CliRunner().invoke(main, ["download", "--help"]).output.split())
    assert all(f"{kind}, " in text or f"{kind};" in text for kind in MEDIA_TYPES)
    assert all(kind in text.partition("--part")[2].partition("--variant")[0] for kind in BY_PART)


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


def test_a_copy_with_validation_properties_is_one_of_ours(http, design):
    copy = get(http, design, "models/shell/model.validated.step").content
    answer = verified(http, copy)
    assert (answer["kind"], answer["intact"]) == ("validated.step", True)
    assert {one["kind"] for one in answer["statements"]} == {"volume", "surface area", "centroid"}
    assert all(one["agrees"] for one in answer["statements"])
    wrong = re.sub(rb"VOLUME_MEASURE\(\d", b"VOLUME_MEASURE(7", copy)
    assert wrong != copy
    answer = verified(http, wrong)
    assert (answer["kind"], answer["intact"]) == ("validated.step", False)
    assert [one["kind"] for one in answer["statements"] if not one["agrees"]] == ["volume"]
    assert verified(http, get(http, design).content)["kind"] == "step"


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
        http,
        {"name": "slow", "models": {"shell": {**SHELL, "parameters": {**BUSH, "inner_diameter": "31.5 mm"}}}},
    )
    answer = get(http, design, "models/shell/model.dxf", Prefer="respond-async")
    assert answer.status_code == 202
    assert answer.headers["content-type"] == "application/json"
    assert "content-disposition" not in answer.headers
    assert get(http, design, "models/shell/model.dxf").content.startswith(b"  0\nSECTION")


def test_the_client_saves_a_file_under_its_name_and_waits_for_it(client, design, tmp_path):
    heard = []
    file = client.download(
        design["id"], "glb", model="shell", revision=1, on_progress=lambda *a: heard.append(a)
    )
    assert file.save(tmp_path) == tmp_path / f"{WIDE}.glb"
    assert (tmp_path / f"{WIDE}.glb").read_bytes().startswith(b"glTF")
    assert [path.name for path in tmp_path.iterdir()] == [f"{WIDE}.glb"]


def test_the_command_line_saves_a_file_under_its_name(served, design, tmp_path):
    place = ["--url", served.url, "--folder", str(tmp_path)]
    done = CliRunner().invoke(main, ["download", design["id"], "dxf", *place])
    assert done.exit_code == 0, done.output
    assert done.stdout.strip() == str(tmp_path / f"{WIDE}.dxf")
    assert (tmp_path / f"{WIDE}.dxf").read_text().startswith("  0\nSECTION")
    refused = CliRunner().invoke(main, ["download", design["id"], "exe", *place])
    assert (refused.exit_code, "there is no file model.exe" in refused.output) == (1, True)


@pytest.mark.parametrize(
    ("header", "name"),
    [
        ("attachment; filename=\"a.step\"; filename*=UTF-8''K%C3%A4fig.step", "Käfig.step"),
        ('attachment; filename="a.step"', "a.step"),
        ("attachment; filename*=UTF-8''..%2F..%2Fpasswd", "passwd"),
        ("", "model.step"),
    ],
)
def test_a_file_is_saved_in_its_folder_whatever_it_is_called(header, name):
    headers = {"Content-Disposition": header} if header else {}
    request = httpx.Request("GET", "http://x/designs/1/model.step")
    assert File.of(httpx.Response(200, headers=headers, content=b"", request=request)).name == name


def aged(served, design, kind, content):
    """The design's model as an older program left it: another build, with this file of that kind."""
    services = served.app.state.services
    sha = services.store.put(content)

    def age(session):
        model = session.get(RevisionModelRow, (design["id"], 1, "shell"))
        new = session.get(BuildRow, model.build_key)
        old = {c.name: getattr(new, c.name) for c in BuildRow.__table__.columns}
        old["measurements"] = {n: v for n, v in old["measurements"].items() if n != "materials"}
        key = hashlib.sha256(sha.encode()).hexdigest()
        session.merge(BuildRow(**{**old, "key": key, "made_by": "Old Kernel 1, recipe 2"}))
        session.flush()
        for artifact in new.artifacts:
            named = sha if artifact.kind == kind else artifact.sha256
            row = {"kind": artifact.kind, "sha256": named, "size": 1, "created": artifact.created}
            session.merge(ArtifactRow(build_key=key, **row))
        model.build_key = key
        return key

    return services.database.write(age)


def test_a_build_of_an_older_recipe_is_stamped_and_verified(served, http, design):
    """An assembly of one, whose header names a build that this program would not make."""
    older = created(http, {"name": "older", "models": {"shell": SHELL}})
    stored = http.get(
        f"{API}/artifacts/{revision(http, older)['models']['shell']['artifacts']['step']}"
    ).content
    assembly = stored.replace(
        b"PRODUCT('full_back','full_back',''", b"PRODUCT('plain_bearing','plain_bearing',''"
    )
    key = aged(served, older, "step", assembly)
    step = get(http, older).content
    assert products(step)[0][0] == "older_shell"
    assert "steel (7850 kg/m³)" in products(step)[0][2]
    # Its header names the build that it was copied from; the row of that build has the other file.
    assert is_copy(step, assembly)
    assert http.get(f"{API}/builds/{key}").json()["artifacts"]["step"] == hashlib.sha256(assembly).hexdigest()


@pytest.mark.slow
def test_a_drawing_of_an_older_program_is_drawn_again(served, http):
    older = created(http, {"name": "drawn", "models": {"shell": SHELL}})
    drawing = get(http, older, "models/shell/model.dxf").text
    unmarked = drawing.replace("stamp:", "other:").encode()
    key = aged(served, older, "dxf", unmarked)
    assert "\ndrawn\n" in get(http, older, "models/shell/model.dxf").text
    assert http.get(f"{API}/builds/{key}").json()["artifacts"]["dxf"] != hashlib.sha256(unmarked).hexdigest()


def test_a_stamped_file_is_compared_with_a_stored_one_that_was_lost(served, http, design):
    step = get(http, design).content
    sha = revision(http, design)["models"]["shell"]["artifacts"]["step"]
    served.app.state.services.store.delete(sha)
    lost = http.post(
        f"{API}/verify", content=step, headers={"Content-Type": "model/step", "Prefer": "respond-async"}
    )
    problem(lost, 503, "rebuilding")
    answer = http.post(f"{API}/verify", content=step, headers={"Content-Type": "model/step", **WAIT})
    assert answer.json()["intact"] is True


def test_single_part_models_are_one_part(http, design):
    step = get(http, design).content
    assert len(products(step)) == 1
    assert b"NEXT_ASSEMBLY_USAGE_OCCURRENCE" not in step
    bearing = created(http, paper(name="Ball"))
    assembly = get(http, bearing, "model.step").content
    assert [name for _, name, _ in products(assembly)] == [
        "Ball_model",
        "inner_ring",
        "outer_ring",
        "ball",
    ]
    assert [id for id, _, _ in products(assembly)][1] == "Ball_model_inner_ring"
    assert verified(http, assembly)["intact"] is True
