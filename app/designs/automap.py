"""Propose relations for unset model parameters; each links a parameter to a value of the design.

A proposal is applied only if the user accepts it. A value fits by three tests:

- the *kind*: value and parameter are the same kind of quantity, and a curve never fits a single value;
- the *name*: value and parameter share a name, their own or one listed under `also`; own names come first;
- the *role*: a name of general words only, such as `bore` or `width`, does not identify a part; the bore
of an engine is the bore of its cylinder. So a value with such a name fits only if it is a parameter of the
design, or of a step, has exactly the name of the parameter, and the ids of template and model share a word.
Two models of one kind are different parts, so such a name never links them.

The same tests apply to values of steps, of the design and of other models; these are proposed in that order.
A model gives its outputs and the parameters that are set. No proposal closes a loop, neither with the
relations of the design nor with another proposal. A parameter whose default comes from a standard's table,
such as the width of a bearing by its designation, has its value already.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from itertools import product

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
    proposed: list[Proposal] = []
    loops = _Loops(graph)
    for model in (block for block in graph.blocks.values() if block.is_model):
        for name in model.cls.inputs:
            if best := _proposal(graph, loops, model, name):
                source, proposal = best
                loops.link(model.name, source.block)
                proposed.append(proposal)
    return proposed


def _proposal(graph: Graph, loops: _Loops, model: Block, name: str) -> tuple[Reference, Proposal] | None:
    """Return the best value for a parameter, with its proposal; None if there is none."""
    declared = model.cls.inputs[name]
    if name in model.cells or isinstance(declared, Choice) or _is_from_a_table(declared):
        return None
    for called, is_own in product((name, *declared.meaning.also), (True, False)):
        sources = [*_named(graph, model, name, called, is_own=is_own)]
        fitting = [one for one in sources if _fits(graph, one, declared.meaning.accepted)]
        if fitting := [one for one in fitting if not loops.closes(model.name, one)]:
            chosen, *others = sorted(fitting, key=lambda source: not _is_namesake(source, model))
            reason = _reason(model, name, called, others)
            return chosen, Proposal(target=f"{model.name}.{name}", relation=f"= {chosen}", reason=reason)
    return None


def _reason(model: Block, name: str, called: str, others: list[Reference]) -> str:
    meaning, words = model.cls.inputs[name].meaning, called.replace("_", " ")
    same = f"both are called {words}" if called == name else f"{meaning.words} is also {words}"
    more = f"; {', '.join(map(str, others))} would fit too" if others else ""
    return f"{same}, and both are the same kind of quantity{more}"


def _named(graph: Graph, model: Block, name: str, called: str, *, is_own: bool) -> Iterator[Reference]:
    """Yield the values with this name (`is_own`), or with this other name: of steps, design, models."""
    tells = _tells_its_part(called)
    steps = [block for block in graph.blocks.values() if not block.is_model]
    for step in steps:
        if tells or (called == name and is_own and _share_a_role(step, model)):
            yield from _values_called(step, step.cls.inputs, called, is_own=is_own)
    if is_own and called in graph.parameters and (tells or called == name):
        yield Reference(called)
    for other in graph.blocks.values():
        if tells and other.is_model and other is not model:
            yield from _values_called(other, other.cells, called, is_own=is_own)


def _values_called(
    block: Block, inputs: Collection[str], called: str, *, is_own: bool
) -> Iterator[Reference]:
    """Yield outputs, then inputs, of a block with this name, or with this other name."""
    for names in (block.cls.formulas, inputs):
        for name in names:
            declared = block.cls.formulas.get(name) or block.cls.inputs[name]
            if name == called if is_own else called in declared.meaning.also:
                yield Reference(block.name, None, name)


class _Loops:
    """The dependencies of a design together with its proposals."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._sources = {
            **{name: {used.block for used in cell.uses.values()} for name, cell in graph.parameters.items()},
            **{
                name: {used.block for cell in block.cells.values() for used in cell.uses.values()}
                for name, block in graph.blocks.items()
            },
        }

    def link(self, target: str, source: str) -> None:
        """Add a proposal."""
        self._sources[target].add(source)

    def closes(self, target: str, source: Reference) -> bool:
        """Return whether a link from `source` to the model `target` would close a loop.

        A model is one part here: none of its parameters is taken by a model on which it depends.
        """
        cell, block = self._graph.cell(source), self._graph.blocks.get(source.block)
        is_apart = cell is not None and not (block and block.is_model)
        waiting = [used.block for used in cell.uses.values()] if cell and is_apart else [source.block]
        seen = set[str]()
        while waiting:
            one = waiting.pop()
            seen.add(one)
            waiting += self._sources.get(one, set()) - seen
        return target in seen


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
