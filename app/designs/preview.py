"""Preview a change before it is saved: old and new values of outputs and model parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from app.calculations.json_values import rendered
from app.calculations.schemas.evaluations import Output
from app.catalogue.catalogues import Catalogues
from app.designs import repository, results, tolerances
from app.designs.document import WORKSHEET, Document, StoredDocument, merge
from app.designs.engine.calculate import calculate
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import judged
from app.designs.errors import DesignError
from app.designs.graph import build_graph, raise_if, read_document, resolved, starts
from app.designs.parameter_explanation import shown
from app.designs.result_cells import as_member
from app.designs.results import Outcome
from app.designs.schemas.designs import Change, ParameterChange, Preview, RevisionStep, RoundedValue, Status
from app.designs.schemas.worksheets import DesignLine
from app.designs.variants.checks import checked
from app.designs.variants.together import Available
from app.designs.variants.verdict import merged
from app.designs.worksheet import previewed
from app.designs.worksheet_lines import lines, typeset
from app.plain import JsonObject
from app.pool.questions import PREVIEW, Kind, Reply, json_answer, json_form
from app.presentation.units import System
from app.schemas.answers import Shown, Warning
from app.solids.analysis_rows import analysed
from app.solids.analysis_views import output as analysis_output
from app.solids.rows import built
from app.solids.schemas.analyses import AnalysisOutput
from app.storage.database import Database
from cad.regenerate import as_typed
from templates.core.criteria.judgement import Judgement
from templates.core.errors import Fault


@dataclass(frozen=True)
class PreviewRequest:
    """Request to preview a patch of a design.

    If `revision` is None, the patch applies to the newest one. With `worksheet`, the answer contains every
    step as a revision would store it, with its formulas written out.
    """

    design: str
    patch: JsonObject
    worksheet: bool = False
    system: System = "si"
    revision: int | None = None


def preview(
    asked: PreviewRequest, database: Database, catalogues: Catalogues
) -> Reply[PreviewRequest, Preview]:
    """Return the old and new values for a patch of a design; nothing is saved or built.

    If values depend on deferred steps, the answer is incomplete and comes with the request to continue with.

    Raises
    ------
    InvalidInputs
        If there are faults; the error lists all of them, except relations of model parameters with wrong
        units, which appear in the status of the parameters.
    """
    with database.read() as session:
        head = (
            repository.head(session, asked.design)
            if asked.revision is None
            else repository.revision(session, asked.design, asked.revision)
        )
    changed = resolved(read_document(merge(head.document, asked.patch)), catalogues)
    catalogues = catalogues.with_drafts(_steps_of(changed))  # a preview saves nothing, so drafts may be used
    new, mismatched = _calculated(database, catalogues, changed)
    # faults of the old document are ignored: the change may correct them
    raise_if([*new.faults, *tolerances.not_stated_in(new, head.document)])
    old, _ = _calculated(database, catalogues, Document.model_validate(head.document))
    own = judged(new)
    steps = _steps(new, own)
    outcomes = _variants(database, catalogues, changed, new, head.document) if not mismatched else []
    everywhere = merged(own, {outcome.name: outcome.judgements for outcome in outcomes})
    content = Preview(
        revision=head.number,
        **rendered(everywhere),
        outputs={
            **_compared(_outputs(_steps(old)), _outputs(steps)),
            **_compared(_analysed(old), _analysed(new)),
        },
        warnings=[*_warnings(steps), *tolerances.warnings(changed.model_dump())],
        model_parameters=_model_parameters(old, new, mismatched),
        **_rounded(new),
        **_worksheet(new, outcomes),
    ).in_units(asked.system)
    if asked.worksheet:
        content.steps, content.parameters = previewed(new, steps, asked.system), _values(new)
    is_deferred = old.deferred or new.deferred or any(outcome.is_deferred for outcome in outcomes)
    return Reply(content, replace(asked, revision=head.number) if is_deferred else None)


def _steps_of(document: Document) -> list[tuple[str, int]]:
    """Return template and version of every step with a pinned version."""
    named = ((step.template, step.version) for step in document.steps.values())
    return [(template, version) for template, version in named if isinstance(version, int)]


def _variants(
    database: Database, catalogues: Catalogues, document: Document, base: Calculation, saved: StoredDocument
) -> list[Outcome]:
    """Return the calculated variants of a document.

    Raises
    ------
    InvalidInputs
        If a save would refuse the table; the error lists the faults.
    """
    available = Available(catalogues, built(database), analysed(database))
    outcomes, faults = checked(document, base, available, saved)
    raise_if(faults)
    return outcomes


def _calculated(
    database: Database, catalogues: Catalogues, document: Document
) -> tuple[Calculation, dict[str, Fault]]:
    graph, faults = build_graph(document, catalogues)
    models = [block for block in graph.blocks.values() if block.is_model]
    cells = {cell.name: cell for model in models for cell in model.cells.values()}
    mismatched = {f.name: f for f in faults if f.code == "unit_mismatch" and f.name in cells}
    raise_if([fault for fault in faults if fault.name not in mismatched])
    available = built(database), analysed(database)
    broken = [cells[name] for name in mismatched]
    return calculate(graph, *available, starts(document), broken=broken), mismatched


Outputs = Mapping[str, Output] | Mapping[str, AnalysisOutput | None]


def _compared(old: Outputs, new: Outputs) -> dict[str, Change]:
    names = dict.fromkeys([*old, *new])
    return {name: Change(old=old.get(name), new=new.get(name)) for name in names}


def _steps(calculation: Calculation, criteria: Sequence[Judgement] = ()) -> dict[str, RevisionStep]:
    steps = results.steps(calculation, criteria)
    return {name: RevisionStep.model_validate(step) for name, step in steps.items()}


def _outputs(steps: Mapping[str, RevisionStep]) -> dict[str, Output]:
    """Return all outputs of all steps by their names in relations: `film.minimum_film_thickness`."""
    return {
        f"{name}.{output}": value for name, step in steps.items() for output, value in step.outputs.items()
    }


def _analysed(calculation: Calculation) -> dict[str, AnalysisOutput | None]:
    """Return the outputs of analyses that relations use, by name; null while pending."""
    outputs: dict[str, AnalysisOutput | None] = {}
    for block in calculation.graph.blocks.values():
        for kind in block.analyses:
            computed = calculation.outputs(block.name, kind)
            for name in calculation.graph.wanted(block.name, kind):
                stored = computed.get(name)
                outputs[f"{block.name}.{kind}.{name}"] = analysis_output(stored) if stored else None
    return outputs


def _warnings(steps: Mapping[str, RevisionStep]) -> list[Warning]:
    return [
        warning.model_copy(update={"name": f"{name}.{warning.name}"})
        for name, step in steps.items()
        for warning in step.warnings
    ]


def _rounded(new: Calculation) -> dict[str, list[RoundedValue]]:
    return {name: list(map(RoundedValue.model_validate, rows)) for name, rows in as_member(new).items()}


def _worksheet(new: Calculation, outcomes: Sequence[Outcome]) -> dict[str, list[DesignLine]]:
    if WORKSHEET not in new.graph.blocks:
        return {}
    return {WORKSHEET: typeset(lines(new, results.rows_of(new, outcomes)))}


def _values(new: Calculation) -> dict[str, Shown]:
    """Return the known values of the design's parameters in their units."""
    names = (name for name in new.graph.parameters if name in new.values)
    return {name: Shown(**shown(new.values[name].value, new.graph.kinds[name].unit)) for name in names}


def _model_parameters(
    old: Calculation, new: Calculation, mismatched: Mapping[str, Fault]
) -> dict[str, ParameterChange]:
    changes: dict[str, ParameterChange] = {}
    for block in new.graph.blocks.values():
        if not block.is_model:
            continue
        before = _parameters(old, block.name)
        after = _parameters(new, block.name)
        for name in block.cls.inputs:
            full = f"{block.name}.{name}"
            status = _status(new, block.name, name, before.get(name), after.get(name), full in mismatched)
            changes[full] = ParameterChange(old=before.get(name), new=after.get(name), status=status)
            if full in mismatched:
                changes[full].detail = mismatched[full].detail
    return changes


def _parameters(calculation: Calculation, model: str) -> dict[str, Shown]:
    shape = calculation.shapes.get(model)
    quantities = as_typed(shape) if shape else {}
    return {name: Shown.model_validate(quantity) for name, quantity in quantities.items()}


def _status(
    new: Calculation, model: str, name: str, before: Shown | None, after: Shown | None, mismatch: bool
) -> Status:
    if mismatch:
        return "unit_mismatch"
    if name in new.missing.get(model, ()):
        return "missing"
    if after is None:
        return "pending"
    return "unchanged" if before == after else "ok"


PREVIEWS = Kind(
    PREVIEW,
    json_form(PreviewRequest),
    json_answer(Preview),
    preview,
    failures=(DesignError,),
    has_parts=True,
)
