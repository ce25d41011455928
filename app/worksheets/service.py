"""Operations on worksheets: draft → tested → reviewed → released → withdrawn.

An edit returns a worksheet to draft; an edit of a released version starts the next version. Texts are read in
a calculation process only. A change is stored only if the version has not changed in the meantime.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import TimeoutError as NotReady
from dataclasses import asdict
from typing import TypeVar, TypeVarTuple

from sqlalchemy.orm import Session

from app.catalogue.catalogues import Catalogues
from app.identity.audit import record
from app.pool.pool import CalculationPool
from app.storage.clock import now
from app.storage.database import Database
from app.storage.idempotency import Once
from app.storage.tables import WorksheetVersionRow as Row
from app.workers.errors import DeadlineExceeded
from app.worksheets import repository, views
from app.worksheets.bodies import ReviewIn, SheetIn, SheetPatch, WithdrawIn
from app.worksheets.errors import IdTaken, OtherText, OutOfOrder, OwnReview, StaleWorksheet, TestsFailed
from app.worksheets.examination import Examination, TestRun, examined, tried
from app.worksheets.imports.record import ImportRecord, require_resolved
from app.worksheets.names import is_same_person, require_free, signed
from app.worksheets.publication import WorksheetPublication
from app.worksheets.repository import RELEASED
from app.worksheets.schemas.worksheets import Sheet

T = TypeVar("T")
Ts = TypeVarTuple("Ts")

Imported = tuple[str, ImportRecord]
"""The SHA-256 of the file from which a worksheet was imported, and the import record."""

PATIENCE = 30.0  # time for reading and testing a text, including the wait [s]


class Worksheets:
    """All operations on worksheets; every method that changes one returns the resulting version."""

    def __init__(
        self,
        database: Database,
        catalogues: Catalogues,
        pool: CalculationPool,
        published: WorksheetPublication,
    ) -> None:
        self.database, self.catalogues, self.pool, self.published = database, catalogues, pool, published

    def create(self, body: SheetIn, once: Once, imported: Imported | None = None) -> Row:
        """Create a worksheet as a draft, and return it.

        Raises
        ------
        IdTaken
            If a file or another worksheet has the id.
        InvalidInputs
            If no worksheet may have it.
        """
        if before := once.find_in(self.database):
            return self.newest(before["id"])
        require_free(body.id, self.catalogues)
        reading = self.calculated(once.client, examined, body.text)

        def unit(session: Session) -> Row:
            if location := once.begin(session):
                return repository.newest(session, location["id"])
            if repository.versions(session, body.id):
                raise IdTaken(body.id, "another worksheet")
            row = _draft(body.id, 1, body.text, reading)
            row.author, row.author_principal = signed(body.author)
            if imported is not None:
                row.import_sha256, row.imported = imported[0], dict(imported[1])
            try:
                repository.add(session, row)
            except StaleWorksheet:
                raise IdTaken(body.id, "another worksheet") from None
            _record(session, "worksheet.create", row)
            once.keep(session, 201, {"id": body.id})
            return row

        return self._written(unit)

    def change(self, id: str, body: SheetPatch, expected: str | None, once: Once) -> Row:
        """Edit a worksheet and return the draft; if the newest version is released, start the next one.

        Raises
        ------
        StaleWorksheet
            If `expected` (an If-Match) does not match the present newest version.
        """
        with self.database.read() as session:
            row = repository.newest(session, id)
            if once.find(session):
                return row
        _require_match(expected, row)
        text = row.text if body.text is None else body.text
        author, principal = signed(row.author if body.author is None else body.author)
        if (text, author) == (row.text, row.author) or (principal and text == row.text):
            return row
        reading = self.calculated(once.client, examined, text)

        def unit(session: Session) -> Row:
            if location := once.begin(session):
                return repository.newest(session, location["id"])
            draft = _draft(id, row.number + 1, text, reading)
            draft.author, draft.author_principal = author, principal
            if row.state in RELEASED:
                if repository.newest(session, id).number != row.number:
                    raise StaleWorksheet(id)
                draft.import_sha256, draft.imported = row.import_sha256, row.imported
                repository.add(session, draft)
            else:
                draft = repository.save(session, row, **_edited(draft))
            _record(session, "worksheet.change", draft)
            once.keep(session, 200, {"id": id})
            return draft

        return self._written(unit)

    def test(self, id: str, expected: str | None, client: str) -> Row:
        """Run the tests and calculate the golden record; if all pass, the version becomes tested.

        Raises
        ------
        OutOfOrder
            If the newest version is already released or reviewed.
        TestsFailed
            If there are faults or failed tests; the error lists all of them, and the state does not change.
        """
        row = self.newest(id, expected)
        _require(row, "draft", "tested")
        result = self._tried(client, row)
        return self._saved(row, "test", state="tested", tests=list(map(asdict, result.tests)))

    def review(self, id: str, body: ReviewIn, expected: str | None) -> Row:
        """Record who reviewed the text.

        Raises
        ------
        OutOfOrder
            If the newest version is not tested.
        OtherText
            If the review is of another text.
        OwnReview
            If the reviewer is the author.
        """
        row = self.newest(id, expected)
        name, principal = signed(body.reviewer)
        reviewer = name or body.reviewer
        is_own = principal is not None and principal == row.author_principal
        if is_own or (row.author is not None and is_same_person(reviewer, row.author)):
            raise OwnReview(reviewer)
        _require(row, "tested", "reviewed")
        if body.digest != row.digest:
            raise OtherText(body.digest, row.digest)
        return self._saved(row, "review", state="reviewed", reviewer=reviewer, reviewer_principal=principal)

    def release(self, id: str, expected: str | None, client: str) -> Row:
        """Make the reviewed version a template that never changes, and store its golden record.

        Raises
        ------
        OutOfOrder
            If the newest version is not reviewed.
        UnresolvedRegions
            If regions of its import are not verified, and their lines are unchanged.
        TestsFailed
            If the tests fail now, for example after an update of the program.
        """
        row = self.newest(id, expected)
        _require(row, "reviewed")
        require_free(id, self.catalogues)
        require_resolved(row)
        result = self._tried(client, row)
        tests = list(map(asdict, result.tests))
        return self._saved(
            row, "release", state="released", tests=tests, record=result.record, released=now()
        )

    def withdraw(self, id: str, body: WithdrawIn, expected: str | None) -> Row:
        """Withdraw a released version and record the reason; designs that use it still calculate.

        Raises
        ------
        OutOfOrder
            If it is not released, or is withdrawn already.
        """
        with self.database.read() as session:
            rows = repository.versions(session, id) or [repository.newest(session, id)]
        numbers = [row.number for row in rows if row.state in RELEASED]
        number = body.version or max(numbers, default=rows[-1].number)
        row = self.version(id, number)
        _require_match(expected, row)
        _require(row, "released")
        return self._saved(row, "withdraw", state="withdrawn", withdrawn=body.reason)

    def delete(self, id: str, expected: str | None) -> None:
        """Delete the newest version if it was never released.

        Raises
        ------
        OutOfOrder
            If it was released.
        """
        row = self.newest(id, expected)
        if row.state in RELEASED:
            raise OutOfOrder(
                f"{id} version {row.number} is {row.state}, so it cannot be deleted; withdraw it instead"
            )
        self.database.write(lambda session: _discard(session, row))
        self.published.look()

    def newest(self, id: str, expected: str | None = None) -> Row:
        """Return the newest version of a worksheet.

        Raises
        ------
        NotFound
            If there is none.
        StaleWorksheet
            If `expected` (an If-Match) does not match its present state.
        """
        with self.database.read() as session:
            row = repository.newest(session, id)
        _require_match(expected, row)
        return row

    def show(self, row: Row) -> Sheet:
        """Return a version of a worksheet as a response."""
        with self.database.read() as session:
            versions = repository.versions(session, row.id)
        return views.sheet(row, versions, self.published.broken)

    def sheet(self, id: str, number: int | None = None) -> Sheet:
        """Return a version of a worksheet, by default the newest, as a response.

        Raises
        ------
        NotFound
            If there is none.
        """
        return self.show(self.newest(id) if number is None else self.version(id, number))

    def version(self, id: str, number: int) -> Row:
        """Return one version of a worksheet.

        Raises
        ------
        NotFound
            If there is none.
        """
        with self.database.read() as session:
            return repository.version(session, id, number)

    def calculated(self, client: str, function: Callable[[*Ts], T], *args: *Ts) -> T:
        """Return the result of applying a function to a text in a calculation process.

        Raises
        ------
        TooManyCalculations
            If too many calculations wait.
        DeadlineExceeded
            If it took too long.
        """
        calculation = self.pool.submit(client, function, *args)
        try:
            result: T = calculation.future.result(PATIENCE)
        except NotReady:
            raise DeadlineExceeded(PATIENCE) from None
        finally:
            self.pool.cancel(calculation)
        return result

    def _tried(self, client: str, row: Row) -> TestRun:
        result = self.calculated(client, tried, row.id, row.number, row.text)
        if result.reasons:
            raise TestsFailed(result.reasons)
        return result

    def _saved(self, row: Row, verb: str, **changes: object) -> Row:
        def unit(session: Session) -> Row:
            saved = repository.save(session, row, **changes)
            _record(session, f"worksheet.{verb}", saved)
            return saved

        return self._written(unit)

    def _written(self, unit: Callable[[Session], Row]) -> Row:
        row = self.database.write(unit)
        self.published.look()
        return row


def _discard(session: Session, row: Row) -> None:
    repository.discard(session, row)
    _record(session, "worksheet.delete", row)


def _record(session: Session, action: str, row: Row) -> None:
    record(session, action, f"worksheets/{row.id}/versions/{row.number}", row.digest)


def _draft(id: str, number: int, text: str, reading: Examination) -> Row:
    return Row(
        id=id,
        number=number,
        text=text,
        state="draft",
        title=reading.title,
        language=reading.language,
        digest=reading.digest,
        faults=[asdict(fault) for fault in reading.faults],
        tests=[],
    )


def _edited(draft: Row) -> dict[str, object]:
    """Return the columns of a version that an edit changes.

    An edit removes the review, because the reviewer has not seen the new text.
    """
    names = ("text", "title", "language", "digest", "faults", "author", "author_principal")
    unsigned: dict[str, object] = {
        "state": "draft",
        "reviewer": None,
        "reviewer_principal": None,
        "tests": [],
    }
    return {**unsigned, **{name: getattr(draft, name) for name in names}}


def _require(row: Row, *allowed: str) -> None:
    """Check that a version is in one of these states.

    Raises
    ------
    OutOfOrder
        If it is in another one.
    """
    if row.state not in allowed:
        wanted = " or ".join(allowed)
        raise OutOfOrder(f"{row.id} version {row.number} is {row.state}, not {wanted}{NEXT[row.state]}")


NEXT = {
    "draft": "; test it first",
    "tested": "; let another person review it first",
    "reviewed": "; an edit returns it to draft",
    "released": "; an edit begins the next version",
    "withdrawn": "; an edit begins the next version",
}
"""The next step for each state."""


def _require_match(expected: str | None, row: Row) -> None:
    if expected is not None and expected.strip() not in ("*", f'"{row.edit}"'):
        raise StaleWorksheet(row.id)
