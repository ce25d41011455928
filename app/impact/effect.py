"""The effect of a version on one design: all changes in the design itself and in its variants."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document, Step
from app.designs.network import LIMITS, limits_of
from app.impact.comparison import Difference, difference
from app.impact.outcome import Outcome
from app.impact.schemas import DesignImpact, StepUse, UpgradeRefused
from app.impact.severity import worst_first
from app.impact.task import Batch, DesignAt
from templates.core.errors import Fault
from templates.core.language.template import Template

MOST_NAMED = 50
"""Largest number of refusals, parameters and names of one design that an answer lists."""

Pairs = Mapping[str | None, tuple[Outcome, Outcome]]
"""Both outcomes by variant; None is the design itself."""


def impact_of(
    batch: Batch, design: DesignAt, document: Document, pairs: Pairs, catalogues: Catalogues
) -> DesignImpact | None:
    """Return the changes in a design; None if nothing changes."""
    about = described(design, document, batch.template, batch.version)
    if refusals := list(_refusals(pairs)):
        given = {"refusals": refusals[:MOST_NAMED], **_remedies(batch, document, pairs, catalogues)}
        return _written({**about, "effect": "refused", **given})
    differences = {variant: difference(*pair, variant) for variant, pair in pairs.items()}
    waiting = list(dict.fromkeys(name for one in differences.values() for name in one.waiting))
    if not any(one.is_moved for one in differences.values()):
        return _written({**about, "effect": "needs_solids", "needs_solids": waiting}) if waiting else None
    return _written(
        {**about, "effect": "moved", "needs_solids": waiting, **_moved(list(differences.values()))}
    )


def described(design: DesignAt, document: Document, template: str, version: int) -> dict[str, object]:
    """Return the description of a design, with its steps that use another version."""
    return {
        "design": design.id,
        "name": document.name,
        "revision": design.revision,
        "steps": used_steps(document, template, version),
    }


def used_steps(document: Document, template: str, version: int) -> list[StepUse]:
    """Return the steps of a document that use another version of a template."""
    return [
        StepUse(step=name, version=int(step.version or 0))
        for name, step in document.steps.items()
        if step.template == template and step.version != version
    ]


def _moved(differences: list[Difference]) -> dict[str, object]:
    """Return the worst change over a design and its variants."""
    margins = [one.margin for one in differences if one.margin]
    largest = max(differences, key=lambda one: one.size)
    return {
        "verdicts": worst_first(verdict for one in differences for verdict in one.verdicts)[:MOST_NAMED],
        "margin": max(margins, key=lambda one: -1.0 if one.relative is None else one.relative, default=None),
        "output": largest.output,
        "outputs_moved": sum(one.outputs for one in differences),
        "gone": list(dict.fromkeys(name for one in differences for name in one.gone))[:MOST_NAMED],
        "parameters": [parameter for one in differences for parameter in one.parameters][:MOST_NAMED],
    }


def _refusals(pairs: Pairs) -> Iterator[UpgradeRefused]:
    """Yield the reasons for which a save of the upgrade is refused, each once, at its first variant."""
    listed = set[tuple[str, str, str]]()
    for variant, (before, after) in pairs.items():
        if before.faults and not after.faults:
            continue  # the new version corrects this fault
        for fault in after.faults:
            key = fault.name, fault.code, fault.detail
            if key not in listed:
                listed.add(key)
                place = {} if variant is None else {"variant": variant}
                shown = {"name": fault.name, "code": fault.code, "detail": fault.detail, **place}
                yield UpgradeRefused.model_validate(shown)


def _remedies(batch: Batch, document: Document, pairs: Pairs, catalogues: Catalogues) -> dict[str, list[str]]:
    """Return the inputs that the version requires, and the inputs that it does not have."""
    cls = catalogues.templates.get(batch.template, batch.version)
    steps = [use.step for use in used_steps(document, batch.template, batch.version)]
    remove = [name for step in steps for name in _left_over(step, document.steps[step], cls)]
    faults = [fault for _, after in pairs.values() for fault in after.faults]
    give = dict.fromkeys(name for fault in faults if _is_missing(fault) for name in fault.names)
    return {"give": list(give)[:MOST_NAMED], "remove": remove[:MOST_NAMED]}


def _left_over(name: str, step: Step, cls: type[Template]) -> Iterator[str]:
    """Yield the inputs and limits of a step that a version does not have."""
    yield from (f"{name}.{given}" for given in step.inputs if given not in cls.inputs)
    limits = limits_of(cls)
    names = limits.keys() | {limit.library for limit in limits.values()}
    yield from (f"{name}.{LIMITS}.{given}" for given in step.limits if given not in names)


def _is_missing(fault: Fault) -> bool:
    return fault.code == "missing"


def _written(parts: dict[str, object]) -> DesignImpact:
    """Return the answer without empty members."""
    return DesignImpact.model_validate(
        {name: part for name, part in parts.items() if part not in ([], None, 0)}
    )


def unusable(about: dict[str, object], absent: list[str]) -> DesignImpact:
    """Return the impact on a design that uses a version missing from the catalogue.

    Neither the design nor its upgrade can be calculated.
    """
    detail = f"the catalogue does not have {', '.join(absent)}, so that the design cannot be calculated"
    return _refused(about, "unknown_name", detail)


def unfinished(about: dict[str, object], error: Exception) -> DesignImpact:
    """Return the impact on a design whose calculation crashed its process."""
    return _refused(about, "not_calculated", f"the calculation did not end: {error}")


def _refused(about: dict[str, object], code: str, detail: str) -> DesignImpact:
    refusal = UpgradeRefused(name="design", code=code, detail=detail)
    return _written({**about, "effect": "refused", "refusals": [refusal]})
