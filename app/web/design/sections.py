"""Render the steps of a design on its page; unchanged steps are not rendered again.

Rendering a step takes some milliseconds, and a design may have sixty steps. Most of them stay the same after
a change.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from hashlib import sha256
from types import MappingProxyType

from cachetools import LRUCache
from fastapi import Request
from markupsafe import Markup

from app.designs.schemas.designs import Design
from app.presentation.criteria import Line
from app.web.shared.blocks import Refusal, StepBlock
from app.web.shared.responses import jinja
from app.web.variants.table import VariantsTable
from app.web.verdict.banner import Banner, opened

KEPT = 16 * 2**20  # largest size of the cached sections [characters]
_kept: LRUCache[bytes, Markup] = LRUCache(KEPT, getsizeof=len)
"""Sections by all values that they show. Only the event loop writes pages, so no lock is needed."""

MOST_IN_FULL = 12
"""Largest number of steps for which the page of a design shows all inputs and results; for more steps it
shows those of a few."""


def asked_step(request: Request, steps: Collection[str]) -> str | None:
    """Return the step that the address names, if the design has it."""
    name = request.query_params.get("step", "")
    return name if name in steps else None


def steps_in_full(request: Request, steps: Collection[str], refusal: Refusal, verdict: Banner) -> set[str]:
    """Return the steps that the page of a long design shows completely.

    They are the step that the address names and the steps of a refused form.
    """
    first = asked_step(request, steps) or opened(list(steps), verdict)
    typed = {name.partition("@" if "@" in name else ".")[0] for name in (*refusal.typed, *refusal.faults)}
    return {name for name in steps if name == first or name in typed}


def sections(
    steps: Sequence[StepBlock],
    verdict: Banner,
    opened: str | None,
    *,
    in_full: Collection[str] | None = None,
    folded: Mapping[str, Markup] = MappingProxyType({}),
) -> Iterator[Markup]:
    """Yield the rendered section of every step.

    The section of the step `opened` is unfolded. If `in_full` is given, all steps that it does not name are
    `folded`.
    """
    worst = verdict.worst_by_step()
    for step in steps:
        if in_full is not None and step.name not in in_full:
            yield folded[step.name]
        else:
            is_open = step.name == opened or step.has_faults
            yield _section(step, worst.get(step.name), is_open, len(steps) == 1 and in_full is None)


def fold_lines(steps: Sequence[StepBlock], verdict: Banner, base: str) -> dict[str, Markup]:
    """Return the summary line of every step; a script loads the rest from an address below `base`."""
    worst = verdict.worst_by_step()
    return {step.name: _fold_line(step, worst.get(step.name), base) for step in steps}


def banner_of(verdict: Banner, design: str) -> Markup:
    """Return the verdict at the top of a design's page.

    The result is cached, because a long design has hundreds of criteria.
    """
    return _macro("verdict/verdict.html", "banner", verdict, design)


def variants_start(design: Design, variants: VariantsTable) -> Markup:
    """Return an empty table for a design's first variants, with a column for each input."""
    return _macro("variants/variants.html", "start", design, variants)


def _fold_line(step: StepBlock, worst: Line | None, base: str) -> Markup:
    template, outputs = step.template, step.result.outputs
    keys = [outputs[name].model_dump_json() for name in step.keys]
    shown = (base, step.name, template.id, template.version, template.digest, step.keys, keys, worst)
    return _written("fold_line", shown, step, worst, base)


def _section(step: StepBlock, worst: Line | None, is_open: bool, is_only: bool) -> Markup:
    shown = _shown(step, worst, is_open, is_only)
    return _written("section", shown, step, worst, is_open, is_only)


def _written(macro: str, shown: object, *arguments: object) -> Markup:
    """Return the output of a macro of steps, cached under its name and everything that it shows."""
    key = sha256(repr((macro, shown)).encode("utf-8", "surrogatepass")).digest()
    html = _kept.get(key)
    if html is None:
        html = _macro("design/step.html", macro, *arguments)
        if len(html) <= KEPT:
            _kept[key] = html
    return html


def _macro(page: str, name: str, *arguments: object) -> Markup:
    return Markup(getattr(jinja.get_template(page).module, name)(*arguments))


def _shown(step: StepBlock, worst: Line | None, is_open: bool, is_only: bool) -> tuple[object, ...]:
    """Return everything that a section shows; the template's digest represents its declarations."""
    template = step.template
    return (
        step.name,
        (template.id, template.version, template.digest, template.withdrawn),
        step.result.model_dump_json(),
        step.outputs,
        step.pictures,
        (step.fields, step.options, step.limits, step.keys),
        (worst, is_open, is_only),
    )
