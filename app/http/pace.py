"""Transfer large bodies and large answers in pieces, one piece per turn of the event loop.

Without this, each of twenty simultaneous uploads would transfer a piece in every turn, and a short request
would wait for all of them several times.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping

from fastapi import Response
from starlette.types import Receive, Scope, Send

from app.workers.pieces import Pieces


class Pace:
    """Lets large transfers take turns; a transfer holds no turn while it waits for its client."""

    def __init__(self) -> None:
        self._turn = asyncio.Lock()

    async def step(self) -> None:
        """Wait for the turn to move the next piece."""
        async with self._turn:
            await asyncio.sleep(0)


class PiecesResponse(Response):
    """A response that is sent in pieces, each after the client has read most of the previous ones."""

    def __init__(self, pieces: Pieces, pace: Pace, media_type: str = "application/json") -> None:
        length: Mapping[str, str] = {"Content-Length": str(len(pieces))}
        super().__init__(headers=length, media_type=media_type)
        self.pieces, self.pace = pieces, pace

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the head, then the pieces."""
        await send({"type": "http.response.start", "status": self.status_code, "headers": self.raw_headers})
        last = len(self.pieces.parts) - 1
        for number, piece in enumerate(self.pieces):
            if number:
                await self.pace.step()
            await send({"type": "http.response.body", "body": piece, "more_body": number < last})
