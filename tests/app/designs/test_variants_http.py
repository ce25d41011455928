"""Variants over HTTP: table saved and read, one solid for equal parameters, files, ZIP, verdict."""

import io
import re
import zipfile

import pytest
from bare_shells import BUSH
from serving import API, created, faults, moody, paper, patched, problem, revision

from app.storage.tables import BuildRow
from cad.inspect import look_at
from cad.step import read_step
from cad.surfaces import Z

DESIGNS = f"{API}/designs"
WAIT = {"Prefer": "wait=60"}
SHELL = {"id": "plain_bearing", "version": 1, "parameters": {**BUSH, "inner_diameter": "= bore"}}
BORES = {"main_1": "31 mm", "main_2": "32 mm", "main_10": "33 mm", "big_end": "31 mm"}
CRITERIA = {"small": {"require": "bore <= 32.5 mm"}}


def shells(**more):
    """A bearing shell of four variants, of which two have the same solid."""
    variants = {name: {"bore": bore} for name, bore in BORES.items()}
    return {
        "name": "Käfig 3",
        "parameters": {"bore": "30 mm"},
        "models": {"shell": SHELL},
        "criteria": CRITERIA,
        "variants": variants,
        **more,
    }


def without_model(**more):
    """The paper's bearing, of which nothing is built."""
    document = paper(**more)
    del document["model"]
    return document


@pytest.fixture(scope="module")
def design(http):
    return created(http, shells())


def table(http, design, tail="variants", **params):
    answer = http.get(f"{DESIGNS}/{design['id']}/{tail}", params=params)
    assert answer.status_code == 200, answer.text
    return answer.json()


def put(http, design, variants, revision=None, **more):
    headers = {"If-Match": f'"{revision or design["revision"]}"', **WAIT}
    return http.put(
        f"{DESIGNS}/{design['id']}/variants", json={"variants": variants, **more}, headers=headers
    )


def rows(out):
    return {row["name"]: row for row in out["rows"]}


def bore_of(step):
    """The smallest cylinder about the shaft in a STEP file [mm]."""
    (seen,) = look_at(read_step(step)).values()
    return min(seen.diameters(Z))


class TestTable:
    def test_rows_stand_in_natural_order_with_values_verdicts_and_models(self, http, design):
        out = table(http, design)
        assert [row["name"] for row in out["rows"]] == ["big_end", "main_1", "main_2", "main_10"]
        assert (out["state"], out["revision"], out["name"]) == ("current", 1, "Käfig 3")
        assert out["columns"] == [
            {"place": "bore", "words": "bore", "unit": "mm", "nominal": {"value": 30.0, "unit": "mm"}}
        ]
        for name, row in rows(out).items():
            bore = float(BORES[name].split()[0])
            assert row["values"] == {"bore": {"value": bore, "unit": "mm"}}
            assert row["state"] == "current"
            model = row["models"]["shell"]
            assert model["measurements"]["dimensions"]["inner_diameter"] == {"value": bore, "unit": "mm"}
            assert model["state"] == "current"
            (criterion,) = row["criteria"]
            assert criterion["verdict"] == ("not_met" if bore == 33 else "met")
            assert criterion["value"] == {"value": bore, "unit": "mm"}

    def test_variants_of_equal_parameters_share_one_solid(self, http, design):
        builds = {name: row["models"]["shell"]["build"] for name, row in rows(table(http, design)).items()}
        assert builds["main_1"] == builds["big_end"]
        assert len(set(builds.values())) == 3

    def test_one_variant_governs_the_design(self, http, design):
        out = table(http, design)
        assert out["governing"]["variant"] == "main_10"
        assert out["by_criterion"]["small"]["verdict"] == "not_met"
        assert out["base"]["criteria"][0]["verdict"] == "met"
        stored = revision(http, design)
        (criterion,) = stored["criteria"]
        assert criterion["where"] == {"variant": "main_10"}
        assert (criterion["points"], criterion["counts"]) == (5, {"met": 4, "not_met": 1})
        assert stored["verdict"]["verdict"] == "not_met"

    def test_the_design_shows_what_was_typed(self, http, design):
        assert list(design["variants"]) == ["big_end", "main_1", "main_2", "main_10"]
        assert design["variants"]["main_2"] == {"bore": "32 mm"}
        assert "shell" in revision(http, design)["models"]
        assert len(revision(http, design)["models"]) == 1

    def test_a_design_without_variants_has_an_empty_table(self, http):
        plain = created(http, {"name": "plain"})
        out = table(http, plain)
        assert (out["rows"], out["columns"], out["variants"]) == ([], [], {})
        assert "governing" not in out
        assert "variants" not in plain

    def test_outputs_are_shown_on_request(self, http):
        film = created(http, without_model(variants={"fast": {"film.speed": "4000 rpm"}}))
        name = "film.minimum_film_thickness"
        out = table(http, film, output=[name])
        thick, thicker = out["base"]["outputs"][name], rows(out)["fast"]["outputs"][name]
        assert thick["unit"] == thicker["unit"]
        assert 0 < thick["value"] != thicker["value"]
        answer = http.get(f"{DESIGNS}/{film['id']}/variants", params={"output": "film.thickness"})
        assert faults(answer) == {"outputs.film.thickness": "unknown_name"}

    def test_units_may_be_those_of_the_united_states(self, http, design):
        out = table(http, design, units="us")
        assert rows(out)["main_2"]["values"]["bore"]["unit"] == "inch"

    def test_an_older_revision_keeps_its_table(self, http):
        first = created(http, shells())
        second = patched(http, first, {"variants": {"main_10": None, "main_2": {"bore": "32.1 mm"}}})
        assert list(rows(table(http, second))) == ["big_end", "main_1", "main_2"]
        old = table(http, first, "revisions/1/variants")
        assert rows(old)["main_2"]["values"]["bore"]["value"] == 32.0
        assert old["governing"]["variant"] == "main_10"


class TestPut:
    def test_a_table_replaces_the_other_and_the_same_makes_no_revision(self, http):
        design = created(http, shells())
        same = put(http, design, table(http, design)["variants"])
        assert (same.status_code, same.json()["revision"], same.headers["etag"]) == (200, 1, '"1"')
        other = put(http, design, {"only": {"bore": "31 mm"}}, note="one")
        assert other.status_code == 200, other.text
        assert (other.json()["revision"], list(rows(other.json()))) == (2, ["only"])
        assert revision(http, design, 2)["note"] == "one"
        assert http.get(f"{DESIGNS}/{design['id']}").json()["variants"] == {"only": {"bore": "31 mm"}}
        none = put(http, design, {}, revision=2)
        assert none.json()["rows"] == []
        assert "variants" not in http.get(f"{DESIGNS}/{design['id']}").json()

    def test_it_needs_the_revision_that_was_read(self, http, design):
        path, body = f"{DESIGNS}/{design['id']}/variants", {"variants": {}}
        problem(http.put(path, json=body), 428, "precondition-required")
        problem(put(http, design, {}, revision=7), 412, "stale-revision")
        csv = http.put(path, content=b"variant", headers={"If-Match": '"1"', "Content-Type": "text/x-none"})
        assert csv.status_code == 415

    def test_everything_wrong_is_named_at_once_and_nothing_saved(self, http, design):
        wrong = {
            "base": {},
            "report": {},
            "a": {"bore": "31", "shell.bore": "1 mm"},
            "b": {"bore": "= width"},
            "c": {"clearance": "1 mm", "shell.width": "= bore * bore"},
            "d": {"shell.inner_diameter": "-3 mm"},
            "fine": {"bore": "31 mm"},
        }
        assert faults(put(http, design, wrong)) == {
            "variants.base": "reserved",
            "variants.report": "reserved",
            "variants.a.shell.bore": "unknown_name",
            "variants.c.clearance": "unknown_name",
            "variants.a.bore": "missing_unit",
            "variants.b.bore": "unknown_name",
            "variants.c.shell.width": "unit_mismatch",
            "variants.d.shell.inner_diameter": "out_of_range",
        }
        assert http.get(f"{DESIGNS}/{design['id']}").json()["revision"] == 1

    def test_at_most_two_hundred(self, http, design):
        many = {f"v{n}": {} for n in range(201)}
        assert "variants" in faults(put(http, design, many))

    def test_done_once_under_one_key(self, http):
        design = created(http, shells())
        headers = {"If-Match": '"1"', "Idempotency-Key": design["id"], **WAIT}
        path, body = f"{DESIGNS}/{design['id']}/variants", {"variants": {"x": {"bore": "31 mm"}}}
        first, second = (http.put(path, json=body, headers=headers) for _ in range(2))
        assert [first.json()["revision"], second.json()["revision"]] == [2, 2]


class TestSolids:
    def test_a_failed_build_is_a_matter_of_its_variants(self, http):
        variants = {
            "good": {"model.size": "12 mm"},
            "bad": {"model.mood": "raises"},
            "worse": {"model.mood": "raises"},
            "dies": {"model.mood": "dies"},
        }
        design = created(http, moody("11 mm", variants=variants))
        assert design["state"] == "current"
        out = rows(table(http, design))
        assert {name: row["state"] for name, row in out.items()} == {
            "bad": "failed", "dies": "failed", "good": "current", "worse": "failed",
        }  # fmt: skip
        assert "bad mood" in out["bad"]["models"]["model"]["problem"]["detail"]
        assert out["worse"]["models"]["model"]["state"] == "failed"
        answer = http.get(f"{DESIGNS}/{design['id']}/variants/bad/model.step")
        assert "bad mood" in problem(answer, 404, "not-found")["detail"]
        archive = http.get(f"{DESIGNS}/{design['id']}/variants.zip")
        assert archive.headers["variants-missing"] == "bad.model, dies.model, worse.model"
        assert zipfile.ZipFile(io.BytesIO(archive.content)).namelist() == ["block_good_r1.step"]

    def test_what_follows_from_a_solid_follows_from_that_of_the_variant(self, http):
        """The width of the second model is tied to the mass of the first, which each variant has its own."""
        second = {"id": "moody", "version": 1, "parameters": {"size": "= model.mass * 1000 mm/kg"}}
        first = {"id": "moody", "version": 1, "parameters": {"size": "= size"}}
        document = {
            "name": "pair",
            "parameters": {"size": "14 mm"},
            "models": {"model": first, "second": second},
            "variants": {"large": {"size": "15 mm"}, "larger": {"size": "16 mm"}},
        }
        design = created(http, document)
        for name, row in rows(table(http, design)).items():
            models = row["models"]
            mass = models["model"]["measurements"]["mass"]["value"]
            size = models["second"]["measurements"]["dimensions"]["size"]["value"]
            assert size == pytest.approx(1000 * mass, rel=1e-9), name

    def test_nothing_is_built_twice(self, http, design, served):
        again = created(http, shells(name="again"))
        with served.app.state.services.database.read() as session:
            rows_ = {row["models"]["shell"]["build"] for row in table(http, again)["rows"]}
            assert {row.key for row in session.query(BuildRow).filter(BuildRow.key.in_(rows_))} == rows_
        assert {row["models"]["shell"]["build"] for row in table(http, design)["rows"]} == rows_


class TestFiles:
    def test_a_file_names_design_variant_and_revision(self, http, design):
        answer = http.get(f"{DESIGNS}/{design['id']}/variants/main_2/model.step", headers=WAIT)
        assert 'filename="Kafig_3_main_2_r1.step"' in answer.headers["content-disposition"]
        assert bore_of(answer.content) == pytest.approx(32, abs=1e-9)
        text = answer.content.decode("latin-1")
        assert "'Kafig_3_main_2'" in text
        assert "variant main_2" in text
        with_model = http.get(f"{DESIGNS}/{design['id']}/variants/main_2/models/shell/model.step")
        assert with_model.content == answer.content

    @pytest.mark.parametrize("kind", ["glb", "png", "dxf"])
    @pytest.mark.sampled(1)
    def test_other_kinds_are_made_when_asked_for(self, http, design, kind):
        answer = http.get(f"{DESIGNS}/{design['id']}/revisions/1/variants/main_1/model.{kind}", headers=WAIT)
        assert answer.status_code == 200, answer.text
        assert f'filename="Kafig_3_main_1_r1.{kind}"' in answer.headers["content-disposition"]

    def test_verify_names_design_revision_and_variant(self, http, design):
        step = http.get(f"{DESIGNS}/{design['id']}/variants/main_1/model.step").content
        answer = http.post(f"{API}/verify", content=step, headers={"Content-Type": "model/step"}).json()
        assert answer["intact"]
        uses = [use for use in answer["revisions"] if use["design"] == design["id"]]
        assert uses == [
            {"design": design["id"], "revision": 1, "current": True, "variant": name}
            for name in ("big_end", "main_1")
        ]

    def test_the_zip_holds_every_bore_under_its_name(self, http, design):
        path = f"{DESIGNS}/{design['id']}/variants.zip"
        answer = http.get(path)
        assert answer.headers["content-type"] == "application/zip"
        archive = zipfile.ZipFile(io.BytesIO(answer.content))
        assert archive.testzip() is None
        names = [f"Käfig_3_{name}_r1.step" for name in ("big_end", "main_1", "main_2", "main_10")]
        assert archive.namelist() == names
        for name in names:
            variant = re.fullmatch(r"Käfig_3_(\w+)_r1\.step", name)[1]
            assert bore_of(archive.read(name)) == pytest.approx(float(BORES[variant].split()[0]), abs=1e-9)
        again = http.get(path)
        assert again.content == answer.content
        tag = {"If-None-Match": answer.headers["etag"]}
        assert http.get(path, headers=tag).status_code == 304

    def test_several_models_are_named_too(self, http):
        models = {"shell": SHELL, "block": {"id": "moody", "version": 1, "parameters": {"size": "13 mm"}}}
        design = created(http, shells(name="two", models=models, variants={"a": {"bore": "31 mm"}}))
        archive = zipfile.ZipFile(io.BytesIO(http.get(f"{DESIGNS}/{design['id']}/variants.zip").content))
        assert sorted(archive.namelist()) == ["two_a_block_r1.step", "two_a_shell_r1.step"]
        answer = http.get(f"{DESIGNS}/{design['id']}/variants/a/model.step")
        assert "variants/a/models/" in problem(answer, 404, "not-found")["detail"]

    @pytest.mark.parametrize("tail", ["variants/none/model.step", "variants/main_1/models/x/model.step"])
    def test_what_is_not_there_is_not_found(self, http, design, tail):
        problem(http.get(f"{DESIGNS}/{design['id']}/{tail}"), 404, "not-found")

    def test_a_new_name_carries_the_variants(self, http):
        design = created(http, shells(name="old name"))
        renamed = patched(http, design, {"name": "new name"})
        out = table(http, renamed)
        assert {row["state"] for row in out["rows"]} == {"current"}
        step = http.get(f"{DESIGNS}/{design['id']}/variants/main_1/model.step")
        assert 'filename="new_name_main_1_r2.step"' in step.headers["content-disposition"]
