"""A chain of throws' matrices agrees with rigid motions, symmetry, and finite elements of a whole shaft."""

import json
from collections.abc import Sequence
from dataclasses import replace
from math import pi, sqrt
from typing import Any

import numpy as np
import pytest

from benchmarks.crank_chain import CASES, GIVEN, RESULTS, compared, in_series, one, shaft
from cad.analysis.chain import Chain, turned
from cad.analysis.chain_answers import OF_THE_CHAIN, SolvedThrows, chain_answers, judged
from cad.analysis.levels import LEVELS
from cad.analysis.throw_matrix import ThrowMatrix, relative_motion
from cad.cranks.chain_throw import has_throws, shaft_of_throws, throws_apart
from cad.cranks.whole import WholeShaft
from cad.models.crank_throw_v1 import CrankThrow
from cad.models.crankshaft_v1 import Crankshaft
from cad.regenerate import ignore
from cad.shaft import PlacedThrow

RIGID = np.array([
    [1, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 1, 0],
    [0, 0, 0, 0, 0, 1],
])  # fmt: skip


def rigid_motions(throw: ThrowMatrix) -> Any:
    """Freedoms of the throw in the six rigid motions of its first end, (14, 6)."""
    relative = relative_motion(throw.pitch, throw.throw)
    return np.vstack([RIGID, -relative[:, :6]])


def softer(throw: ThrowMatrix, *parts: float) -> ThrowMatrix:
    """The throw with more flexibility, each part a share of what it has: no mirror image of itself."""
    flexibility = np.linalg.inv(throw.stiffness[6:, 6:])
    flexibility += np.diag(np.diag(flexibility) * parts)
    relative = relative_motion(throw.pitch, throw.throw)
    return replace(throw, stiffness=relative.T @ np.linalg.solve(flexibility, relative))


def weighted() -> WholeShaft:
    """A shaft of four throws with counterweights, the first and the last alike."""
    radii = {"value": [70, 0, 0, 70, 60, 0, 70, 0], "unit": "mm"}
    pins = {"value": [0, 180, 180, 0], "unit": "deg"}
    given = {**GIVEN, "pin_angles": pins, "counterweight_radius": radii}
    drawn = shaft_of_throws(Crankshaft.from_quantities(given))
    assert drawn is not None
    return drawn


class TestThrowsApart:
    def test_throws_alike_share_a_solid(self) -> None:
        apart = throws_apart(weighted())
        assert [place.solid for place in apart.places] == [0, 1, 2, 0]
        assert [place.angle for place in apart.places] == pytest.approx([0, pi, pi, 0])
        assert len({one.step for one in apart.solids}) == 3
        assert all(one.shaft.loaded == -one.shaft.held == weighted().pitch / 2 for one in apart.solids)

    def test_only_a_shaft_of_throws_has_them(self) -> None:
        assert has_throws(Crankshaft)
        assert not has_throws(CrankThrow)
        assert shaft_of_throws(CrankThrow.from_quantities(CrankThrow.example)) is None


class TestOneThrow:
    @pytest.mark.slow
    def test_rigid_motions_meet_no_resistance(self) -> None:
        force = one().stiffness @ rigid_motions(one())
        scale = np.abs(one().stiffness) @ np.abs(rigid_motions(one()))
        assert np.abs(force).max() < 1e-9 * scale.max()

    def test_stiffness_is_symmetric_and_eight_times_positive(self) -> None:
        K = one().stiffness
        d = np.sqrt(np.diag(K))
        scaled = K / d / d[:, None]
        assert np.abs(scaled - scaled.T).max() < 1e-9
        values = np.linalg.eigvalsh(scaled)
        assert (values[6:] > 1e-6).all()
        assert np.abs(values[:6]).max() < 1e-9

    def test_mass_of_rigid_motions_is_that_of_the_solid(self) -> None:
        r = rigid_motions(one())
        rigid = r.T @ one().mass @ r
        pitch = one().pitch
        solid = shaft((0.0,))
        t = solid.like
        volume = solid.volume() - pi * (
            t.journal**2 * t.journal_length + solid.nose.radius**2 * solid.nose.length
            + solid.flange.radius**2 * solid.flange.length
        )  # fmt: skip
        assert rigid[0, 0] == pytest.approx(7850e-12 * volume, rel=2e-3)  # the elements' own volume
        assert rigid[:3, :3] == pytest.approx(rigid[0, 0] * np.eye(3), rel=1e-9, abs=1e-12)
        assert rigid[0, 4] == pytest.approx(rigid[0, 0] * pitch / 2, rel=1e-3)

    def test_mirrored_throw_has_mirrored_stiffness(self) -> None:
        """The throw is its image in y = 0: what is odd in y does not couple with what is even."""
        odd = [1, 3, 5, 7, 9, 11, 13]
        even = [0, 2, 4, 6, 8, 10, 12]
        K = one().stiffness
        d = np.sqrt(np.diag(K))
        assert np.abs((K / d / d[:, None])[np.ix_(odd, even)]).max() < 5e-3  # the mesh is no mirror image


class TestChain:
    def test_angle_common_to_all_changes_nothing(self) -> None:
        for guided in (False, True):
            values = [Chain([one()] * 2, [a, a + pi / 2]).stiffness(guided=guided) for a in (0.0, 0.7)]
            assert values[0] == pytest.approx(values[1], rel=1e-9)

    def test_turning_a_throw_is_orthogonal(self) -> None:
        assert turned(0.3) @ turned(0.3).T == pytest.approx(np.eye(14), abs=1e-12)

    def test_inertia_adds_up(self) -> None:
        assert Chain([one()] * 3, [0, 2, 4]).inertia() == pytest.approx(3 * Chain([one()], [0]).inertia())

    @pytest.mark.parametrize("guided", [False, True])
    def test_throws_in_their_places_are_in_series(self, guided: bool) -> None:
        chain = Chain([one(), softer(one(), *[0.2] * 8), one()], [0, 2, 4])
        between = chain.throw_stiffnesses(guided=guided)
        assert 1 / sum(1 / between) == pytest.approx(chain.stiffness(guided=guided), rel=1e-9)
        alone = [Chain([throw], [0.0]).stiffness(guided=False) for throw in chain.throws]
        assert (between == pytest.approx(alone, rel=1e-7)) is not guided

    def test_guides_make_it_stiffer_and_series_is_too_soft(self) -> None:
        chain = Chain([one()] * 4, [0, pi, pi, 0])
        free, guided = (chain.stiffness(guided=guided) for guided in (False, True))
        assert guided > free
        assert in_series([one()] * 4, guided=False) < 0.96 * guided


class TestAnswers:
    """What two orders of elements say together."""

    PLACES = (PlacedThrow(0, 0.0), PlacedThrow(0, pi))

    def answers(self, low: ThrowMatrix, boundary: Any = "free_end") -> dict[str, dict[str, Any]]:
        solved = SolvedThrows(
            [low], [one()], elements=10, degrees_of_freedom=90, is_sharp=False, is_resolved=True
        )
        return judged(solved, self.PLACES, boundary, LEVELS[0], seconds=1.0)

    def test_values_are_those_of_the_higher_order(self) -> None:
        for boundary, guided in (("free_end", False), ("guided_end", True)):
            answers = self.answers(replace(one(), stiffness=1.01 * one().stiffness), boundary)
            chain = Chain([one(), one()], [0.0, pi])
            assert answers["stiffness"]["value"] == chain.stiffness(guided=guided)
            assert answers["torsional_frequency"]["value"] == chain.frequency(guided=guided)
            assert answers["throw_stiffnesses"]["value"] == chain.throw_stiffnesses(guided=guided).tolist()

    def test_errors_are_that_of_the_mesh_and_that_of_the_chain(self) -> None:
        answers = self.answers(replace(one(), stiffness=1.01 * one().stiffness))
        for name, change in (("stiffness", 0.01), ("torsional_frequency", sqrt(1.01) - 1)):
            of_the_mesh = LEVELS[0].factor * change + LEVELS[0].floor
            assert answers[name]["error"] == pytest.approx(of_the_mesh + OF_THE_CHAIN[name], rel=1e-6)
        listed = LEVELS[0].factor * 0.01 + LEVELS[0].floor + OF_THE_CHAIN["throw_stiffnesses"]
        assert answers["throw_stiffnesses"]["error"] == pytest.approx(listed, rel=1e-6)

    def test_orders_far_apart_give_a_reason(self) -> None:
        answers = self.answers(replace(one(), stiffness=3 * one().stiffness))
        for answer in answers.values():
            assert answer["value"] is None
            assert "too large" in answer["reason"]


@pytest.mark.slow
@pytest.mark.parametrize("boundary", ["free_end", "guided_end"])
def test_the_whole_shaft_lies_within_the_error(boundary: Any) -> None:
    """The whole is on the mesh of the same level, so what the mesh leaves is common to both."""
    answers = chain_answers(throws_apart(shaft(CASES[0])), boundary, "coarse", None, ignore)
    rows: Sequence[Any] = json.loads(RESULTS.read_text())["rows"]
    guided = boundary == "guided_end"
    whole = next(row for row in rows if row["pins"] == [*CASES[0]] and row["guided"] is guided)
    for name, kept in (("stiffness", "stiffness"), ("torsional_frequency", "frequency")):
        answer = answers[name]
        assert abs(answer["value"] / whole[f"{kept}_of_the_whole"] - 1) < OF_THE_CHAIN[name] < answer["error"]


@pytest.mark.slow
@pytest.mark.parametrize("angles", CASES)
def test_chain_is_the_whole_shaft_within_1_percent(angles: tuple[float, ...]) -> None:
    for row in compared(angles):
        assert abs(row["chain"]) < 0.01
        assert abs(row["chain_frequency"]) < 0.01
        assert max(map(abs, row["throws"])) < 0.01
