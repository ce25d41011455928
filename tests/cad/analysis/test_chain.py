"""A chain of throws' matrices: rigid motions, symmetry, and the finite elements of a whole shaft."""

from math import pi
from typing import Any

import numpy as np
import pytest

from benchmarks.crank_chain import CASES, compared, one, shaft
from cad.analysis.chain import Chain, in_series, turned
from cad.analysis.throw_matrix import ThrowMatrix, relative_motion

RIGID = np.array([
    [1, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 1, 0],
    [0, 0, 0, 0, 0, 1],
])  # fmt: skip


def rigid_motions(throw: ThrowMatrix) -> Any:
    """Freedoms of the throw in the six rigid motions of its first end, (14, 6)."""
    relative = relative_motion(throw.pitch, throw.throw)
    return np.vstack([RIGID, -relative[:, :6]])


class TestOneThrow:
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

    def test_guides_make_it_stiffer_and_series_is_too_soft(self) -> None:
        chain = Chain([one()] * 4, [0, pi, pi, 0])
        free, guided = (chain.stiffness(guided=guided) for guided in (False, True))
        assert guided > free
        assert in_series([one()] * 4, guided=False) < 0.96 * guided


@pytest.mark.slow
@pytest.mark.parametrize("angles", CASES)
def test_chain_is_the_whole_shaft_within_1_percent(angles: tuple[float, ...]) -> None:
    for row in compared(angles):
        assert abs(row["chain"]) < 0.01
        assert abs(row["chain_frequency"]) < 0.01
