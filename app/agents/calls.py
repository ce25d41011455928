"""What a call of a tool may use: the service with the caller's key, and the caller's full answers."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from dataclasses import dataclass

from pydantic import BaseModel

from app.agents.replies import SCHEME
from app.client import AsyncClient

MOST_ANSWERS = 64
LONGEST_ANSWER = 4 * 2**20  # bytes; a longer one is not stored


class AnswerStore:
    """The newest full answers in memory, each readable with the key that asked the question."""

    def __init__(self) -> None:
        self._answers: OrderedDict[str, tuple[str, str]] = OrderedDict()

    def add(self, owner: str, answer: BaseModel) -> str:
        """Store an answer, and return its resource."""
        text = answer.model_dump_json(by_alias=True, exclude_unset=True)
        if len(text) > LONGEST_ANSWER:
            return f"none: the answer has {len(text)} bytes; name the outputs that you need"
        name = _digest(owner + text)[:16]
        self._answers[name] = owner, text
        self._answers.move_to_end(name)
        while len(self._answers) > MOST_ANSWERS:
            self._answers.popitem(last=False)
        return f"{SCHEME}answers/{name}"

    def find(self, owner: str, name: str) -> str | None:
        """Return an answer as JSON; None if it is not there, or belongs to another key."""
        answer = self._answers.get(name)
        return answer[1] if answer and answer[0] == owner else None


@dataclass(frozen=True)
class Call:
    """One call by one caller."""

    service: AsyncClient
    answers: AnswerStore
    owner: str = ""

    @classmethod
    def of(cls, url: str, key: str | None, answers: AnswerStore) -> Call:
        """Open a call to a service; raise ValueError if the key does not have the form of a key."""
        return cls(AsyncClient(url, name="agent", key=key), answers, _digest(key or ""))

    def rest(self, answer: BaseModel) -> str:
        """Return the resource with a full answer."""
        return self.answers.add(self.owner, answer)


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "backslashreplace")).hexdigest()
