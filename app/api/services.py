"""The services that the routes use, created once in `app.assembly` and kept in `app.state.services`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypedDict

from app.answers.schemas import DesignAnswer
from app.answers.service import AnswerQuestion
from app.api.responses import Threads
from app.approvals.comments import Comments
from app.approvals.service import ApprovalService
from app.calculations.operations import Question
from app.catalogue.catalogues import Catalogues
from app.designs import decisions as decisions_of
from app.designs.explanation import ExplanationQuestion
from app.designs.labels import LabelService
from app.designs.preview import PreviewRequest
from app.designs.questions import DesignQuestion
from app.designs.schemas.decision import Decision
from app.designs.schemas.designs import Explanation, Preview
from app.designs.schemas.solution import DesignSolution
from app.designs.schemas.variants import VariantDetail
from app.designs.service import Designs
from app.designs.variants.detail import WantedVariant
from app.http.streams import Streams
from app.identity.service import Identity
from app.impact import survey
from app.impact.schemas import Impact
from app.imported_models.service import ModelImports
from app.jobs.service import Jobs
from app.observation.readiness import Readiness
from app.pool.pool import CalculationPool
from app.pool.questions import Questions
from app.pool.steps import Steps
from app.reports.paper import Press
from app.reports.service import Reports
from app.settings import Settings
from app.signing.keys import StampKeys
from app.solids.analyses import Analyses
from app.solids.models import Models
from app.solids.repair import ArtifactRepair
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.studies.service import Studies
from app.tolerances.schemas import ToleranceAnalysis
from app.workers.pieces import Pieces
from app.worksheets.imports.service import Imports
from app.worksheets.service import Worksheets


class QuestionServices(TypedDict):
    """The services that answer a question at once or by a job, by their field in `Services`."""

    evaluations: Questions[Question, Pieces]
    previews: Questions[PreviewRequest, Preview]
    decisions: Questions[decisions_of.DecisionQuestion, Decision]
    explanations: Questions[ExplanationQuestion, Explanation]
    impacts: Questions[survey.ImpactQuestion, Impact]
    solving: Questions[DesignQuestion, DesignSolution]
    tolerances: Questions[DesignQuestion, ToleranceAnalysis]
    variant_details: Questions[WantedVariant, VariantDetail]


@dataclass(frozen=True)
class Services:
    """All parts of the service; each part is closed when the application ends."""

    settings: Settings
    catalogues: Catalogues
    database: Database
    identity: Identity
    store: Artifacts
    jobs: Jobs
    calculations: CalculationPool
    steps: Steps
    threads: Threads
    evaluations: Questions[Question, Pieces]
    designs: Designs
    answers: Questions[AnswerQuestion, DesignAnswer]
    labelling: LabelService
    previews: Questions[PreviewRequest, Preview]
    decisions: Questions[decisions_of.DecisionQuestion, Decision]
    explanations: Questions[ExplanationQuestion, Explanation]
    studies: Studies
    worksheets: Worksheets
    imports: Imports
    solving: Questions[DesignQuestion, DesignSolution]
    tolerances: Questions[DesignQuestion, ToleranceAnalysis]
    variant_details: Questions[WantedVariant, VariantDetail]
    impacts: Questions[survey.ImpactQuestion, Impact]
    models: Models
    model_imports: ModelImports
    analyses: Analyses
    healing: ArtifactRepair
    approving: ApprovalService
    comments: Comments
    reports: Reports
    press: Press
    streams: Streams
    readiness: Readiness
    stamp_keys: StampKeys | None
