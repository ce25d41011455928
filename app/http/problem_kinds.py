"""The kinds of problems, and the table that maps errors to them; the domains do not depend on HTTP.

A kind has a `type`, `/problems/<slug>`, a status, a title and a remedy.
"""

from __future__ import annotations

from dataclasses import dataclass

from fastapi.exceptions import RequestValidationError
from starlette.requests import ClientDisconnect

from app.approvals import errors as approvals
from app.calculations.errors import InvalidBody, NoArray, TooManyValues
from app.designs import errors as designs
from app.http.guard import BadHost, CrossSite, HostNotAllowed
from app.http.limits import AddressCrowded, BodyTooLarge, BodyTooSlow, HeadTooLarge, ServiceStopping
from app.http.streams import TooManyStreams
from app.http.strict_requests import (
    NotCsv,
    NotForm,
    NotJson,
    NotModel,
    NotSheet,
    NotStep,
    PreconditionRequired,
    TooIntricate,
)
from app.identity import errors as identity
from app.identity.limits import LimitReached
from app.identity.oidc import ProviderRefused
from app.imported_models.errors import ModelIdTaken
from app.jobs import errors as jobs
from app.reports.errors import Unprintable
from app.storage import errors as storage
from app.storage.errors import CannotRebuild
from app.studies.errors import RowsLost
from app.workers import errors as workers
from app.worksheets import errors as worksheets
from app.worksheets.imports.errors import SheetNotRead
from cad.errors import AnalysisError, GeometryError, ProgramMissing, UnreadableModel, UnreadableStep
from templates.core import errors as templates
from templates.library.tables import UnknownTable


@dataclass(frozen=True)
class Kind:
    """A kind of problem: the last part of its `type`, its status, its title, and the remedy."""

    slug: str
    status: int
    title: str
    remedy: str


INVALID = Kind(
    "invalid-inputs", 422, "Some inputs are wrong", "correct each entry of `errors`; nothing was saved"
)
INTERNAL = Kind("internal", 500, "The service failed", "this is a fault of the program; please report it")
CROWDED = Kind("too-many-connections", 503, "Too many connections", "close some, then retry")
CANCELLED = Kind("cancelled", 409, "The work was cancelled", "send the change again")

NOT_READY = Kind("not-ready", 503, "The service is not ready", "see `errors`; ask the operator")
REBUILDING = Kind("rebuilding", 503, "The file is being rebuilt", "retry after the time in Retry-After")

TABLE: dict[type[Exception], Kind] = {
    templates.InvalidInputs: INVALID,
    RequestValidationError: INVALID,
    InvalidBody: INVALID,
    templates.QuarantinedTemplate: Kind(
        "quarantined", 404, "The version is quarantined", "correct its file: GET /api/v1/catalogue/faults"
    ),
    templates.UnreleasedTemplate: Kind(
        "unreleased",
        404,
        "The version is a draft",
        "release the worksheet first; until then only previews and `evaluate` accept it",
    ),
    templates.UnknownTemplate: Kind("unknown-template", 404, "No such version", "GET the list of versions"),
    UnknownTable: Kind("unknown-table", 404, "No such table", "GET /api/v1/library lists them"),
    templates.Unreachable: Kind("unreachable", 422, "The target is out of reach", "see `reachable`"),
    templates.TemplateError: Kind("refused", 422, "The calculation refuses these values", "see `detail`"),
    storage.NotFound: Kind("not-found", 404, "Not found", "GET the list to see what exists"),
    designs.StaleRevision: Kind("stale-revision", 412, "The design has changed", "read it again, then retry"),
    designs.DesignSigned: Kind(
        "design-signed",
        409,
        "A design with a signed revision cannot be deleted",
        "archive the design instead",
    ),
    approvals.Unacknowledged: Kind(
        "acknowledgement",
        409,
        "The statement on unconfirmed criteria is missing, or not needed",
        "send `acknowledged` only if the approvals list `unconfirmed` criteria",
    ),
    approvals.NotReady: Kind(
        "not-ready-to-sign", 409, "The revision cannot be signed in its present state", "see `detail`"
    ),
    approvals.OutOfOrder: Kind(
        "step-out-of-order",
        409,
        "Another step must be taken first",
        "calculated → checked → released; see `detail`",
    ),
    approvals.SamePrincipal: Kind(
        "same-principal", 409, "Another principal has to act", "let somebody else take this step"
    ),
    approvals.OtherDigest: Kind(
        "other-digest", 412, "The content to sign has changed", "read the approvals again, then sign"
    ),
    worksheets.StaleWorksheet: Kind(
        "stale-worksheet", 412, "The worksheet has changed", "read it again, then retry"
    ),
    worksheets.IdTaken: Kind("id-taken", 409, "The id is taken", "choose another id; see `detail`"),
    worksheets.OwnReview: Kind(
        "own-review", 403, "Authors do not review their own worksheets", "let another person review it"
    ),
    worksheets.OtherText: Kind(
        "other-text", 409, "The review refers to another text", "read the worksheet again, then review it"
    ),
    worksheets.TestsFailed: Kind(
        "tests-failed", 409, "The worksheet is not sound", "correct each entry of `errors`"
    ),
    worksheets.UnresolvedRegions: Kind(
        "unresolved-import",
        409,
        "Regions of the import are unresolved",
        "rewrite or remove each region in `errors`",
    ),
    worksheets.OutOfOrder: Kind(
        "out-of-order", 409, "The worksheet is in another state", "draft → test → review → release → withdraw"
    ),
    storage.KeyReused: Kind("idempotency-key-reused", 422, "Idempotency-Key reused", "send a new key"),
    designs.NotConverged: Kind("not-converged", 422, "The iteration did not settle", "see `rounds`"),
    PreconditionRequired: Kind("precondition-required", 428, "If-Match is needed", "send the design's ETag"),
    NotJson: Kind("unsupported-media-type", 415, "The body is not JSON", "send application/json"),
    NotCsv: Kind("not-csv", 415, "The body is not CSV", "send text/csv in UTF-8"),
    NotSheet: Kind(
        "not-sheet", 415, "The media type is not one of a file", "send the file as application/octet-stream"
    ),
    NotModel: Kind(
        "not-model",
        415,
        "The media type is not one of a model",
        "send the file as application/octet-stream",
    ),
    NotStep: Kind("not-step", 415, "The media type is not that of STEP", "send the file as model/step"),
    NotForm: Kind("not-a-form", 415, "The body is not a form", "send application/x-www-form-urlencoded"),
    BadHost: Kind(
        "bad-host",
        400,
        "The request names no host",
        "send exactly one header Host, and only a path as the target",
    ),
    HostNotAllowed: Kind(
        "host-not-allowed",
        421,
        "The service does not answer to this host",
        "use localhost or the address it listens on, or ask the operator to set CRANKWRIGHT_ALLOWED_HOSTS",
    ),
    CrossSite: Kind(
        "cross-site",
        403,
        "Another site may not do this",
        "use the service's own pages, or a client that is not a browser",
    ),
    BodyTooLarge: Kind("body-too-large", 413, "The body is too large", "send less at once"),
    HeadTooLarge: Kind("head-too-large", 431, "The headers are too large", "send fewer or shorter headers"),
    TooIntricate: Kind("body-too-intricate", 413, "The body is too complex", "send less at once"),
    NoArray: Kind("no-array", 406, "The answer is not an array", "accept application/json; see `detail`"),
    TooManyValues: Kind("too-many-values", 413, "Too many values", "request fewer points or outputs"),
    ServiceStopping: Kind("stopping", 503, "The service is stopping", "send the request again once it runs"),
    BodyTooSlow: Kind(
        "too-slow", 408, "The request arrives too slowly", "send it faster, or split it into smaller requests"
    ),
    AddressCrowded: CROWDED,
    TooManyStreams: Kind("too-many-streams", 429, "Too many streams are open", "close some, then retry"),
    identity.NotSignedIn: Kind(
        "not-signed-in", 401, "A key is needed", "send `Authorization: Bearer cw_…`, or sign in at /sign-in"
    ),
    identity.RoleNeeded: Kind(
        "role-needed", 403, "Your roles do not allow this", "ask an administrator for the role in `detail`"
    ),
    identity.NotOwn: Kind("not-own", 403, "This belongs to another", "ask its owner or an administrator"),
    identity.KeyInAddress: Kind(
        "key-in-address", 400, "The address contains a key", "revoke it; send keys only in Authorization"
    ),
    LimitReached: Kind(
        "limit-reached",
        429,
        "Your limit is used up",
        "retry after the time in Retry-After; without it, ask an administrator",
    ),
    identity.Outlives: Kind(
        "outlives-key", 403, "The key would be valid for too long", "choose a shorter lifetime"
    ),
    identity.TooManyKeys: Kind("too-many-keys", 409, "There are too many keys", "use or revoke an old one"),
    ProviderRefused: Kind(
        "provider-refused", 403, "The sign-in failed", "start again, or sign in with a key"
    ),
    identity.FirstByCommand: Kind(
        "first-by-command", 409, "There are no keys yet", "the operator creates the first one; see `detail`"
    ),
    identity.NameTaken: Kind("name-taken", 409, "The name is taken", "choose another name"),
    jobs.JobNotFound: Kind("no-such-job", 404, "No such job", "GET /api/v1/jobs lists them"),
    jobs.JobFinished: Kind("job-finished", 409, "The job has ended", "there is nothing left to cancel"),
    jobs.JobShared: Kind("job-shared", 409, "Other clients wait for the job", "let it finish"),
    jobs.QueueFull: Kind("queue-full", 429, "The queue is full", "retry after the time in Retry-After"),
    jobs.JobLost: Kind("lost", 422, "The work was lost", "simplify the model; ask the operator"),
    Unprintable: Kind("unprintable", 422, "The report is too long for paper", "request text/html"),
    storage.ArtifactMissing: Kind("no-such-artifact", 404, "No such artifact", "use a hash from a revision"),
    storage.ArtifactDamaged: Kind("artifact-damaged", 503, "The file is damaged", "retry: it is rebuilt"),
    storage.ArtifactsUnreachable: Kind(
        "files-unreachable", 503, "The file store does not answer", "retry after the time in Retry-After"
    ),
    storage.DiskFull: Kind("disk-full", 507, "The disk is full", "ask the operator to free disk space"),
    storage.DatabaseDamaged: Kind(
        "database-damaged", 503, "The database is damaged", "the operator restores a backup; see `detail`"
    ),
    CannotRebuild: Kind(
        "artifact-gone", 410, "The file is lost", "see `detail` for the reason and the remaining data"
    ),
    RowsLost: REBUILDING,
    storage.StorageError: Kind("storage", 503, "The storage is not available", "retry; ask the operator"),
    ProgramMissing: Kind(
        "program-missing",
        503,
        "The model's program is not installed",
        "install it; see `detail`",
    ),
    UnreadableModel: Kind("unreadable-model", 422, "The file cannot be read as a model", "see `detail`"),
    ModelIdTaken: Kind(
        "model-id-taken", 409, "The id of a model is taken", "choose another id; see `detail`"
    ),
    GeometryError: Kind(
        "geometry", 422, "These values give no sound solid", "change the parameters in `errors`"
    ),
    AnalysisError: Kind(
        "analysis",
        422,
        "The solid could not be analysed",
        "see `errors`; add fillets or accept less accuracy",
    ),
    SheetNotRead: Kind("unreadable-sheet", 422, "The file cannot be read as a Mathcad sheet", "see `detail`"),
    UnreadableStep: Kind("unreadable-step", 422, "Not a STEP file", "send a STEP file (ISO 10303-21)"),
    workers.DeadlineExceeded: Kind("deadline", 422, "The work took too long", "simplify the model"),
    workers.MemoryExceeded: Kind(
        "memory", 422, "The work took too much memory", "simplify the model; see `detail`"
    ),
    workers.JobCrashed: Kind("crashed", 422, "The process crashed", "change the inputs"),
    workers.JobCancelled: CANCELLED,
    ClientDisconnect: CANCELLED,  # left while sending its body, so nobody reads this
}
HTTP = {
    404: Kind("no-such-path", 404, "No such path", "GET /openapi.json lists all paths"),
    405: Kind("method-not-allowed", 405, "Method not allowed here", "see the header Allow"),
}

BEFORE_HTTP = (
    CROWDED,
    Kind("not-http", 400, "Not HTTP", "send HTTP/1.1"),
)
"""Problems that `app.http.connections` sends before a request exists."""


SLUGS = {
    kind.slug: kind
    for kind in (*TABLE.values(), *HTTP.values(), *BEFORE_HTTP, NOT_READY, REBUILDING, INTERNAL)
}
"""All kinds of problems by slug."""


def kind_of(error: Exception) -> Kind:
    """Return the kind of problem for an error: that of its nearest base class in the table."""
    return next((TABLE[cls] for cls in type(error).__mro__ if cls in TABLE), INTERNAL)
