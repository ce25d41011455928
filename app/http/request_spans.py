"""Record every request as a span; imported only if traces are on, see `app.observation.traces`."""

from __future__ import annotations

import re

from fastapi import FastAPI
from opentelemetry.trace import SpanKind
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.http.request_log import method_of, route_of
from app.observation import logs
from app.observation.traces import Traces

_TRACEPARENT = re.compile(rb"[0-9a-f]{2}-[0-9a-f]{32}-[0-9a-f]{16}-[0-9a-f]{2}")


class RequestSpans:
    """ASGI middleware that records a span with route, method, status and id of a request, without its query.

    The span continues the trace of the caller: the `traceparent` of a proxy, or the trace of the page for
    which the service calls itself.
    """

    def __init__(self, app: ASGIApp, traces: Traces) -> None:
        self.app, self.traces = app, traces

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on within a span."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        token = logs.TRACE.set(_of_caller(scope))
        try:
            await self._within_span(scope, receive, send)
        finally:
            logs.TRACE.reset(token)

    async def _within_span(self, scope: Scope, receive: Receive, send: Send) -> None:
        method = method_of(scope)
        about = {"http.request.method": method, "crankwright.request_id": logs.REQUEST_ID.get()}
        with self.traces.span(method, about, SpanKind.SERVER) as span:

            async def observed(message: Message) -> None:
                if message["type"] == "http.response.start":
                    route = route_of(scope)
                    span.update_name(f"{method} {route}")
                    span.set_attribute("http.route", route)
                    span.set_attribute("http.response.status_code", message["status"])
                await send(message)

            await self.app(scope, receive, observed)


def install(app: FastAPI, traces: Traces) -> None:
    """Wrap the whole app; other observers must be installed outside."""
    build = app.build_middleware_stack
    app.build_middleware_stack = lambda: RequestSpans(build(), traces)  # type: ignore[method-assign]


def _of_caller(scope: Scope) -> str:
    """Return the trace context that a caller sends, if it is well-formed."""
    for name, value in scope["headers"]:
        if name == b"traceparent" and _TRACEPARENT.fullmatch(value):
            return str(value.decode())
    return ""
