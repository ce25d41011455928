"""Approvals of revisions and comments on them, as the REST interface accepts and returns them."""

from __future__ import annotations

import re
from typing import Annotated, Literal, Self

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field, model_validator

from app.identity.schemas.principals import Author
from app.schemas.answers import Answer, Page
from app.schemas.approval_steps import ApprovalState, Step
from app.schemas.bounds import Bounded
from app.schemas.texts import BLANK

Files = dict[str, dict[str, str]]
"""SHA-256 of the files of solids, by model name and kind of file."""

LONGEST_TEXT = 4000  # letters of a comment or a reason
LONGEST_SUBJECT = 140
_CONTROL = r"\x00-\x08\x0b\x0c\x0e-\x1f\x7f"
PLAIN = f"^[^{_CONTROL}]*$"
"""Lines of text, without control characters."""

WRITTEN = rf"^[^{_CONTROL}]*[^{_CONTROL}{BLANK}][^{_CONTROL}]*$"
"""Lines of text with at least one letter."""


def _written(text: object) -> object:
    """Return the text; raise ValueError if it has no letter or has control characters."""
    if isinstance(text, str) and not re.search(WRITTEN, text):
        plain = re.search(PLAIN, text)
        raise ValueError("the text needs at least one letter" if plain else "remove the control characters")
    return text


Text = Annotated[
    str,
    Field(min_length=1, max_length=LONGEST_TEXT, pattern=WRITTEN),
    BeforeValidator(_written),
    AfterValidator(str.strip),
]


class SignedContent(Answer):
    """The signed content; the `digest` of its step is the SHA-256 of this object as canonical JSON.

    In canonical JSON the names are sorted, there are no blanks, letters beyond ASCII are not escaped, and the
    encoding is UTF-8. `reason`, `unconfirmed`, `acknowledged`, `account_by` and
    `prints` are omitted if they are empty.
    """

    design: str
    revision: int
    title: str = Field(description="name of the design in this revision")
    step: Step
    principal: str
    name: str = Field(description="name of the principal at that time")
    at: str
    document: str = Field(description="SHA-256 of the document as canonical JSON")
    results: str = Field(description="SHA-256 of the calculated results as canonical JSON")
    files: Files = Field(description="SHA-256 of every file of its solids, at least of STEP")
    previous: str | None = Field(description="digest of the previous step; null for the first step")
    reason: str | None = Field(None, description="reason for a withdrawal")
    unconfirmed: list[str] = Field([], description="criteria that are not confirmed, each in a sentence")
    acknowledged: str | None = Field(None, description="why it was signed nevertheless")
    account_by: Author | None = Field(
        None, description="the administrator who created the principal; absent if the operator did"
    )
    prints: Literal["recorded"] | None = Field(
        None,
        description="`recorded` if the service records every report that it prints of the revision from this "
        "step on; an earlier version of the program did not",
    )


class Approval(Answer):
    """One step of the approval of a revision."""

    step: Step
    principal: str
    name: str = Field(description="name of the principal at that time")
    at: str
    digest: str
    content: SignedContent


class Present(Answer):
    """The present content of a revision, to be compared with the signed one."""

    document: str
    results: str
    files: Files


class PrintedReport(Answer):
    """A report that the service printed of a signed revision."""

    model_config = ConfigDict(from_attributes=True)

    sha256: str = Field(description="SHA-256 of the file (PDF)")
    at: str = Field(description="time of its first print")


class Approvals(Answer):
    """The approval of a revision: calculated by its author, checked and released by two others."""

    design: str
    revision: int
    state: ApprovalState
    steps: list[Approval] = Field(description="completed steps, in order")
    next: Step | None = Field(description="the next step; null if there is none")
    unconfirmed: list[str] = Field(
        [],
        description="criteria that are not met with a known error, each in a sentence; "
        "to check or release the revision, state in `acknowledged` why that is acceptable",
    )
    obstacle: str | None = Field(description="why you cannot take the next step now; null if you can")
    to_sign: str = Field(description="digest of the content to sign: send it as If-Match; also the ETag")
    present: Present
    prints: list[PrintedReport] = Field(description="reports printed since the first signature, oldest first")
    supersedes: int | None = Field(description="the released revision that this one replaces")
    superseded_by: int | None = Field(description="the newest released revision, if it is a later one")


class ReleasedRevision(Answer):
    """The newest released revision of a design, and where its files are."""

    design: str
    revision: int
    title: str
    approval: Approval
    report: str = Field(description="link to the revision's report (PDF)")
    files: Files = Field(description="links to the files of the revision's solids")


class Comment(Answer):
    """A comment on a revision, in plain text."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    design: str
    revision: int
    name: str = Field(description="name of the author at that time")
    subject: str | None = Field(description="the name in the design that the comment is about")
    text: str
    created: str
    resolved: str | None = Field(description="time of resolution; null while the comment is open")
    resolved_by: str | None = Field(description="name of the principal that resolved it")


class CommentList(Page[Comment]):
    """A page of comments, newest first."""


class ApprovalIn(Bounded):
    """A step to take in the approval of a revision."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        json_schema_extra={
            "examples": [{"step": "calculated"}],
        },
    )

    step: Step
    reason: Text | None = Field(None, description="reason for a withdrawal; no other step takes one")

    acknowledged: Text | None = Field(
        None,
        description="why the revision may be checked or released although criteria are not confirmed; "
        "required if there are unconfirmed criteria, else refused",
    )

    @model_validator(mode="after")
    def with_its_reason(self) -> Self:
        """Require a reason for a withdrawal, and refuse one for any other step; raises ValueError."""
        if (self.step == "withdrawn") != (self.reason is not None):
            raise ValueError("a withdrawal needs a `reason`; no other step takes one")
        return self


class CommentIn(Bounded):
    """A new comment on a revision."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        json_schema_extra={
            "examples": [{"text": "Why 22 mm? The case allows 24.", "subject": "film.bearing_width"}]
        },
    )

    text: Text
    subject: str | None = Field(
        None,
        min_length=1,
        max_length=LONGEST_SUBJECT,
        description="a name in the design: a parameter, a block, or a value of a block, such as "
        "`film.bearing_width`",
    )


ATTACHMENT = "approval.json"


class BlockStep(Answer):
    """A step that was complete when the report was printed."""

    step: Step
    name: str = Field(max_length=1000)
    at: str = Field(max_length=40)
    digest: str = Field(pattern=r"^[0-9a-f]{64}$")


class Block(Answer):
    """The revision that a report describes, and the state of its approval."""

    format: Literal[1]
    design: str = Field(pattern=r"^[A-Za-z0-9_]{1,64}$")
    revision: int = Field(ge=1, le=10**9)
    units: Literal["si", "us"]
    has_variants: bool = Field(False, description="whether the report covers all variants")
    has_appendix: bool = Field(False, description="whether that report has its appendix")
    state: ApprovalState
    steps: list[BlockStep] = Field(max_length=4)
