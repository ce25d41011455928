"""The approval as a PDF report carries it for programs, in its attachment `approval.json`."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.schemas.answers import Answer
from app.schemas.approvals import ApprovalState, Step

ATTACHMENT = "approval.json"


class BlockStep(Answer):
    """A step that had been taken when the report was printed."""

    step: Step
    name: str = Field(max_length=1000)
    at: str = Field(max_length=40)
    digest: str = Field(pattern=r"^[0-9a-f]{64}$")


class Block(Answer):
    """The revision of a report, and the progress of its approval."""

    format: Literal[1]
    design: str = Field(pattern=r"^[A-Za-z0-9_]{1,64}$")
    revision: int = Field(ge=1, le=10**9)
    units: Literal["si", "us"]
    has_variants: bool = Field(False, description="whether it is the report of all variants")
    state: ApprovalState
    steps: list[BlockStep] = Field(max_length=4)
