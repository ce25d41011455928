"""`oil_film` 1 as a worksheet has the same results, refusals, description and record as the file."""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest
from seeds import seeded

import benchmarks
from app.pool.sources import SheetSource, loaded, source_of
from templates.core.catalogue import golden
from templates.core.catalogue.digests import digest, release_file
from templates.core.checks.check import faults_of
from templates.core.errors import InvalidInputs
from templates.core.language import dimensions
from templates.core.language.evaluate import evaluate
from templates.core.language.levels import accuracy, accuracy_file
from templates.core.paper import report
from templates.core.paper.schema import describe
from templates.core.paper.verdicts import checks
from templates.core.sheets import read
from templates.oil_film.oil_film_v1 import OilFilm

TEXT = (Path(benchmarks.__file__).parent / "oil_film.sheet").read_text(encoding="utf-8")
GOLDEN = Path(__file__).parents[3] / "golden" / "oil_film_v1.json"
RANGES = {  # wide enough for every refusal of the template
    "radial_load": (-1, 3000, "kN"),
    "diametral_clearance": (-0.01, 0.2, "mm"),
    "bearing_diameter": (0.1, 100, "mm"),
    "bearing_width": (5, 50, "mm"),
    "speed": (-100, 8000, "rpm"),
    "oil_inlet_temperature": (-110, 200, "degC"),
    "oil_outlet_temperature": (20, 520, "degC"),
    "kinematic_viscosity_1": (0.2, 150, "mm**2/s"),
    "kinematic_viscosity_2": (0.2, 150, "mm**2/s"),
    "reference_density": (-10, 1000, "kg/m**3"),
}


@pytest.fixture(scope="module")
def film():
    return read(TEXT).template("oil_film", 1)


def points(count, number):
    random = np.random.default_rng(seeded(number))
    spread = {name: random.uniform(low, high, count) for name, (low, high, _) in RANGES.items()}
    return {name: {"value": values.tolist(), "unit": RANGES[name][2]} for name, values in spread.items()}


def outcome(cls, inputs):
    """The outputs in SI, or what is refused."""
    try:
        return golden.results(cls, inputs)
    except InvalidInputs as refusal:
        return sorted((fault.name, fault.code, fault.detail) for fault in refusal.faults)


class TestResults:
    def test_equal_the_file_at_1000_points(self, film):
        inputs = {**OilFilm.example, **points(1000, 1)}
        sheet, file = evaluate(film, inputs), evaluate(OilFilm, inputs)
        assert sheet.outputs.keys() == file.outputs.keys()
        for name, answer in file.outputs.items():
            mine = sheet.outputs[name]
            np.testing.assert_allclose(mine.value, answer.value, rtol=1e-12, atol=0, err_msg=name)
            assert np.isnan(answer.value).any() == (answer.reasons is not None)
            if answer.reasons is not None:
                assert (np.equal(mine.reasons, None) == np.equal(answer.reasons, None)).all()
        assert 0.05 < np.isnan(file.outputs["minimum_film_thickness"].value).mean() < 0.95

    def test_equal_the_file_point_by_point(self, film):
        drawn = points(60, 2)
        names = {name: OilFilm.inputs[name].meaning.scale for name in drawn}
        for place in range(60):
            one = {name: float(names[name].to_si(values["value"][place])) for name, values in drawn.items()}
            inputs = {**golden._given(OilFilm), **one}
            mine, theirs = outcome(film, inputs), outcome(OilFilm, inputs)
            if isinstance(theirs, list):
                assert [fault[:2] for fault in mine] == [fault[:2] for fault in theirs]
            else:
                assert mine == pytest.approx(theirs, rel=1e-12, abs=0)

    def test_equal_the_golden_record(self, film):
        cases = golden.record(film)["cases"]
        for mine, kept in zip(cases, json.loads(GOLDEN.read_text(encoding="utf-8"))["cases"], strict=True):
            assert mine.get("refused") == kept.get("refused")
            if "outputs" in kept:
                assert mine["outputs"] == pytest.approx(kept["outputs"], rel=1e-12, abs=0)

    def test_equal_sensitivities(self, film):
        assert film.formulas.keys() == OilFilm.formulas.keys()
        for name, formula in OilFilm.formulas.items():
            inputs = {d.attribute for d in OilFilm.inputs.values()}
            assert film.dependencies(film.formulas[name].attribute) & inputs == (
                OilFilm.dependencies(formula.attribute) & inputs
            )


class TestTheSameKindOfTemplate:
    def test_inputs_and_outputs_are_described_alike(self, film):
        mine, theirs = describe(film), describe(OilFilm)
        assert (mine["inputs"], mine["outputs"]) == (theirs["inputs"], theirs["outputs"])
        assert json.loads(json.dumps(mine, allow_nan=False)) == mine
        assert mine["title"].startswith("Minimum oil film thickness of an engine bearing")

    def test_has_no_faults(self, film):
        assert faults_of(film, None) == []
        assert dimensions.faults(film) == []

    def test_asks_for_no_file(self, film):
        assert (accuracy_file(film), accuracy(film), release_file(film)) == (None, None, None)

    def test_has_the_digest_of_its_sheet(self, film):
        assert digest(film) == film.sheet.digest()

    def test_reports_every_formula_on_paper(self, film):
        template = evaluate(film, film.example).template
        rows = {row.name: row for row in report.rows(template)}
        assert rows.keys() == film.formulas.keys()
        assert rows["relative_clearance"].latex == (
            r"C=\frac{c}{d}=\frac{0.055\,\text{mm}}{47.945\,\text{mm}}=0.0011471"
        )
        assert all("<math" in row.mathml for row in rows.values())

    def test_reports_its_rules(self, film):
        rules = [check for check in checks(evaluate(film, film.example).template) if check.kind == "rule"]
        theirs = [c for c in checks(evaluate(OilFilm, OilFilm.example).template) if c.kind == "rule"]
        assert [(r.words, r.used, r.holds) for r in rules] == [(r.words, r.used, r.holds) for r in theirs]
        assert rules[0].demand == "c<D"

    def test_is_pickled_as_text(self, film):
        packed = pickle.dumps(film)
        assert TEXT.encode()[:60] in packed
        again = pickle.loads(packed)
        assert (again.id, again.version, again.sheet.digest()) == ("oil_film", 1, film.sheet.digest())
        withdrawn = read(TEXT).template("oil_film", 1)
        withdrawn.withdrawn = "it has another successor"
        assert pickle.loads(pickle.dumps(withdrawn)).withdrawn == "it has another successor"
        template = pickle.loads(pickle.dumps(evaluate(film, film.example).template))
        assert template.h_0 == pytest.approx(3.24491e-6, rel=1e-5)

    def test_goes_to_processes_as_text(self, film):
        source = source_of(film)
        assert source == SheetSource("oil_film", 1, TEXT, None)
        assert loaded(source).sheet.digest() == film.sheet.digest()
        assert loaded(source) is loaded(SheetSource("oil_film", 1, TEXT, None))
