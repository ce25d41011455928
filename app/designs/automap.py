"""Proposals for model parameters that are not set: mapped by name and unit, each with its reason."""

from __future__ import annotations

from collections.abc import Iterator

from app.designs.network import Block, Graph
from app.designs.reference import Reference
from app.schemas.designs import Proposal
from templates.core.language.spec import Choice
from templates.core.units.units import compatible, unit


def proposals(graph: Graph) -> list[Proposal]:
    """One proposal for every unset model parameter that something fits by name and unit."""
    models = [block for block in graph.blocks.values() if block.is_model]
    return [
        found for model in models for name in model.cls.inputs if (found := _proposal(graph, model, name))
    ]


def _proposal(graph: Graph, model: Block, name: str) -> Proposal | None:
    declared = model.cls.inputs[name]
    if name in model.cells or isinstance(declared, Choice):
        return None
    target = f"{model.name}.{name}"
    for called in (name, *declared.meaning.also):
        fitting = [source for source in _named(graph, called) if _fits(graph, source, declared.meaning.unit)]
        if fitting:
            words = called.replace("_", " ")
            same = (
                f"both are called {words}" if called == name else f"{declared.meaning.words} is also {words}"
            )
            others = f"; {', '.join(map(str, fitting[1:]))} would fit too" if fitting[1:] else ""
            reason = f"{same}, and both are given in {declared.meaning.unit} or its like{others}"
            return Proposal(target=target, relation=f"= {fitting[0]}", reason=reason)
    return None


def _named(graph: Graph, called: str) -> Iterator[Reference]:
    """What is called so: outputs and inputs of steps first, then parameters of the design."""
    steps = [block for block in graph.blocks.values() if not block.is_model]
    yield from (Reference(step.name, None, called) for step in steps if called in step.cls.formulas)
    yield from (Reference(step.name, None, called) for step in steps if called in step.cls.inputs)
    if called in graph.parameters:
        yield Reference(called)


def _fits(graph: Graph, source: Reference, wanted: str) -> bool:
    if source.output is None:
        return compatible(graph.kinds[source.block].base, unit(wanted).base)
    return compatible(unit(graph.unit_of(source)).base, unit(wanted).base)
