"""Request bodies for approvals and comments."""

from __future__ import annotations

import re
from typing import Annotated, Self

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field, model_validator

from app.schemas.approval_steps import Step
from app.schemas.bounds import Bounded
from app.schemas.texts import BLANK

LONGEST_TEXT = 4000  # letters of a comment or a reason
LONGEST_SUBJECT = 140
_CONTROL = r"\x00-\x08\x0b\x0c\x0e-\x1f\x7f"
PLAIN = f"^[^{_CONTROL}]*$"
"""Lines of text, without control characters."""

WRITTEN = rf"^[^{_CONTROL}]*[^{_CONTROL}{BLANK}][^{_CONTROL}]*$"
"""Lines of text with at least one letter."""


def _written(text: object) -> object:
    """Return whatever it is, unless it is a text without a letter or with control characters.

    Raises ValueError.
    """
    if isinstance(text, str) and not re.search(WRITTEN, text):
        plain = re.search(PLAIN, text)
        raise ValueError(
            "the text needs at least one letter" if plain else "leave out the control characters"
        )
    return text


Text = Annotated[
    str,
    Field(min_length=1, max_length=LONGEST_TEXT, pattern=WRITTEN),
    BeforeValidator(_written),
    AfterValidator(str.strip),
]


class ApprovalIn(Bounded):
    """A step of the approval of a revision."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        json_schema_extra={
            "examples": [{"step": "calculated"}],
        },
    )

    step: Step
    reason: Text | None = Field(None, description="of a withdrawal, which needs one; nothing else has one")

    @model_validator(mode="after")
    def with_its_reason(self) -> Self:
        """A withdrawal and its reason; raises ValueError."""
        if (self.step == "withdrawn") != (self.reason is not None):
            raise ValueError("a withdrawal needs a `reason`, and no other step has one")
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
        description="a name in the design: a parameter, a block, or a value of one such as "
        "`film.bearing_width`",
    )
