"""Look up stored results on solids: measures of built models, and outputs of their analyses.

They are looked up when asked for: a step may take minutes, and no connection is held meanwhile.
"""

from __future__ import annotations

from app.designs.engine.calculation import Analysed, Measured, Measures
from app.solids import analysis_rows as analyses
from app.solids import rows
from app.solids.outputs import Outputs
from app.solids.questions import Question, under_load
from app.storage.database import Database
from cad.model import CadModel
from cad.regenerate import build_key


def built(database: Database) -> Measured:
    """Return measurements of the models that have been built."""

    def measured(shape: CadModel) -> Measures | None:
        with database.read() as session:
            return rows.measures(session, build_key(shape))

    return measured


def analysed(database: Database) -> Analysed:
    """Return results of finite elements on models, where all wanted results are stored."""

    def stored(shape: CadModel, question: Question, wanted: tuple[str, ...]) -> Outputs | None:
        with database.read() as session:
            outputs = analyses.outputs_of(session, question.key(build_key(shape)))
        if not set(wanted) <= outputs.keys():
            return None
        return under_load(question, {name: outputs[name] for name in wanted})

    return stored
