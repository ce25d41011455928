"""Summarise the explanation of a parameter for the panel of a clicked face."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from app.designs.schemas.designs import Explanation
from app.presentation.criteria import Line, line

MOST_FORMULAS, MOST_INPUTS, MOST_CRITERIA = 3, 12, 6
"""Largest numbers of formulas, inputs and criteria that the panel lists; a link leads to the rest."""
_NO_INPUTS = ("told_above", "deeper", "iterated")


@dataclass(frozen=True)
class FaceView:
    """The parameter of a face: formulas and inputs behind it (nearest first), errors, criteria.

    `errors` are the outputs of steps behind it that have an error, known or not.
    """

    chain: Explanation
    formulas: list[Explanation]
    inputs: list[Explanation]
    errors: list[Explanation]
    criteria: list[Line]
    more: int  # inputs and criteria that are not listed

    @property
    def words(self) -> str:
        """Return the parameter in words, without its model."""
        return self.chain.name.rpartition(".")[2].replace("_", " ")


def face_of(chain: Explanation) -> FaceView:
    """Return the summary of the explanation of a parameter."""
    nodes = [*_nearest_first(chain)]
    inputs = [
        node for node in nodes if not node.because and node.kind not in _NO_INPUTS and node is not chain
    ]
    criteria = [line(one) for one in chain.criteria or []]
    return FaceView(
        chain,
        [node for node in nodes if node.latex is not None and not _is_own(node, chain)][:MOST_FORMULAS],
        inputs[:MOST_INPUTS],
        [node for node in nodes if "error" in node.model_fields_set],
        criteria[:MOST_CRITERIA],
        max(0, len(inputs) - MOST_INPUTS) + max(0, len(criteria) - MOST_CRITERIA),
    )


def _is_own(node: Explanation, chain: Explanation) -> bool:
    """Return whether a node is the relation of the parameter itself, which the panel shows anyway."""
    return node is chain and node.relation is not None


def _nearest_first(chain: Explanation) -> Iterator[Explanation]:
    """Yield the nodes of an explanation, those with fewer links to the parameter first."""
    level = [chain]
    while level:
        yield from level
        level = [one for node in level for one in node.because or [] if one.kind != "told_above"]
