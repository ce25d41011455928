"""Records of clients' actions: the audit log, and stored responses to requests that may be repeated."""

from sqlalchemy import BigInteger, Index, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from app.plain import JsonObject
from app.storage.tables.base import Base


class AuditRow(Base):
    """One action and its author. Rows are only added; a sealer numbers and chains them."""

    __tablename__ = "audit"
    __table_args__ = (UniqueConstraint("seq"),)

    id: Mapped[str] = mapped_column(primary_key=True)
    at: Mapped[str]
    principal: Mapped[str]
    name: Mapped[str]  # the principal's name at that time
    action: Mapped[str]  # design.create, key.revoke, …
    object: Mapped[str] = mapped_column(index=True)  # designs/<id>/revisions/<n>, keys/<prefix>, …
    digest: Mapped[str | None]  # digest of the written or signed content
    seq: Mapped[int | None] = mapped_column(BigInteger)
    previous: Mapped[str | None]  # the hash of the previous row
    hash: Mapped[str | None]


class IdempotencyRow(Base):
    """The stored response to a request that a client may send again."""

    __tablename__ = "idempotency"
    __table_args__ = (Index(None, "operated"),)

    key: Mapped[str] = mapped_column(primary_key=True)
    scope: Mapped[str] = mapped_column(primary_key=True)  # method and path
    client: Mapped[str] = mapped_column(primary_key=True, default="")  # see `app.http.access`
    fingerprint: Mapped[str]  # SHA-256 of the body
    status: Mapped[int]
    location: Mapped[JsonObject]  # data to render the response again
    created: Mapped[str]
    operated: Mapped[int] = mapped_column(BigInteger, default=0)  # when it was stored [s of operation]
