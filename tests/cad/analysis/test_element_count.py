"""Elements are counted before meshing: the integral of a uniform size, and a refusal without a mesh."""

from math import inf
from typing import Any

import numpy as np
import pytest
from netgen.meshing import MeshingParameters
from netgen.occ import Box, Pnt

from cad.analysis import mesh
from cad.analysis.element_count import PER_BOX, _elements_in, estimated_elements
from cad.analysis.mesh import MOST_ELEMENTS, ONE_THREAD, make_grid, sharp_edges
from cad.analysis.solid import Solid, read_solid
from cad.analysis.stress import START
from cad.errors import AnalysisError
from cad.shaft import Shaft
from templates.core.arrays import Array
from tests.references.shoulder_fillet import END, FILLET, shoulder


def filleted(fillet: float) -> Solid:
    return read_solid(shoulder(fillet), Shaft(0.0, END))


@pytest.mark.parametrize("size", [4.0, 8.0])
def test_elements_of_one_size_fill_the_volume(size: float) -> None:
    """Analytic: a block without curvature has elements of the largest permitted size."""
    block = Box(Pnt(0, 0, 0), Pnt(32, 32, 64))
    parameters = MeshingParameters(maxh=size, **ONE_THREAD)
    estimate = estimated_elements(block, parameters, size, MOST_ELEMENTS)
    assert estimate == pytest.approx(PER_BOX * 32 * 32 * 64 / size**3, rel=0.01)


@pytest.mark.parametrize("place", [0.0, 7.0, 20.0])
@pytest.mark.parametrize("smallest", [2.0, 0.2, 0.02])
@pytest.mark.parametrize("share", [0.3, 0.9, 1.0, 1.1])
def test_a_limit_stops_the_count_only_if_the_whole_count_exceeds_it(
    place: float, smallest: float, share: float
) -> None:
    """One small size in the middle of a large box says little about the elements in that box."""

    def size_at(centres: Array) -> Array:
        return np.minimum(smallest + 0.5 * np.linalg.norm(centres - place, axis=1), 20.0)

    whole = _elements_in(size_at, np.zeros((1, 3)), 80.0, inf)
    counted = _elements_in(size_at, np.zeros((1, 3)), 80.0, share * whole)
    assert (counted > share * whole) == (share < 1)


def test_estimate_is_that_of_the_mesh_within_its_range() -> None:
    """The range of benchmarks/results/element_counts.json."""
    solid = filleted(FILLET)
    edges = sharp_edges(solid, START)
    parameters, largest = mesh.sizes(solid, START, (), edges), START.size * solid.scale
    estimate = estimated_elements(solid.shape, parameters, largest, MOST_ELEMENTS)
    assert 0.5 < make_grid(solid, START, (), edges).mesh.ne / estimate < 1.5


def test_too_many_elements_are_refused_before_meshing(monkeypatch: pytest.MonkeyPatch) -> None:
    solid = filleted(FILLET)
    edges = sharp_edges(solid, START)

    def no_mesh(*_: Any) -> None:
        raise AssertionError("the solid was meshed")

    monkeypatch.setattr(mesh, "OCCGeometry", no_mesh)
    monkeypatch.setattr(mesh, "MOST_ELEMENTS", 100)
    with pytest.raises(AnalysisError, match="more than 100 elements"):
        make_grid(solid, START, (), edges)


def test_a_tiny_fillet_is_counted_up_to_the_limit_only() -> None:
    solid = filleted(0.05)
    mesh.bound_sizes(solid, START)
    largest = START.size * solid.scale
    parameters = MeshingParameters(maxh=largest, curvaturesafety=START.curvature, **ONE_THREAD)
    assert estimated_elements(solid.shape, parameters, largest, MOST_ELEMENTS) > MOST_ELEMENTS
