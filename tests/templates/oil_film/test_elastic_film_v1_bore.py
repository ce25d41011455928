"""Level `elastic` of `elastic_film`, whose bore is a matrix of modes."""

import numpy as np
import pytest

from cad.analysis.kinds import KINDS, mode_names
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.elastic_film_v1 import ElasticFilm
from templates.physics.elastic.bore_film import attitude, bore_balances
from templates.physics.elastic.bore_journal import BoreSoftness
from templates.physics.elastic.bore_modes import BENDING, HIGHEST, MODES, modes_along, modes_around
from templates.physics.elastic.compliance import ring_compliance
from tests.recorded_bore import BORE_WIDTH, MODULUS, POISSON_RATIO, recorded_bore

FILM = "minimum_film_thickness"
CHANGED = (FILM, "relative_eccentricity", "attitude_angle", "maximum_pressure", "power_loss", "side_flow")
STEEL = ring_compliance(24.3e-3, 38e-3, 210e9, 0.3) * 1e15
ORDERS = [0, *(n for n in range(1, HIGHEST + 1) for _ in "cs")]
RING = np.diag(np.concatenate([STEEL[ORDERS], np.zeros(19)]))
HOUSING = {
    "housing_modulus": f"{MODULUS} GPa", "housing_poisson_ratio": POISSON_RATIO,
    "bore_width": f"{BORE_WIDTH} mm",
}  # fmt: skip


def rows(matrix):
    return {"compliance": {"value": np.asarray(matrix).tolist(), "unit": "um/GPa"}}


def outputs(raw=None, **options):
    found = evaluate(ElasticFilm, {**ElasticFilm.example, **(raw or {})}, **options).outputs
    return {name: one.value for name, one in found.items()}


class TestModes:
    def test_modes_are_those_of_the_analysis(self):
        assert mode_names() == MODES
        assert ElasticFilm.inputs["compliance"].columns == mode_names()
        assert ElasticFilm.inputs["compliance"].meaning.unit == KINDS["bore_compliance"]["compliance"]
        assert [MODES[i] for i in np.flatnonzero(~BENDING)] == ["c1", "s1"]

    def test_analytic_modes_have_a_mean_square_of_one_and_are_apart(self):
        angle = np.linspace(0, 2 * np.pi, 100, endpoint=False)
        zeta, weight = np.polynomial.legendre.leggauss(6)
        around, along = modes_around(angle), modes_along(zeta)
        modes = np.concatenate([around[:, None] * along[None, :, k, None] for k in range(2)], axis=-1)
        gram = np.einsum("azi,azj,z->ij", modes, modes, weight / 2) / angle.size
        assert gram == pytest.approx(np.eye(38), abs=1e-12)


class TestLimits:
    def test_limit_a_stiff_bore_is_rigid(self):
        rigid = outputs({"liner_thickness": "0 mm"})
        found = outputs({**rows(np.zeros((38, 38))), "liner_thickness": "0 mm"}, level="elastic")
        for name in CHANGED:
            assert found[name] == pytest.approx(rigid[name], rel=1e-6), name

    def test_limit_without_a_load_nothing_is_deformed(self):
        found = outputs({**rows(RING), "radial_load": "0 N"}, level="elastic")
        assert found["largest_deformation"] == 0
        assert (
            found["minimum_film_thickness"]
            == outputs({"radial_load": "0 N"}, level="rigid")["minimum_film_thickness"]
        )

    def test_limit_a_ring_is_level_housing(self):
        """Besides harmonics 10 to 40, here of a half plane: within 0.1 %, whatever the angle."""
        ring, found = (
            outputs(level="housing"),
            outputs({**rows(RING), "load_angle": "40 deg"}, level="elastic"),
        )
        for name in (*CHANGED, "largest_deformation"):
            assert found[name] == pytest.approx(ring[name], rel=1e-3), name

    @pytest.mark.slow
    def test_property_the_bore_turns_with_its_load(self):
        """The modes' second harmonic softened along c2: a quarter turn of the load takes s and c in turn."""
        soft, other = RING.copy(), RING.copy()
        soft[3, 3] *= 2  # c2, about the block
        other[4, 4] *= 2  # s2, 45 degrees on
        one = outputs({**rows(soft), "load_angle": "20 deg"}, level="elastic")
        same = outputs({**rows(other), "load_angle": "65 deg"}, level="elastic")
        far = outputs({**rows(soft), "load_angle": "65 deg"}, level="elastic")
        for name in CHANGED:
            assert one[name] == pytest.approx(same[name], rel=1e-6), name
        assert abs(one["maximum_pressure"] / far["maximum_pressure"] - 1) > 1e-3


class TestBalance:
    def test_property_load_flow_and_turn_are_balanced(self):
        matrix = np.array(recorded_bore())
        matrix *= 0.1 / matrix[3, 3]
        softness = BoreSoftness(0.0, np.zeros(41), matrix=matrix, share=0.8)
        for _, soft in bore_balances(3.0, 0.5, 0.75, softness, 0.6):
            film = soft.film
            assert np.hypot(*film.force) == pytest.approx(3.0, rel=1e-8)
            assert film.softness.turn == pytest.approx(0.6 + attitude(film), abs=1e-8)
            assert np.abs(film.loss[soft.inside]).max() < 1e-7 * np.abs(film.loss).max()
            assert (film.P >= 0).all()
            assert film.deformation.max() > 0.1 * film.H.min()

    def test_property_a_housing_lowers_the_pressure(self):
        rigid = outputs({**rows(recorded_bore()), **HOUSING})
        found = outputs({**rows(recorded_bore()), **HOUSING}, level="elastic")
        assert found["maximum_pressure"] < 0.9 * rigid["maximum_pressure"]
        assert found["mesh_error"] < 0.01
        assert 0.5 < rigid["neglected_deformation"] / found["largest_deformation"] < 2


class TestAnswers:
    def test_property_criterion_takes_the_matrix(self):
        """What is neglected at level rigid is proportional to the matrix, and nothing is at level elastic."""
        bare = {"liner_thickness": "0 mm", "housing_modulus": "1e9 GPa"}
        one, twice = (outputs({**rows(k * RING), **bare}) for k in (1, 2))
        assert twice["neglected_deformation"] == pytest.approx(2 * one["neglected_deformation"], rel=1e-4)
        answer = evaluate(ElasticFilm, {**ElasticFilm.example, **rows(RING)})
        assert {notice.code for notice in answer.warnings} == {"elasticity_matters"}
        assert outputs(rows(RING), level="elastic")["neglected_deformation"] == 0

    def test_property_ladder_has_elastic_where_its_matrix_is_given(self):
        assert "elastic" not in ElasticFilm.from_quantities(ElasticFilm.example).ladder()
        given = ElasticFilm.from_quantities({**ElasticFilm.example, **rows(RING)})
        assert given.ladder()[-1] == "elastic"

    @pytest.mark.parametrize(
        ("change", "words"),
        [
            (lambda C: C[:37], "38 rows"),
            (lambda C: C[:, :37], "at most 38 rows of m, c1, s1"),
            (lambda C: C + np.eye(38, k=1), "column i"),
            (lambda C: C - 2 * np.diag(np.diag(C)), "negative eigenvalues"),
            (lambda C: C + 1e3 * (np.eye(38, k=1) + np.eye(38, k=-1)), "negative eigenvalues"),
        ],
    )
    def test_property_wrong_matrices_are_refused_by_name(self, change, words):
        with pytest.raises(InvalidInputs) as refusal:
            outputs(rows(change(np.array(recorded_bore()))))
        (fault,) = refusal.value.faults
        assert "compliance" in fault.names
        assert words in fault.detail

    @pytest.mark.parametrize(
        ("raw", "level", "name"),
        [
            ({}, "elastic", "compliance_modes"),
            ({**rows(RING), "bore_width": "17 mm"}, "elastic", "bore_width"),
            pytest.param(rows(1e5 * RING), "elastic", "relative_eccentricity", marks=pytest.mark.slow),
        ],
    )
    def test_property_refuses_by_name(self, raw, level, name):
        with pytest.raises(InvalidInputs) as refusal:
            outputs(raw, level=level)
        assert name in {one for fault in refusal.value.faults for one in fault.names}
