"""Streamable HTTP: hosts, origins and the caller's key are checked before any message is read."""

from __future__ import annotations

import httpx
import uvicorn
from mcp.server.transport_security import TransportSecuritySettings
from starlette.requests import Request
from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send

from app.agents.server import AgentServer
from app.client.exchange import BASE
from app.http import guard, problems
from app.http.strict_requests import HttpError
from app.identity.principal import LOCAL
from app.settings.hosts import Hosts, is_loopback

PATH = "/mcp"
LARGEST_BODY = 32 * 2**20  # bytes; a STEP file in base64 fits
RELAYED = ("content-type", "www-authenticate", "retry-after")
KEYLESS = "the service has no keys, so its tools are open to this machine only; add one: crankwright keys add"


def application(server: AgentServer, host: str, allowed: tuple[str, ...] = ()) -> ASGIApp:
    """Return the web application of the tools, which answers to `host` and to the names in `allowed`."""
    inner = server.protocol().streamable_http_app(
        streamable_http_path=PATH,
        stateless_http=True,
        json_response=True,
        max_request_body_size=LARGEST_BODY,
        transport_security=TransportSecuritySettings(enable_dns_rebinding_protection=False),  # see Door
    )
    return Door(inner, server.url, Hosts(allowed, host), is_local=is_loopback(host.lower()))


class Door:
    """The checks that every request passes before the protocol reads it.

    The key is the service's to judge: the door asks it who the caller is, and passes its refusal on.
    """

    def __init__(self, app: ASGIApp, url: str, hosts: Hosts, *, is_local: bool) -> None:
        self.app, self.url, self.hosts, self.is_local = app, url, hosts, is_local

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it."""
        if scope["type"] == "http" and (refused := await self._refusal(scope)) is not None:
            await refused(scope, receive, send)
            return
        await self.app(scope, receive, send)

    async def _refusal(self, scope: Scope) -> Response | None:
        try:
            guard.check({**scope, "method": "POST"}, self.hosts)  # reading needs an own origin, too
        except HttpError as error:
            return problems.refusal(error)
        key = {name: value for name, value in Request(scope).headers.items() if name == "authorization"}
        try:
            async with httpx.AsyncClient(base_url=self.url, trust_env=False) as client:
                answer = await client.get(f"{BASE}/me", headers=key)
        except httpx.TransportError:
            return None  # each tool says that the service does not answer
        if answer.is_error:
            headers = {name: answer.headers[name] for name in RELAYED if name in answer.headers}
            return Response(answer.content, answer.status_code, headers)
        if not self.is_local and answer.json().get("id") == LOCAL.id:
            return problems.refusal(guard.HostNotAllowed(KEYLESS))
        return None


def serve_http(url: str, host: str, port: int, allowed_hosts: tuple[str, ...]) -> None:
    """Serve callers over streamable HTTP until the process ends."""
    app = application(AgentServer(url), host, allowed_hosts)
    uvicorn.run(app, host=host, port=port, log_level="warning", access_log=False)
