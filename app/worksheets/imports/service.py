"""Import sheets as jobs: store the file by its hash, read it in a separate process, and save a draft."""

from __future__ import annotations

from sqlalchemy.orm import Session

from app.catalogue.catalogues import Catalogues
from app.jobs.service import Completion, Job, JobContext, JobFailed, Jobs
from app.jobs.uploads import last_name, queue_upload
from app.storage.artifacts import Artifacts
from app.storage.errors import ArtifactDamaged, ArtifactMissing
from app.storage.idempotency import Once
from app.workers.base import Limits
from app.worksheets import repository
from app.worksheets.bodies import SheetIn
from app.worksheets.errors import IdTaken, WorksheetError
from app.worksheets.imports.errors import SheetNotRead
from app.worksheets.imports.job import imported
from app.worksheets.imports.record import ImportRecord
from app.worksheets.names import require_free
from app.worksheets.service import Worksheets
from templates.core.errors import TemplateError

IMPORT = "worksheet_import"
LIMITS = Limits(deadline=20.0, memory_mb=512)
MOST_BYTES = 16 * 2**20
"""Largest size of a file; the largest public sheet is 0.6 MB."""


class Imports:
    """Queues imports, and handles their jobs.

    A failed import leaves no worksheet, and retention later deletes its file.
    """

    def __init__(
        self,
        store: Artifacts,
        jobs: Jobs,
        catalogues: Catalogues,
        worksheets: Worksheets,
    ) -> None:
        self.store, self.jobs = store, jobs
        self.catalogues, self.worksheets = catalogues, worksheets

    def begin(self, content: memoryview, id: str, file: str, once: Once) -> str:
        """Queue the import of a file as a worksheet and return the id of the job.

        Raises
        ------
        SheetNotRead
            If the file is empty or too large.
        IdTaken, InvalidInputs
            If no worksheet may have the id.
        QueueFull
            If too many jobs are waiting.
        """
        if not 0 < len(content) <= MOST_BYTES:
            what = "the body is empty" if not content else f"it is larger than {MOST_BYTES // 2**20} MiB"
            raise SheetNotRead(
                "too_large" if content else "no_sheet", f"{what}: send one .mcdx, .xmcd or .xmcdz file"
            )
        require_free(id, self.catalogues)

        def check(session: Session) -> None:
            if repository.versions(session, id):
                raise IdTaken(id, "another worksheet")

        about = {"id": id, "name": last_name(file)}
        return queue_upload(self.jobs, self.store, IMPORT, content, about, once, check)

    def __call__(self, job: Job, context: JobContext) -> Completion:
        """Import the file of a job; the result of the job is the worksheet.

        Raises
        ------
        JobFailed
            If the file is refused, or the id has been taken in the meantime.
        """
        payload = job.payload
        id, sha, name = payload["id"], payload["file"], payload["name"]
        try:
            content = self.store.read(sha)
            context.progress(0.1, "reading the sheet")
            sheet = context.run(imported, content, name or id.replace("_", " ").capitalize(), limits=LIMITS)
            context.progress(0.9, "saving the draft")
            once = Once(f"import {job.id}", IMPORT, sha, payload["client"])
            body = SheetIn(id=id, text=sheet.text)
            record: ImportRecord = {**sheet.record, "file": name}
            self.worksheets.create(body, once, (sha, record))
        except (SheetNotRead, WorksheetError, TemplateError, ArtifactMissing, ArtifactDamaged) as error:
            raise JobFailed(error) from error
        link = f"/api/v1/worksheets/{id}"
        return lambda session: link
