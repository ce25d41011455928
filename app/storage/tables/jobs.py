"""Jobs, the events of jobs and designs, and the counters that only increase."""

from sqlalchemy import BigInteger, Double, ForeignKeyConstraint, Index
from sqlalchemy.orm import Mapped, mapped_column

from app.plain import JsonObject
from app.storage.tables.base import Base, JsonText


class JobRow(Base):
    """A long calculation or build. The queue takes turns among clients."""

    __tablename__ = "job"
    __table_args__ = (
        ForeignKeyConstraint(["design_id", "revision"], ["revision.design_id", "revision.number"]),
        Index(None, "state", "turn", "id"),
        Index(None, "client", "state"),
        Index(None, "design_id", "revision"),
        Index(None, "operated"),
        Index(None, "owner"),
    )

    id: Mapped[str] = mapped_column(primary_key=True)
    kind: Mapped[str]
    state: Mapped[str]  # queued, running, done, failed, cancelled
    design_id: Mapped[str | None]
    revision: Mapped[int | None]
    payload: Mapped[JsonObject]
    attempt: Mapped[int]  # how often it was claimed: only the newest claim may write
    crashes: Mapped[int]  # how often its process crashed
    progress: Mapped[float]
    log: Mapped[list[str]]
    problem: Mapped[JsonObject | None]
    result: Mapped[str | None]  # a link
    created: Mapped[str]
    updated: Mapped[str]
    client: Mapped[str] = mapped_column(default="")  # the client in whose turn it runs; see `app.http.access`
    others: Mapped[list[str]] = mapped_column(JsonText, default=list)  # other clients that wait for it
    turn: Mapped[int] = mapped_column(BigInteger, default=0)
    operated: Mapped[int] = mapped_column(
        BigInteger, default=0
    )  # when it was queued, later when it ended [s of operation]
    principal: Mapped[str | None] = mapped_column(default=None)  # the principal that requested it
    event: Mapped[int] = mapped_column(BigInteger, default=0)  # the number of its newest event
    losses: Mapped[int] = mapped_column(default=0)  # how often its worker was lost
    owner: Mapped[str | None] = mapped_column(default=None)  # the server process that runs it
    lease_until: Mapped[float | None] = mapped_column(Double, default=None)  # by the database's clock [s]
    cause: Mapped[str | None] = mapped_column(default=None)  # the id of its request, and the trace context
    question: Mapped[str | None] = mapped_column(
        default=None, index=True
    )  # the key of the request that it answers


class EventRow(Base):
    """An event of a design or a job, numbered within its topic without gaps."""

    __tablename__ = "event"

    topic: Mapped[str] = mapped_column(primary_key=True)  # design:<id>, job:<id>
    number: Mapped[int] = mapped_column(BigInteger, primary_key=True)
    name: Mapped[str]
    data: Mapped[JsonObject]
    created: Mapped[str]
    operated: Mapped[int] = mapped_column(BigInteger, index=True)  # time of the event [s of operation]


class CounterRow(Base):
    """A number that only increases, whatever the wall clock does; see `app.storage.clock`, `ownership`."""

    __tablename__ = "counter"

    name: Mapped[str] = mapped_column(primary_key=True)  # identity, operation, database
    value: Mapped[int] = mapped_column(BigInteger)
