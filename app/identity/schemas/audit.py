"""The audit as the interface shows it: who did what, and the chain that the rows are sealed in."""

from __future__ import annotations

from pydantic import ConfigDict, Field

from app.schemas.answers import Answer, Page


class AuditEntry(Answer):
    """One change; it was written in the transaction of the change itself."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    at: str
    principal: str = Field(description="id of whoever did it")
    name: str = Field(description="of the principal at that time")
    action: str = Field(description="the object's kind and the verb, such as `design.create`")
    object: str = Field(description="its path below `/api/v1/`")
    digest: str | None = Field(description="SHA-256 of what was written or signed, where there is one")
    seq: int | None = Field(description="its number in the chain; null until it is sealed, within a second")
    previous: str | None = Field(description="hash of the row before; null in the first one")
    hash: str | None = Field(description="SHA-256 over all of the above")


class AuditList(Page[AuditEntry]):
    """A page of the audit, newest first."""


class AuditHead(Answer):
    """The newest sealed row. Whoever notes the hash elsewhere can verify the chain up to it later."""

    seq: int = Field(description="how many rows are sealed")
    hash: str | None = Field(description="null while none is")
