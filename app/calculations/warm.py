"""The module from which calculation processes are forked: it calculates every template's example once.

Tables are read and formulas compiled at first use; processes forked after that share them. Nothing else may
import it.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from pathlib import Path

from pydantic_core import to_json

import templates
from app.calculations import operations  # noqa: F401 - what the processes run
from app.calculations.rendering import evaluation
from app.workers.scheduling import give_way
from templates.core.catalogue.finding import find
from templates.core.errors import TemplateError
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template


def rehearse(has_come: Callable[[], bool]) -> None:
    """Let the server go first; called once in every process before its first request."""
    give_way()


def _calculate_examples() -> None:
    for cls in find([Path(folder) for folder in templates.__path__], Template):
        try:
            to_json(evaluation(evaluate(cls, cls.example)))
        except TemplateError as error:
            logging.getLogger(__name__).warning("The example of %s %d: %s", cls.id, cls.version, error)


_calculate_examples()
