"""One variant with every output of its steps, curves included, calculated on request.

A revision stores the single outputs of its variants only, because the curves of 200 variants would fill the
database.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from app.calculations import json_values
from app.calculations.json_values import rendered
from app.calculations.schemas.evaluations import Output
from app.catalogue.catalogues import Catalogues
from app.designs import repository
from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.designs.errors import DesignError
from app.designs.graph import raise_if
from app.designs.questions import settled
from app.designs.result_cells import as_member
from app.designs.results import Outcome
from app.designs.schemas.variants import VariantDetail
from app.designs.variants.names import BASE
from app.designs.variants.together import Available, together
from app.pool.questions import VARIANT, Kind, Reply, json_answer, json_form
from app.presentation.units import System
from app.solids.analysis_rows import analysed
from app.solids.rows import built
from app.storage.database import Database
from app.storage.errors import NotFound
from templates.core.criteria.summary import worst_first
from templates.core.errors import Fault, InvalidInputs, unknown_names

WAITS = "it depends on a solid that is not built yet"
ITERATED = "a design iterates only when it is saved; create a separate design for the variant"


@dataclass(frozen=True)
class WantedVariant:
    """Request for a variant of a design, or `base` for the design itself, and for some or all of its outputs.

    If `outputs` is empty, all are returned. If `revision` is None, it is the newest.
    """

    design: str
    variant: str
    outputs: tuple[str, ...] = ()
    revision: int | None = None
    system: System = "si"


def detailed(
    wanted: WantedVariant, database: Database, catalogues: Catalogues
) -> Reply[WantedVariant, VariantDetail]:
    """Return the variant, or the request to continue with if a step is deferred.

    Raises
    ------
    NotFound
        If there is no such design, revision or variant.
    InvalidInputs
        If an output is unknown, or the variant cannot be calculated.
    """
    with database.read() as session:
        number = wanted.revision or repository.head(session, wanted.design).number
        document = Document.model_validate(repository.document(session, wanted.design, number))
    own = _alone(document, wanted)
    [outcome] = together(own, Available(catalogues, built(database), analysed(database)))
    raise_if(list(outcome.faults))
    if outcome.is_deferred:
        return Reply(None, replace(wanted, revision=number))
    return Reply(_shown(wanted, number, outcome))


def _alone(document: Document, wanted: WantedVariant) -> Document:
    """Return the document with the requested variant as its only one."""
    variants = {BASE: {}, **document.variants}
    if wanted.variant not in variants:
        there = f"there are {', '.join(variants)}"
        raise NotFound(f"design {wanted.design}: there is no variant {wanted.variant!r}; {there}")
    if document.iterations:
        raise InvalidInputs([Fault("iterations", "iterated", ITERATED)])
    return document.model_copy(update={"variants": {wanted.variant: variants[wanted.variant]}})


def _shown(wanted: WantedVariant, number: int, outcome: Outcome) -> VariantDetail:
    assert outcome.calculation is not None, "it has no faults"
    outputs = dict(_outputs(outcome.calculation))
    unknown = [name for name in wanted.outputs if name not in outputs]
    if unknown:
        raise InvalidInputs(fault.within("outputs") for fault in unknown_names(unknown, outputs, "output"))
    return VariantDetail.model_validate(
        {
            "design": wanted.design,
            "revision": number,
            "name": wanted.variant,
            "values": outcome.values,
            **as_member(outcome.calculation),
            "inputs": dict(_inputs(outcome.calculation)),
            "outputs": {name: outputs[name] for name in wanted.outputs or outputs},
            **rendered(worst_first(outcome.judgements)),
        }
    ).in_units(wanted.system)


def _inputs(calculation: Calculation) -> Iterator[tuple[str, object]]:
    """Yield name and value of every input of the calculated steps."""
    for step, evaluation in calculation.evaluations.items():
        yield from ((f"{step}.{name}", one) for name, one in json_values.inputs(evaluation.inputs).items())


def _outputs(calculation: Calculation) -> Iterator[tuple[str, Output]]:
    """Yield the name and value of every step output.

    The value is null with its reason while the step is pending.
    """
    for block in calculation.graph.blocks.values():
        if block.is_model:
            continue
        evaluation = calculation.evaluations.get(block.name)
        if evaluation is None:
            waiting = calculation.graph.computed(block) or tuple(block.cls.formulas)
            yield from ((f"{block.name}.{name}", Output(value=None, reason=WAITS)) for name in waiting)
        else:
            shown = json_values.outputs(evaluation.outputs)
            yield from ((f"{block.name}.{name}", Output.model_validate(one)) for name, one in shown.items())


VARIANT_DETAILS = Kind(
    VARIANT,
    json_form(WantedVariant),
    json_answer(VariantDetail),
    detailed,
    failures=(DesignError,),
    settle=settled,
)
