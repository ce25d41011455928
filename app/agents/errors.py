"""Refusals as text: what is wrong, and the remedy."""

from __future__ import annotations

import httpx

from app.client import Problem

REMEDIES = {
    401: "Remedy: send a key, `Authorization: Bearer cw_…`; with stdio, set CRANKWRIGHT_KEY.",
    403: "Remedy: ask an administrator for a key with the role, or a person to do it.",
    404: "Remedy: correct the name; the tool find lists what there is.",
    412: "Remedy: read the design again, then propose again.",
    422: "Remedy: correct each value named above; write quantities with a unit, such as '25 kN'.",
    429: "Remedy: wait, then call again.",
    503: "Remedy: wait, then call again.",
}
DOWN = "Remedy: start it with `crankwright serve`, or set CRANKWRIGHT_URL to its address."


class Refused(Exception):
    """Arguments that no request to the service can express; the text says what would be right."""


def message(error: Exception, url: str) -> str | None:
    """Return the text of a refusal; None for a fault of this program."""
    if isinstance(error, Problem):
        return _problem(error)
    if isinstance(error, Refused):
        return f"Refused: {error}"
    if isinstance(error, (UnicodeError, RecursionError)):
        return "Refused: a text is not Unicode, or the arguments nest too deep"
    if isinstance(error, httpx.TransportError):
        return f"The service at {url} does not answer: {error or type(error).__name__}. {DOWN}"
    return None


def _problem(problem: Problem) -> str:
    listed = [f"{fault.name}: {fault.detail}" for fault in problem.errors]
    lines = [f"{problem.status} {problem.described.title}", *(listed or [problem.described.detail])]
    return "\n".join([*lines[:12], *([REMEDIES[problem.status]] if problem.status in REMEDIES else [])])
