"""Requests that the stopping server cuts are answered by a problem.

uvicorn cancels what is in flight at the end of the drain time, and answers with a bare 500 where nothing was
sent yet. Nothing else in the service cancels a request.
"""

from __future__ import annotations

import asyncio

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api import problems
from app.api.problem_kinds import STOPPING

RETRY_AFTER = 5  # until the service is back, if it is started again [s]


class StoppingAnswer:
    """ASGI middleware that answers 503 when a request is cancelled before its response began."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, or answer in the application's stead."""
        has_begun = False

        async def noted(message: Message) -> None:
            nonlocal has_begun
            has_begun = True
            await send(message)

        try:
            await self.app(scope, receive, noted)
        except asyncio.CancelledError:
            if scope["type"] != "http" or has_begun:
                raise
            about = problems.problem(STOPPING, "the service stopped before the answer was ready")
            await problems.answer(about, {"Retry-After": str(RETRY_AFTER)})(scope, receive, send)
