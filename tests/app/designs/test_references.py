"""Designs resolve names as references, order their network, and continue calculations."""

import pytest

from app.catalogue.discovery import find_templates
from app.designs.document import Document
from app.designs.engine.calculate import calculate, resume
from app.designs.graph import Catalogues, build_graph
from app.designs.network import Block, Solid, SolidAnalysis
from app.reference import Reference
from cad.catalogue import models

THROW = {
    "journal_diameter": "55 mm",
    "pin_diameter": "= 0.9 * 50 mm",
    "pin_length": "32 mm",
    "journal_length": "40 mm",
    "web_thickness": "18 mm",
    "web_width": "80 mm",
    "throw": "43 mm",
}
SHELL = {"inner_diameter": "= 20 mm + throw.mass * 1 mm/kg + throw.torsion.stiffness * 1e-6 mm*rad/N/m"}
MEASURES = {"mass": 5.0}
FOUND = {"stiffness": {"value": 2e6, "unit": "N*m/rad", "error": None}}


@pytest.fixture(scope="module")
def catalogues():
    return Catalogues(find_templates(()), models())


@pytest.fixture(scope="module")
def graph(catalogues):
    throw = {"id": "crank_throw", "version": 1, "parameters": THROW, "analyses": {"torsion": {}}}
    shell = {"id": "plain_bearing", "version": 1, "parameters": SHELL}
    document = Document.model_validate({"name": "x", "models": {"shell": shell, "throw": throw}})
    graph, faults = build_graph(document, catalogues)
    assert not faults
    return graph


@pytest.mark.parametrize(
    ("name", "reference", "member"),
    [
        ("scale", Reference("scale"), ""),
        ("film.radial_load", Reference("film", None, "radial_load"), "radial_load"),
        ("throw.torsion.stiffness", Reference("throw", "torsion", "stiffness"), "torsion.stiffness"),
        ("a.b.c.d", Reference("a", "b", "c.d"), "b.c.d"),
    ],
)
def test_a_name_is_parsed_and_written(name, reference, member):
    assert Reference.parse(name) == reference
    assert str(reference) == name
    assert reference.member == member


def test_a_reference_is_not_changed():
    with pytest.raises(AttributeError):
        Reference("film").block = "other"


def test_every_node_stands_behind_those_it_follows_from(graph):
    places = {node: place for place, node in enumerate(graph.order)}
    assert len(places) == len(graph.order) == len(graph.sources)
    assert all(places[source] < places[node] for node, sources in graph.sources.items() for source in sources)
    behind = graph.sources[graph.blocks["shell"].cells["inner_diameter"]]
    assert {type(node) for node in behind} == {Solid, SolidAnalysis}


def test_a_loop_is_returned_as_a_fault_with_its_path(catalogues):
    document = Document(name="x", parameters={"a": "= b", "b": "= c", "c": "= a"})
    graph, (fault,) = build_graph(document, catalogues)
    assert fault.code == "loop"
    assert graph.order == ()
    assert sum(f" {name} " in f" {fault.detail} ".replace(";", " ") for name in "abc") == 3


def test_a_continued_calculation_is_that_of_all_at_once(graph):
    def nothing(*_):
        return None

    def measured(shape):
        return MEASURES if shape.id == "crank_throw" else None

    first = calculate(graph, nothing, nothing)
    waiting = {node.name for node in first.pending if isinstance(node, Block)}
    assert waiting == {"shell"}
    second = resume(first, measured, nothing)
    assert [node.kind for node in second.waiting()] == ["torsion"]
    last = resume(second, measured, lambda *_: FOUND)
    whole = calculate(graph, measured, lambda *_: FOUND)
    assert last.values == whole.values
    assert last.shapes["shell"].inputs_si() == whole.shapes["shell"].inputs_si()
    assert last.values["shell.inner_diameter"].value == pytest.approx(0.027)
    assert last.pending == whole.pending == {graph.blocks["shell"].solid}
    assert first.pending > last.pending  # the earlier one is as it was
