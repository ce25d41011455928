"""Propose relations for unset model parameters; each links a parameter to a value of the design.

A proposal is applied only if the user accepts it. A value fits by three tests:

- the *kind*: value and parameter are the same kind of quantity, and a curve never fits a single value;
- the *name*: the value has the name of the parameter, or a name listed under `also`;
- the *role*: a name of general words only, such as `bore` or `width`, does not identify a part; the bore
of an engine is the bore of its cylinder. So a value with such a name fits only if it has exactly the name
of the parameter and the ids of template and model share a word.

A parameter whose default comes from a standard's table, such as the width of a bearing by its designation,
has its value already. Values of other models are proposed where no step has one: outputs, and parameters that
are set and do not depend on the target's model.
"""

from __future__ import annotations

from collections.abc import Iterator

from app.designs.network import Block, Graph
from app.designs.schemas.designs import Proposal
from app.reference import Reference
from templates.core.language.spec import Choice, Curve, Derived, Profile, Table, Text
from templates.core.units.conformity import misfit
from templates.core.units.units import unit

GENERAL = frozenset(
    "angle area bore clearance depth diameter face height inner length load mass number outer radius size "
    "speed stroke temperature thickness volume wall width".split()
)
"""Words that name a quantity without identifying the part."""
NO_SINGLE_VALUE = (Choice, Curve, Profile, Table, Text)


def proposals(graph: Graph) -> list[Proposal]:
    """Return one proposal for every unset model parameter that has a suitable value."""
    models = [block for block in graph.blocks.values() if block.is_model]
    candidates = (_proposal(graph, model, name) for model in models for name in model.cls.inputs)
    return [proposal for proposal in candidates if proposal is not None]


def _proposal(graph: Graph, model: Block, name: str) -> Proposal | None:
    declared = model.cls.inputs[name]
    if name in model.cells or isinstance(declared, Choice) or _is_from_a_table(declared):
        return None
    for called in (name, *declared.meaning.also):
        fitting = [
            s for s in _named(graph, model, name, called) if _fits(graph, s, declared.meaning.accepted)
        ]
        if fitting:
            chosen, *others = sorted(fitting, key=lambda source: not _is_namesake(source, model))
            relation = f"= {chosen}"
            return Proposal(
                target=f"{model.name}.{name}", relation=relation, reason=_reason(model, name, called, others)
            )
    return None


def _reason(model: Block, name: str, called: str, others: list[Reference]) -> str:
    meaning, words = model.cls.inputs[name].meaning, called.replace("_", " ")
    same = f"both are called {words}" if called == name else f"{meaning.words} is also {words}"
    more = f"; {', '.join(map(str, others))} would fit too" if others else ""
    return f"{same}, and both are the same kind of quantity{more}"


def _named(graph: Graph, model: Block, name: str, called: str) -> Iterator[Reference]:
    """Yield the values with this name: outputs and inputs of steps first, then parameters of the design."""
    fitting = [
        block
        for block in graph.blocks.values()
        if not block.is_model
        and (_tells_its_part(called) or (called == name and _share_a_role(block, model)))
    ]
    yield from (Reference(step.name, None, called) for step in fitting if called in step.cls.formulas)
    yield from (Reference(step.name, None, called) for step in fitting if called in step.cls.inputs)
    if called in graph.parameters and (_tells_its_part(called) or called == name):
        yield Reference(called)
    if _tells_its_part(called):
        yield from _of_models(graph, model, called)


def _of_models(graph: Graph, model: Block, called: str) -> Iterator[Reference]:
    """Yield the values with this name that other models provide: outputs, and parameters that are set.

    Only models whose names come earlier in the alphabet count.
    """
    for _, other in sorted(graph.blocks.items()):
        if other is model:
            return  # one direction alone never forms a loop
        if other.is_model and (called in other.cls.formulas or called in other.cells):
            if not _depends(graph, other.name, model.name):
                yield Reference(other.name, None, called)


def _depends(graph: Graph, name: str, on: str) -> bool:
    """Return whether a block or parameter depends on a block, directly or through others."""
    waiting, seen = [name], set[str]()
    while waiting:
        one = waiting.pop()
        seen.add(one)
        cells = graph.blocks[one].cells.values() if one in graph.blocks else [graph.parameters[one]]
        waiting += [used.block for cell in cells for used in cell.uses.values() if used.block not in seen]
    return on in seen


def _is_from_a_table(declared: object) -> bool:
    """Return whether the default of a parameter comes from a published table."""
    return isinstance(declared, Derived) and bool(declared.meaning.source)


def _tells_its_part(called: str) -> bool:
    """Return whether a name identifies a part: `bearing_width` does, `width` does not."""
    return not GENERAL.issuperset(called.split("_"))


def _share_a_role(step: Block, model: Block) -> bool:
    return not set(step.cls.id.split("_")).isdisjoint(model.cls.id.split("_"))


def _is_namesake(source: Reference, model: Block) -> bool:
    """Return whether the names of a step and a model share a word, as do `front_film` and `front_shell`."""
    block = source.block if source.output is not None else ""
    return not set(block.split("_")).isdisjoint(model.name.split("_"))


def _fits(graph: Graph, source: Reference, wanted: str) -> bool:
    """Return whether a source is a single value of the required kind."""
    if source.output is None:
        return misfit(graph.kinds[source.block], unit(wanted), source.block) is None
    cls = graph.blocks[source.block].cls
    declared = cls.formulas.get(source.output) or cls.inputs[source.output]
    if isinstance(declared, NO_SINGLE_VALUE):
        return False
    return misfit(graph.kind_of(source), unit(wanted), str(source)) is None
