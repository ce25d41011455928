"""The steps of a design as its page shows them; what was written before is not written again.

A step takes a page some milliseconds, and a design may have sixty. After a change most are as they were.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from hashlib import sha256

from cachetools import LRUCache
from markupsafe import Markup

from app.presentation.criteria import Line
from app.web.blocks import StepBlock
from app.web.rendering import jinja
from app.web.verdict import Banner

KEPT = 16 * 2**20  # characters of sections
_kept: LRUCache[bytes, Markup] = LRUCache(KEPT, getsizeof=len)
"""Sections by all that they show. Pages are written in the event loop alone, so nothing locks."""


def sections(steps: Sequence[StepBlock], verdict: Banner, opened: str | None) -> Iterator[Markup]:
    """The section of every step; that of `opened` is unfolded."""
    for step in steps:
        is_open = step.name == opened or step.has_faults
        yield _section(step, verdict.of_step(step.name), is_open, len(steps) == 1)


def _section(step: StepBlock, worst: Line | None, is_open: bool, is_only: bool) -> Markup:
    key = _key(step, worst, is_open, is_only)
    html = _kept.get(key)
    if html is None:
        html = Markup(jinja.get_template("step.html").module.section(step, worst, is_open, is_only))  # type: ignore[attr-defined]
        if len(html) <= KEPT:
            _kept[key] = html
    return html


def _key(step: StepBlock, worst: Line | None, is_open: bool, is_only: bool) -> bytes:
    """A digest of all that a section shows; the code of the template stands for what it declares."""
    template = step.template
    shown = (
        step.name,
        (template.id, template.version, template.digest, template.withdrawn),
        step.result.model_dump_json(),
        step.outputs,
        step.pictures,
        (step.fields, step.options, step.limits, step.keys),
        (worst, is_open, is_only),
    )
    return sha256(repr(shown).encode("utf-8", "surrogatepass")).digest()
