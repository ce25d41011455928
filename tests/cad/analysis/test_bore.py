"""The compliance of a split bore agrees with Lamé and Michell; real housings satisfy energy bounds."""

from functools import cache

import numpy as np
import pytest
from netgen.occ import Cylinder, Dir, Pnt

from cad.analysis.bore import (
    BORE,
    RIGID,
    BoredSolid,
    BoreFineness,
    _points,
    bore_mesh,
    compliance_on,
    mode_functions,
    read_bored,
)
from cad.analysis.bore_tables import LEVELS, bore_tables, difference
from cad.analysis.kinds import HARMONICS, KINDS, mode_names
from cad.analysis.solid import FREE, MIRROR
from cad.errors import AnalysisError
from cad.header import Header
from cad.models.bearing_housing_v1 import BearingHousing
from cad.models.connecting_rod_v1 import ConnectingRod
from cad.shaft import STEEL_MATERIAL, BorePlace
from cad.shells.bore_place import bore_place
from cad.step import write_step
from templates.physics.elastic.compliance import ring_compliance

RADIUS, OUTER, HALF = 24.0, 36.0, 6.0
RING = ring_compliance(RADIUS / 1e3, OUTER / 1e3, STEEL_MATERIAL.young, STEEL_MATERIAL.poisson) * 1e9
"""[mm/MPa]"""
PLANE = 2 * HARMONICS + 1
"""How many modes are even along the bore."""
ORDER = [0, *(n for n in range(1, HARMONICS + 1) for _ in "cs")]
NAMES = mode_names()


def sleeve() -> BoredSolid:
    """A ring whose two ends cannot move along z: plane strain. Nothing holds it otherwise."""
    full, hole = (Cylinder(Pnt(0, 0, 0), Dir(0, 0, 1), r=radius, h=HALF) for radius in (OUTER, RADIUS))
    shape = full - hole
    for face in shape.faces:
        x, y, z = np.array([point for edge in face.edges for point in _points(edge)]).T
        on_bore = abs(np.hypot(x[0], y[0]) - RADIUS) < 1e-6
        face.name = MIRROR if np.ptp(z) < 1e-6 else BORE if on_bore else FREE
    return BoredSolid(shape, BorePlace(RADIUS, HALF, 0.0, None, STEEL_MATERIAL))


@cache
def of_sleeve(order):
    solid = sleeve()
    return compliance_on(bore_mesh(solid, BoreFineness(0.3, 0.6)), order, solid.place, spring=1e-3)[0]


@cache
def drawn(cls):
    model = cls.from_quantities(cls.example)
    return write_step(list(model.build()), Header(cls.id, 1, {}, "0" * 64)), bore_place(model)


@cache
def answered(cls, level):
    return bore_tables(*drawn(cls), level, lambda done, what: None)


class TestSleeve:
    """The closed forms that level housing of elastic_film 1 uses."""

    def test_analytic_even_pressure_is_lame_and_low_harmonics_are_michell(self):
        widened = np.diag(of_sleeve(3))[:PLANE]
        assert widened[0] == pytest.approx(RING[0], rel=1e-4)
        for place in range(3, 7):  # c2, s2, c3, s3
            assert widened[place] == pytest.approx(RING[ORDER[place]], rel=0.01), NAMES[place]

    @pytest.mark.slow
    def test_analytic_every_harmonic_is_michell_within_the_change_of_order(self):
        """The stated error of each mode, the change from one order less, bounds the true one."""
        low, high = (np.diag(of_sleeve(order))[:PLANE] for order in (3, 4))
        for name, n, one, before in zip(NAMES, ORDER, high, low, strict=False):
            if n > 1:
                assert abs(one / RING[n] - 1) < abs(before / one - 1), name
            if n in (0, 2, 3, 4):
                assert one == pytest.approx(RING[n], rel=1e-3), name

    def test_analytic_harmonics_of_a_ring_do_not_couple(self):
        """But for what the mesh lacks in symmetry."""
        matrix = of_sleeve(3)[:PLANE, :PLANE]
        kept = np.ix_(~RIGID[:PLANE], ~RIGID[:PLANE])
        off = matrix[kept] - np.diag(np.diag(matrix[kept]))
        assert np.abs(off).max() < 1e-3 * RING[2]

    def test_property_work_is_mutual_and_positive(self):
        matrix = of_sleeve(3)
        assert np.abs(matrix - matrix.T).max() < 1e-12 * np.abs(matrix).max()
        assert np.linalg.eigvalsh((matrix + matrix.T) / 2).min() > 0

    @pytest.mark.slow
    def test_order_converges_from_the_stiff_side(self):
        """Elements of a higher order hold those of a lower one, so they give way further."""
        low, high = np.diag(of_sleeve(3)), np.diag(of_sleeve(4))
        assert (high[~RIGID] > low[~RIGID]).all()
        assert difference(of_sleeve(3), of_sleeve(4)) < 0.005


def test_modes_have_a_mean_square_of_one_and_are_apart():
    """By quadrature over the bore: what makes the matrix symmetric."""
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    zeta, weight = np.polynomial.legendre.leggauss(6)
    around = [np.ones_like(angle)]
    for n in range(1, HARMONICS + 1):
        around += [np.sqrt(2) * np.cos(n * angle), np.sqrt(2) * np.sin(n * angle)]
    along = [np.ones_like(zeta), np.sqrt(5) * (3 * zeta**2 - 1) / 2]
    modes = np.array([np.outer(a, z) for z in along for a in around])
    gram = np.einsum("iaz,jaz,z->ij", modes, modes, weight / 2) / angle.size
    assert gram == pytest.approx(np.eye(len(NAMES)), abs=1e-12)
    assert len(mode_functions(BorePlace(1, 1, 0, None, STEEL_MATERIAL))) == len(NAMES) == 38


class TestPlaces:
    def test_models_say_where_their_bore_is(self):
        housing, rod = (
            bore_place(cls.from_quantities(cls.example)) for cls in (BearingHousing, ConnectingRod)
        )
        assert (housing.radius, housing.half_width, housing.held_at) == (26.4, 11.5, 70)
        assert housing.held_radius is None
        assert (rod.radius, rod.held_at, rod.held_radius) == (25.9, 144, 10.5)
        assert (housing.material.young, rod.material.young) == (110e9, 210e9)

    @pytest.mark.slow
    def test_a_solid_without_that_bore_is_refused(self):
        step, place = drawn(BearingHousing)
        with pytest.raises(AnalysisError, match="no bore"):
            read_bored(step, BorePlace(20.0, place.half_width, place.held_at, None, place.material))
        with pytest.raises(AnalysisError, match="no face to hold it by"):
            read_bored(step, BorePlace(place.radius, place.half_width, 71.0, None, place.material))


@pytest.mark.slow
@pytest.mark.parametrize("cls", [BearingHousing, ConnectingRod])
class TestModels:
    def test_reference_a_finer_mesh_differs_by_less_than_the_error(self, cls):
        fine = np.array(answered(cls, "fine")["compliance"]["value"])
        for level in ("coarse", "default"):
            answer = answered(cls, level)["compliance"]
            assert difference(np.array(answer["value"]), fine) < answer["error"] < 0.1, level
        assert answered(cls, "default")["compliance"]["error"] < 0.01

    def test_property_energy_and_symmetry_of_the_solid(self, cls):
        matrix = np.array(answered(cls, "default")["compliance"]["value"])
        assert np.linalg.eigvalsh(matrix).min() > 0
        # The solid mirrors itself in x = 0: cosines and sines do not couple.
        sines = np.array([name.startswith("s") for name in NAMES])
        assert np.abs(matrix[np.ix_(sines, ~sines)]).max() < 2e-3 * matrix[2 * 2 - 1, 2 * 2 - 1]

    def test_reference_the_highest_harmonic_is_near_a_half_plane(self, cls):
        """Between plane strain and plane stress, whose compliances differ by 1 − ν²; ends are free."""
        place = drawn(cls)[1]
        matrix = np.array(answered(cls, "default")["compliance"]["value"])
        nu = place.material.poisson
        strain = 2 * (1 - nu**2) * place.radius / (place.material.young * HARMONICS) * 1e12
        mean = np.mean([matrix[i, i] for i in (PLANE - 2, PLANE - 1)])
        assert 0.95 * strain < mean < 1.15 * strain / (1 - nu**2)

    def test_all_outputs_are_answered(self, cls):
        answers = answered(cls, "coarse")
        assert answers.keys() == KINDS["bore_compliance"].keys()
        assert answers["compliance"]["columns"] == [*NAMES]
        assert answers["modulus"]["error"] == 0
        assert set(LEVELS) == {"coarse", "default", "fine"}
