"""A report never says "met" of a criterion that was not judged, whichever optional input or limit is missing.

The reports are built without a server: document, calculation, content, page.
"""

import re
from collections import Counter
from html import unescape
from math import ceil

import pytest
from newest import older_slow

from app.designs import results
from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.graph import Catalogues, build_graph
from app.designs.schemas.designs import Revision
from app.designs.service import resolved
from app.designs.worksheet import worksheet
from app.reports.content import Report
from app.reports.routes import page
from app.reports.signatures import signatures_of
from app.reports.steps import step_of
from app.reports.verdict import judged
from cad.catalogue import models
from templates.door import built_in

CATALOGUES = Catalogues(built_in(), models())
MET = re.compile(r"\bmet\b", re.IGNORECASE)
VERDICT = re.compile(r'<section class="verdict.*?</section>', re.DOTALL)
ROW = re.compile(r'<tr class="(\w+)">(.*?)</tr>', re.DOTALL)
TAG = re.compile(r"<[^>]*>")
NAME = re.compile(r"[a-z][a-z0-9_]*")
STEP = "only"
SI = {"note": None, "created": "2026-01-01T00:00:00Z", "state": "current", "problem": None}
TEMPLATES = list(CATALOGUES.templates)


def document_of(cls, inputs, limits):
    step = {"template": cls.id, "version": cls.version, "inputs": inputs, "limits": limits}
    level = {"level": cls.levels[0]} if cls.levels else {}
    return Document.model_validate({"name": "one step", "steps": {STEP: {**step, **level}}})


def revision_of(document):
    """The results that a revision of the document keeps; None if the template refuses it."""
    document = resolved(document, CATALOGUES)
    graph, faults = build_graph(document, CATALOGUES)
    assert not faults
    calculation = calculate(graph, lambda shape: None, lambda *question: None)
    if calculation.faults:
        return None
    kept = results.stored(calculation, [])
    for more in ("analyses", "table"):
        kept.pop(more)
    names = {"design": "d", "number": 1, "name": document.name, "parameters": {}, "models": {}}
    return Revision.model_validate({**names, **SI, **kept})


def report_of(revision, document):
    """The page of the report."""
    worked = worksheet(revision, CATALOGUES.templates, "si")
    typed = document.model_dump()["steps"]
    steps = [step_of(name, step, typed[name], CATALOGUES) for name, step in worked.steps.items()]
    texts = {"title": worked.name, "design": "d", "note": "", "date": worked.created, "state": worked.state}
    parts = {"problem": "", "program": "", "units": "si", "summary": [], "parameters": [], "models": []}
    parts["signatures"] = signatures_of("d", 1, "si", [])
    return page(Report(revision=1, newest=1, verdict=judged(worked), steps=steps, **texts, **parts))


def limits_of(cls):
    return {limit.name: limit for criterion in cls.declared_criteria for limit in criterion.limits}


def variations(cls, most):
    """Inputs and limits: all, then without one optional input, without each limit, with neither.

    Of many optional inputs about `most` are left out in turn, evenly among them.
    """
    inputs, limits = dict(cls.example), {n: f"1 {one.unit}" for n, one in limits_of(cls).items()}
    optional = [name for name, declared in cls.inputs.items() if name in inputs and not declared.required]
    needed = {name: value for name, value in inputs.items() if name not in optional}
    yield inputs, limits
    yield from (
        ({n: v for n, v in inputs.items() if n != left_out}, limits)
        for left_out in optional[:: ceil(len(optional) / most) or 1]
    )
    yield from ((inputs, {n: v for n, v in limits.items() if n != left_out}) for left_out in limits)
    yield inputs, {}
    yield needed, {}


def has_value(amount):
    """Whether it is a number, or an array that holds one."""
    return any(map(has_value, amount)) if isinstance(amount, list) else amount is not None


def available(cls, step, limits):
    """The names of inputs, outputs and limits that have a value."""
    values = {**step.inputs, **step.outputs}
    names = {name for name, one in values.items() if has_value(one.value)} | limits.keys()
    defaults = {n: one.default[1] for n, one in limits_of(cls).items() if one.default}
    return names | {name for name, source in defaults.items() if source in names}


def without_a_side(cls, revision, limits):
    """The numbers of the criteria that name something without a value, in the order of the revision."""
    declared = {*cls.inputs, *cls.formulas, *limits_of(cls)}
    names = available(cls, revision.steps[STEP], limits)
    wanted = [declared & set(NAME.findall(one.require)) for one in revision.criteria or []]
    instead = [names_instead(cls, one.name) for one in revision.criteria or []]
    return {
        number
        for number, (sides, others) in enumerate(zip(wanted, instead, strict=True))
        if not sides <= names and not (others and others <= names)
    }


def names_instead(cls, name):
    """The names in the comparison that a criterion is judged by where a side has no value."""
    criterion = next(one for one in cls.declared_criteria if f"{STEP}.{one.name}" == name)
    others = [missing.instead.names for missing in criterion.absent.values() if missing.instead]
    return set().union(*others)


@pytest.mark.parametrize("cls", older_slow(TEMPLATES))
@pytest.mark.parametrize("most", [8, pytest.param(1000, marks=pytest.mark.slow)])
@pytest.mark.sampled(6)
def test_a_report_says_met_only_of_criteria_with_value_and_limit(cls, most):
    unjudged = []
    for inputs, limits in variations(cls, most):
        document = document_of(cls, inputs, limits)
        if revision := revision_of(document):
            page = report_of(revision, document)
            unjudged.append(says_only_what_was_judged(cls, revision, limits, page))
    assert len(unjudged) >= 2 + len(limits_of(cls)), "refused for its limits"
    assert any(unjudged) == bool(cls.declared_criteria)


def says_only_what_was_judged(cls, revision, limits, page):
    """Check a page; how many of its criteria have no value or no limit."""
    verdict = VERDICT.search(page)[0]
    rows = ROW.findall(verdict)
    unjudged = without_a_side(cls, revision, limits)
    assert len(rows) == len(revision.criteria or [])
    for number in unjudged:
        kind, row = rows[number]
        assert kind == "not_checked", text_of(row)
        assert not MET.search(text_of(row))
    counts = Counter(kind.replace("_", " ") for kind, _ in rows)
    headline = re.search(r"<h2.*?</h2>", verdict)[0]
    said = Counter[str]()
    for number, words in re.findall(r"(\d+) (not met|met|undecided|not checked)", headline):
        said[words] += int(number)  # met with an unknown error is counted apart
    assert said == counts
    governing = re.search(r'<p class="said">.*?</p>', verdict)
    assert counts["met"] + counts["not met"] or not (governing and MET.search(governing[0]))
    beside = unescape(text_of(page.replace(verdict, "")))
    for warning in revision.steps[STEP].warnings:  # of a criterion that was judged, in its words
        beside = beside.replace(warning.detail, "")
    assert not MET.search(beside), "said beside the verdict"
    return len(unjudged)


def text_of(markup):
    return TAG.sub(" ", markup)
