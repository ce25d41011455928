"""Verify a printed report line by line against the approval stored in the service."""

from __future__ import annotations

import hashlib
import io
import re
import unicodedata
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from itertools import pairwise

from pydantic import ValidationError

from app.approvals.content import hashed
from app.approvals.schemas import ATTACHMENT, Approval, Approvals, Block, BlockStep
from app.reports.signatures import moment
from templates.core.errors import plain

LARGEST = 64 * 2**20  # largest report [bytes]
LARGEST_BLOCK = 64 * 2**10  # largest attachment [bytes]
MOST_SHOWN = 3  # largest number of differences listed
_NUMBER = re.compile(r"\d+(?:[.,]\d+)+|\d{3,}")
"""A number with a decimal mark or at least three digits: those of pages differ with the layout."""


class NotReport(Exception):
    """The file is not a report with an approval block."""


@dataclass(frozen=True)
class Line:
    """One check and its result."""

    holds: bool
    words: str


def read_block(pdf: bytes) -> Block:
    """Return the approval block that a report contains.

    Raises
    ------
    NotReport
        If it contains none.
    """
    from pypdf import PdfReader  # in the extra `team`; only this module reads PDF

    if len(pdf) > LARGEST:
        raise NotReport(f"the file is larger than {LARGEST // 2**20} MiB: it is not a report of this service")
    try:
        attached = PdfReader(io.BytesIO(pdf)).attachments.get(ATTACHMENT, [])
    except Exception as error:  # whatever somebody wrote into the file
        raise NotReport(f"the file cannot be read as PDF: {plain(str(error), 200)}") from error
    if len(attached) != 1 or len(attached[0]) > LARGEST_BLOCK:
        raise NotReport(
            f"the file has no attachment {ATTACHMENT}: it is not a report, or an older version printed it"
        )
    try:
        return Block.model_validate_json(attached[0])
    except ValidationError as error:
        first = error.errors()[0]
        place = plain(".".join(map(str, first["loc"])), 100)
        raise NotReport(f"its attachment {ATTACHMENT} is wrong: {place}: {first['msg']}") from None


def verify(pdf: bytes, block: Block, approvals: Approvals, printed: bytes) -> Iterator[Line]:
    """Compare a report with the approval in the service, and return the checks.

    Parameters
    ----------
    pdf
        The report.
    block
        The approval block in the report.
    approvals
        The service's approval of the revision that the block names.
    printed
        The report of that revision as the service prints it now.
    """
    by_step = {one.step: one for one in approvals.steps}
    for step in block.steps:
        yield _signature(step, by_step.get(step.step))
    for one in approvals.steps:
        yield from _row(one, approvals)
    yield _chain(approvals.steps)
    yield _state(block, approvals)
    yield from _text(pdf, approvals, printed)


def _signature(step: BlockStep, row: Approval | None) -> Line:
    """Return the check that the service has a signature of the block."""
    if row is None:
        return Line(False, f"{step.step}: the service knows no such step of this revision")
    if step.digest != row.digest:
        return Line(False, f"{step.step}: digest {step.digest[:16]}… is unknown; it is {row.digest[:16]}…")
    if (step.name, step.at) != (row.name, row.at):
        said, right = f"{step.name} at {step.at}", f"{row.name} at {row.at}"
        return Line(False, plain(f"{step.step}: the file says {said}; it was {right}", 500))
    return Line(True, plain(f"{step.step} by {row.name}, {moment(row.at)}, digest {row.digest[:16]}…", 500))


def _row(row: Approval, approvals: Approvals) -> Iterator[Line]:
    """Return the check that the revision in the service still has the content that was signed."""
    content, present = row.content, approvals.present
    sound = hashed(content) == row.digest and (
        (content.step, content.name, content.at, content.principal)
        == (row.step, row.name, row.at, row.principal)
        and (content.design, content.revision) == (approvals.design, approvals.revision)
    )
    if not sound:
        yield Line(False, f"{row.step}: the signed content was changed: it does not hash to the digest")
    for name in ("document", "results"):
        if getattr(content, name) != getattr(present, name):
            yield Line(False, f"{row.step}: the revision's {name}: not as signed")
    for model, kinds in content.files.items():
        for kind, sha in kinds.items():
            if present.files.get(model, {}).get(kind) != sha:
                words = f"{row.step}: file {model}.{kind} is not the one that was signed"
                yield Line(False, plain(words, 300))


def _chain(steps: Sequence[Approval]) -> Line:
    """Return the check that every step names the previous one."""
    linked = all(later.content.previous == earlier.digest for earlier, later in pairwise(steps))
    if not (linked and (not steps or steps[0].content.previous is None)):
        return Line(False, "the steps do not follow each other: one was replaced")
    return Line(True, "the service has document, results and files as they were signed, step by step")


def _state(block: Block, approvals: Approvals) -> Line:
    """Return the check that the revision is released."""
    if approvals.state == "withdrawn":
        last = approvals.steps[-1]
        reason = last.content.reason or "no reason"
        return Line(False, plain(f"withdrawn by {last.name}, {moment(last.at)}: {reason}", 5000))
    if approvals.state != "released":
        return Line(False, f"not released: the revision is {approvals.state}")
    if block.state != "released":
        return Line(False, f"printed when the revision was {block.state}; it is released now: print it again")
    later = approvals.superseded_by
    return Line(True, "released" + (f"; revision {later} is a later release" if later else ""))


def _text(pdf: bytes, approvals: Approvals, printed: bytes) -> Iterator[Line]:
    """Return the check that the service has printed this file, or what differs from its present print."""
    sha256 = hashlib.sha256(pdf).hexdigest()
    recorded = next((one for one in approvals.prints if one.sha256 == sha256), None)
    if recorded is not None:
        yield Line(True, f"every byte is that of the report as the service printed it, {moment(recorded.at)}")
        return
    if pdf == printed:
        yield Line(True, "every byte is that of the report as the service prints it")
        return
    try:
        ours, theirs = _lines(printed), _lines(pdf)
    except Exception as error:  # whatever somebody wrote into the file
        yield Line(False, f"the text of the pages cannot be read: {plain(str(error), 200)}")
        return
    if all(one.content.prints == "recorded" for one in approvals.steps):
        yield from _differences(ours, theirs)
    else:
        yield _numbers(ours, theirs)


def _differences(ours: list[str], theirs: list[str]) -> Iterator[Line]:
    """Return what differs between the text of a file and the report as the service prints it."""
    yield Line(False, "the service has not printed this file: all its reports of this revision are recorded")
    changes = [
        f"the file says {' '.join(theirs[c:d])!r}, the service {' '.join(ours[a:b])!r}"
        for kind, a, b, c, d in SequenceMatcher(None, ours, theirs, autojunk=False).get_opcodes()
        if kind != "equal"
    ]
    for change in changes[:MOST_SHOWN]:
        yield Line(False, plain(f"the text differs: {change}", 600))
    if not changes:
        yield Line(False, "the text is the same as today; pictures, fonts or hidden parts differ")


def _numbers(ours: list[str], theirs: list[str]) -> Line:
    """Return the check that an older print, which nobody recorded, has no other numbers than today's print.

    Layout and words change from version to version; the numbers of a signed revision do not.
    """
    here, there = (Counter(_NUMBER.findall(" ".join(lines))) for lines in (ours, theirs))
    if others := sorted(there - here):
        listed = ", ".join(others[:MOST_SHOWN])
        return Line(False, f"the file has numbers that the report of this revision has not: {listed}")
    return Line(
        True,
        f"printed by another version before prints were recorded: its {there.total()} numbers are those of "
        "today's report; words and pictures are not compared",
    )


def _lines(pdf: bytes) -> list[str]:
    """Return the lines of text on the pages."""
    from pypdf import PdfReader

    pages = PdfReader(io.BytesIO(pdf)).pages
    text = unicodedata.normalize("NFKC", "\n".join(page.extract_text() for page in pages))
    return [" ".join(line.split()) for line in text.splitlines() if line.strip()]
