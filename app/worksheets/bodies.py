"""Request bodies of worksheets."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, ConfigDict, Field
from pydantic.config import JsonValue

from app.schemas.bounds import Bounded

LONGEST_TEXT = 65_536  # largest size of a worksheet in UTF-8 [bytes]
MOST_CHECKED = (
    2**20
)  # characters that `check` accepts, so that its answer can state the limit for a longer text
ID = r"^[a-z][a-z0-9_]*$"
NAME = r"^[^\x00-\x1f\x7f]*[^\x00-\x20\x7f][^\x00-\x1f\x7f]*$"


def storable(text: str) -> str:
    """Return the text if the database can store it.

    Raises
    ------
    ValueError
        If it is too long, or contains an invalid character.
    """
    if (size := len(text.encode("utf-8"))) > LONGEST_TEXT:
        raise ValueError(f"a worksheet may have at most {LONGEST_TEXT} bytes in UTF-8, not {size}")
    if (place := text.find("\0")) >= 0:
        line = text.count("\n", 0, place) + 1
        raise ValueError(f"a worksheet must not contain the character NUL; remove it from line {line}")
    return text


def legible(name: str) -> str:
    """Return a person's name if it is legible.

    Raises
    ------
    ValueError
        If it contains neither a letter nor a digit, and would look empty.
    """
    if not any(map(str.isalnum, name)):
        raise ValueError("a name must contain a letter or a digit, such as A. Weber")
    return name


Text = Annotated[str, AfterValidator(storable), Field(max_length=LONGEST_TEXT, description="the worksheet")]
Person = Annotated[
    str, AfterValidator(legible), Field(min_length=1, max_length=100, pattern=NAME, examples=["A. Weber"])
]


EXAMPLE = """# Bush duty
given F [kN] "radial load" (>= 0; example 25 kN)
given D [mm] "bearing diameter" (> 0; example 48 mm)
p [MPa] = F / D**2 "projected pressure"
test "by hand" with F = 25 kN gives p = 10.85 MPa within 0.1 %
"""
EDITED = EXAMPLE.replace("> 0;", "> 0; <= 2 m;")


def _examples(**example: JsonValue) -> ConfigDict:
    """Return a body's model configuration, with a valid example."""
    return ConfigDict(extra="forbid", strict=True, json_schema_extra={"examples": [{**example}]})


class WorksheetBody(Bounded):
    """Base class of request bodies about worksheets."""

    model_config = ConfigDict(extra="forbid", strict=True)


class SheetCheckIn(WorksheetBody):
    """Request to check a text."""

    model_config = _examples(text=EXAMPLE)

    text: str = Field(
        max_length=MOST_CHECKED, description="the text of the worksheet; at most 64 KiB are valid"
    )
    id: str | None = Field(
        None, max_length=64, pattern=ID, description="id under which the check describes it"
    )


class SheetIn(WorksheetBody):
    """Request for a new worksheet."""

    model_config = _examples(id="bush_duty", text=EXAMPLE, author="A. Weber")

    id: str = Field(
        max_length=64,
        pattern=ID,
        description="small letters, digits and _; not used by a template, model or other worksheet",
        examples=["bush_duty"],
    )
    text: Text
    author: Person | None = Field(None, description="who wrote it; a typed name is not verified")


class SheetPatch(WorksheetBody):
    """Request to change a worksheet; members that are not given stay unchanged."""

    model_config = _examples(text=EDITED)

    text: Text | None = None
    author: Person | None = None


class ReviewIn(WorksheetBody):
    """Review of one text."""

    model_config = _examples(reviewer="B. Klein", digest="0" * 64)

    reviewer: Person = Field(description="the reviewer, who is not the author; a typed name is not verified")
    digest: str = Field(max_length=64, pattern=r"^[0-9a-f]{64}$", description="digest of the reviewed text")


class WithdrawIn(WorksheetBody):
    """Request to withdraw a released version, with the reason."""

    model_config = _examples(reason="the clearance is too small")

    reason: str = Field(min_length=1, max_length=1000, pattern=NAME)
    version: int | None = Field(
        None, ge=1, le=10**6, description="the version; by default the newest released one"
    )
