"""The tables. Times are ISO 8601 texts in UTC; JSON is canonical, so that equal values give equal texts."""

from app.storage.tables.approvals import ApprovalRow, CommentRow, PrintedReportRow
from app.storage.tables.base import NAMING, Base, JsonText, NotWritten, canonical_json
from app.storage.tables.designs import (
    DesignRow,
    DesignTagRow,
    RevisionModelRow,
    RevisionRow,
    variant_of,
)
from app.storage.tables.imported_models import ImportedModelRow
from app.storage.tables.jobs import CounterRow, EventRow, JobRow
from app.storage.tables.people import ApiKeyRow, PrincipalRow, SessionRow, StorageRow, UsageRow
from app.storage.tables.records import AuditRow, IdempotencyRow
from app.storage.tables.solids import AnalysisRow, ArtifactRow, BuildRow
from app.storage.tables.studies import StudyChunkRow, StudyRow
from app.storage.tables.worksheets import WorksheetVersionRow

__all__ = [
    "NAMING",
    "AnalysisRow",
    "ApiKeyRow",
    "ApprovalRow",
    "ArtifactRow",
    "AuditRow",
    "Base",
    "BuildRow",
    "CommentRow",
    "CounterRow",
    "DesignRow",
    "DesignTagRow",
    "EventRow",
    "IdempotencyRow",
    "ImportedModelRow",
    "JobRow",
    "JsonText",
    "NotWritten",
    "PrincipalRow",
    "PrintedReportRow",
    "RevisionModelRow",
    "RevisionRow",
    "SessionRow",
    "StorageRow",
    "StudyChunkRow",
    "StudyRow",
    "UsageRow",
    "WorksheetVersionRow",
    "canonical_json",
    "variant_of",
]
