"""The content of a report as plain data, built once for the page and for the PDF.

Formulas are MathML and numbers are texts; this module does not depend on HTML or Typst.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from app.presentation.result_lines import ResultLines
from app.reports.cells import NOTHING, Cell


@dataclass(frozen=True)
class Line:
    """A value with its meaning: an input, a result, or a measure."""

    words: str
    symbol: str  # MathML
    value: Cell
    si: Cell = NOTHING
    origin: str = ""  # given, default, or the relation
    error: str = ""
    relation: str = ""  # MathML; empty if the origin is not a relation, or only a name


@dataclass(frozen=True)
class Formula:
    """One formula of the calculation, in MathML; missing parts are empty."""

    words: str
    source: str
    lead: str  # symbol = expression
    numbers: str
    result: str


@dataclass(frozen=True)
class Criterion:
    """A criterion as judged, in words about this case."""

    words: str
    verdict: str  # met, not_met, undecided, not_checked
    verdict_words: str
    sentence: str
    used: str
    margin: str
    error: str
    source: str
    remarks: list[str]  # restrictions of the verdict, and missing inputs


@dataclass(frozen=True)
class ReportVerdict:
    """The verdict at the head of a report; without criteria, the headline states why there is no verdict."""

    headline: str
    tone: str  # green, bad, open, plain
    governing: str
    criteria: list[Criterion]


@dataclass(frozen=True)
class Rule:
    """A range or a rule of a template, and whether the values satisfy it; it does not judge the design."""

    words: str
    kind: str
    demand: str  # MathML
    numbers: str  # MathML, with the sign that holds
    used: str  # used share of the allowance
    holds: bool
    state: str  # inside, outside; kept, violated
    remark: str


@dataclass(frozen=True)
class Plot:
    """A chart of a step."""

    title: str
    svg: str


@dataclass(frozen=True)
class WorksheetRow:
    """A line of the design's worksheet: prose, or a formula with its value, or a check with its verdict."""

    kind: str
    is_heading: bool
    words: str
    formula: str  # MathML
    value: Cell
    verdict: str  # of a check
    verdict_words: str
    sentence: str  # the comparison of a check, or why there is no value


@dataclass(frozen=True)
class StepWarning:
    """A warning of a step."""

    name: str
    detail: str


@dataclass(frozen=True)
class Identity:
    """The version of a template or model, with the digest of its code."""

    id: str
    version: int
    digest: str
    title: str
    withdrawn: str
    review: str = ""  # review of a worksheet


@dataclass(frozen=True)
class Step:
    """A calculation step of the design."""

    name: str
    template: Identity
    state: str  # "done", or why there are no results
    level: str
    inputs: list[Line]
    formulas: list[Formula]
    results: list[Line]
    plots: list[Plot]
    ranges: list[Rule]  # range of validity: domains and published ranges
    rules: list[Rule]
    warnings: list[StepWarning]
    assumed: list[str]  # default values in use that make a part look safer
    references: list[str]


@dataclass(frozen=True)
class MappedParameter:
    """A parameter of a model: the relation that drives it, its old and new value, and the measured size."""

    words: str
    symbol: str
    relation: str
    formula: str  # the relation in MathML; empty if it is only a name
    old: Cell
    new: Cell
    measured: Cell
    changed: bool


@dataclass(frozen=True)
class File:
    """A file of a build, with its hash."""

    kind: str
    sha256: str


@dataclass(frozen=True)
class PaintedField:
    """A picture of a part, coloured by a field."""

    id: str
    title: str
    low: Cell  # lower end of the colour scale
    high: Cell


@dataclass(frozen=True)
class ToleranceLine:
    """A parameter with a tolerance, and where the files of its model state it."""

    words: str
    detail: str


@dataclass(frozen=True)
class Model:
    """A CAD model of the design."""

    name: str
    model: Identity
    state: str
    build: str
    compared: str  # the revision used for comparison
    parameters: list[MappedParameter]
    tolerances: list[ToleranceLine]
    measures: list[Line]
    analyses: list[Line]  # finite-element results; the origin states how
    warnings: list[StepWarning]
    rules: list[Rule]
    files: list[File]
    remark: str  # on pictures that are not available
    painted: list[PaintedField] = field(default_factory=list)


@dataclass(frozen=True)
class Round:
    """One round of an iteration."""

    number: int
    through: str
    assumed: Cell
    measured: Cell


@dataclass(frozen=True)
class Columns:
    """A part of the table of variants that fits the paper: headings, and a row of texts for each variant."""

    heads: list[str]
    rows: list[list[str]]


@dataclass(frozen=True)
class Solid:
    """A solid that one variant uses, or several share."""

    name: str  # name of the picture
    words: str
    file: File | None
    remark: str


@dataclass(frozen=True)
class Variants:
    """All variants of the design."""

    table: ResultLines
    governing: str  # in one sentence; empty without criteria
    judged: ReportVerdict | None  # every criterion of the governing variant
    plots: list[Plot]  # of the governing variant
    inputs: list[Columns]
    used: list[Columns]  # in the appendix: used share of each limit
    solids: list[Solid]  # in the appendix


@dataclass(frozen=True)
class Signature:
    """A step of the approval; without a name the step has not been taken."""

    role: str
    name: str = ""
    at: str = ""
    digest: str = ""
    reason: str = ""  # reason for a withdrawal
    acknowledged: str = ""  # why unconfirmed criteria are acceptable, and their number


@dataclass(frozen=True)
class Signatures:
    """The people who calculated, checked and released the revision."""

    words: str  # state of the approval, in words
    is_released: bool
    items: list[Signature]
    block: str  # the same as JSON, for programs

    @property
    def is_signed(self) -> bool:
        """Return whether any step of the approval was taken."""
        return any(one.name for one in self.items)


@dataclass(frozen=True)
class Report:
    """The complete report of a revision."""

    title: str
    design: str
    revision: int
    newest: int
    note: str
    date: str
    state: str
    problem: str
    program: str
    units: str
    verdict: ReportVerdict
    summary: list[str]
    signatures: Signatures
    parameters: list[Line]
    steps: list[Step]
    models: list[Model]
    rounds: list[Round] = field(default_factory=list)
    rounded: list[Line] = field(default_factory=list)
    variants: Variants | None = None
    worksheet: list[WorksheetRow] = field(default_factory=list)  # lines of the design itself
    worksheet_plots: list[Plot] = field(default_factory=list)
    author: str = ""  # who saved the revision; empty on a service without keys
